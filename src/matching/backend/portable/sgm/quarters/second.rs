//! Sums that count no more, and the second best.

use super::lanes::before;
use crate::matching::backend::loops::keep_loop;
use crate::matching::memory::winners::BESIDE;

/// Makes the sums more than any other in these lanes of each word: 255 in the `open` ones of a path and in
/// those of the other two.
#[inline(always)]
pub(super) fn close_sums(path: &[u32], sums: &mut [u32], open: &mut [u32], lanes: impl Fn(usize) -> u32) {
    // It is rarely asked for: no loop is written out, whatever is known of the column.
    let (path, sums, open) = core::hint::black_box((path, sums, open));
    for (word, ((open, path), sum)) in open.iter_mut().zip(path).zip(sums).enumerate() {
        keep_loop();
        let lanes = lanes(word);
        (*open, *sum) = (path | lanes, *sum | lanes);
    }
}

/// The least cost of the candidates that are neither before the first one nor beside a winner, which `least`
/// finds.
#[inline(never)]
pub(super) fn second(
    path: &[u32],
    sums: &mut [u32],
    open: &mut [u32],
    (closed, winner): (usize, usize),
    least: impl FnOnce([&[u32]; 2]) -> u8,
) -> u8 {
    let count = sums.len();
    let [closed, below, around] =
        [closed, winner.saturating_sub(BESIDE), winner + BESIDE + 1].map(|place| before(place, count));
    close_sums(path, sums, open, |word| closed(word) | around(word) & !below(word));
    least([open, sums])
}
