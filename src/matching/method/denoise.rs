//! The lines around a row, smoothed as the configuration asks for.
//!
//! It is done again for every row, in room that its other stages do not need yet: keeping smoothed lines
//! would take two more lines of each camera. So no row waits longer, and a row depends on the same lines as
//! without.

use crate::imaging::{Noise, smooth};
use crate::matching::backend::loops::keep_loop;
use crate::matching::memory::Rows5;

/// How far gradients are shifted to the right.
pub(super) const fn gradient_shift(noise: Noise) -> u32 {
    match noise {
        Noise::None => 0,
        Noise::Low => 1,
        Noise::High => 2,
    }
}

/// The lines of both images. Those whose number is a multiple of `every` are smoothed, each in one of the
/// places.
pub(super) fn denoise<'a>(
    lines: [&Rows5<'a>; 2],
    smoothed: &mut [Rows5<'a>; 2],
    every: usize,
    mut places: impl Iterator<Item = &'a mut [u8]>,
) {
    for (lines, smoothed) in lines.into_iter().zip(smoothed) {
        denoise_lines(lines, smoothed, every, &mut places);
    }
}

/// Denoised lines of one image.
#[cfg_attr(not(stereopsis_simd), inline(never))]
fn denoise_lines<'a>(
    lines: &Rows5<'a>,
    smoothed: &mut Rows5<'a>,
    every: usize,
    places: &mut impl Iterator<Item = &'a mut [u8]>,
) {
    for (row, (smoothed, line)) in smoothed.iter_mut().zip(lines).enumerate() {
        keep_loop();
        *smoothed = line;
        if row.is_multiple_of(every)
            && let Some(place) = places.next()
        {
            smooth(lines, row, place);
            *smoothed = place;
        }
    }
}
