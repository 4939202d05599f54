//! Features that two pictures have in common.

use crate::correspond::{CorrespondError, Plan, correspond};
use image::GrayImage;
use nalgebra::Point2;
use stereopsis::features::Orientation;
use stereopsis::geometry::two_view::Correspondence;

/// Corners that are looked for: enough for a few hundredths of a pixel, in a few milliseconds.
const CORNERS: u16 = 600;
/// Partners in a pair to be matched are at most so many rows apart, px.
pub(super) const ROWS_APART: f64 = 12.0;
/// Corners are so far from what a camera did not see, px: its border is none.
const MARGIN: i64 = 6;
/// With fewer matches nothing is said.
pub(super) const FEWEST: usize = 16;
/// A disparity that is none for sure, px.
pub(super) const STILL: f64 = 1.5;

/// Features that two pictures have in common.
#[derive(Clone, Debug)]
pub struct PairMatches {
    /// All matches, wherever they are.
    pub(super) all: Vec<Correspondence<f64>>,
    /// Those in about the same rows.
    pub in_rows: Vec<Correspondence<f64>>,
}

impl PairMatches {
    /// Matches two pictures; `valid` is 0 where a picture shows nothing.
    pub fn find(pictures: [&GrayImage; 2], valid: Option<[&GrayImage; 2]>) -> Result<Self, CorrespondError> {
        let plan =
            Plan { corners: CORNERS, levels: 1, orientation: Some(Orientation::Upright), ..Plan::default() };
        let found = correspond(&plan, pictures[0], pictures[1])?;
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
        Ok(Self { all, in_rows })
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

    /// Whether most matches are in rows, there are enough of them, and their disparities are those of a pair:
    /// of a mirrored image they spread over all its width.
    pub fn is_aligned(&self, width: u32) -> bool {
        self.in_rows.len() >= FEWEST
            && 2 * self.in_rows.len() > self.all.len()
            && 3.0 * middle(self.disparities_px()).spread < f64::from(width)
    }

    /// Whether the matches move along columns, as far as is different, and not along rows.
    pub(super) fn moves_along_columns(&self) -> bool {
        let along_rows = middle(self.all.iter().map(|s| s.first.x - s.second.x).collect());
        let along_columns = middle(self.all.iter().map(|s| s.first.y - s.second.y).collect());
        self.all.len() >= FEWEST
            && along_rows.median.abs() < STILL
            && along_columns.median.abs() > 2.0 * STILL
            && along_columns.spread > STILL.max(3.0 * along_rows.spread)
    }

    /// Whether most matches are in rows when one of the pictures is moved up or down. (In a flat picture
    /// chance may say so.)
    pub(super) fn are_rows_apart(&self, height: u32) -> bool {
        let lower = |s: &Correspondence<f64>| s.second.y - s.first.y;
        let Middle { median, .. } = middle(self.all.iter().map(lower).collect());
        let count = self.all.iter().filter(|s| (lower(s) - median).abs() < ROWS_APART).count();
        count >= FEWEST && 2 * count > self.all.len() && f64::from(height) > 8.0 * ROWS_APART
    }

    /// The disparities of the matches in rows, in ascending order, px.
    pub(super) fn disparities_px(&self) -> Vec<f64> {
        let mut found: Vec<_> = self.in_rows.iter().map(|s| s.first.x - s.second.x).collect();
        found.sort_by(f64::total_cmp);
        found
    }
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
