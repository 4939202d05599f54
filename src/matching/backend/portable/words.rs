//! Four bytes in a 32-bit word.
//!
//! A subtraction adds 128 to each lane, whose top bit then says whether it is not smaller: differences that
//! end at 0 are made of that, and minima of those, in six operations. (Arm's instructions on four bytes take
//! two: see `armv7em`.) The sum may carry into the next lane: what counts is that each lane's own result,
//! the difference and 128, fits a byte, for then the word's arithmetic is the lanes' whatever was carried on
//! the way. So differences are good from -128 to 127, and the numbers themselves may be any bytes.
//!
//! Each operation says what its lanes may hold, asserts it in a checked build, and is tested with every pair
//! of bytes that it allows. [`Penalties`](crate::matching::Penalties) says why the costs along paths keep to
//! it.

use super::group::Group;
use crate::matching::backend::loops::keep_loop;
use crate::matching::memory::views::{view, view_mut};
use crate::matching::memory::winners::BESIDE;

/// Whether this is an RV32 that gives the upper half of a product (`mulhu`), which has code of its own.
pub(in crate::matching::backend) const HAS_PRODUCTS: bool = cfg!(stereopsis_rv32m);

/// The top bit of each lane.
const TOP: u32 = 0x8080_8080;
/// A one in each lane.
const ONE: u32 = 0x0101_0101;

/// The bits below the top one of each lane whose top bit is set, where lanes have one bit more than `BITS`
/// and none is set but top bits.
#[inline(always)]
pub(in crate::matching::backend) fn below_tops<const BITS: u32>(tops: u32) -> u32 {
    if HAS_PRODUCTS { by_product::<BITS>(tops) } else { by_shift::<BITS>(tops) }
}

/// [`below_tops`] in two instructions.
#[inline(always)]
fn by_shift<const BITS: u32>(tops: u32) -> u32 {
    tops - (tops >> BITS)
}

/// [`below_tops`] in one instruction, where one gives the upper half of a product (RV32's `mulhu`): a number
/// times 1 - 1 / 2^`BITS`.
#[inline(always)]
fn by_product<const BITS: u32>(tops: u32) -> u32 {
    let factor = 0u32.wrapping_sub(1 << (32 - BITS));
    ((u64::from(tops) * u64::from(factor)) >> 32) as u32
}

/// Whether something holds for the bytes of each lane.
#[inline(always)]
fn lanes(a: Word, b: Word, holds: impl Fn(i16, i16) -> bool) -> bool {
    a.0.to_le_bytes().into_iter().zip(b.0.to_le_bytes()).all(|(a, b)| holds(a.into(), b.into()))
}

/// Four bytes, the first lane lowest.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(in crate::matching::backend) struct Word(u32);

impl Group for Word {
    const LANES: usize = 4;
    type Cell = u32;
    type Number = u8;
    type Bytes = [u8; 4];

    #[inline(always)]
    fn cells(bytes: &[u8]) -> &[u32] {
        view::<u8, u32>(bytes)
    }

    #[inline(always)]
    fn cells_mut(bytes: &mut [u8]) -> &mut [u32] {
        view_mut::<u8, u32>(bytes)
    }

    #[inline(always)]
    fn groups(bytes: &[u8]) -> &[[u8; 4]] {
        bytes.as_chunks().0
    }

    #[inline(always)]
    fn of(cell: u32) -> Self {
        Self(cell)
    }

    #[inline(always)]
    fn of_bytes(bytes: [u8; 4]) -> Self {
        Self(u32::from_le_bytes(bytes))
    }

    #[inline(always)]
    fn cell(self) -> u32 {
        self.0
    }

    #[inline(always)]
    fn splat(number: u8) -> Self {
        Self(u32::from(number) * ONE)
    }

    #[inline(always)]
    fn number(number: u8) -> u8 {
        number
    }

    #[inline(always)]
    fn splat_number(number: u8) -> Self {
        Self::splat(number)
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        debug_assert!(lanes(self, other, |a, b| a + b < 256), "a sum over a byte: {self:08x?} {other:08x?}");
        Self(self.0.wrapping_add(other.0))
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        debug_assert!(lanes(self, other, |a, b| a >= b), "a difference below 0: {self:08x?} {other:08x?}");
        Self(self.0.wrapping_sub(other.0))
    }

    #[inline(always)]
    fn plus_saturating(self, other: Self) -> Self {
        debug_assert!(lanes(self, other, |_, b| b < 128), "eight bits are added: {other:08x?}");
        let sum = (self.0 & !TOP) + other.0;
        let over = self.0 & sum & TOP;
        Self(sum | (self.0 & TOP) | ((over >> 7) * 0xff))
    }

    #[inline(always)]
    fn minus_saturating(self, other: Self) -> Self {
        debug_assert!(
            lanes(self, other, |a, b| (-128..128).contains(&(a - b))),
            "a difference of eight bits: {self:08x?} {other:08x?}"
        );
        // 128 more in each lane, not the top bit set: the sum with what is over 127 counts.
        let difference = self.0.wrapping_add(TOP).wrapping_sub(other.0);
        let not_less = difference & TOP;
        Self(difference & below_tops::<7>(not_less))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.minus(self.minus_saturating(other))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        other.plus(self.minus_saturating(other))
    }

    #[inline(always)]
    fn apart(self, other: Self) -> Self {
        // The greater less the lesser, of which only the whole is no less than 0 in each lane.
        let more = self.minus_saturating(other).0;
        Self(other.0.wrapping_sub(self.0).wrapping_add(more).wrapping_add(more))
    }

    #[inline(always)]
    fn average_up(self, other: Self) -> Self {
        debug_assert!(lanes(self, other, |a, b| a + b < 255), "a sum over a byte: {self:08x?} {other:08x?}");
        Self((self.0 + other.0 + ONE) >> 1 & !TOP)
    }

    #[inline(always)]
    fn average_down(self, other: Self) -> Self {
        debug_assert!(lanes(self, other, |a, b| a + b < 256), "a sum over a byte: {self:08x?} {other:08x?}");
        Self((self.0 + other.0) >> 1 & !TOP)
    }

    #[inline(always)]
    fn quarter(self) -> Self {
        Self((self.0 >> 2) & 0x3f3f_3f3f)
    }

    #[inline(always)]
    fn bits_apart(self, other: Self) -> Self {
        let bits = self.0 ^ other.0;
        let pairs = bits - ((bits >> 1) & 0x5555_5555);
        let fours = (pairs & 0x3333_3333) + ((pairs >> 2) & 0x3333_3333);
        Self((fours + (fours >> 4)) & 0x0f0f_0f0f)
    }

    #[inline(always)]
    fn key_of_four(code: u8) -> Self {
        Self::splat(code)
    }

    #[inline(always)]
    fn four_bits_apart(self, others: Self) -> Self {
        debug_assert!(lanes(self, others, |a, b| a < 16 && b < 16), "codes of four bits");
        let bits = self.0 ^ others.0;
        let pairs = bits - (bits >> 1 & 0x0505_0505);
        Self((pairs & 0x0303_0303) + (pairs >> 2 & 0x0303_0303))
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    #[inline(always)]
    fn after(self, before: Self) -> Self {
        Self(self.0 << 8 | before.0 >> 24)
    }

    #[inline(always)]
    fn before(self, next: Self) -> Self {
        Self(self.0 >> 8 | next.0 << 24)
    }

    #[inline(always)]
    fn least(self) -> Self {
        debug_assert!(lanes(self, self, |a, _| a < 128), "eight bits: {self:08x?}");
        let two = self.min(Self(self.0 >> 16));
        Self::splat(two.min(Self(two.0 >> 8)).0 as u8)
    }

    #[inline(always)]
    fn last_least(cells: &[Self]) -> (u8, usize) {
        debug_assert!(cells.len() < 128, "a place has seven bits");
        // Of equal ones the later is taken.
        let keys = {
            // Half-words with a spare bit: the cost above seven bits of the place, counted down.
            const HALVES: u32 = 0x8000_8000;
            let mut least = [0x7fff_7fffu32; 2];
            let mut place = 0x007f_007fu32;
            for cell in cells {
                keep_loop();
                for (least, costs) in
                    least.iter_mut().zip([(cell.0 & 0x00ff_00ff) << 7, cell.0 >> 1 & 0x7f80_7f80])
                {
                    let key = costs | place;
                    let difference = (*least | HALVES) - key;
                    let not_less = difference & HALVES;
                    *least -= difference & below_tops::<15>(not_less);
                }
                place -= 0x0001_0001;
            }
            let key = |half: u32, lane: u32| {
                let (cost, place) = (half >> 7, 127 - (half & 0x7f));
                cost << 16 | (0xffff - (4 * place + lane))
            };
            let [even, odd] = least;
            [key(even & 0xffff, 0), key(odd & 0xffff, 1), key(even >> 16, 2), key(odd >> 16, 3)]
        };
        let [a, b, c, d] = keys;
        let key = a.min(b).min(c.min(d));
        ((key >> 16) as u8, 0xffff - (key & 0xffff) as usize)
    }

    #[inline(always)]
    fn lane(cells: &[Self], lane: usize) -> u8 {
        cells.get(lane / 4).map_or(0, |cell| (cell.0 >> (8 * (lane % 4))) as u8)
    }

    #[inline(always)]
    fn raise_around(cells: &mut [Self], lane: usize) {
        for lane in lane.saturating_sub(BESIDE)..lane + BESIDE + 1 {
            if let Some(cell) = cells.get_mut(lane / 4) {
                cell.0 |= 0xff << (8 * (lane % 4));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What an operation makes of every pair of bytes that it allows, in each lane beside every neighbour of
    /// a few, is what it makes of the bytes.
    fn check(
        allows: impl Fn(i16, i16) -> bool,
        of_words: impl Fn(Word, Word) -> Word,
        of_bytes: impl Fn(i16, i16) -> i16,
    ) {
        let pairs = || (0..=255u8).flat_map(|a| (0..=255u8).map(move |b| (a, b)));
        let allowed = |(a, b): &(u8, u8)| allows((*a).into(), (*b).into());
        let corners = [0u8, 1, 15, 126, 127, 128, 129, 254, 255];
        let beside: [_; 81] = core::array::from_fn(|i| (corners[i / 9], corners[i % 9]));
        for ((a, b), lane) in pairs().filter(allowed).zip((0..4).cycle()) {
            for (c, d) in beside.into_iter().filter(allowed) {
                let (mut first, mut second) = ([c; 4], [d; 4]);
                (first[lane], second[lane]) = (a, b);
                let found = of_words(Word::of_bytes(first), Word::of_bytes(second)).0.to_le_bytes();
                let expected: [u8; 4] =
                    core::array::from_fn(|i| of_bytes(first[i].into(), second[i].into()) as u8);
                assert_eq!(found, expected, "{first:?} {second:?}");
            }
        }
    }

    fn near(a: i16, b: i16) -> bool {
        (-128..128).contains(&(a - b))
    }

    #[test]
    fn sums_and_differences() {
        check(|a, b| a + b < 256, Word::plus, |a, b| a + b);
        check(|a, b| a >= b, Word::minus, |a, b| a - b);
        check(|_, b| b < 128, Word::plus_saturating, |a, b| (a + b).min(255));
        check(near, Word::minus_saturating, |a, b| (a - b).max(0));
        check(near, Word::apart, |a, b| (a - b).abs());
    }

    #[test]
    fn bits_below_tops() {
        for lanes in 0..16u32 {
            let tops = (0..4).map(|lane| (lanes >> lane & 1) << (8 * lane + 7)).sum();
            assert_eq!(by_product::<7>(tops), tops / 128 * 127, "{tops:08x}");
            assert_eq!(by_shift::<7>(tops), tops / 128 * 127, "{tops:08x}");
        }
        for tops in [0, 0x8000, 0x8000_0000, 0x8000_8000] {
            assert_eq!(by_product::<15>(tops), tops / 0x8000 * 0x7fff, "{tops:08x}");
            assert_eq!(by_shift::<15>(tops), tops / 0x8000 * 0x7fff, "{tops:08x}");
        }
    }

    #[test]
    fn minima_and_maxima() {
        check(near, Word::min, i16::min);
        check(near, Word::max, i16::max);
        for (a, b) in (0..128u8).flat_map(|a| (0..128).map(move |b| (a, b))) {
            for (lane, other) in [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (1, 3)] {
                let mut bytes = [127; 4];
                (bytes[lane], bytes[other]) = (a, b);
                assert_eq!(Word::of_bytes(bytes).least().0, Word::splat(a.min(b)).0, "{bytes:?}");
            }
        }
    }

    #[test]
    fn averages_and_bits() {
        check(|a, b| a + b < 255, Word::average_up, |a, b| (a + b + 1) / 2);
        check(|a, b| a + b < 256, Word::average_down, |a, b| (a + b) / 2);
        check(|_, _| true, |a, _| a.quarter(), |a, _| a / 4);
        check(|_, _| true, Word::bits_apart, |a, b| (a ^ b).count_ones() as i16);
        check(|a, b| a < 16 && b < 16, Word::four_bits_apart, |a, b| (a ^ b).count_ones() as i16);
    }

    #[test]
    fn the_last_of_the_least() {
        for place in 0..508 {
            for least in [0, 1, 127, 128, 254] {
                let mut bytes = [255; 508];
                (bytes[place / 2], bytes[place]) = (least, least);
                let cells: [Word; 127] = core::array::from_fn(|i| {
                    Word::of_bytes([bytes[4 * i], bytes[4 * i + 1], bytes[4 * i + 2], bytes[4 * i + 3]])
                });
                assert_eq!(Word::last_least(&cells), (least, place));
            }
        }
    }

    #[test]
    fn lanes_are_the_bytes_of_memory() {
        let memory: [u32; 3] = [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12]].map(u32::from_le_bytes);
        let cells = memory.map(Word::of);
        for lane in 0..14 {
            assert_eq!(Word::lane(&cells, lane), if lane < 12 { lane as u8 + 1 } else { 0 });
        }
        let (first, second) = (cells[0], cells[1]);
        assert_eq!(second.after(first).0.to_le_bytes(), [4, 5, 6, 7]);
        assert_eq!(first.before(second).0.to_le_bytes(), [2, 3, 4, 5]);
        assert_eq!(Word::splat(0xa5).0.to_le_bytes(), [0xa5; 4]);
        assert_eq!(Word::key_of_four(9).0.to_le_bytes(), [9; 4]);
        let bytes = [0x0f, 0x33, 0x55, 0xff];
        let (first, second) = (Word::of_bytes(bytes), Word::of_bytes([0x3c; 4]));
        assert_eq!(first.or(second).0.to_le_bytes(), bytes.map(|byte| byte | 0x3c));
        assert_eq!(first.and(second).0.to_le_bytes(), bytes.map(|byte| byte & 0x3c));
        assert_eq!(Word::groups(&[1, 2, 3, 4, 5, 6, 7, 8, 9]), [[1, 2, 3, 4], [5, 6, 7, 8]]);
        let mut memory = memory;
        let bytes = view_mut::<u32, u8>(&mut memory);
        assert_eq!((Word::cells(bytes).len(), Word::cells_mut(bytes).len()), (3, 3));
        assert_eq!(Word::cells(bytes)[1].to_le_bytes(), [5, 6, 7, 8]);
    }

    #[test]
    fn what_is_around_a_winner_is_raised() {
        for lane in 0..16 {
            let mut cells =
                [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12], [13, 14, 15, 16]].map(Word::of_bytes);
            Word::raise_around(&mut cells, lane);
            for (at, found) in (0..16).map(|at| (at, Word::lane(&cells, at))) {
                let expected = if lane.abs_diff(at) <= BESIDE { 255 } else { at as u8 + 1 };
                assert_eq!(found, expected, "{lane} {at}");
            }
        }
    }
}
