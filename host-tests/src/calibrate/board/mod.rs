//! A chessboard's inner corners in a picture.
//!
//! In: a grey picture and a [`Pattern`], and the [`Markers`] in its white squares, if any. Out: the corners
//! in the board's order, to a small part of a pixel, or [`BoardError`]. In running order, at several sizes
//! of the picture until the board is found at one:
//!
//! * `level`: the picture made smaller or larger, smoothed, with its derivatives.
//! * `corners`: places where brightness is a saddle, and where two dark and two bright sectors meet.
//! * `links`: corners that an edge joins, dark on the right side of it and bright on the other all along.
//! * `grid`: corners with whole coordinates, from link to link; gaps filled, and the block that is the
//!   pattern.
//! * `order`: which of its corners is the first.
//! * `markers`: where on the board the grid is, by the markers in it: then a part of the board is enough.
//!   `dictionary`: what they look like.
//! * `refine`: the corners again in the picture itself, where all gradients around point across them.

mod corners;
mod dictionary;
mod grid;
mod level;
mod links;
mod markers;
mod order;
mod refine;

pub use dictionary::{Dictionary, Marker};
pub use markers::Markers;

use image::GrayImage;
use nalgebra::Point2;
use std::cell::LazyCell;

/// The inner corners of a chessboard: where four squares meet.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Pattern {
    columns: usize,
    rows: usize,
}

impl Pattern {
    /// A pattern of so many inner corners along a row and down a column, 3 to 64 each; `None` of others.
    pub fn new(columns: usize, rows: usize) -> Option<Self> {
        let is_one = |n: usize| (3..=64).contains(&n);
        (is_one(columns) && is_one(rows)).then_some(Self { columns, rows })
    }

    /// Corners along a row.
    pub fn columns(self) -> usize {
        self.columns
    }

    /// Corners down a column.
    pub fn rows(self) -> usize {
        self.rows
    }

    /// All of them.
    pub fn corners(self) -> usize {
        self.columns * self.rows
    }

    /// Where the corners are on the board, in squares, row by row.
    pub fn places(self) -> impl Iterator<Item = Point2<f64>> {
        (0..self.rows).flat_map(move |y| (0..self.columns).map(move |x| Point2::new(x as f64, y as f64)))
    }

    /// Whether the board looks the same when it is turned by half a turn: then its first corner cannot be
    /// told from its last.
    pub fn is_ambiguous(self) -> bool {
        (self.columns + self.rows).is_multiple_of(2)
    }
}

/// A board in a picture.
#[derive(Clone, PartialEq, Debug)]
pub struct Board {
    /// The corners in the order of [`Pattern::places`], px. The order is right-handed, seen from the camera.
    pub corners: Vec<Point2<f64>>,
    /// Which of [`Pattern::places`] each of them is, in ascending order: all of a plain chessboard.
    pub numbers: Vec<usize>,
}

/// Why there is no board.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BoardError {
    /// No corners that belong together, or far fewer than the pattern has.
    #[error("no board with {} x {} inner corners is seen; the most that belong together are \
        {most}", pattern.columns, pattern.rows)]
    NotFound {
        /// What was looked for.
        pattern: Pattern,
        /// The largest grid's corners.
        most: usize,
        /// Its columns and rows where it is a board, of another size.
        other: Option<(usize, usize)>,
    },
    /// No grid whose markers say where on the board it is.
    #[error(
        "no part of the board is seen with eight corners and markers that agree; the most corners that \
        belong together are {most}"
    )]
    NoMarkers {
        /// The largest grid's corners.
        most: usize,
    },
    /// A grid that holds the pattern in more than one place.
    #[error(
        "the board has more inner corners than the pattern, up to {columns} x {rows}; give the pattern as \
         the board is"
    )]
    Larger {
        /// Corners along the grid.
        columns: usize,
        /// Corners down the grid.
        rows: usize,
    },
}

impl BoardError {
    /// The inner corners along the longer and the shorter side of the board that is seen in place of the
    /// pattern.
    pub fn other_board(&self) -> Option<(usize, usize)> {
        let (columns, rows) = match *self {
            Self::NotFound { other, .. } => other?,
            Self::NoMarkers { .. } => return None,
            Self::Larger { columns, rows } => (columns, rows),
        };
        Some((columns.max(rows), columns.min(rows)))
    }
}

/// The largest side of a picture that is searched at once, px: more makes the search slow and no surer.
const LARGEST: u32 = 1100;
/// The least larger side of a picture's half that is searched before the picture itself, px.
const COARSE: f64 = 300.0;

/// Finds what is seen of a board with markers: eight corners or more. The markers say which corners they are,
/// so it does not matter how the board is turned.
pub fn find_marked(picture: &GrayImage, pattern: Pattern, markers: &Markers) -> Result<Board, BoardError> {
    let full = level::Level::new(picture, 1.0);
    let (mut most, mut best) = (0, Vec::new());
    for scale in scales(picture) {
        let level = level::Level::new(picture, scale);
        let corners = corners::find(&level);
        let links = links::links(&level, &corners, links::Search::MARKED);
        for mut grid in grid::grids(&corners, &links) {
            most = most.max(grid.len());
            grid.prune_marked();
            let found = markers.locate(pattern, &grid, &level, &full).unwrap_or_default();
            if found.len() > best.len() {
                best = found;
            }
        }
        // Another size finds more where much is missing.
        if 4 * best.len() >= 3 * pattern.corners() {
            break;
        }
    }
    let (numbers, corners): (Vec<_>, Vec<_>) =
        refine::refine_marked(&full, pattern, &best).into_iter().unzip();
    if numbers.len() < markers::FEWEST {
        return Err(BoardError::NoMarkers { most });
    }
    Ok(Board { corners, numbers })
}

/// The sizes at which a picture is searched, in shares of its own, in order.
fn scales(picture: &GrayImage) -> impl Iterator<Item = f64> {
    let side = f64::from(picture.width().max(picture.height()));
    let mut base = 1.0;
    while side * base > f64::from(LARGEST) {
        base /= 2.0;
    }
    let scales = [1.0, 0.5, 2.0, 0.25, 0.125].map(|scale| scale * base);
    let fits =
        move |scale: &f64| *scale <= 2.0 && side * scale >= 60.0 && side * scale <= 2.0 * f64::from(LARGEST);
    scales.into_iter().filter(fits)
}

/// Finds the board. Of a pattern that [is ambiguous](Pattern::is_ambiguous) the first row points to the
/// right, or as it does in `like`, another camera's picture of the same moment.
pub fn find(picture: &GrayImage, pattern: Pattern, like: Option<&Board>) -> Result<Board, BoardError> {
    let (mut most, mut linked, mut other, mut larger) = (0, 0, None, None);
    let full = LazyCell::new(|| level::Level::new(picture, 1.0));
    let mut scales: Vec<f64> = scales(picture).collect();
    // Most boards show at half of the size, which has a quarter of the pixels.
    if f64::from(picture.width().max(picture.height())) * scales.get(1).unwrap_or(&0.0) >= COARSE {
        scales.swap(0, 1);
    }
    for scale in scales {
        let level = level::Level::new(picture, scale);
        let corners = corners::find(&level);
        let links = links::links(&level, &corners, links::Search::PLAIN);
        for mut grid in grid::grids(&corners, &links) {
            // Of the corners that links join: what is put in later may lie beyond the board.
            if grid.len() > linked {
                (linked, other) = (grid.len(), grid.board_size());
            }
            grid.prune();
            // Corners that links missed are looked for where they are needed.
            let found = match grid.block(pattern) {
                Err(None) => {
                    grid.complete(&level, &corners);
                    grid.block(pattern)
                }
                found => found,
            };
            most = most.max(grid.len());
            match found {
                Ok(block) => {
                    let found = order::order(&block, pattern, like);
                    let places = found.into_iter().map(|p| level.to_picture(&p));
                    let saddle = |place| full.saddle(&place, 0.5 / scale).unwrap_or(place);
                    let places = places.map(saddle).collect();
                    if let Some(corners) = refine::refine(&full, pattern, places) {
                        return Ok(Board { corners, numbers: (0..pattern.corners()).collect() });
                    }
                }
                Err(Some((columns, rows))) => {
                    // The largest grid of the first size that shows one.
                    larger.get_or_insert(BoardError::Larger { columns, rows });
                }
                Err(None) => {}
            }
        }
    }
    Err(larger.unwrap_or(BoardError::NotFound { pattern, most, other }))
}
