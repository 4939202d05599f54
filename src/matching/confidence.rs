//! How sure each answer is, a byte a pixel, if asked for.
//!
//! Two things tell right answers from wrong ones: by how much the best of the candidates over two px away costs more, and how
//! far the answers around it are from it. With the margin `m = second best - winner` of the costs, up to [`MOST_MARGIN`], the
//! greatest difference `s` to an answer 4 or 8 columns left or right, and `t` to one 2 or 4 rows above or below, in 1/32 px,
//!
//! `confidence = m + (K - min(s / 4, K)) + (K - min(t / 4, K))`, `K =` [`AGREEMENT`]
//!
//! with `s` and `t` apart because they go wrong apart, and at few places because those between said no more. An answer that was
//! filled in has [`FILLED`], a pixel without an answer 0.
//!
//! The number puts answers in order; it is no probability. What it is worth is the area under the sparsification curve: the share
//! of wrong answers among those that are left, while the least sure ones are taken away.
//!
//! No memory is added for it. While a row waits to be judged, what is refused has flags and what is answered has a margin,
//! and the two share a byte. Margins come where the kernel leaves them, in the room for the lengths of surfaces;
//! confidences go to where the row's winners stood.

use super::config::Config;
use super::kernels::{BESIDE, bytes_of_halves};
use super::memory::first;
use crate::units::{Disparity, PixelFlags};

/// The largest margin that is told apart: seven bits of the shared byte.
pub(super) const MOST_MARGIN: u8 = 127;
/// The bit of the shared byte for [`PixelFlags::CEILING`], the one flag that stands with an answer.
const CEILING: u8 = 0x80;
/// What agreement with the answers beside it is worth, and as much that with those above and below.
pub(super) const AGREEMENT: u8 = 40;
/// How far off the answers are that are looked at: columns to each side, rows above and below.
const COLUMNS: [usize; 2] = [4, 8];
pub(super) const ROWS: [usize; 2] = [2, 4];
/// The confidence of an answer that was filled in, the least: it has no costs of its own.
const FILLED: u8 = 1;

/// Room for the margins of a row: the lengths of its surfaces are counted later. Empty where no confidences are asked for.
#[inline(always)]
pub(super) fn margins<'a>(config: &Config, lengths: &'a mut [u16]) -> &'a mut [u8] {
    if config.confidence { first(bytes_of_halves(lengths), usize::from(config.width)) } else { &mut [] }
}

/// Puts the margins of a row's answers where their flags are.
#[inline(never)]
pub(super) fn keep(config: &Config, margins: &mut [u8], answers: &[Disparity], flags: &mut [PixelFlags]) {
    // These may have no candidate over two px from the winner, and so nothing to be sure by.
    let begin = usize::from(config.min_disparity).min(margins.len());
    let few = begin..margins.len().min(begin + 2 * BESIDE + 1);
    margins.get_mut(few).unwrap_or_default().fill(0);
    for (flags, (&margin, answer)) in flags.iter_mut().zip(margins.iter().zip(answers)) {
        let shared = margin.min(MOST_MARGIN) | CEILING * u8::from(flags.contains(PixelFlags::CEILING));
        *flags = if answer.is_some() { PixelFlags::from_bits(shared) } else { *flags };
    }
}

/// Makes confidences of the margins of a row, of which `answers` are those that are to be judged and `row` what they were
/// before the median, and gives its flags back. `columns` are the rows above and below, `room` has a byte for each pixel.
#[inline(never)]
pub(super) fn tell<'a>(
    answers: &[Disparity],
    row: &[Disparity],
    columns: impl Iterator<Item = &'a [Disparity]>,
    flags: &mut [PixelFlags],
    [confidences, room]: [&mut [u8]; 2],
) {
    for ((flags, answer), confidence) in flags.iter_mut().zip(answers).zip(confidences.iter_mut()) {
        let shared = flags.bits();
        *confidence = shared & MOST_MARGIN;
        *flags = if answer.is_some() { PixelFlags::CEILING.when(shared & CEILING != 0) } else { *flags };
    }
    room.fill(0);
    for off in COLUMNS {
        apart(answers, row.get(off..).unwrap_or(&[]), room);
        let (right, room) = (answers.get(off..).unwrap_or(&[]), room.get_mut(off..).unwrap_or_default());
        apart(right, row, room);
    }
    agree(room, confidences);
    room.fill(0);
    for other in columns {
        apart(answers, other, room);
    }
    agree(room, confidences);
}

/// Keeps in `most` how far an answer is from another one, in quarters of steps, up to [`AGREEMENT`].
#[inline(never)]
fn apart(answers: &[Disparity], others: &[Disparity], most: &mut [u8]) {
    for ((answer, other), most) in answers.iter().zip(others).zip(most) {
        let apart = (answer.raw().abs_diff(other.raw()) / 4).min(u16::from(AGREEMENT)) as u8;
        // No answer says nothing.
        *most = (*most).max(if other.is_some() { apart } else { 0 });
    }
}

/// Adds what is left of the agreement.
fn agree(apart: &[u8], confidences: &mut [u8]) {
    for (confidence, apart) in confidences.iter_mut().zip(apart) {
        *confidence += AGREEMENT - apart;
    }
}

/// Says of a row that is judged and filled which of its pixels have no answer of their own.
#[inline(never)]
pub(super) fn judge(finished: &[Disparity], flags: &[PixelFlags], confidences: &mut [u8]) {
    for (confidence, (answer, flags)) in confidences.iter_mut().zip(finished.iter().zip(flags)) {
        let own = if flags.contains(PixelFlags::FILLED) { FILLED } else { (*confidence).max(FILLED) };
        *confidence = if answer.is_some() { own } else { 0 };
    }
}
