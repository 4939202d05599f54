//! Winners become answers with flags.
//!
//! * The left-right check: [`consistency`].
//! * The fraction of a pixel: [`subpixel`].
//! * What is flat, or at the end of the search; and what of all this refuses an answer: here.
//!
//! * `pixels`: pixel by pixel.
//! * `lanes`: pixels side by side, for the kernels in vectors.
//!
//! Both give the same. The work is the same for every row.

mod consistency;
#[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
mod lanes;
mod pixels;
mod subpixel;

use super::config::Config;
#[cfg(stereopsis_dsp)]
use super::kernels::bytes::{self, Refused};
use super::kernels::{Kernel, Winner};
#[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
use super::kernels::{WinnerRows, bytes_mut};
use super::scheme::Scheme;
use crate::units::{Disparity, PixelFlags};

/// A row between the kernel and its answers. All slices but the room have the row's width.
pub(super) struct Winners<'a> {
    /// The winners.
    pub winners: &'a mut [Winner],
    /// Room for what each right column keeps.
    pub right: &'a mut [u16],
    /// Room for two bytes a pixel.
    pub room: &'a mut [u32],
}

/// Which winners are refused.
struct Rules {
    min_disparity: u16,
    /// The last candidate.
    ceiling: u8,
    /// How far from the disparity that the partner keeps, px.
    tolerance: u8,
    /// The flag of winners that are flat.
    flat: PixelFlags,
    /// The flags that refuse.
    refused: PixelFlags,
}

/// Makes answers of the winners, none of those that the checks contradict, and tells why: of `flags` those
/// stay that are said already.
pub(super) fn answer<S: Scheme>(
    kernel: Kernel,
    config: &Config,
    row: Winners<'_>,
    answers: &mut [Disparity],
    flags: &mut [PixelFlags],
) {
    let checks = &config.checks;
    let rules = Rules {
        min_disparity: config.min_disparity,
        ceiling: (config.disparities - 1) as u8,
        // Where nothing is checked, nothing is over the tolerance.
        tolerance: checks.left_right_px.unwrap_or(u8::MAX),
        flat: PixelFlags::UNTEXTURED.when(checks.refuse_flat),
        refused: PixelFlags::UNTEXTURED
            .union(PixelFlags::AMBIGUOUS)
            .union(PixelFlags::MISMATCH)
            .union(PixelFlags::CEILING.when(checks.refuse_ceiling)),
    };
    // Left of here no pixel has a candidate.
    let width = answers.len();
    let begin = usize::from(config.min_disparity).min(width);
    let (outside, answers) = answers.split_at_mut_checked(begin).unwrap_or_default();
    outside.fill(Disparity::NONE);
    let (outside, flags) = flags.split_at_mut_checked(begin).unwrap_or_default();
    outside.fill(PixelFlags::OUTSIDE);
    let Winners { winners, right, room } = row;
    #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
    if kernel.has_vectors() {
        let winners = WinnerRows::of(winners, begin);
        let (kept, fractions) = bytes_mut(room).split_at_mut_checked(width).unwrap_or_default();
        lanes::keep(&winners, right, kept);
        return kernel.in_vectors(
            #[inline(always)]
            || lanes::answer::<S>(&winners, kept, &rules, fractions, answers, flags),
        );
    }
    let _ = (kernel, room);
    let winners = winners.get(begin..).unwrap_or(&[]);
    #[cfg(not(stereopsis_dsp))]
    pixels::offer(winners, right);
    #[cfg(stereopsis_dsp)]
    bytes::offer(winners, right);
    #[cfg(stereopsis_dsp)]
    if S::STEP == 0 {
        let Rules { min_disparity, ceiling, tolerance, flat, refused } = rules;
        let refused = Refused { min_disparity, ceiling, tolerance, flat, flags: refused };
        return bytes::answer(winners, right, &refused, answers, flags);
    }
    pixels::answer::<S>(winners, right, &rules, answers, flags);
}
