//! The two methods whose costs are sums over a window: their census, the window, and how much of a column's
//! sum a window's is made of.
//!
//! Every window's sum fits a byte. Where the bits under a window are more than that, the lowest digits of its
//! columns' sums are left out: `block` adds quarters of them, rounded down. On real pairs that hardly shows,
//! while the windows take half the registers of a vector, and two of ten bit planes less.

use super::confidence;
#[cfg(target_pointer_width = "64")]
use super::kernels::Group;
#[cfg(not(stereopsis_vectors))]
use super::kernels::codes;
use super::kernels::{RowWork, Select, TABLE_WORDS, Unique, bytes_of, bytes_of_halves};
use super::memory::{Bytes, WindowMemory};
use super::quiet::quiet;
use super::row::slot;
use super::scheme::{Around, Lines, Scheme};
use super::speckle::BAND;
use super::stages::{Stages, slot_mut};
use crate::imaging::{Noise, census_plus4, census_ring8};
use crate::units::PixelFlags;

/// A method whose costs are sums over a window.
pub trait Windowed: Scheme {
    /// Bits of a census code.
    const BITS: usize;
    /// Bits of a column's sum.
    const COLUMN_BITS: usize;
    /// Lowest bits of a column's sum that are left out of a window's.
    const COLUMN_SHIFT: usize;
    /// The census row at the centre of five rows.
    fn census(rows: &Around<'_>, out: &mut [u8]);
    /// The codes of four pixels, from the words around them: rows, and columns two to the left, here, two to
    /// the right.
    #[cfg(not(stereopsis_vectors))]
    fn codes(around: &[[u32; 3]; 3]) -> u32;
    /// What a code is compared by with [`Self::apart`].
    #[cfg(target_pointer_width = "64")]
    fn key<G: Group>(code: u8) -> G;
    /// How many bits of a code, whose key this is, and of others differ.
    #[cfg(target_pointer_width = "64")]
    fn apart<G: Group>(key: G, others: G) -> G;
    /// The digits of columns' sums that a window adds up.
    #[cfg(target_pointer_width = "64")]
    fn digits<G: Group>(columns: G) -> G;
    /// How many bits are set in each byte of two words together, of the bits that a code has.
    #[cfg(not(stereopsis_vectors))]
    fn bits_of_two(a: u32, b: u32) -> u32;
}

/// Census rows that are held: those under the window and the one that leaves it, row `y` in slot `y % rows`.
const fn rows<S: Windowed>() -> usize {
    2 * S::RADIUS_Y + 2
}

/// Bytes that a pixel's two codes take: one, where no kernel wants more.
pub(super) const fn code_bytes<S: Windowed>() -> usize {
    if cfg!(stereopsis_dsp) && S::BITS <= 4 { 1 } else { 2 }
}

/// Words for the tables of the kernel that has some.
const fn table_words<S: Windowed>() -> usize {
    if cfg!(stereopsis_dsp) { most_table_words::<S>() } else { 0 }
}

/// The same for any kernel: a matcher's bytes are told for all processors alike.
const fn most_table_words<S: Windowed>() -> usize {
    if S::BITS <= 4 { TABLE_WORDS } else { 0 }
}

/// What the arithmetic relies on.
const fn check<S: Windowed>() {
    let column = S::BITS * (2 * S::RADIUS_Y + 1);
    assert!(
        column < 1 << S::COLUMN_BITS && S::COLUMN_BITS <= 8,
        "a column's sum must fit its bits, and a byte"
    );
    let window = (column >> S::COLUMN_SHIFT) * (2 * S::RADIUS_X + 1);
    assert!(window < u8::MAX as usize, "a window's sum must fit a byte, and be no 255");
}

/// [`Lines`] of a window.
macro_rules! window_lines {
    ($method:ty) => {
        const _: () = check::<$method>();

        impl Lines for $method {
            type Memory<const W: usize, const D: usize> = WindowMemory<
                { code_bytes::<$method>() },
                { rows::<$method>() },
                { table_words::<$method>() },
                W,
                D,
            >;
            const BYTES: Bytes =
                WindowMemory::<2, { rows::<$method>() }, { most_table_words::<$method>() }, 0, 0>::BYTES;

            #[inline(always)]
            fn enter(stages: &mut Stages<'_, Self>, y: usize, lines: [&Around<'_>; 2]) {
                stages.enter_codes(y, lines);
            }

            // For the reason that `Kernel::row` is inlined.
            #[inline(always)]
            fn select(
                stages: &mut Stages<'_, Self>,
                bottom: usize,
                lines: Option<[&Around<'_>; 2]>,
                row: Option<usize>,
            ) {
                if lines.is_some() || row.is_some() {
                    stages.select_windows(bottom, lines.is_some(), row);
                }
            }

            fn step(stages: Stages<'_, Self>, y: usize, lines: Option<[&Around<'_>; 2]>) {
                stages.step(y, lines);
            }
        }
    };
}

window_lines!(Fast);
window_lines!(Block);

/// The neighbours of [`census_plus4`] and [`census_ring8`] in order of their bits, two rows and columns to a
/// step.
#[cfg(not(stereopsis_vectors))]
const PLUS4: [(usize, usize); 4] = [(0, 1), (1, 0), (1, 2), (2, 1)];
#[cfg(not(stereopsis_vectors))]
const RING8: [(usize, usize); 8] = [(0, 0), (0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1), (2, 2)];

/// Method `fast`: a 4-bit census (up, down, left, right at distance 2) summed over 9x7 pixels.
#[derive(Clone, Copy, Debug)]
pub struct Fast;

impl Scheme for Fast {
    const RADIUS_X: usize = 4;
    const RADIUS_Y: usize = 3;
    const SIGMA_PX: f32 = 0.15;
    const NAME: &'static str = "fast";
}

impl Windowed for Fast {
    const BITS: usize = 4;
    const COLUMN_BITS: usize = 5;
    const COLUMN_SHIFT: usize = 0;

    fn census(rows: &Around<'_>, out: &mut [u8]) {
        census_plus4(rows, out);
    }

    #[cfg(not(stereopsis_vectors))]
    #[inline(always)]
    fn codes(around: &[[u32; 3]; 3]) -> u32 {
        codes(around, &PLUS4)
    }

    #[cfg(target_pointer_width = "64")]
    #[inline(always)]
    fn key<G: Group>(code: u8) -> G {
        G::key_of_four(code)
    }

    #[cfg(target_pointer_width = "64")]
    #[inline(always)]
    fn apart<G: Group>(key: G, others: G) -> G {
        key.four_bits_apart(others)
    }

    #[cfg(target_pointer_width = "64")]
    #[inline(always)]
    fn digits<G: Group>(columns: G) -> G {
        columns
    }

    #[cfg(not(stereopsis_vectors))]
    #[inline(always)]
    fn bits_of_two(a: u32, b: u32) -> u32 {
        // The two times four bits fill a byte.
        let bits = (a & 0x0f0f_0f0f) | (b & 0x0f0f_0f0f) << 4;
        let pairs = bits - (bits >> 1 & 0x5555_5555);
        let fours = (pairs & 0x3333_3333) + (pairs >> 2 & 0x3333_3333);
        (fours + (fours >> 4)) & 0x0f0f_0f0f
    }
}

/// Method `block`: an 8-bit census in 5x5 summed over 9x9 pixels, in quarters.
#[derive(Clone, Copy, Debug)]
pub struct Block;

impl Scheme for Block {
    const RADIUS_X: usize = 4;
    const RADIUS_Y: usize = 4;
    const SIGMA_PX: f32 = 0.15;
    const NAME: &'static str = "block";
}

impl Windowed for Block {
    const BITS: usize = 8;
    const COLUMN_BITS: usize = 7;
    const COLUMN_SHIFT: usize = 2;

    fn census(rows: &Around<'_>, out: &mut [u8]) {
        census_ring8(rows, out);
    }

    #[cfg(not(stereopsis_vectors))]
    #[inline(always)]
    fn codes(around: &[[u32; 3]; 3]) -> u32 {
        codes(around, &RING8)
    }

    #[cfg(target_pointer_width = "64")]
    #[inline(always)]
    fn key<G: Group>(code: u8) -> G {
        G::splat(code)
    }

    #[cfg(target_pointer_width = "64")]
    #[inline(always)]
    fn apart<G: Group>(key: G, others: G) -> G {
        key.bits_apart(others)
    }

    #[cfg(target_pointer_width = "64")]
    #[inline(always)]
    fn digits<G: Group>(columns: G) -> G {
        columns.quarter()
    }

    #[cfg(not(stereopsis_vectors))]
    #[inline(always)]
    fn bits_of_two(a: u32, b: u32) -> u32 {
        let pairs = |bits: u32| bits - (bits >> 1 & 0x5555_5555);
        let fours = |pairs: u32| (pairs & 0x3333_3333) + (pairs >> 2 & 0x3333_3333);
        // Up to eight in four bits, up to sixteen in a byte.
        let fours = fours(pairs(a)) + fours(pairs(b));
        (fours & 0x0f0f_0f0f) + (fours >> 4 & 0x0f0f_0f0f)
    }
}

impl<S: Windowed> Stages<'_, S> {
    /// Turns the lines around row `y` into its codes.
    fn enter_codes(&mut self, y: usize, lines: [&Around<'_>; 2]) {
        let row = slot_mut(self.codes, y % rows::<S>(), code_bytes::<S>() * self.width);
        let smoothed;
        let lines = if self.config.noise == Noise::None {
            lines
        } else {
            // The row has no winners yet. Codes look at three rows of the five.
            let (winners, of_right) = (bytes_of(self.winners), bytes_of_halves(self.right));
            let places = [winners, of_right].map(|room| room.chunks_exact_mut(self.width.max(1)));
            smoothed = quiet(lines, &[0, 2, 4], places.into_iter().flatten());
            smoothed.each_ref()
        };
        self.kernel.codes::<S>(lines, usize::from(self.config.min_disparity), self.scratch, row);
    }

    /// Moves the window; without a `row`, costs are only gathered.
    // For the reason that [`Kernel::row`] is inlined.
    #[inline(always)]
    fn select_windows(&mut self, bottom: usize, enters: bool, row: Option<usize>) {
        let (width, config) = (self.width, self.config);
        let leaves = bottom.checked_sub(2 * S::RADIUS_Y + 1);
        let codes = |y: usize| slot(self.codes, y % rows::<S>(), code_bytes::<S>() * width);
        let work = RowWork {
            width,
            stride: self.stride,
            min_disparity: usize::from(config.min_disparity),
            enter: enters.then(|| codes(bottom)),
            leave: leaves.map(codes),
            columns: self.columns,
            scratch: self.scratch,
        };
        let flags = slot_mut(self.flags, row.unwrap_or(0) % BAND, width);
        let margins = confidence::margins(config, self.support.lengths);
        let select = row.map(|_| {
            flags.fill(PixelFlags::CLEAR);
            Select {
                disparities: usize::from(config.disparities),
                winners: self.winners,
                unique: Unique::new(config.checks.uniqueness_percent, flags, margins),
            }
        });
        self.kernel.row::<S>(work, select);
    }
}
