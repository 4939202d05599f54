//! Block Cholesky factorization within the envelope of the reduced camera matrix (George & Liu 1981).

use super::workspace::{Block, ViewSlot};
use crate::geometry::Real;

/// The lower triangle of a matrix of blocks. Row i begins with the first view that has a point in common with
/// view i or with one before it that reaches over i, and has every block from there to the diagonal: what
/// Cholesky's method fills (George & Liu 1981, the envelope). A sequence in which views far apart have
/// nothing in common takes its length times that reach.
pub(super) struct Envelope<'a, V, T, const N: usize> {
    pub slots: &'a mut [ViewSlot<V, T, N>],
    pub blocks: &'a mut [Block<T, N>],
}

/// The matrix is not positive definite, to rounding.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Indefinite;

/// The blocks of rows `first..=i` of row i begin at `offset`.
fn row<const N: usize, T>(blocks: &[Block<T, N>], offset: usize, first: usize, i: usize) -> &[Block<T, N>] {
    blocks.get(offset..offset + (i - first.min(i)) + 1).unwrap_or(&[])
}

impl<V, T: Real, const N: usize> Envelope<'_, V, T, N> {
    /// The block of row `i` and column `j <= i`, transposed.
    pub fn block(&mut self, i: usize, j: usize) -> Option<&mut Block<T, N>> {
        let slot = self.slots.get(i)?;
        self.blocks.get_mut(slot.offset + j.checked_sub(slot.first)?)
    }

    /// `L L^T`, in place. Refuses a pivot that is not more than `least` of the diagonal that the slot
    /// remembers.
    pub fn factor(&mut self, least: T) -> Result<(), Indefinite> {
        for (i, slot) in self.slots.iter().enumerate() {
            let Some((before, rest)) = self.blocks.split_at_mut_checked(slot.offset) else {
                return Err(Indefinite);
            };
            let Some(own) = rest.get_mut(..i - slot.first.min(i) + 1) else { return Err(Indefinite) };
            for (at, other) in self.slots.iter().enumerate().take(i).skip(slot.first) {
                let Some((done, block)) = own.split_at_mut_checked(at - slot.first) else {
                    return Err(Indefinite);
                };
                let Some(block) = block.first_mut() else { return Err(Indefinite) };
                let theirs = row(before, other.offset, other.first, at);
                let Some((diagonal, theirs)) = theirs.split_last() else { return Err(Indefinite) };
                // What both rows have before this column.
                let (mine, theirs) = if other.first > slot.first {
                    (done.get(other.first - slot.first..).unwrap_or(&[]), theirs)
                } else {
                    (&*done, theirs.get(slot.first - other.first..).unwrap_or(&[]))
                };
                for (a, b) in theirs.iter().zip(mine) {
                    subtract_product(block, a, b);
                }
                solve_rows(diagonal, block);
            }
            let Some((diagonal, done)) = own.split_last_mut() else { return Err(Indefinite) };
            for block in done.iter() {
                subtract_product(diagonal, block, block);
            }
            cholesky(diagonal, &slot.diagonal, least)?;
        }
        Ok(())
    }

    /// Solves `L x = b`, in the slots' steps, of rows from `from` on: those before are zero.
    pub fn forward(&mut self, from: usize) {
        for i in from..self.slots.len() {
            let Some((before, rest)) = self.slots.split_at_mut_checked(i) else { return };
            let Some(slot) = rest.first_mut() else { return };
            let Some((diagonal, row)) = row(self.blocks, slot.offset, slot.first, i).split_last() else {
                return;
            };
            let mut x = slot.step;
            for (block, other) in row.iter().zip(before.iter().skip(slot.first)) {
                for (line, &y) in block.iter().zip(&other.step) {
                    for (x, &m) in x.iter_mut().zip(line) {
                        *x -= m * y;
                    }
                }
            }
            for k in 0..N {
                x[k] /= diagonal[k][k];
                for a in k + 1..N {
                    x[a] -= diagonal[k][a] * x[k];
                }
            }
            slot.step = x;
        }
    }

    /// Solves `L^T x = b`, in the slots' steps.
    pub fn backward(&mut self) {
        for i in (0..self.slots.len()).rev() {
            let Some((before, rest)) = self.slots.split_at_mut_checked(i) else { return };
            let Some(slot) = rest.first_mut() else { return };
            let Some((diagonal, row)) = row(self.blocks, slot.offset, slot.first, i).split_last() else {
                return;
            };
            let x = &mut slot.step;
            for k in (0..N).rev() {
                for a in k + 1..N {
                    x[k] -= diagonal[k][a] * x[a];
                }
                x[k] /= diagonal[k][k];
            }
            for (block, other) in row.iter().zip(before.iter_mut().skip(slot.first)) {
                for (line, y) in block.iter().zip(&mut other.step) {
                    for (&x, &m) in x.iter().zip(line) {
                        *y -= m * x;
                    }
                }
            }
        }
    }
}

/// `C -= A^T B`.
#[inline]
fn subtract_product<T: Real, const N: usize>(c: &mut Block<T, N>, a: &Block<T, N>, b: &Block<T, N>) {
    for k in 0..N {
        let mut line = c[k];
        for (from, to) in a.iter().zip(b) {
            for l in 0..N {
                line[l] -= from[k] * to[l];
            }
        }
        c[k] = line;
    }
}

/// `B = U^-T B`, with U upper triangular.
#[inline]
fn solve_rows<T: Real, const N: usize>(u: &Block<T, N>, b: &mut Block<T, N>) {
    for k in 0..N {
        let by = T::ONE / u[k][k];
        b[k].iter_mut().for_each(|x| *x *= by);
        let line = b[k];
        for below in k + 1..N {
            let by = u[k][below];
            for (x, &y) in b[below].iter_mut().zip(&line) {
                *x -= by * y;
            }
        }
    }
}

/// `B = U` with `U^T U = B`.
fn cholesky<T: Real, const N: usize>(
    b: &mut Block<T, N>,
    sizes: &[T; N],
    least: T,
) -> Result<(), Indefinite> {
    for k in 0..N {
        let pivot = b[k][k];
        if !(pivot > sizes[k] * least && pivot > T::ZERO && pivot.is_finite()) {
            return Err(Indefinite);
        }
        let by = T::ONE / pivot.sqrt();
        b[k].iter_mut().for_each(|x| *x *= by);
        let line = b[k];
        for below in k + 1..N {
            let by = line[below];
            for (x, &y) in b[below].iter_mut().zip(&line) {
                *x -= by * y;
            }
        }
    }
    Ok(())
}
