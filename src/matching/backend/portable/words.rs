//! Four bytes in a 32-bit word.
//!
//! The lanes have a spare bit at the top of each. It is set before a subtraction and tells then whether the
//! lane is not smaller: differences that end at 0 are made of that, and minima of those, in six operations.
//! (Arm's instructions on four bytes take two: see `armv7em`.)

use super::group::Group;
use crate::matching::backend::loops::keep_loop;
use crate::matching::memory::views::{view, view_mut};
use crate::matching::memory::winners::BESIDE;

/// The top bit of each lane.
const TOP: u32 = 0x8080_8080;
/// A one in each lane.
const ONE: u32 = 0x0101_0101;

/// Four bytes, the first lane lowest.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(in crate::matching::backend) struct Word(u32);

impl Group for Word {
    const LANES: usize = 4;
    type Cell = u32;
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
    fn plus(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self(self.0.wrapping_sub(other.0))
    }

    #[inline(always)]
    fn plus_saturating(self, other: Self) -> Self {
        let sum = (self.0 & !TOP) + other.0;
        let over = self.0 & sum & TOP;
        Self(sum | (self.0 & TOP) | ((over >> 7) * 0xff))
    }

    #[inline(always)]
    fn minus_saturating(self, other: Self) -> Self {
        let difference = (self.0 | TOP) - other.0;
        let not_less = difference & TOP;
        Self(difference & (not_less - (not_less >> 7)))
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
        let more = self.minus_saturating(other);
        other.minus(self).plus(more).plus(more)
    }

    #[inline(always)]
    fn average_up(self, other: Self) -> Self {
        Self((self.0 + other.0 + ONE) >> 1 & !TOP)
    }

    #[inline(always)]
    fn average_down(self, other: Self) -> Self {
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
        let two = self.min(Self(self.0 >> 16));
        Self::splat(two.min(Self(two.0 >> 8)).0 as u8)
    }

    #[inline(always)]
    fn last_least(cells: &[Self]) -> (u8, usize) {
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
                    *least -= difference & (not_less - (not_less >> 15));
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
