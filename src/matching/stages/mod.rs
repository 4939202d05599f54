//! The stages of a row, in running order.
//!
//! ```text
//! when row y comes in (r: rows that the method looks down; BAND = 5, LOOK_AHEAD = 4, HISTORY = 5)
//!
//! stage            reads                               writes
//! method.enter     lines y - 2 .. y + 2                codes y
//! texture          line y                              texture of y, counts of the window around y - r
//! fill.undo        flags y - r - 5                     finished y - r - 5, without what was filled
//! median           band y - r - 5 .. y - r - 3         finished y - r - 4
//! method.select    codes to y                          costs, winners y - r, flags and margins y - r
//! texture.mark     counts                              flags y - r
//! left_right       winners, margins y - r              band y - r, flags y - r
//! confidence       margins y - r                       flags y - r (shared with the margins)
//! smooth           band y - r                          band y - r, surface lengths y - r
//! confidence       band y - r - 4 +- 4, finished       confidences, flags y - r - 4
//! speckle          band y - r, y - r - 1, y - r - 4    support, finished and flags y - r - 4
//! vertical         finished y - r - 5, band y - r      finished y - r - 4
//! fill             finished y - r - 4                  finished and flags y - r - 4
//! confidence       finished, flags y - r - 4           confidences y - r - 4
//! ```
//!
//! The row that comes out is `y - r - LOOK_AHEAD`.

pub(super) mod confidence;
mod fill;
mod left_right;
pub(super) mod mask;
mod median;
mod smooth;
mod speckle;
mod texture;
mod vertical;

use super::memory::rings::{BAND, HISTORY, LOOK_AHEAD, first, row, row_mut};
use super::memory::views::view_mut;
use super::memory::winners::Winner;
use super::memory::{Rows5, margins};
use super::method::{Block, Fast, Frame, Method, Sgm, SgmEdge, SgmLean, Steps};
use crate::units::{Disparity, PixelFlags};
use left_right::Winners;
use speckle::Support;
use texture::Texture;

/// The stages of a method, compiled with this crate.
macro_rules! steps {
    ($($method:ty),*) => {$(
        impl Steps for $method {
            fn step(frame: Frame<'_>, y: usize, lines: Option<[&Rows5<'_>; 2]>) {
                step::<Self>(frame, y, lines);
            }
        }
    )*};
}

steps!(Fast, Block, SgmLean, Sgm, SgmEdge);

/// Forgets the frame before.
#[inline(never)]
pub(super) fn begin(frame: Frame<'_>) {
    frame.columns.fill(0);
    Texture { history: frame.texture, counts: frame.textured }.clear();
    Support { lengths: frame.lengths, kept: frame.support }.begin(frame.band);
}

/// Takes row `y` of both images (`None` below the last one) and finishes the row that is due with it.
#[inline(always)]
fn step<S: Method>(mut frame: Frame<'_>, y: usize, lines: Option<[&Rows5<'_>; 2]>) {
    if let Some(lines) = lines {
        S::enter(&mut frame, y, lines);
    }
    if frame.config.checks.texture_pixels > 0 {
        let line = lines.and_then(|[left, _]| left[2].get(..frame.width));
        let mut texture = Texture { history: frame.texture, counts: frame.textured };
        texture.push::<S>(line, &frame.config.checks);
    }
    finish_row::<S>(&mut frame, y, lines);
}

/// Adds row `bottom`, makes the answers of the row that has its costs with it, and finishes the one that
/// waited for those.
fn finish_row<S: Method>(frame: &mut Frame<'_>, bottom: usize, lines: Option<[&Rows5<'_>; 2]>) {
    let height = usize::from(frame.config.height);
    let newest = bottom.checked_sub(S::RADIUS_Y);
    if let Some(newest) = newest {
        undo_fill(frame, newest);
        take_medians(frame, newest);
    }
    S::select(frame, bottom, lines, newest.filter(|&row| row < height));
    let Some(newest) = newest else { return };
    if newest < height {
        flag_untextured::<S>(frame, newest);
        make_answers::<S>(frame, newest);
        store_margins(frame, newest);
        smooth_along_row(frame, newest);
    } else {
        // No surface goes on below the image.
        row_mut(frame.band, newest % BAND, frame.width).fill(Disparity::NONE);
    }
    let checks = &frame.config.checks;
    make_confidences(frame, newest);
    drop_speckle(frame, newest);
    // The first row has none above it, and the last have none so far below.
    if S::VERTICAL_FILTER && checks.smoothing_radius > 0 && newest > LOOK_AHEAD && newest < height {
        let below = row(frame.band, newest % BAND, frame.width);
        vertical::vertical(frame.backend, waiting(newest), frame.finished, below);
    }
    fill_gaps(frame, newest);
    finish_confidences(frame, newest);
}

/// A row whose slots are those of the row that waits for `newest`, [`LOOK_AHEAD`] above it.
const fn waiting(newest: usize) -> usize {
    newest + BAND - LOOK_AHEAD
}

/// The flags and the answers of the row that waits for `newest`.
fn waiting_row<'a>(frame: &'a mut Frame<'_>, newest: usize) -> (&'a mut [PixelFlags], &'a mut [Disparity]) {
    let row = waiting(newest);
    (row_mut(frame.flags, row % BAND, frame.width), row_mut(frame.finished, row % HISTORY, frame.width))
}

/// Takes what was filled out of the row that came out last: the history keeps it as it was decided.
fn undo_fill(frame: &mut Frame<'_>, newest: usize) {
    if frame.config.checks.fill_pixels > 0 {
        let flags = row(frame.flags, newest % BAND, frame.width);
        fill::undo(row_mut(frame.finished, newest % HISTORY, frame.width), flags);
    }
}

/// Makes the medians of the row that waits, while the band still holds the row above it.
fn take_medians(frame: &mut Frame<'_>, newest: usize) {
    if frame.config.checks.median {
        let here = waiting(newest);
        let of_band = |y: usize| row(frame.band, y % BAND, frame.width);
        let rows = [newest, here, here + 1].map(of_band);
        median::median(frame.backend, rows, row_mut(frame.finished, here % HISTORY, frame.width));
    }
}

/// Flags the answers of `newest` whose window has too little texture.
fn flag_untextured<S: Method>(frame: &mut Frame<'_>, newest: usize) {
    let pixels = frame.config.checks.texture_pixels;
    if pixels > 0 {
        let flags = row_mut(frame.flags, newest % BAND, frame.width);
        Texture { history: frame.texture, counts: frame.textured }.mark::<S>(u16::from(pixels), flags);
    }
}

/// Turns the winners of `newest` into answers, but for those that the checks refuse.
fn make_answers<S: Method>(frame: &mut Frame<'_>, newest: usize) {
    let flags = row_mut(frame.flags, newest % BAND, frame.width);
    let answers = row_mut(frame.band, newest % BAND, frame.width);
    // The costs are done with the workspace.
    let winners = Winners { winners: frame.winners, right: frame.right, workspace: frame.workspace };
    left_right::left_right::<S>(frame.backend, frame.config, winners, answers, flags);
}

/// Keeps the margins of the winners of `newest`, which stand where the lengths of its surfaces will.
fn store_margins(frame: &mut Frame<'_>, newest: usize) {
    if frame.config.confidence {
        let margins = margins(frame.config, frame.lengths);
        let answers = row(frame.band, newest % BAND, frame.width);
        let flags = row_mut(frame.flags, newest % BAND, frame.width);
        confidence::store_margins(frame.config, margins, answers, flags);
    }
}

/// Averages the answers of `newest` within their surfaces.
fn smooth_along_row(frame: &mut Frame<'_>, newest: usize) {
    let answers = row_mut(frame.band, newest % BAND, frame.width);
    let workspace = view_mut::<u32, u16>(frame.workspace);
    smooth::smooth(frame.backend, answers, frame.lengths, workspace, &frame.config.checks);
}

/// Makes the confidences of the row that waits, where its winners stood.
fn make_confidences(frame: &mut Frame<'_>, newest: usize) {
    let Some(here) = newest.checked_sub(LOOK_AHEAD).filter(|_| frame.config.confidence) else { return };
    let (width, finished, band) = (frame.width, &*frame.finished, &*frame.band);
    let of_band = row(band, here % BAND, width);
    let answers = if frame.config.checks.median { row(finished, here % HISTORY, width) } else { of_band };
    let [near, far] = confidence::ROWS;
    let above = |off: usize| here.checked_sub(off).map_or(&[][..], |y| row(finished, y % HISTORY, width));
    let below = |off: usize| row(band, (here + off) % BAND, width);
    let columns = [above(near), above(far), below(near), below(far)];
    let neighbours = confidence::Neighbours { answers, row: of_band, columns };
    let confidences = first(view_mut::<Winner, u8>(frame.winners), width);
    confidence::confidences(&neighbours, row_mut(frame.flags, here % BAND, width), confidences);
}

/// Drops the answers of the row that waits which too few others support.
fn drop_speckle(frame: &mut Frame<'_>, newest: usize) {
    let here = waiting(newest);
    let flags = row_mut(frame.flags, here % BAND, frame.width);
    let finished = row_mut(frame.finished, here % HISTORY, frame.width);
    let mut support = Support { lengths: frame.lengths, kept: frame.support };
    support.filter(frame.backend, newest, frame.band, &frame.config.checks, flags, finished);
}

/// Closes the small gaps of the row that waits.
fn fill_gaps(frame: &mut Frame<'_>, newest: usize) {
    let checks = &frame.config.checks;
    if checks.fill_pixels > 0 {
        let (flags, finished) = waiting_row(frame, newest);
        fill::fill(finished, flags, checks.fill_pixels, checks.fill_step);
    }
}

/// Gives the row that waits its last confidences: none without an answer, the least where one was filled in.
fn finish_confidences(frame: &mut Frame<'_>, newest: usize) {
    if frame.config.confidence {
        let here = waiting(newest);
        let flags = row(frame.flags, here % BAND, frame.width);
        let finished = row(frame.finished, here % HISTORY, frame.width);
        confidence::finish(finished, flags, first(view_mut::<Winner, u8>(frame.winners), frame.width));
    }
}

/// Flags the row `index`, which just came out, as one that rests on a lost line.
pub(super) fn mark_damaged(frame: Frame<'_>, index: usize, keeps_answers: bool) {
    for flags in row_mut(frame.flags, index % BAND, frame.width) {
        let others = if keeps_answers { *flags } else { flags.without(PixelFlags::FILLED) };
        *flags = others.union(PixelFlags::DAMAGED);
    }
    if !keeps_answers {
        row_mut(frame.finished, index % HISTORY, frame.width).fill(Disparity::NONE);
        if frame.config.confidence {
            // Where the winners share the workspace, they are the first in it.
            let winners = if frame.winners.is_empty() {
                view_mut::<u32, Winner>(frame.workspace)
            } else {
                frame.winners
            };
            first(view_mut::<Winner, u8>(winners), frame.width).fill(0);
        }
    }
}
