//! Window sums in the halves of words, each above its candidate's number: the arithmetic of the kernel in words.
//!
//! A key is 15 bits, the highest of a half is free: a comparison of two pairs of keys leaves its outcome there.

use super::scratch::halves_of;

/// The low byte of each half.
const LOW: u32 = 0x00ff_00ff;
/// The highest bit of each half, which no key has.
const TOP: u32 = 0x8000_8000;
/// A key is a sum above this many bits of its word's number.
pub(super) const NUMBER_BITS: u32 = 5;
/// Words whose numbers tell them apart: 128 candidates.
pub(super) const GROUP: usize = 1 << NUMBER_BITS;

/// The keys of a window: those of the even candidates, then those of the odd ones, each a word for four candidates and
/// four words together.
pub(super) struct Keys<'a> {
    pub even: &'a mut [[u32; 4]],
    pub odd: &'a mut [[u32; 4]],
}

impl<'a> Keys<'a> {
    /// No sums, and every word's number, for `groups` of 16 candidates.
    pub(super) fn new(words: &'a mut [u32], groups: usize) -> Option<Self> {
        let (even, odd) = words.as_chunks_mut::<4>().0.get_mut(..2 * groups)?.split_at_mut_checked(groups)?;
        for half in [&mut *even, &mut *odd] {
            for (n, word) in half.as_flattened_mut().iter_mut().enumerate() {
                *word = (n % GROUP) as u32 * 0x0001_0001;
            }
        }
        Some(Self { even, odd })
    }

    /// Adds a column that enters the window and takes one that leaves it.
    #[inline(always)]
    pub(super) fn slide(&mut self, enters: &[[u32; 4]], leaves: &[[u32; 4]]) {
        let halves = self.even.iter_mut().zip(self.odd.iter_mut());
        for ((even, odd), (enters, leaves)) in halves.zip(enters.iter().zip(leaves)) {
            for i in 0..4 {
                moved(&mut even[i], &mut odd[i], enters[i], leaves[i]);
            }
        }
    }

    /// [`Self::slide`] and the best of up to 128 candidates.
    #[inline(always)]
    pub(super) fn slide_to_best(&mut self, enters: &[[u32; 4]], leaves: &[[u32; 4]]) -> Best {
        let mut least = Here::MOST;
        let halves = self.even.iter_mut().zip(self.odd.iter_mut());
        for ((even, odd), (enters, leaves)) in halves.zip(enters.iter().zip(leaves)) {
            for i in 0..4 {
                moved(&mut even[i], &mut odd[i], enters[i], leaves[i]);
                least.take(even[i], odd[i]);
            }
        }
        best_of(least, 0)
    }

    /// The best of the first `candidates`.
    #[inline(never)]
    pub(super) fn best(&self, candidates: usize) -> Best {
        let mut best = (u32::MAX, 0);
        let mut left = candidates;
        for (n, (even, odd)) in self.even.chunks(GROUP / 4).zip(self.odd.chunks(GROUP / 4)).enumerate() {
            let mut least = Here::MOST;
            for (even, odd) in even.as_flattened().iter().zip(odd.as_flattened()) {
                let mask = MASKS[left.min(4)];
                least.take(even | mask[0], odd | mask[1]);
                left = left.saturating_sub(4);
            }
            best = better(best, best_of(least, n * 4 * GROUP));
        }
        best
    }

    /// The costs of the candidates one below and one above, which both are some.
    #[inline(always)]
    pub(super) fn beside(&self, candidate: usize) -> (u32, u32) {
        // Both are of the other parity, one after the other.
        let other = if candidate.is_multiple_of(2) { &*self.odd } else { &*self.even };
        let keys = halves_of(other.as_flattened()).get(candidate.wrapping_sub(1) / 2..).unwrap_or(&[]);
        let Some(&[below, above]) = keys.first_chunk::<2>() else { return (0, 0) };
        (u32::from(below) >> NUMBER_BITS, u32::from(above) >> NUMBER_BITS)
    }

    /// The cost of a candidate.
    pub(super) fn cost(&self, candidate: usize) -> u32 {
        let half = if candidate.is_multiple_of(2) { &*self.even } else { &*self.odd };
        halves_of(half.as_flattened()).get(candidate / 2).map_or(0, |&key| u32::from(key) >> NUMBER_BITS)
    }

    /// The word that holds a candidate's key, and the bits that are the key's.
    pub(super) fn place(&mut self, candidate: usize) -> Option<(&mut u32, u32)> {
        let half = if candidate.is_multiple_of(2) { &mut *self.even } else { &mut *self.odd };
        let word = half.as_flattened_mut().get_mut(candidate / 4)?;
        Some((word, 0x7fff << (candidate as u32 & 2) * 8))
    }
}

/// Adds four sums of a column that enters the window and takes those of one that leaves it.
#[inline(always)]
fn moved(even: &mut u32, odd: &mut u32, enters: u32, leaves: u32) {
    // Differences of whole words, borrows and all: what one half borrows from the next is gone once the sums are whole
    // again, for no sum is below zero.
    let low = (enters & LOW).wrapping_sub(leaves & LOW);
    let high = enters.wrapping_sub(leaves).wrapping_sub(low) as i32;
    *even = even.wrapping_add(low << NUMBER_BITS);
    *odd = odd.wrapping_add((high >> (8 - NUMBER_BITS)) as u32);
}

/// The least of the keys taken, for each of the four places in a word.
trait Least: Copy {
    /// More than any key.
    const MOST: Self;
    /// Takes a word of even candidates and one of odd ones.
    fn take(&mut self, even: u32, odd: u32);
    /// The least keys of the first to the fourth candidate of all words.
    fn keys(self) -> [u32; 4];
}

/// Pairs of keys, over [`TOP`]: compared both at once, without a branch.
#[derive(Clone, Copy)]
struct ByBits([u32; 2]);

impl Least for ByBits {
    const MOST: Self = Self([u32::MAX; 2]);

    #[inline(always)]
    fn take(&mut self, even: u32, odd: u32) {
        for (least, keys) in self.0.iter_mut().zip([even, odd]) {
            let above = least.wrapping_sub(keys);
            let over = above & TOP;
            // All bits below the top one where the key is less.
            *least -= above & (over - (over >> 15));
        }
    }

    #[inline(always)]
    fn keys(self) -> [u32; 4] {
        let Self([even, odd]) = self;
        [even & 0x7fff, odd & 0x7fff, even >> 16 & 0x7fff, odd >> 16 & 0x7fff]
    }
}

/// Keys in the high halves of words, compared one by one: where a branch is one instruction and a choice is many.
#[derive(Clone, Copy)]
struct ByBranches([u32; 4]);

impl Least for ByBranches {
    const MOST: Self = Self([u32::MAX; 4]);

    #[inline(always)]
    fn take(&mut self, even: u32, odd: u32) {
        // What stands below a key decides nothing: no two keys of a place are equal, for their numbers are not.
        for (least, key) in self.0.iter_mut().zip([even << 16, odd << 16, even, odd]) {
            if key < *least {
                *least = key;
            }
        }
    }

    #[inline(always)]
    fn keys(self) -> [u32; 4] {
        self.0.map(|key| key >> 16)
    }
}

#[cfg(target_arch = "riscv32")]
type Here = ByBranches;
#[cfg(not(target_arch = "riscv32"))]
type Here = ByBits;

/// A cost and the first candidate that has it.
pub(super) type Best = (u32, usize);

/// The best of 128 candidates from `first` on.
#[inline(always)]
fn best_of(least: impl Least, first: usize) -> Best {
    let [a, b, c, d] = least.keys();
    let best = (a << 2).min(b << 2 | 1).min((c << 2 | 2).min(d << 2 | 3));
    (best >> (NUMBER_BITS + 2), first + (best & 127) as usize)
}

/// The better of two, the first if they cost the same.
#[inline(always)]
fn better(first: Best, second: Best) -> Best {
    if second.0 < first.0 { second } else { first }
}

/// What is laid over the keys of a word of which the first none to four are candidates.
const MASKS: [[u32; 2]; 5] = {
    let none = 0x7fff;
    let (low, high) = (none, none << 16);
    [[low | high, low | high], [high, low | high], [high, high], [0, high], [0, 0]]
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_find_the_least() {
        let (mut bits, mut branches) = (ByBits::MOST, ByBranches::MOST);
        let mut random = 1u32;
        for number in 0..GROUP as u32 {
            let mut word = || {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (random >> 1 & 0x7fe0_7fe0) | number * 0x0001_0001
            };
            let (even, odd) = (word(), word());
            bits.take(even, odd);
            branches.take(even, odd);
            assert_eq!(bits.keys(), branches.keys());
            assert_eq!(best_of(bits, 0), best_of(branches, 0));
        }
    }
}
