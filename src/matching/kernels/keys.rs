//! Window sums in the halves of words, each above its candidate's number: the arithmetic of the kernel in words.
//!
//! A key is 15 bits, the highest of a half is free: a comparison of two pairs of keys leaves its outcome there.

/// The low byte of each half.
const LOW: u32 = 0x00ff_00ff;
/// The highest bit of each half, which no key has.
const TOP: u32 = 0x8000_8000;
/// A key is a sum above this many bits of its word's number.
pub(super) const NUMBER_BITS: u32 = 5;
/// Words whose numbers tell them apart: 128 candidates.
pub(super) const GROUP: usize = 1 << NUMBER_BITS;

/// The even and the odd candidates' keys of four words of columns.
pub(super) type Keys = [[u32; 2]; 4];

/// No sums, and every word's number.
#[inline(always)]
pub(super) fn number(sums: &mut [Keys]) {
    for (n, pair) in sums.as_flattened_mut().iter_mut().enumerate() {
        *pair = [(n % GROUP) as u32 * 0x0001_0001; 2];
    }
}

/// Adds a column that enters the window to the sums and takes one that leaves it.
#[inline(always)]
fn moved(sums: &mut [u32; 2], enters: u32, leaves: u32) {
    // Differences of whole words, borrows and all: what one half borrows from the next is gone once the sums are whole
    // again, for no sum is below zero.
    let even = (enters & LOW).wrapping_sub(leaves & LOW);
    let odd = enters.wrapping_sub(leaves).wrapping_sub(even) as i32;
    sums[0] = sums[0].wrapping_add(even << NUMBER_BITS);
    sums[1] = sums[1].wrapping_add((odd >> (8 - NUMBER_BITS)) as u32);
}

/// [`moved`] for a whole column.
#[inline(never)]
pub(super) fn slide(sums: &mut [Keys], enters: &[[u32; 4]], leaves: &[[u32; 4]]) {
    for (sums, (enters, leaves)) in sums.iter_mut().zip(enters.iter().zip(leaves)) {
        for i in 0..4 {
            moved(&mut sums[i], enters[i], leaves[i]);
        }
    }
}

/// The least keys of the even and of the odd candidates, over [`TOP`].
type Least = [u32; 2];

/// More than any key.
const MOST: Least = [u32::MAX; 2];

/// The lesser of two pairs of keys, the first and the result over [`TOP`].
#[inline(always)]
fn lesser(least: u32, keys: u32) -> u32 {
    let above = least.wrapping_sub(keys);
    let over = above & TOP;
    // All bits below the top one where the key is less.
    least - (above & (over - (over >> 15)))
}

/// A cost and the first candidate that has it.
pub(super) type Best = (u32, usize);

/// The best of 128 candidates from `first` on.
#[inline(always)]
pub(super) fn best_of(least: Least, first: usize) -> Best {
    let key = |half: u32, i: u32| (half & 0x7fff) << 2 | i;
    let low = key(least[0], 0).min(key(least[1], 1));
    let best = low.min(key(least[0] >> 16, 2).min(key(least[1] >> 16, 3)));
    (best >> (NUMBER_BITS + 2), first + (best & 127) as usize)
}

/// [`slide`] and the least keys of up to 128 candidates.
#[inline(always)]
pub(super) fn slide_to_least(sums: &mut [Keys], enters: &[[u32; 4]], leaves: &[[u32; 4]]) -> Least {
    let mut least = MOST;
    for (sums, (enters, leaves)) in sums.iter_mut().zip(enters.iter().zip(leaves)) {
        for i in 0..4 {
            moved(&mut sums[i], enters[i], leaves[i]);
            least = [lesser(least[0], sums[i][0]), lesser(least[1], sums[i][1])];
        }
    }
    least
}

/// The best of the first candidates of a group.
#[inline(always)]
pub(super) fn best_of_group(sums: &[Keys], candidates: usize, first: usize) -> Best {
    let mut least = MOST;
    let mut left = candidates;
    for keys in sums.first().into_iter().flatten() {
        let mask = MASKS[left.min(4)];
        least = [lesser(least[0], keys[0] | mask[0]), lesser(least[1], keys[1] | mask[1])];
        left = left.saturating_sub(4);
    }
    best_of(least, first)
}

/// The better of two, the first if they cost the same.
#[inline(always)]
pub(super) fn better(first: Best, second: Best) -> Best {
    if second.0 < first.0 { second } else { first }
}

/// What is laid over the keys of a word of which the first none to four are candidates.
const MASKS: [[u32; 2]; 5] = {
    let none = 0x7fff;
    let (low, high) = (none, none << 16);
    [[low | high, low | high], [high, low | high], [high, high], [0, high], [0, 0]]
};

/// Where the sum of a candidate is: its word and the shift down to it.
#[inline(always)]
pub(super) fn place(candidate: usize) -> ([usize; 3], u32) {
    ([candidate / 16, candidate / 4 % 4, candidate % 2], (candidate as u32 & 2) * 8)
}

/// The cost of a candidate.
#[inline(always)]
pub(super) fn cost(sums: &[Keys], candidate: usize) -> u32 {
    let ([group, pair, parity], shift) = place(candidate);
    let word = sums.get(group).map_or(0, |keys| keys[pair][parity]);
    (word >> shift & 0x7fff) >> NUMBER_BITS
}
