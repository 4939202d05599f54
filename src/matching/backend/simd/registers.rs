//! What groups in registers have alike, whichever processor's: everything that only moves bytes.

use crate::matching::memory::winners::BESIDE;

/// Items of an `impl Group` for a register of so many bytes, from a table: the instructions that load, store
/// and fill a register; the numbers in memory that it is filled with, and by which instruction; then those
/// that make one register of two, by the operation that they are.
///
/// Where it is called, `safely!` says why the instructions may be used. Beside the items an `impl` needs
/// `last_lane_of(cells, number)`: the last lane of all cells that has the number which is in all lanes of
/// `number` and in one of the cells.
macro_rules! register {
    (
        $lanes:literal bytes, load $load:ident, store $store:ident, splat $splat:ident,
        numbers $number:ident $splat_number:ident,
        $($operation:ident $instruction:ident),* $(,)?
    ) => {
        const LANES: usize = $lanes;
        type Cell = [u8; $lanes];
        type Bytes = [u8; $lanes];
        type Number = $number;

        #[inline(always)]
        fn cells(bytes: &[u8]) -> &[Self::Cell] {
            bytes.as_chunks().0
        }

        #[inline(always)]
        fn cells_mut(bytes: &mut [u8]) -> &mut [Self::Cell] {
            bytes.as_chunks_mut().0
        }

        #[inline(always)]
        fn groups(bytes: &[u8]) -> &[Self::Bytes] {
            bytes.as_chunks().0
        }

        #[inline(always)]
        fn of(cell: Self::Cell) -> Self {
            safely!(Self($load(cell.as_ptr().cast())))
        }

        #[inline(always)]
        fn cell(self) -> Self::Cell {
            let mut cell = [0; $lanes];
            safely!($store(cell.as_mut_ptr().cast(), self.0));
            cell
        }

        #[inline(always)]
        fn splat(number: u8) -> Self {
            safely!(Self($splat(number as _)))
        }

        // The same in each of its bytes.
        #[inline(always)]
        fn number(number: u8) -> $number {
            $number::from(number) * ($number::MAX / 255)
        }

        #[inline(always)]
        fn splat_number(number: $number) -> Self {
            safely!(Self($splat_number(number as _)))
        }

        $(
            #[inline(always)]
            fn $operation(self, other: Self) -> Self {
                safely!(Self($instruction(self.0, other.0)))
            }
        )*

        #[inline(always)]
        fn of_bytes(bytes: Self::Bytes) -> Self {
            Self::of(bytes)
        }

        #[inline(always)]
        fn last_least(cells: &[Self]) -> (u8, usize) {
            let all = cells.iter().fold(
                Self::splat(u8::MAX),
                #[inline(always)]
                |all, &cell| all.min(cell),
            );
            let least = all.least();
            (Self::lane(&[least], 0), Self::last_lane_of(cells, least))
        }

        #[inline(always)]
        fn lane(cells: &[Self], lane: usize) -> u8 {
            const { assert!(size_of::<Self>() == $lanes) };
            let (first, length) = (cells.as_ptr().cast(), size_of_val(cells));
            // SAFETY: registers are bytes, and as many of them are looked at as there are.
            let bytes: &[u8] = unsafe { core::slice::from_raw_parts(first, length) };
            bytes.get(lane).copied().unwrap_or(0)
        }

        #[inline(always)]
        fn raise_around(cells: &mut [Self], lane: usize) {
            let ones = crate::matching::memory::slices::part(AROUND, 256usize.wrapping_sub(lane)..);
            for (cell, &ones) in cells.iter_mut().zip(Self::groups(ones)) {
                *cell = cell.or(Self::of_bytes(ones));
            }
        }
    };
}
pub(super) use register;

/// Items of an `impl HalfWords`, by the operation that they are.
macro_rules! half_words {
    ($($operation:ident $instruction:ident),* $(,)?) => {$(
        #[inline(always)]
        fn $operation(self, other: Self) -> Self {
            safely!(Self($instruction(self.0, other.0)))
        }
    )*};
}
pub(super) use half_words;

/// Items of an `impl Group` for what x86-64 has no instruction for, by `shifted_right`.
#[cfg(target_arch = "x86_64")]
macro_rules! by_shifts {
    () => {
        #[inline(always)]
        fn average_down(self, other: Self) -> Self {
            self.plus(other).shifted_right::<1>()
        }

        #[inline(always)]
        fn quarter(self) -> Self {
            self.shifted_right::<2>()
        }
    };
}
#[cfg(target_arch = "x86_64")]
pub(super) use by_shifts;

/// Ones in the lane 256 and as many beside it as belong to a winner.
pub(super) const AROUND: &[u8; 512] = &{
    let mut around = [0; 512];
    let mut lane = 256 - BESIDE;
    while lane <= 256 + BESIDE {
        around[lane] = u8::MAX;
        lane += 1;
    }
    around
};

/// How many bits of two codes of four bits differ.
pub(super) const BITS_APART_OF_FOUR: &[[u8; 16]; 16] = &{
    let mut apart = [[0; 16]; 16];
    let mut codes = 0;
    while codes < 256 {
        apart[codes / 16][codes % 16] = ((codes / 16) ^ (codes % 16)).count_ones() as u8;
        codes += 1;
    }
    apart
};
