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

use crate::matching::backend::loops::{keep_length, keep_loop, once_without_vectors};
use crate::matching::config::Config;
use crate::matching::memory::notes::Note;
use crate::matching::memory::rings::{LOOK_AHEAD, waiting};
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::BESIDE;
use crate::matching::method::Frame;
use crate::units::{Disparity, PixelFlags};

/// What agreement with the answers beside it is worth, and as much that with those above and below.
const AGREEMENT: u8 = 40;
const _: () =
    assert!(Note::MOST_MARGIN + 2 * AGREEMENT == Config::MOST_CONFIDENCE, "what all that agrees gives");
/// How far a refused pixel counts as being: so far that nothing agrees.
const MISSING: u16 = 4 * AGREEMENT as u16;
/// How far off the answers are that are looked at: along the row, and above and below.
const COLUMNS: [isize; 4] = [-8, -4, 4, 8];
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
    let column = [above(near), above(far), below(near), below(far)].map(|row| (row, 0));
    let neighbours = Neighbours { answers, along: COLUMNS.map(|off| (row, off)), column };
    let notes = view_mut::<PixelFlags, Note>(frame.flags.row_mut(here));
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
    /// Those along the row, before the median.
    along: [Neighbour<'a>; COLUMNS.len()],
    /// Those above and below; in an empty row where there is none.
    column: [Neighbour<'a>; 2 * ROWS.len()],
}

/// An answer beside each one of a row: the row that it stands in, and how many columns farther right.
type Neighbour<'a> = (&'a [Disparity], isize);

/// Makes confidences of the notes of a row, which become flags again.
#[inline(never)]
fn confidences(neighbours: &Neighbours<'_>, notes: &mut [Note], confidences: &mut [u8]) {
    for (x, confidence) in confidences.iter_mut().enumerate() {
        keep_loop();
        let (Some(note), Some(here)) = (notes.get_mut(x), neighbours.answers.get(x)) else { return };
        let beside = agreement(*here, &neighbours.along, x) + agreement(*here, &neighbours.column, x);
        *confidence = note.give_back(*here) + beside;
    }
}

once_without_vectors! {
    /// What it is worth that the neighbours of the answer in column `x` agree with it. Above and beside the
    /// image there is none, which says nothing.
    fn agreement(here: Disparity, neighbours: &[Neighbour<'_>], x: usize) -> u8 {
        let mut most = 0;
        for &(row, off) in keep_length(neighbours) {
            keep_loop();
            if let Some(other) = row.get(x.wrapping_add_signed(off)) {
                most = most.max(if other.is_some() { other.raw().abs_diff(here.raw()) } else { MISSING });
            }
        }
        AGREEMENT.saturating_sub((most / 4).min(255) as u8)
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
