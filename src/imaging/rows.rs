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
