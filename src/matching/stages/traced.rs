//! Rows shown as stages leave them, where somebody takes them.

use super::left_right::compared;
use crate::matching::backend::{Isa, compared_cost};
use crate::matching::memory::Rows5;
use crate::matching::memory::record::WinnerRecord;
use crate::matching::memory::rings::{LOOK_AHEAD, waiting};
use crate::matching::memory::workspace::ForAnswers;
use crate::matching::method::{Frame, Method};
use crate::matching::trace::TracedStage;

/// Shows the winners of `newest`, before answers are made of them. What partners keep is worked out in the
/// place where the left-right check works it out again.
pub(super) fn winners<S: Method>(frame: &mut Frame<'_>, newest: usize, lines: Option<[&Rows5<'_>; 2]>) {
    let Some(trace) = &mut frame.trace else { return };
    if S::EXTERNAL_WINNERS {
        return;
    }
    let in_words = frame.backend.has_winners_in_words();
    let ForAnswers { mut winners, right, .. } = frame.workspace.for_answers();
    let width = winners.width();
    // Left of here no pixel has a candidate.
    let begin = usize::from(frame.config.min_disparity).min(width);
    let bytes = &*winners.bytes();
    let winner = |x: usize| {
        let at = |part: usize| if in_words { 4 * x + part } else { part * width + x };
        [0, 1, 2, 3].map(|part| bytes.get(at(part)).copied().unwrap_or_default())
    };
    let pixels = compared::<S>(frame.config, lines, begin, width);
    right.fill(u16::MAX);
    for x in begin..width {
        let [_, cost, _, disparity] = winner(x);
        let partner = (x - begin).wrapping_sub(disparity.into());
        let pair = pixels.and_then(|[left, right]| Some((*left.get(x - begin)?, *right.get(partner)?)));
        let cost = pair.map_or(cost, |(left, right)| compared_cost(cost, left, right));
        if let Some(kept) = right.get_mut(partner) {
            *kept = u16::from_be_bytes([cost, disparity]).min(*kept);
        }
    }
    for x in begin..width {
        let [below, cost, above, disparity] = winner(x);
        let kept = right.get((x - begin).wrapping_sub(disparity.into()));
        let [_, kept] = kept.map_or([0, disparity], |kept| kept.to_be_bytes());
        let record = WinnerRecord::new(disparity, cost, [below, above]).with_kept(kept);
        trace.winner(newest, x, record.sealed(newest as u16));
    }
}

/// Shows the answers and flags of `newest` after the left-right check and the fit to a fraction of a pixel.
pub(super) fn subpixel(frame: &mut Frame<'_>, newest: usize) {
    let Some(trace) = &mut frame.trace else { return };
    trace.row(TracedStage::Subpixel, newest, frame.band.row(newest), frame.flags.row(newest));
}

/// Shows the answers of `newest` after smoothing, and its flags, unless notes stand in their place.
pub(super) fn smoothed(frame: &mut Frame<'_>, newest: usize) {
    let Some(trace) = &mut frame.trace else { return };
    let flags = if frame.config.confidence { &[] } else { frame.flags.row(newest) };
    trace.row(TracedStage::Smoothed, newest, frame.band.row(newest), flags);
}

/// Shows the answers and flags of the row that waited for `newest`, after the filters over several rows.
pub(super) fn checked(frame: &mut Frame<'_>, newest: usize) {
    let (Some(trace), Some(row)) = (&mut frame.trace, newest.checked_sub(LOOK_AHEAD)) else { return };
    let slot = waiting(newest);
    trace.row(TracedStage::Checked, row, frame.finished.row(slot), frame.flags.row(slot));
}
