//! Bytes side by side, which the code along paths is written for.

/// Group of bytes in a register. None of the operations but those that say so lets a lane overflow: numbers
/// have seven bits unless more are allowed.
pub trait Group: Copy + 'static {
    /// Bytes in a group.
    const LANES: usize;
    /// Whether a group is as long as a line of the cache: one that is read from another place lies in two.
    const IS_A_LINE: bool = Self::LANES == 64;
    /// A group in memory, where a word may stand if it is one.
    type Cell: Copy + 'static;
    /// A group anywhere in memory.
    type Bytes: Copy + 'static;
    /// A number of eight bits in memory, in the form that is put in all lanes as it is read.
    type Number: Copy + Default;

    /// The cells of a slice, as far as they are whole ones.
    fn cells(bytes: &[u8]) -> &[Self::Cell];
    /// Mutable access to the cells of a slice of bytes.
    fn cells_mut(bytes: &mut [u8]) -> &mut [Self::Cell];
    /// The groups of a slice that begins anywhere, as far as they are whole ones.
    fn groups(bytes: &[u8]) -> &[Self::Bytes];
    fn of(cell: Self::Cell) -> Self;
    fn of_bytes(bytes: Self::Bytes) -> Self;
    fn cell(self) -> Self::Cell;
    /// Puts a number of eight bits in all lanes.
    fn splat(number: u8) -> Self;

    /// The number that will be put in all lanes.
    fn number(number: u8) -> Self::Number;
    /// [`Self::splat`].
    fn splat_number(number: Self::Number) -> Self;
    /// The group that stands here, given this one, which stands a byte before.
    #[inline(always)]
    fn moved(self, here: &Self::Bytes) -> Self {
        Self::of_bytes(*here)
    }

    /// The sum, of eight bits.
    fn plus(self, other: Self) -> Self;
    /// The difference to a smaller number.
    fn minus(self, other: Self) -> Self;
    /// The sum, 255 where it would be more. The first number has eight bits.
    fn plus_saturating(self, other: Self) -> Self;
    /// The difference, 0 where it would be less.
    fn minus_saturating(self, other: Self) -> Self;
    fn min(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
    /// How far apart the numbers are.
    fn apart(self, other: Self) -> Self;
    /// The average, rounded up.
    fn average_up(self, other: Self) -> Self;
    /// The average, rounded down.
    fn average_down(self, other: Self) -> Self;
    /// A quarter, rounded down.
    fn quarter(self) -> Self;
    /// How many bits of two bytes differ: eight bits each.
    fn bits_apart(self, other: Self) -> Self;
    /// What a code of four bits is compared by with [`Self::four_bits_apart`].
    fn key_of_four(code: u8) -> Self;
    /// How many bits of a code, whose key this is, and of others differ: four bits each.
    fn four_bits_apart(self, others: Self) -> Self;
    /// Bits of either, eight bits each.
    fn or(self, other: Self) -> Self;
    /// Bits of both, eight bits each.
    fn and(self, other: Self) -> Self;
    /// Each lane's number in the lane after it; the first one's is the last of `before`.
    fn after(self, before: Self) -> Self;
    /// Each lane's number in the lane before it; the last one's is the first of `next`.
    fn before(self, next: Self) -> Self;
    /// [`Self::after`] where the first lane may have `before`'s number or its own, whichever takes less.
    #[inline(always)]
    fn after_end(self, before: Self) -> Self {
        self.after(before)
    }
    /// [`Self::before`] where the last lane may have `next`'s number or its own, whichever takes less.
    #[inline(always)]
    fn before_end(self, next: Self) -> Self {
        self.before(next)
    }
    /// The least number, in all lanes.
    fn least(self) -> Self;

    /// The least number of eight bits of all cells, and the last lane that has it.
    fn last_least(cells: &[Self]) -> (u8, usize);
    /// [`Self::last_least`], which may take fewer steps one after the other, but moves more bytes: each
    /// number goes into a half-word, above how many lanes there are after it.
    #[inline(always)]
    fn last_least_by_keys(cells: &[Self]) -> (u8, usize) {
        Self::last_least(cells)
    }
    /// The number in one of the lanes of all cells.
    fn lane(cells: &[Self], lane: usize) -> u8;
    /// The numbers in two lanes.
    #[inline(always)]
    fn lanes(self, lanes: [usize; 2]) -> [u8; 2] {
        lanes.map(
            #[inline(always)]
            |lane| Self::lane(&[self], lane),
        )
    }
    /// Puts 255 in one of the lanes of all cells and in [`BESIDE`](crate::matching::memory::winners::BESIDE)
    /// to each side of it.
    fn raise_around(cells: &mut [Self], lane: usize);
}
