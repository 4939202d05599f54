//! How sure each answer is, a byte a pixel, if asked for.
//!
//! Two things tell right answers from wrong ones: by how much the best of the candidates over two px away
//! costs more, and how far the answers around it are from it. With the margin `m = second best - winner` of
//! the costs, up to [`MOST_MARGIN`], the greatest difference `s` to an answer 4 or 8 columns left or right,
//! and `t` to one 2 or 4 rows above or below, in 1/32 px,
//!
//! `confidence = m + (K - min(s / 4, K)) + (K - min(t / 4, K))`, `K =` [`AGREEMENT`]
//!
//! with `s` and `t` apart because they go wrong apart, and at few places because those between said no more.
//! An answer that was filled in has [`FILLED`], a pixel without an answer 0.
//!
//! The number puts answers in order; it is no probability. What it is worth is the area under the
//! sparsification curve: the share of wrong answers among those that are left, while the least sure ones are
//! taken away.
//!
//! No memory is added for it. While a row waits to be judged, what is refused has flags and what is answered
//! has a margin, and the two share a byte. Margins come where the kernel leaves them, in the room for the
//! lengths of surfaces; confidences go to where the row's winners stood.

use crate::matching::backend::loops::keep_loop;
use crate::matching::config::Config;
use crate::matching::memory::winners::BESIDE;
use crate::units::{Disparity, PixelFlags};

/// The largest margin that is told apart: seven bits of the shared byte.
pub(in crate::matching) const MOST_MARGIN: u8 = 127;
/// The bit of the shared byte for [`PixelFlags::CEILING`], the one flag that stands with an answer.
const CEILING: u8 = 0x80;
/// What agreement with the answers beside it is worth, and as much that with those above and below.
pub(in crate::matching) const AGREEMENT: u8 = 40;
/// How far off the answers are that are looked at: columns to each side, rows above and below.
const COLUMNS: [usize; 2] = [4, 8];
pub(super) const ROWS: [usize; 2] = [2, 4];
/// The confidence of an answer that was filled in, the least: it has no costs of its own.
const FILLED: u8 = 1;

/// Puts the margins of a row's answers where their flags are.
#[inline(never)]
pub(super) fn store_margins(
    config: &Config,
    margins: &[u8],
    answers: &[Disparity],
    flags: &mut [PixelFlags],
) {
    // The columns before may have no candidate over two px from the winner, and so nothing to be sure by.
    let enough = usize::from(config.min_disparity) + 2 * BESIDE + 1;
    for (x, flags) in flags.iter_mut().enumerate() {
        keep_loop();
        let (Some(&margin), Some(answer)) = (margins.get(x), answers.get(x)) else { return };
        let margin = if x < enough { 0 } else { margin.min(MOST_MARGIN) };
        if answer.is_some() {
            *flags =
                PixelFlags::from_bits(margin | (CEILING * u8::from(flags.contains(PixelFlags::CEILING))));
        }
    }
}

/// The rows around one that is to be judged.
pub(super) struct Neighbours<'a> {
    /// What is to be judged.
    pub answers: &'a [Disparity],
    /// Answers of the row before the median.
    pub row: &'a [Disparity],
    /// The rows above and below, [`ROWS`] off; empty where there is none.
    pub columns: [&'a [Disparity]; 2 * ROWS.len()],
}

/// Makes confidences of the margins of a row, and gives its flags back.
#[inline(never)]
pub(super) fn confidences(neighbours: &Neighbours<'_>, flags: &mut [PixelFlags], confidences: &mut [u8]) {
    for (x, confidence) in confidences.iter_mut().enumerate() {
        keep_loop();
        let (Some(flags), Some(here)) = (flags.get_mut(x), neighbours.answers.get(x)) else { return };
        let shared = flags.bits();
        // Beside the row there is no answer, which says nothing.
        let beside = COLUMNS.map(|off| [x.wrapping_sub(off), x + off]);
        let s =
            beside.as_flattened().iter().fold(0, |most, &x| apart(*here, neighbours.row.get(x)).max(most));
        let t = neighbours.columns.iter().fold(0, |most, row| apart(*here, row.get(x)).max(most));
        let agreement = |apart: u16| AGREEMENT.saturating_sub((apart / 4).min(255) as u8);
        *confidence = (shared & MOST_MARGIN) + agreement(s) + agreement(t);
        if here.is_some() {
            *flags = PixelFlags::CEILING.when(shared & CEILING != 0);
        }
    }
}

/// How far another answer is, 0 where it is none.
#[inline(always)]
fn apart(here: Disparity, other: Option<&Disparity>) -> u16 {
    other.map_or(0, |other| if other.is_some() { other.raw().abs_diff(here.raw()) } else { 0 })
}

/// Says of a row that is judged and filled which of its pixels have no answer of their own.
#[inline(never)]
pub(super) fn finish(finished: &[Disparity], flags: &[PixelFlags], confidences: &mut [u8]) {
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
