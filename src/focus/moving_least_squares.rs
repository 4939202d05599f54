//! Moving least squares (Lancaster & Salkauskas 1981): smoothing of a focus map by local planes.

use super::cells::Cells;
use super::{FocusPeak, NoFocus};

/// Places that are looked at to either side, in steps of 1, 2 or 4 cells.
const REACH: i32 = 3;
/// Noise from which on that step is taken, 1/256 frame: a tenth of a frame, two and four.
const STEPS: [(u32, i32); 3] = [(102, 4), (51, 2), (26, 1)];
/// What answers of one surface differ by without noise, and what none is surer than, 1/256 frame.
const NEAR: u32 = 90;
const SUREST: f32 = 38.0;
/// How many times the variance of answers may be that of their distances from a plane.
const FARTHEST: f32 = 2.0;
/// What a slope is held back by, of the weight of all.
const RIDGE: f32 = 1e-3;

/// The answers of a row of cells, each the value at its own place of the plane that fits best to the answers
/// around it, in proportion to one over their variance: moving least squares (Lancaster & Salkauskas 1981).
/// `peaks` are all cells, row by row; `out` has the medians of that row ([`median_row`](super::median_row)),
/// which say what answers are of the same surface: those within a third of a frame and three
/// deviations.
///
/// An answer that noise moves by less than a tenth of a frame stays as it is; others see 7 by 7 answers
/// around them, one, two or four cells apart, the more noise the farther. For a window's sharpness is shared
/// by its neighbours, and only what lies farther away adds anything new. A plane and no mean, as weights are
/// not the same on both sides of a slope. Where the answers are farther from the plane than their noise
/// explains, the surface is curved: the next shorter step is taken, and without one the median stays. No
/// answer leaves the range of those that it comes from. A cell without an answer stays so, and one keeps
/// its own deviation and confidence.
pub fn plane_row(
    peaks: &[Result<FocusPeak, NoFocus>],
    columns: usize,
    row: usize,
    out: &mut [Result<FocusPeak, NoFocus>],
) {
    let cells = Cells { peaks, columns };
    for (x, own) in (0..columns as i32).zip(out) {
        let Ok(own) = own else { continue };
        for &(_, step) in STEPS.iter().filter(|(least, _)| own.noise_q8 >= *least) {
            let mut plane = LocalPlane::default();
            let (mut lowest, mut highest) = (own.position_q8, own.position_q8);
            for dy in -REACH..=REACH {
                for dx in -REACH..=REACH {
                    let Some(near) = cells.at(x + step * dx, row as i32 + step * dy) else { continue };
                    if is_within(own, &near, NEAR) {
                        let off = near.position_q8 as f32 - own.position_q8 as f32;
                        plane.add([dx as f32, dy as f32], off, near.noise_q8 as f32);
                        lowest = lowest.min(near.position_q8);
                        highest = highest.max(near.position_q8);
                    }
                }
            }
            if let Some((value, true)) = plane.value(RIDGE) {
                // Rounded; a cast of what is out of range is the nearest end.
                own.position_q8 = ((own.position_q8 as f32 + value + 0.5) as u32).clamp(lowest, highest);
                break;
            }
        }
    }
}

/// Whether two answers differ by no more than `near` and three deviations of their difference. In integers,
/// for an answer at the very bound belongs to a surface or does not on every machine alike.
pub(super) fn is_within(a: &FocusPeak, b: &FocusPeak, near: u32) -> bool {
    let square = |value: u32| u64::from(value).saturating_mul(value.into());
    let variance = square(a.noise_q8).saturating_add(square(b.noise_q8));
    square(a.position_q8.abs_diff(b.position_q8).saturating_sub(near)) <= variance.saturating_mul(9)
}

/// The normal equations of a plane `z + a x + b y` through weighted answers.
#[derive(Default)]
pub(super) struct LocalPlane {
    weight: f32,
    /// Sums of weight and place, and of weight and its square and product.
    places: [f32; 2],
    squares: [f32; 2],
    product: f32,
    /// Sums of weight and answer, and of these and place.
    value: f32,
    values: [f32; 2],
    /// Sums of weight and squared answer, and of weight and variance.
    energy: f32,
    noise: f32,
}

impl LocalPlane {
    /// Adds an answer at a place, with its noise, 1/256 frame.
    pub(super) fn add(&mut self, [x, y]: [f32; 2], value: f32, noise: f32) {
        let weight = SUREST * SUREST / (noise * noise + SUREST * SUREST);
        self.energy += weight * value * value;
        self.noise += weight * noise * noise;
        self.weight += weight;
        let [px, py] = &mut self.places;
        let [sx, sy] = &mut self.squares;
        let [vx, vy] = &mut self.values;
        *px += weight * x;
        *py += weight * y;
        *sx += weight * x * x;
        *sy += weight * y * y;
        self.product += weight * x * y;
        self.value += weight * value;
        *vx += weight * x * value;
        *vy += weight * y * value;
    }

    /// Value of the plane at the place itself, and whether answers are as near to it as their noise says;
    /// `None` without answers. The slopes come from sums about the weighted mean, of which the ridge, a
    /// share of the weight of all, bounds the condition: in those about the place itself a lone answer at
    /// the side leaves the determinant nothing but rounding.
    pub(super) fn value(&self, ridge: f32) -> Option<(f32, bool)> {
        if self.weight <= 0.0 {
            return None;
        }
        let [mean_x, mean_y] = self.places.map(|sum| sum / self.weight);
        let mean = self.value / self.weight;
        let [px, py] = self.places;
        let [sx, sy] = self.squares;
        let [vx, vy] = self.values;
        let ridge = ridge * self.weight;
        let (sx, sy) = (sx - px * mean_x + ridge, sy - py * mean_y + ridge);
        let product = self.product - px * mean_y;
        let (vx, vy) = (vx - px * mean, vy - py * mean);
        let determinant = sx * sy - product * product;
        let (a, b) = if determinant > 0.0 {
            ((vx * sy - vy * product) / determinant, (vy * sx - vx * product) / determinant)
        } else {
            (0.0, 0.0)
        };
        let off_plane = self.energy - self.value * mean - a * vx - b * vy;
        Some((mean - a * mean_x - b * mean_y, off_plane <= FARTHEST * self.noise))
    }
}
