//! What a method is made of: its census, its window and how much of a column's sum a window's is made of.
//!
//! Every window's sum fits a byte. Where the bits under a window are more than that, the lowest digits of its columns'
//! sums are left out: `block` adds quarters of them, rounded down. On real pairs that hardly shows, while the windows take
//! half the registers of a vector, and two of ten bit planes less.

#[cfg(not(stereopsis_vectors))]
use super::kernels::codes;
use super::stages::Stages;
use crate::imaging::{census_plus4, census_ring8};

/// A block matching method. The crate's own types implement it: [`Fast`] and [`Block`].
pub trait Scheme: Lines + Sized + 'static {
    /// The window reaches this many columns to each side.
    const RADIUS_X: usize;
    /// The window reaches this many rows up and down.
    const RADIUS_Y: usize;
    /// Bits of a census code.
    const BITS: usize;
    /// Bits of a column's sum.
    const COLUMN_BITS: usize;
    /// Lowest bits of a column's sum that are left out of a window's.
    const COLUMN_SHIFT: usize;
    /// Standard deviation of an answer away from depth edges, px: so that on rendered scenes, with sensor noise of up to
    /// two grey levels, three of it hold 99 % of the answers.
    const SIGMA_PX: f32;
    /// The method's name, as the programs spell it.
    const NAME: &'static str;
}

/// The parts of a method that only the matcher sees: its storage and its arithmetic.
pub trait Lines: Sized {
    /// The census rows of both cameras: those under the window and the one that leaves it.
    type Codes<const W: usize>: Codes;
    /// The census row at the centre of five rows.
    fn census(rows: &Around<'_>, out: &mut [u8]);
    /// The codes of four pixels, from the words around them: rows, and columns two to the left, here, two to the right.
    #[cfg(not(stereopsis_vectors))]
    fn codes(around: &[[u32; 3]; 3]) -> u32;
    /// How many bits of two codes differ.
    #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
    fn hamming(a: u8, b: u8) -> u8;
    /// How many bits are set in each byte of two words together, of the bits that a code has.
    #[cfg(not(stereopsis_vectors))]
    fn bits_of_two(a: u32, b: u32) -> u32;
    /// [`Stages::step`]. Each method says so for itself, so that its stages are compiled with this crate, once, and
    /// not with every crate that chooses a capacity.
    fn step(stages: Stages<'_, Self>, y: usize, lines: Option<[&Around<'_>; 2]>)
    where
        Self: Scheme;
}

/// The five lines around a row.
pub type Around<'a> = [&'a [u8]; 5];

/// Census rows, two bytes a pixel, as the kernel keeps them.
pub trait Codes {
    /// All codes 0.
    const EMPTY: Self;
    /// How many rows it holds.
    const ROWS: usize;
    /// All of them, one after the other.
    fn flat(&mut self) -> &mut [u8];
}

impl<const W: usize, const N: usize> Codes for [[[u8; 2]; W]; N] {
    const EMPTY: Self = [[[0; 2]; W]; N];
    const ROWS: usize = N;

    fn flat(&mut self) -> &mut [u8] {
        self.as_flattened_mut().as_flattened_mut()
    }
}

/// The neighbours of [`census_plus4`] and [`census_ring8`] in order of their bits, two rows and columns to a step.
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
    const BITS: usize = 4;
    const COLUMN_BITS: usize = 5;
    const COLUMN_SHIFT: usize = 0;
    const SIGMA_PX: f32 = 0.15;
    const NAME: &'static str = "fast";
}

impl Lines for Fast {
    type Codes<const W: usize> = [[[u8; 2]; W]; 8];

    fn census(rows: &Around<'_>, out: &mut [u8]) {
        census_plus4(rows, out);
    }

    #[cfg(not(stereopsis_vectors))]
    #[inline(always)]
    fn codes(around: &[[u32; 3]; 3]) -> u32 {
        codes(around, &PLUS4)
    }

    #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
    #[inline(always)]
    fn hamming(a: u8, b: u8) -> u8 {
        // Four bits need half of a byte's bit count: pairs, then the two pairs.
        let x = a ^ b;
        let pairs = x - ((x >> 1) & 0b0101);
        (pairs & 0b0011) + (pairs >> 2)
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

    fn step(stages: Stages<'_, Self>, y: usize, lines: Option<[&Around<'_>; 2]>) {
        stages.step(y, lines);
    }
}

/// Method `block`: an 8-bit census in 5x5 summed over 9x9 pixels, in quarters.
#[derive(Clone, Copy, Debug)]
pub struct Block;

impl Scheme for Block {
    const RADIUS_X: usize = 4;
    const RADIUS_Y: usize = 4;
    const BITS: usize = 8;
    const COLUMN_BITS: usize = 7;
    const COLUMN_SHIFT: usize = 2;
    const SIGMA_PX: f32 = 0.15;
    const NAME: &'static str = "block";
}

impl Lines for Block {
    type Codes<const W: usize> = [[[u8; 2]; W]; 10];

    fn census(rows: &Around<'_>, out: &mut [u8]) {
        census_ring8(rows, out);
    }

    #[cfg(not(stereopsis_vectors))]
    #[inline(always)]
    fn codes(around: &[[u32; 3]; 3]) -> u32 {
        codes(around, &RING8)
    }

    #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
    #[inline(always)]
    fn hamming(a: u8, b: u8) -> u8 {
        let x = a ^ b;
        if cfg!(stereopsis_vectors) {
            // Vectors that have no bit count.
            let pairs = x - ((x >> 1) & 0x55);
            let fours = (pairs & 0x33) + ((pairs >> 2) & 0x33);
            (fours + (fours >> 4)) & 0x0f
        } else {
            x.count_ones() as u8
        }
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

    fn step(stages: Stages<'_, Self>, y: usize, lines: Option<[&Around<'_>; 2]>) {
        stages.step(y, lines);
    }
}
