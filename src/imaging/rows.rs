//! Rows of a picture that are kept for a while, in rings in borrowed memory.

/// The last `N` rows of a picture, `width` samples each: row `y` stands in slot `y mod N`.
pub(crate) struct RowRing<'a, T, const N: usize> {
    slots: &'a mut [T],
    width: usize,
}

impl<'a, T, const N: usize> RowRing<'a, T, N> {
    /// A ring in the first `N * width` samples of a memory, and the rest of the memory. Where it is too short
    /// all rows are empty.
    pub fn split(memory: &'a mut [T], width: usize) -> (Self, &'a mut [T]) {
        let (slots, rest) = memory.split_at_mut_checked(N * width).unwrap_or_default();
        (Self { slots, width }, rest)
    }

    /// Row `y`, to be written.
    pub fn row_mut(&mut self, y: usize) -> &mut [T] {
        let begin = y % N * self.width;
        self.slots.get_mut(begin..begin + self.width).unwrap_or_default()
    }

    /// The `M` rows around `centre`, `M` odd. Rows above the picture are row 0, and rows below `newest` are
    /// that one. The ring must still hold them.
    pub fn around<const M: usize>(&self, centre: usize, newest: usize) -> [&[T]; M] {
        core::array::from_fn(|i| {
            let begin = (centre + i).saturating_sub(M / 2).min(newest) % N * self.width;
            self.slots.get(begin..begin + self.width).unwrap_or_default()
        })
    }

    /// All rows of the ring, from row `oldest` on.
    pub fn all(&self, oldest: usize) -> [&[T]; N] {
        // One division for all.
        let mut slot = oldest % N;
        core::array::from_fn(|_| {
            let begin = slot * self.width;
            slot = if slot + 1 < N { slot + 1 } else { 0 };
            self.slots.get(begin..begin + self.width).unwrap_or_default()
        })
    }
}

/// The whole parts of `count` numbers, one after another; of one number where none are asked for.
///
/// [`slice::chunks_exact`] panics without a count, and an optimiser that makes code for size leaves that in.
#[inline(always)]
pub(crate) fn chunks<T>(slice: &[T], count: usize) -> impl Iterator<Item = &[T]> {
    let (mut rest, count) = (slice, count.max(1));
    core::iter::from_fn(move || {
        let (chunk, behind) = rest.split_at_checked(count)?;
        rest = behind;
        Some(chunk)
    })
}

/// Mutable access to what [`chunks`] gives.
#[inline(always)]
pub(crate) fn chunks_mut<T>(slice: &mut [T], count: usize) -> impl Iterator<Item = &mut [T]> {
    let (mut rest, count) = (slice, count.max(1));
    core::iter::from_fn(move || {
        let (chunk, behind) = core::mem::take(&mut rest).split_at_mut_checked(count)?;
        rest = behind;
        Some(chunk)
    })
}

/// The `N` samples of a row from `begin` on, which are inside. Where the caller has compared that, nothing is
/// compared here.
#[inline(always)]
pub(crate) fn part<const N: usize>(row: &[u8], begin: usize) -> &[u8; N] {
    row.get(begin..begin + N).and_then(|part| part.first_chunk()).unwrap_or(&[0; N])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of three rows of two samples, with so many rows written, each of its number and ten times that.
    fn ring(memory: &mut [u16], rows: usize) -> RowRing<'_, u16, 3> {
        let (mut ring, _) = RowRing::split(memory, 2);
        (0..rows).for_each(|y| ring.row_mut(y).copy_from_slice(&[y as u16, 10 * y as u16]));
        ring
    }

    #[test]
    fn a_ring_keeps_the_last_rows() {
        let mut memory = [0; 6];
        for rows in 3..9 {
            let ring = ring(&mut memory, rows);
            let oldest = rows - 3;
            let expected = [0, 1, 2].map(|i| [(oldest + i) as u16, 10 * (oldest + i) as u16]);
            assert_eq!(ring.all(oldest), expected.each_ref().map(|row| &row[..]));
        }
    }

    #[test]
    fn rows_around_are_those_of_the_picture() {
        let mut memory = [0; 6];
        let first = |ring: &RowRing<'_, u16, 3>, centre: usize, newest: usize| {
            ring.around::<3>(centre, newest).map(|row| row[0])
        };
        // Above the picture is its first row, below it the newest one.
        let ring_of_three = ring(&mut memory, 3);
        assert_eq!(first(&ring_of_three, 0, 2), [0, 0, 1]);
        assert_eq!(first(&ring_of_three, 1, 2), [0, 1, 2]);
        assert_eq!(first(&ring_of_three, 2, 2), [1, 2, 2]);
        let ring_of_eight = ring(&mut memory, 8);
        assert_eq!(first(&ring_of_eight, 6, 7), [5, 6, 7]);
        assert_eq!(first(&ring_of_eight, 7, 7), [6, 7, 7]);
        let five = ring_of_eight.around::<5>(7, 7);
        assert_eq!(five, [[5, 50], [6, 60], [7, 70], [7, 70], [7, 70]].each_ref().map(|row| &row[..]));
    }

    #[test]
    fn a_ring_leaves_the_rest_of_the_memory() {
        let mut memory = [7; 9];
        let (_, rest) = RowRing::<u16, 3>::split(&mut memory, 2);
        assert_eq!(rest.len(), 3);
        // Where there is too little, all rows are empty.
        let (mut ring, rest) = RowRing::<u16, 3>::split(&mut memory[..5], 2);
        assert!(rest.is_empty() && ring.row_mut(0).is_empty());
        assert!(ring.all(0).iter().chain(&ring.around::<3>(1, 2)).all(|row| row.is_empty()));
    }

    #[test]
    fn chunks_are_whole() {
        let mut numbers = [1, 2, 3, 4, 5, 6, 7];
        assert!(chunks(&numbers, 3).eq([[1, 2, 3], [4, 5, 6]]));
        assert_eq!(chunks(&numbers, 0).count(), 7);
        chunks_mut(&mut numbers, 3).for_each(|chunk| chunk[0] = 0);
        assert_eq!(numbers, [0, 2, 3, 0, 5, 6, 7]);
        assert_eq!(chunks_mut(&mut numbers, 0).count(), 7);
        assert_eq!(part::<3>(&[1, 2, 3, 4, 5], 2), &[3, 4, 5]);
    }
}
