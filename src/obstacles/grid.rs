//! Rows of pixels -> cells, each with the nearer of its two largest groups of like disparities.

use crate::units::{Disparity, PixelFlags};

/// A group of a cell's answers, each within one px of the one before it: a slanted surface is one group.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Cluster {
    sum: u32,
    last: u16,
    count: u8,
}

impl Cluster {
    pub(super) const EMPTY: Self = Self { sum: 0, last: 0, count: 0 };

    /// Adds an answer that belongs to the group, or begins one; returns whether it did.
    #[inline]
    fn take(&mut self, d: u16) -> bool {
        if self.count != 0 && d.abs_diff(self.last) > Disparity::ONE {
            return false;
        }
        // At most 255 pixels.
        *self = Self { sum: self.sum.wrapping_add(u32::from(d)), last: d, count: self.count.wrapping_add(1) };
        true
    }

    /// The mean answer, rounded, of a group of at least `least` pixels.
    fn mean(&self, least: u8) -> Option<u16> {
        let count = u32::from(self.count);
        let mean = (self.sum + count / 2).checked_div(count)?;
        (self.count >= least).then_some(mean as u16)
    }
}

/// The two groups of a cell that is being filled.
///
/// An answer joins the first group whose last answer is within one px. One that joins neither begins the
/// second group, if that is empty or has one answer, and is ignored else.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Filling([Cluster; 2]);

impl Filling {
    pub(super) const EMPTY: Self = Self([Cluster::EMPTY; 2]);

    #[inline]
    fn take(&mut self, d: u16) {
        let [first, second] = &mut self.0;
        if first.take(d) || second.take(d) {
            return;
        }
        if second.count == 1 {
            *second = Cluster::EMPTY;
            second.take(d);
        }
    }

    /// The nearer of the groups that hold a quarter of the cell's `area`.
    pub(super) fn answer(&self, area: u8) -> Disparity {
        let least = area.div_ceil(4);
        let nearest = self.0.iter().filter_map(|group| group.mean(least)).max();
        nearest.map_or(Disparity::NONE, Disparity::from_raw)
    }
}

/// Whether an answer with these flags counts: what was filled in is a guess, what is damaged may be wrong.
const LEFT_OUT: PixelFlags = PixelFlags::FILLED.union(PixelFlags::DAMAGED);

/// Adds a row of pixels to cells `cell_width` px wide. Confidences may be empty.
pub(super) fn fill(
    cells: &mut [Filling],
    cell_width: usize,
    disparities: &[Disparity],
    flags: &[PixelFlags],
    confidences: &[u8],
    min_confidence: u8,
) {
    let width = cell_width.max(1);
    let pixels = disparities.chunks_exact(width).zip(flags.chunks_exact(width));
    if confidences.is_empty() || min_confidence == 0 {
        for (cell, (disparities, flags)) in cells.iter_mut().zip(pixels) {
            for (d, flags) in disparities.iter().zip(flags) {
                if d.is_some() && !flags.intersects(LEFT_OUT) {
                    cell.take(d.raw());
                }
            }
        }
        return;
    }
    let pixels = pixels.zip(confidences.chunks_exact(width));
    for (cell, ((disparities, flags), confidences)) in cells.iter_mut().zip(pixels) {
        for ((d, flags), &confidence) in disparities.iter().zip(flags).zip(confidences) {
            if d.is_some() && !flags.intersects(LEFT_OUT) && confidence >= min_confidence {
                cell.take(d.raw());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_answers_with_its_nearer_large_group() {
        let mut cell = Filling::EMPTY;
        [320, 330, 640, 641, 900, 322].into_iter().for_each(|d| cell.take(d));
        // Quarters of 8 pixels: (320 + 330 + 322) / 3 and (640 + 641) / 2 rounded up.
        assert_eq!(cell.answer(8), Disparity::from_raw(641));
        assert_eq!(cell.answer(12), Disparity::from_raw(324));
        assert_eq!(cell.answer(16), Disparity::NONE);
    }
}
