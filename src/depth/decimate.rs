//! Decimation: disparity rows downsampled by the median of blocks.

use crate::units::Disparity;
use core::num::NonZero;

/// Downsamples `N x N` pixels to one, `N` from 2 to 8, row by row: the median of the block's answers, the
/// nearer of two middle ones, where at least half of its pixels have one.
///
/// A median is one of the answers, while the mean of two surfaces is neither. Disparities stay in pixels of
/// the full image, so that [`DepthScale`](super::DepthScale) applies; a pixel stands for the block's middle,
/// `N u + (N - 1) / 2`. The capacity `W` is in full-size columns: `2 W N` bytes.
///
/// ```
/// use stereopsis::depth::Decimator;
/// use stereopsis::units::Disparity;
/// let mut small = Decimator::<4, 2>::new();
/// let row = |d: [u16; 4]| d.map(Disparity::from_pixels);
/// assert!(small.push(&row([3, 4, 9, 9]), &mut [Disparity::NONE; 2]).is_none());
/// let mut out = [Disparity::NONE; 2];
/// assert_eq!(small.push(&row([5, 6, 9, 9]), &mut out), Some(0));
/// assert_eq!(out, [5, 9].map(Disparity::from_pixels));
/// ```
#[derive(Debug)]
pub struct Decimator<const W: usize, const N: usize> {
    rows: [[Disparity; W]; N],
    taken: usize,
}

/// A borrowed [`Decimator`] of any width.
#[derive(Debug)]
pub struct DecimatorView<'a, const N: usize> {
    rows: &'a mut [Disparity],
    taken: &'a mut usize,
}

/// Number of pixels of the largest block.
const MOST: usize = 64;

impl<const W: usize, const N: usize> Decimator<W, N> {
    /// Creates a decimator that awaits a frame's first row.
    pub const fn new() -> Self {
        Self { rows: [[Disparity::NONE; W]; N], taken: 0 }
    }

    /// The decimator without its capacity.
    pub fn as_mut_view(&mut self) -> DecimatorView<'_, N> {
        DecimatorView::new(self.rows.as_flattened_mut(), &mut self.taken)
    }

    /// Begins a frame.
    pub fn begin(&mut self) {
        self.taken = 0;
    }

    /// Takes the next row, see [`DecimatorView::push`].
    pub fn push(&mut self, row: &[Disparity], out: &mut [Disparity]) -> Option<usize> {
        self.as_mut_view().push(row, out)
    }
}

impl<'a, const N: usize> DecimatorView<'a, N> {
    /// A decimator in the caller's memory: rows of up to an `N`th of its length, and how many of the frame's
    /// were taken. It does not matter what is in the memory before a frame begins.
    pub fn new(rows: &'a mut [Disparity], taken: &'a mut usize) -> Self {
        const { assert!(N >= 2 && N <= 8, "blocks have 2 to 8 pixels a side") };
        Self { rows, taken }
    }

    /// Begins a frame.
    pub fn begin(&mut self) {
        *self.taken = 0;
    }

    /// Takes the next row; every `N`th call writes a downsampled row and returns its index. Columns and rows
    /// that fill no block are left out.
    pub fn push(&mut self, row: &[Disparity], out: &mut [Disparity]) -> Option<usize> {
        let most = self.rows.len() / N;
        let slot = self.rows.chunks_exact_mut(most.max(1)).nth(*self.taken % N)?;
        slot.iter_mut().zip(row).for_each(|(to, &from)| *to = from);
        let width = row.len().min(most);
        *self.taken += 1;
        if !self.taken.is_multiple_of(N) {
            return None;
        }
        let block = const { if let Some(block) = NonZero::new(N) { block } else { NonZero::<usize>::MIN } };
        shrink(self.rows, most, width, block, out);
        Some(*self.taken / N - 1)
    }
}

impl<const W: usize, const N: usize> Default for Decimator<W, N> {
    fn default() -> Self {
        Self::new()
    }
}

/// Writes the medians of blocks of `block` x `block` pixels, from `block` rows that begin `stride` words
/// apart and have `width` columns.
pub(crate) fn shrink(
    rows: &[Disparity],
    stride: usize,
    width: usize,
    block: NonZero<usize>,
    out: &mut [Disparity],
) {
    let side = block.get();
    for (u, out) in out.iter_mut().enumerate().take(width / block) {
        let mut values = [0; MOST];
        let mut count = 0;
        let lines = (0..side).filter_map(|y| rows.get(y * stride + u * side..y * stride + (u + 1) * side));
        for (answer, to) in lines.flatten().filter(|d| d.is_some()).zip(&mut values) {
            *to = answer.raw();
            count += 1;
        }
        *out = median(&mut values, count).filter(|_| 2 * count >= side * side).unwrap_or(Disparity::NONE);
    }
}

/// Sorts the first `count` values and returns their median, the larger of two middle ones.
fn median(values: &mut [u16; MOST], count: usize) -> Option<Disparity> {
    let values = values.get_mut(..count)?;
    // By insertion: 64 of them at most.
    for i in 1..count {
        for j in (1..=i).rev() {
            match values.get_mut(j - 1..=j) {
                Some([a, b]) if *a > *b => core::mem::swap(a, b),
                _ => break,
            }
        }
    }
    values.get(count / 2).map(|&steps| Disparity::from_raw(steps))
}
