//! Features that two pictures have in common.

use super::agreement::{FEWEST, RowFit, of_things, on_surfaces};
use super::contrast::Contrast;
use crate::correspond::{CorrespondError, Plan, correspond};
use image::GrayImage;
use nalgebra::Point2;
use stereopsis::features::Orientation;
use stereopsis::geometry::{camera::Camera, two_view::Correspondence};

/// Corners that are looked for: enough for a few hundredths of a pixel, in a few milliseconds.
const CORNERS: u16 = 600;
/// Partners in a pair to be matched are at most so many rows apart, px.
pub(super) const ROWS_APART: f64 = 12.0;
/// Corners are so far from what a camera did not see, px: its border is none.
const MARGIN: i64 = 6;
/// A disparity that is none for sure, px.
pub(super) const STILL: f64 = 1.5;
/// A disparity that neither noise nor strong compression makes of none, px.
const MOVED: f64 = 5.0;

/// Features that two pictures have in common.
#[derive(Clone, Debug)]
pub struct PairMatches {
    /// All matches, wherever they are.
    pub all: Vec<Correspondence<f64>>,
    /// Those in about the same rows.
    pub in_rows: Vec<Correspondence<f64>>,
    /// How many features each picture has.
    pub(super) features: [usize; 2],
    /// The grey levels of each picture.
    pub(super) contrast: [Contrast; 2],
    /// Columns and rows of the pictures.
    size: (u32, u32),
}

impl PairMatches {
    /// Matches two pictures; `valid` is 0 where a picture shows nothing.
    pub fn find(pictures: [&GrayImage; 2], valid: Option<[&GrayImage; 2]>) -> Result<Self, CorrespondError> {
        let plan =
            Plan { corners: CORNERS, levels: 1, orientation: Some(Orientation::Upright), ..Plan::default() };
        let contrast = [0, 1].map(|side| Contrast::of(pictures[side], valid.map(|valid| valid[side])));
        let [left, right] = [0, 1].map(|side| contrast[side].spread(pictures[side]));
        let found = correspond(&plan, &left, &right)?;
        let is_shown = |s: &Correspondence<f64>| {
            valid.is_none_or(|[left, right]| is_within(left, &s.first) && is_within(right, &s.second))
        };
        let all: Vec<_> = found
            .points()
            .map(|[x1, y1, x2, y2]| Correspondence {
                first: Point2::new(x1, y1).cast::<f64>(),
                second: Point2::new(x2, y2).cast(),
            })
            .filter(is_shown)
            .collect();
        let in_rows = all.iter().copied().filter(|s| (s.first.y - s.second.y).abs() < ROWS_APART).collect();
        let features = [found.left.len(), found.right.len()];
        Ok(Self { all, in_rows, features, contrast, size: pictures[0].dimensions() })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.all.len()
    }

    /// The share of the matches that are in the same place of both pictures, up to so many pixels.
    pub(super) fn share_within(&self, px: f64) -> f64 {
        let is_still = |s: &&Correspondence<f64>| (s.first - s.second).amax() <= px;
        self.in_rows.iter().filter(is_still).count() as f64 / self.in_rows.len().max(1) as f64
    }

    /// Whether most matches are in rows that agree with each other, there are enough of them, and their
    /// disparities are those of a pair: of a mirrored image they spread over all its width.
    pub fn is_aligned(&self) -> bool {
        self.in_rows.len() >= FEWEST
            && 2 * self.in_rows.len() > self.all.len()
            && 3.0 * middle(self.disparities_px()).spread < f64::from(self.size.0)
            && self.row_fit().is_some_and(|fit| fit.is_about_agreed())
    }

    /// Whether this is a pair for sure: aligned, with rows that are the same for most matches and disparities
    /// of what is in front of both cameras for three in four of those that move.
    pub fn is_sure(&self) -> bool {
        self.is_aligned() && self.are_positive() && self.row_fit().is_some_and(|fit| fit.is_agreed())
    }

    /// Whether most matches are in rows, and three in four of those that move have positive disparities.
    pub fn are_positive(&self) -> bool {
        let moved: Vec<_> = self.disparities_px().into_iter().filter(|d| d.abs() > STILL).collect();
        let positive = moved.iter().filter(|&&d| d > 0.0).count();
        self.in_rows.len() >= FEWEST
            && 2 * self.in_rows.len() > self.all.len()
            && 4 * positive >= 3 * moved.len()
    }

    /// Whether most matches in rows are in front of the cameras, where what is at infinity has a disparity of
    /// less than 0 by so much.
    pub fn are_in_front(&self, offset_px: f64) -> bool {
        let in_rows = self.disparities_px();
        let found = if in_rows.len() < FEWEST { self.in_moved_rows().0 } else { in_rows };
        2 * found.iter().filter(|&&d| d + offset_px > 0.0).count() > found.len()
    }

    /// How the rows lie, by a camera with a field of view of 53 degrees: rows and the roll are the same by
    /// any other.
    fn row_fit(&self) -> Option<RowFit> {
        let (w, h) = (f64::from(self.size.0), f64::from(self.size.1));
        RowFit::of(&self.in_rows, &Camera::new(w, w, (w - 1.0) / 2.0, (h - 1.0) / 2.0).ok()?)
    }

    /// Whether a part of the matches, not in the same place of both pictures, agree on where they are: with
    /// the disparities of a near or a far surface, and not of both as those of a pattern that repeats.
    pub(super) fn has_another_surface(&self) -> bool {
        let found = on_surfaces(&self.disparities_px(), self.size.0);
        let near = found.iter().filter(|&&d| d > MOVED).count();
        let far = found.iter().filter(|&&d| d < -MOVED).count();
        let (most, least) = (near.max(far), near.min(far));
        most >= FEWEST / 2 && most > 4 * least && 20 * most > self.in_rows.len()
    }

    /// Whether the matches move along columns, as far as is different, and not along rows.
    pub(super) fn moves_along_columns(&self) -> bool {
        let [along_rows, along_columns] = self.moves();
        self.all.len() >= FEWEST
            && along_rows.median.abs() < STILL
            && along_columns.median.abs() > 2.0 * STILL
            && along_columns.spread > STILL.max(3.0 * along_rows.spread)
    }

    /// Whether most matches are in about the same columns, and differ by more along columns than along rows:
    /// of a pair that stands higher or lower all differ by the same.
    pub(super) fn are_in_columns(&self) -> bool {
        let count = self.all.iter().filter(|s| (s.first.x - s.second.x).abs() < ROWS_APART).count();
        let [along_rows, along_columns] = self.moves();
        count >= FEWEST && 2 * count > self.all.len() && along_columns.spread > along_rows.spread
    }

    /// How the matches move along rows and along columns.
    fn moves(&self) -> [Middle; 2] {
        [
            middle(self.all.iter().map(|s| s.first.x - s.second.x).collect()),
            middle(self.all.iter().map(|s| s.first.y - s.second.y).collect()),
        ]
    }

    /// The disparities of the matches in rows when one of the pictures is moved up or down, and by how much
    /// it is, px: within an eighth of a low picture, as a quarter of those of chance are.
    fn in_moved_rows(&self) -> (Vec<f64>, f64) {
        let lower = |s: &Correspondence<f64>| s.second.y - s.first.y;
        let Middle { median, .. } = middle(self.all.iter().map(lower).collect());
        let apart = ROWS_APART.min(f64::from(self.size.1) / 8.0);
        let moved = self.all.iter().filter(|s| (lower(s) - median).abs() < apart);
        (moved.map(|s| s.first.x - s.second.x).collect(), median)
    }

    /// How many matches are in rows as they are, or when one of the pictures is moved up or down.
    pub(super) fn most_in_rows(&self) -> usize {
        self.in_rows.len().max(self.in_moved_rows().0.len())
    }

    /// Whether most matches are in rows when one of the pictures is moved up or down by a good deal.
    pub(super) fn are_rows_apart(&self) -> bool {
        let (moved, median) = self.in_moved_rows();
        median.abs() >= ROWS_APART && moved.len() >= FEWEST && 2 * moved.len() > self.all.len()
    }

    /// Whether over 85 % of the matches that move have negative disparities when one of the pictures is moved
    /// up or down.
    pub(super) fn are_negative_in_moved_rows(&self) -> bool {
        are_negative(&self.in_moved_rows().0)
    }

    /// The disparities of the matches in rows that agree with each other, in ascending order, px.
    pub(super) fn surfaces_px(&self) -> Vec<f64> {
        on_surfaces(&self.disparities_px(), self.size.0)
    }

    /// The disparities of what has several matches in one place, in ascending order, px.
    pub(super) fn things_px(&self) -> Vec<f64> {
        of_things(&self.in_rows, self.size.0)
    }

    /// Whether over 85 % of the matches that move have negative disparities.
    pub(super) fn are_negative(&self) -> bool {
        are_negative(&self.disparities_px())
    }

    /// The disparities of the matches in rows, in ascending order, px.
    pub(super) fn disparities_px(&self) -> Vec<f64> {
        let mut found: Vec<_> = self.in_rows.iter().map(|s| s.first.x - s.second.x).collect();
        found.sort_by(f64::total_cmp);
        found
    }
}

/// Whether over 85 % of the disparities that are no noise, of enough of them, are negative.
pub fn are_negative(disparities_px: &[f64]) -> bool {
    let moved: Vec<_> = disparities_px.iter().filter(|d| d.abs() > STILL).collect();
    let negative = moved.iter().filter(|&&&d| d < 0.0).count();
    moved.len() >= FEWEST && 20 * negative > 17 * moved.len()
}

/// The middle of some numbers, and from their lowest fifth to their highest one.
struct Middle {
    median: f64,
    spread: f64,
}

/// The middle of some numbers; all zero of none.
fn middle(mut numbers: Vec<f64>) -> Middle {
    numbers.sort_by(f64::total_cmp);
    let at = |tenths: usize| numbers.get(numbers.len() * tenths / 10).copied().unwrap_or(0.0);
    Middle { median: at(5), spread: at(8) - at(2) }
}

/// Whether a place and what is around it is shown.
fn is_within(valid: &GrayImage, place: &Point2<f64>) -> bool {
    let at = |dx: i64, dy: i64| {
        let (x, y) = (place.x.round() as i64 + dx, place.y.round() as i64 + dy);
        let pixel = u32::try_from(x).ok().zip(u32::try_from(y).ok());
        pixel.and_then(|(x, y)| valid.get_pixel_checked(x, y)).is_some_and(|pixel| pixel.0[0] != 0)
    };
    [(-MARGIN, -MARGIN), (MARGIN, -MARGIN), (-MARGIN, MARGIN), (MARGIN, MARGIN)]
        .into_iter()
        .all(|(x, y)| at(x, y))
}
