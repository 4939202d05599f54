//! How sure each answer is, a byte a pixel, if asked for.
//!
//! Two things tell right answers from wrong ones: by how much the best of the candidates over two px away
//! costs more, and how far the answers around it are from it. With the margin `m = second best - winner` of
//! the costs, up to [`Note::MOST_MARGIN`], the greatest difference `s` to an answer 4 or 8 columns left or
//! right, and `t` to one 2 or 4 rows above or below, in 1/32 px,
//!
//! `confidence = m + (K - min(s / 4, K)) + (K - min(t / 4, K))`, `K =` [`AGREEMENT`]
//!
//! with `s` and `t` apart because they go wrong apart, and at few places because those between said no more.
//! A pixel that was refused agrees with none: where all around is refused an answer is hardly ever right.
//! Below the image all pixels count as refused, for no row below bears an answer of the last rows out.
//! An answer that was filled in has [`FILLED`], a pixel without an answer 0.
//!
//! The number puts answers in order; it is no probability. What it is worth is the area under the
//! sparsification curve: the share of wrong answers among those that are left, while the least sure ones are
//! taken away.
//!
//! No memory is added for it: [`notes`](crate::matching::memory::notes) and
//! [`workspace`](crate::matching::memory::workspace) say where margins and confidences stand.

use crate::matching::backend::loops::{keep_loop, once_without_vectors};
use crate::matching::config::Config;
use crate::matching::memory::notes::Note;
use crate::matching::memory::rings::{LOOK_AHEAD, waiting};
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::BESIDE;
use crate::matching::method::Frame;
use crate::units::{Disparity, PixelFlags};

/// What agreement with the answers beside it is worth, and as much that with those above and below.
pub(in crate::matching) const AGREEMENT: u8 = 40;
/// How far a refused pixel counts as being: so far that nothing agrees.
const MISSING: u16 = 4 * AGREEMENT as u16;
/// How far off the answers are that are looked at: columns to each side, rows above and below.
const COLUMNS: [usize; 2] = [4, 8];
const ROWS: [usize; 2] = [2, 4];
/// The confidence of an answer that was filled in, the least: it has no costs of its own.
const FILLED: u8 = 1;

/// Notes the margins of the winners of `newest`.
pub(super) fn note_margins(frame: &mut Frame<'_>, newest: usize) {
    if frame.config.confidence {
        let notes = view_mut::<PixelFlags, Note>(frame.flags.row_mut(newest));
        take_margins(frame.config, frame.workspace.margins(), frame.band.row(newest), notes);
    }
}

/// Makes the confidences of the row that waits of its notes, which become flags again.
pub(super) fn make_confidences(frame: &mut Frame<'_>, newest: usize) {
    let Some(here) = newest.checked_sub(LOOK_AHEAD).filter(|_| frame.config.confidence) else { return };
    let row = frame.band.row(here);
    let answers = if frame.config.checks.median { frame.finished.row(here) } else { row };
    let [near, far] = ROWS;
    let above = |off: usize| here.checked_sub(off).map_or(&[][..], |y| frame.finished.row(y));
    let below = |off: usize| frame.band.row(here + off);
    let columns = [above(near), above(far), below(near), below(far)];
    let notes = view_mut::<PixelFlags, Note>(frame.flags.row_mut(here));
    let neighbours = Neighbours { answers, row, columns };
    confidences(&neighbours, notes, frame.workspace.confidences());
}

/// Gives the row that waits its last confidences: none without an answer, the least where one was filled in.
pub(super) fn finish_confidences(frame: &mut Frame<'_>, newest: usize) {
    if frame.config.confidence {
        let here = waiting(newest);
        let (answers, flags) = (frame.finished.row(here), frame.flags.row(here));
        finish(answers, flags, frame.workspace.confidences());
    }
}

/// Whether column `x` has a margin: those before may have no candidate over two px from the winner, and so
/// nothing to be sure by.
#[inline(always)]
pub(super) fn has_margin(config: &Config, x: usize) -> bool {
    x > usize::from(config.min_disparity) + 2 * BESIDE
}

/// Notes the margins of a row's answers.
#[inline(never)]
fn take_margins(config: &Config, margins: &[u8], answers: &[Disparity], notes: &mut [Note]) {
    for (x, note) in notes.iter_mut().enumerate() {
        keep_loop();
        let (Some(&margin), Some(&answer)) = (margins.get(x), answers.get(x)) else { return };
        note.take(if has_margin(config, x) { margin } else { 0 }, answer);
    }
}

/// The rows around one whose confidences are made.
struct Neighbours<'a> {
    /// The row's answers, after the median where there is one.
    answers: &'a [Disparity],
    /// The row's answers before the median.
    row: &'a [Disparity],
    /// The rows above and below, [`ROWS`] off; empty where there is none.
    columns: [&'a [Disparity]; 2 * ROWS.len()],
}

/// Makes confidences of the notes of a row, which become flags again.
#[inline(never)]
fn confidences(neighbours: &Neighbours<'_>, notes: &mut [Note], confidences: &mut [u8]) {
    for (x, confidence) in confidences.iter_mut().enumerate() {
        keep_loop();
        let (Some(note), Some(here)) = (notes.get_mut(x), neighbours.answers.get(x)) else { return };
        // Beside the row there is no answer, which says nothing.
        let beside = COLUMNS.map(|off| [x.wrapping_sub(off), x + off]);
        let (mut s, mut t) = (0, 0);
        for &x in beside.as_flattened() {
            keep_loop();
            s = apart(*here, neighbours.row, x).max(s);
        }
        for row in neighbours.columns {
            keep_loop();
            t = apart(*here, row, x).max(t);
        }
        let agreement = |apart: u16| AGREEMENT.saturating_sub((apart / 4).min(255) as u8);
        *confidence = note.give_back(*here) + agreement(s) + agreement(t);
    }
}

once_without_vectors! {
    /// How far the answer in column `x` of a row is, 0 above and beside the image.
    fn apart(here: Disparity, row: &[Disparity], x: usize) -> u16 {
        row.get(x).map_or(0, |other| if other.is_some() { other.raw().abs_diff(here.raw()) } else { MISSING })
    }
}

/// Says of a finished row which of its pixels have no answer of their own.
#[inline(never)]
fn finish(finished: &[Disparity], flags: &[PixelFlags], confidences: &mut [u8]) {
    for (x, confidence) in confidences.iter_mut().enumerate() {
        keep_loop();
        let (Some(answer), Some(flags)) = (finished.get(x), flags.get(x)) else { return };
        if answer.is_none() {
            *confidence = 0;
        } else if flags.contains(PixelFlags::FILLED) || *confidence == 0 {
            *confidence = FILLED;
        }
    }
}
