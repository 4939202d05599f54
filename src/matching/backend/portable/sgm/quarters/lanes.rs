//! Four bytes in a word that are compared by subtraction.
//!
//! The numbers have seven bits. A number is marked where its top bit is set, which is 128 more: a marked one
//! less one that is not is 128 and their difference, whose top bit says whether it is not negative. Nothing
//! is carried from lane to lane.

use crate::matching::backend::portable::words::below_tops;

/// The top bit of each lane.
pub(super) const TOP: u32 = 0x8080_8080;
/// A one in each lane.
pub(super) const ONE: u32 = 0x0101_0101;

/// A one in each half-word, where sums are compared.
pub(super) const ONES: u32 = 0x0001_0001;
/// How many bits of a half say how many words ago a sum was found: it has nine itself, and one is to spare.
pub(super) const AGO: u32 = 6;
/// More than any sum, in each half, and so much less than the most that a half may go through all words.
pub(super) const NO_SUM: u32 = ONES * (0xffff - (1 << AGO));

/// A byte four times.
#[inline(always)]
pub(super) const fn splat(number: u32) -> u32 {
    number.wrapping_mul(ONE)
}

/// What each lane is over 128, or 0.
#[inline(always)]
pub(super) fn over(difference: u32) -> u32 {
    difference & below_tops::<7>(difference & TOP)
}

/// Each lane, or 128 where it is more.
#[inline(always)]
pub(super) fn up_to_top(difference: u32) -> u32 {
    difference - over(difference)
}

/// The lesser of two numbers, the first of which is marked, as the lesser is.
#[inline(always)]
pub(super) fn lesser(marked: u32, other: u32) -> u32 {
    marked - over(marked.wrapping_sub(other))
}

/// The averages, rounded down, of numbers whose sum fits a byte.
#[inline(always)]
pub(super) fn average(a: u32, b: u32) -> u32 {
    a.wrapping_add(b) >> 1 & !TOP
}

/// The least of four marked numbers.
#[inline(always)]
pub(super) fn least_of_four(marked: u32) -> u32 {
    let two = lesser(marked, marked >> 16 & !TOP);
    lesser(two, two >> 8 & !TOP) & 0x7f
}

/// The lanes of each of so many words whose candidates are before the one at `place`, where the candidates of
/// a lane stand one after the other, those of the next lane after them.
#[inline(always)]
pub(super) fn before(place: usize, words: usize) -> impl Fn(usize) -> u32 {
    let (lanes, rest) = lanes_before(place, words);
    let next = lanes << 8 | 0xff;
    move |word| if word < rest { next } else { lanes }
}

/// The lanes all of whose words are before a place, and how many words of the next lane are.
#[inline(never)]
fn lanes_before(place: usize, words: usize) -> (u32, usize) {
    let (mut lanes, mut rest) = (0u32, place);
    while rest >= words && lanes != u32::MAX {
        lanes = lanes << 8 | 0xff;
        rest -= words;
    }
    (lanes, rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two numbers of seven bits, in each lane beside others.
    fn pairs() -> impl Iterator<Item = ([u8; 4], [u8; 4])> {
        let corners = [(0, 127), (127, 0), (0, 0), (127, 127), (63, 64)];
        (0..128u8).flat_map(|a| (0..128u8).map(move |b| (a, b))).zip((0..4).cycle()).flat_map(
            move |((a, b), lane)| {
                corners.into_iter().map(move |(c, d)| {
                    let (mut first, mut second) = ([c; 4], [d; 4]);
                    (first[lane], second[lane]) = (a, b);
                    (first, second)
                })
            },
        )
    }

    fn each(of: impl Fn(usize) -> u8) -> u32 {
        u32::from_le_bytes(core::array::from_fn(of))
    }

    #[test]
    fn comparisons_are_those_of_bytes() {
        for (a, b) in pairs() {
            let [first, second] = [a, b].map(u32::from_le_bytes);
            let difference = (first | TOP) - second;
            assert_eq!(over(difference), each(|i| a[i].saturating_sub(b[i])), "{a:?} {b:?}");
            assert_eq!(up_to_top(difference), each(|i| 128 - b[i].saturating_sub(a[i])), "{a:?} {b:?}");
            assert_eq!(lesser(first | TOP, second), each(|i| a[i].min(b[i]) | 0x80), "{a:?} {b:?}");
            assert_eq!(average(first, second), each(|i| (a[i] + b[i]) / 2), "{a:?} {b:?}");
            let least = a.into_iter().fold(u8::MAX, u8::min);
            assert_eq!(least_of_four(first | TOP), least.into(), "{a:?}");
        }
    }

    #[test]
    fn lanes_before_a_place() {
        for words in [4, 8, 12, 64] {
            for place in 0..=4 * words {
                for word in 0..words {
                    let lanes = each(|lane| if lane * words + word < place { 0xff } else { 0 });
                    assert_eq!(before(place, words)(word), lanes, "{place} {word} {words}");
                }
            }
        }
    }
}
