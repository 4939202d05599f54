//! Occluding edges: the sharpness of what is in front, and its blur, lie over what is behind.

use super::cells::Cells;
use super::moving_least_squares::{LocalPlane, is_within};
use super::{FocusPeak, NoFocus};

/// How far from an edge a window sees what is in front, cells: two cells, and two for what is measured in
/// them.
const STRIP: i32 = 4;
/// How far from a cell answers are that are carried to it, how many are enough, and what slopes are held back
/// by, of the weight of all: they come from one side.
const REACH: i32 = 10;
const FEWEST: u32 = 12;
const RIDGE: f32 = 0.5;
/// What answers of one surface differ by at most, 1/256 frame, however narrow their peaks are.
const LEAST: u32 = 64;

/// In which direction the frames of a stack are focused.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FocusOrder {
    /// The last frame is focused on what is nearest.
    FarToNear,
    /// The last frame is focused on what is farthest.
    NearToFar,
}

/// Whether two answers differ by more than so many twelfths of the mean width of their peaks and three
/// deviations. What a deviation has beside noise is a twelfth of the width.
fn differ(a: &FocusPeak, b: &FocusPeak, twelfths: u32) -> bool {
    let [a_12th, b_12th] = [a, b].map(|peak| peak.sigma_q8.saturating_sub(peak.noise_q8));
    let most = a_12th.saturating_add(b_12th).saturating_mul(twelfths) / 2;
    !is_within(a, b, most.max(LEAST))
}

/// Whether there is an edge between two neighbours: they differ by a quarter of their width.
fn is_edge(a: &FocusPeak, b: &FocusPeak) -> bool {
    differ(a, b, 3)
}

/// Whether two answers nearby are of one surface, which may be a slope: they differ by five twelfths at most.
fn is_one_surface(a: &FocusPeak, b: &FocusPeak) -> bool {
    !differ(a, b, 5)
}

/// Cells to either side of an edge by which [`FocusOrder::of_answers`] judges it.
const SIDE: usize = 11;
/// The mean of cells 1 to 3 from the edge less the line through cells 5 to 10, where those three are, in
/// 1/210.
const PULL: [i64; SIDE] = [0, 70, 70, 70, 0, -200, -134, -68, -2, 64, 130];

impl FocusOrder {
    /// The order that the answers tell by themselves; `None` where they don't, as without an edge in depth.
    ///
    /// Beside an edge the window of what is behind sees a part of what is in front, which pulls the answer
    /// towards it; what is in front has all of its window's light. So the side that leaves the line through
    /// its answers farther from the edge, towards the other one, is behind. All edges along rows and columns
    /// between eleven answers of one surface on either side are asked, and must agree by two deviations.
    pub fn of_answers(peaks: &[Result<FocusPeak, NoFocus>], columns: usize) -> Option<Self> {
        let cells = Cells { peaks, columns };
        let rows = peaks.len().checked_div(columns)?;
        let (mut sum, mut squares) = (0_i64, 0_i64);
        for (y, x) in (0..rows as i32).flat_map(|y| (0..columns as i32).map(move |x| (y, x))) {
            for (dx, dy) in [(1, 0), (0, 1)] {
                let first = cells.at(x, y);
                let next = cells.at(x + dx, y + dy);
                if first.zip(next).is_none_or(|(a, b)| !is_edge(&a, &b)) {
                    continue;
                }
                let before = pull(|step| cells.at(x - step * dx, y - step * dy));
                let after = pull(|step| cells.at(x + (1 + step) * dx, y + (1 + step) * dy));
                if let Some((before, after)) = before.zip(after) {
                    // Upwards on the lower side where that is behind, downwards on the higher side else.
                    let both = before + after;
                    sum = sum.saturating_add(both);
                    squares = squares.saturating_add(both.saturating_mul(both));
                }
            }
        }
        let is_told = sum.saturating_abs() > squares.isqrt().saturating_mul(2);
        is_told.then_some(if sum > 0 { Self::FarToNear } else { Self::NearToFar })
    }

    /// Whether `a` is in front of `b`, with an edge between them.
    fn is_before(self, a: &FocusPeak, b: &FocusPeak) -> bool {
        (a.position_q8 > b.position_q8) == (self == Self::FarToNear) && is_edge(a, b)
    }
}

/// How far the answers next to an edge are off the line through those farther away, 1/256 frame; `at` has
/// those of one side, from the edge on. `None` where they are not of one surface.
fn pull(at: impl Fn(i32) -> Option<FocusPeak>) -> Option<i64> {
    let (mut sum, mut before) = (0, None);
    for (step, weight) in (0..).zip(PULL) {
        let peak = at(step)?;
        if before.is_some_and(|before| is_edge(&before, &peak)) {
            return None;
        }
        sum += weight * i64::from(peak.position_q8);
        before = Some(peak);
    }
    Some(sum / 210)
}

/// A row of cells without the rim of what is in front: a cell with something behind it beside, above or below
/// has the farthest of these answers in place of its own.
///
/// The edge between two surfaces is sharp where the front one is, and the second differences of sharpness
/// reach over it: what is in front grows by a cell at least. `peaks` are all cells, row by row; `out` begins
/// with the row itself.
pub fn uncover_row(
    peaks: &[Result<FocusPeak, NoFocus>],
    columns: usize,
    row: usize,
    order: FocusOrder,
    out: &mut [Result<FocusPeak, NoFocus>],
) {
    let cells = Cells { peaks, columns };
    for (x, out) in (0..columns as i32).zip(out) {
        let Some(own) = cells.at(x, row as i32) else { continue };
        let beside = [(0, -1), (-1, 0), (1, 0), (0, 1)].map(|(dx, dy)| cells.at(x + dx, row as i32 + dy));
        let behind = beside.into_iter().flatten().filter(|beside| order.is_before(&own, beside));
        if let Some(farthest) = behind.max_by_key(|behind| behind.position_q8.abs_diff(own.position_q8)) {
            *out = Ok(farthest);
        }
    }
}

/// Which cells of a row have something in front of them within four cells: it has a part in their windows,
/// if these are 5 pixels wide. `peaks` are all cells, row by row.
pub fn partly_hidden_row(
    peaks: &[Result<FocusPeak, NoFocus>],
    columns: usize,
    row: usize,
    order: FocusOrder,
    out: &mut [bool],
) {
    let cells = Cells { peaks, columns };
    for (x, out) in (0..columns as i32).zip(out) {
        let own = cells.at(x, row as i32);
        let is_behind = |(dx, dy): (i32, i32)| {
            let near = cells.at(x + dx, row as i32 + dy);
            own.zip(near).is_some_and(|(own, near)| order.is_before(&near, &own))
        };
        let square = (-STRIP..=STRIP).flat_map(|dy| (-STRIP..=STRIP).map(move |dx| (dx, dy)));
        *out = square.filter(|(dx, dy)| dx * dx + dy * dy <= STRIP * STRIP).any(is_behind);
    }
}

/// The answers of a row of cells with those that are partly hidden replaced by the plane through answers of
/// the same surface that are not: weighted least squares over 21 by 21 cells, for what is left of their
/// windows pulls answers towards what is in front. `peaks` and `is_hidden` are all cells, row by row;
/// `out` begins with the row itself. A cell with fewer than twelve such answers around it keeps its own, and
/// no plane goes on beyond the last of `frames`.
pub fn extend_row(
    peaks: &[Result<FocusPeak, NoFocus>],
    is_hidden: &[bool],
    columns: usize,
    row: usize,
    frames: u32,
    out: &mut [Result<FocusPeak, NoFocus>],
) {
    let cells = Cells { peaks, columns };
    let last_q8 = frames.saturating_sub(1).saturating_mul(256);
    let hidden = |x: i32, y: i32| cells.index(x, y).and_then(|place| is_hidden.get(place)).copied();
    for (x, out) in (0..columns as i32).zip(out) {
        let (Ok(own), Some(true)) = (out, hidden(x, row as i32)) else { continue };
        let (mut plane, mut count) = (LocalPlane::default(), 0);
        for dy in -REACH..=REACH {
            for dx in -REACH..=REACH {
                let place = (x + dx, row as i32 + dy);
                let (Some(near), Some(false)) = (cells.at(place.0, place.1), hidden(place.0, place.1)) else {
                    continue;
                };
                if is_one_surface(own, &near) {
                    let off = near.position_q8 as f32 - own.position_q8 as f32;
                    plane.add([dx as f32, dy as f32], off, near.noise_q8 as f32);
                    count += 1;
                }
            }
        }
        if count >= FEWEST
            && let Some((value, _)) = plane.value(RIDGE)
        {
            // Rounded; a cast of what is out of range is the nearest end.
            own.position_q8 = ((own.position_q8 as f32 + value + 0.5) as u32).min(last_q8);
        }
    }
}
