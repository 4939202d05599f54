//! The candidates of a row's pixels, from pixel to pixel.

use super::group::Group;
use crate::matching::memory::slices::part;

/// What is compared of a pixel's candidates, of one row of features.
pub(in crate::matching::backend) struct Candidates<G, const CELLS: usize, const SLIDES: bool>([G; CELLS]);

impl<G: Group, const CELLS: usize, const SLIDES: bool> Candidates<G, CELLS, SLIDES> {
    /// Before the first pixel.
    #[inline(always)]
    pub fn new(row: &[u8], stride: usize) -> Self {
        let mut candidates = Self([G::splat(0); CELLS]);
        if SLIDES && G::IS_A_LINE {
            candidates.load(part(row, ..stride));
            let mut before = G::splat(0);
            for cell in &mut candidates.0 {
                (*cell, before) = (cell.after(before), *cell);
            }
        }
        candidates
    }

    /// Those of the next pixel, which stand here.
    #[inline(always)]
    pub fn next(&mut self, here: &[u8]) -> &[G; CELLS] {
        if SLIDES && G::IS_A_LINE {
            for (cell, bytes) in self.0.iter_mut().zip(G::groups(here)) {
                *cell = cell.moved(bytes);
            }
        } else {
            self.load(here);
        }
        &self.0
    }

    #[inline(always)]
    fn load(&mut self, here: &[u8]) {
        for (cell, &bytes) in self.0.iter_mut().zip(G::groups(here)) {
            *cell = G::of_bytes(bytes);
        }
    }
}
