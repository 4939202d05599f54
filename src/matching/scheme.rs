//! What a method is made of: its census, its window and the lanes that its sums fit in.

use super::kernels::Lane;
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
    /// Standard deviation of an answer away from depth edges, px: so that on rendered scenes, with sensor noise of up to
    /// two grey levels, three of it hold 99 % of the answers.
    const SIGMA_PX: f32;
    /// The method's name, as the programs spell it.
    const NAME: &'static str;
}

/// The parts of a method that only the matcher sees: its lanes, its storage and its arithmetic.
pub trait Lines: Sized {
    /// Holds the sum of a whole window.
    type Sum: Lane;
    /// The census rows of one camera: those under the window and the one that leaves it.
    type Codes<const W: usize>: Codes;
    /// The census row at the centre of five rows.
    fn census(rows: &Around<'_>, out: &mut [u8]);
    /// How many bits of two codes differ.
    fn hamming(a: u8, b: u8) -> u8;
    /// [`Stages::step`]. Each method says so for itself, so that its stages are compiled with this crate, once, and
    /// not with every crate that chooses a capacity.
    fn step(stages: Stages<'_, Self>, y: usize, lines: Option<[&Around<'_>; 2]>)
    where
        Self: Scheme;
}

/// The five lines around a row.
pub type Around<'a> = [&'a [u8]; 5];

/// Census rows, one code a byte.
pub trait Codes {
    /// All codes 0.
    const EMPTY: Self;
    /// How many rows it holds.
    const ROWS: usize;
    /// All of them, one after the other.
    fn flat(&mut self) -> &mut [u8];
}

impl<const W: usize, const N: usize> Codes for [[u8; W]; N] {
    const EMPTY: Self = [[0; W]; N];
    const ROWS: usize = N;

    fn flat(&mut self) -> &mut [u8] {
        self.as_flattened_mut()
    }
}

/// Method `fast`: a 4-bit census (up, down, left, right at distance 2) summed over 9x7 pixels. Every sum fits a byte.
#[derive(Clone, Copy, Debug)]
pub struct Fast;

impl Scheme for Fast {
    const RADIUS_X: usize = 4;
    const RADIUS_Y: usize = 3;
    const BITS: usize = 4;
    const SIGMA_PX: f32 = 0.15;
    const NAME: &'static str = "fast";
}

impl Lines for Fast {
    type Sum = u8;
    type Codes<const W: usize> = [[u8; W]; 8];

    fn census(rows: &Around<'_>, out: &mut [u8]) {
        census_plus4(rows, out);
    }

    #[inline(always)]
    fn hamming(a: u8, b: u8) -> u8 {
        // Four bits need half of a byte's bit count: pairs, then the two pairs.
        let x = a ^ b;
        let pairs = x - ((x >> 1) & 0b0101);
        (pairs & 0b0011) + (pairs >> 2)
    }

    fn step(stages: Stages<'_, Self>, y: usize, lines: Option<[&Around<'_>; 2]>) {
        stages.step(y, lines);
    }
}

/// Method `block`: an 8-bit census in 5x5 summed over 9x9 pixels.
#[derive(Clone, Copy, Debug)]
pub struct Block;

impl Scheme for Block {
    const RADIUS_X: usize = 4;
    const RADIUS_Y: usize = 4;
    const BITS: usize = 8;
    const SIGMA_PX: f32 = 0.15;
    const NAME: &'static str = "block";
}

impl Lines for Block {
    type Sum = i16;
    type Codes<const W: usize> = [[u8; W]; 10];

    fn census(rows: &Around<'_>, out: &mut [u8]) {
        census_ring8(rows, out);
    }

    #[inline(always)]
    fn hamming(a: u8, b: u8) -> u8 {
        (a ^ b).count_ones() as u8
    }

    fn step(stages: Stages<'_, Self>, y: usize, lines: Option<[&Around<'_>; 2]>) {
        stages.step(y, lines);
    }
}
