//! Half-words side by side in the registers that [`Group`] has bytes in.

use crate::matching::backend::portable::group::Group;
use crate::matching::backend::portable::words::Word;
use crate::matching::memory::views::{view, view_mut};

/// What is done to all half-words of a register at once.
pub(super) trait HalfWords: Group {
    /// How many half-words a register has.
    const COUNT: usize = Self::LANES / size_of::<u16>();

    /// The sums, `u16::MAX` where they would be more.
    fn sums(self, other: Self) -> Self;
    /// The differences, 0 where they would be less.
    fn differences(self, other: Self) -> Self;
    /// The greater of both.
    #[inline(always)]
    fn greater(self, other: Self) -> Self {
        other.sums(self.differences(other))
    }
    /// Each number so many places farther on, behind zeros: a power of two, less than [`Self::COUNT`].
    fn on<const BY: usize>(self) -> Self;
    /// Each number so many places farther back, before zeros.
    fn back<const BY: usize>(self) -> Self;

    /// The first of the numbers, as many as a register has.
    #[inline(always)]
    fn of_half_words(numbers: &[u16]) -> Self {
        Self::groups(view(numbers)).first().map_or(Self::splat(0), |&bytes| Self::of_bytes(bytes))
    }

    /// Puts them in the place of the first of the numbers.
    #[inline(always)]
    fn put_half_words(self, numbers: &mut [u16]) {
        if let Some(cell) = Self::cells_mut(view_mut(numbers)).first_mut() {
            *cell = self.cell();
        }
    }
}

/// Two half-words of a word.
impl HalfWords for Word {
    #[inline(always)]
    fn sums(self, other: Self) -> Self {
        of_each(self, other, u16::saturating_add)
    }

    #[inline(always)]
    fn differences(self, other: Self) -> Self {
        of_each(self, other, u16::saturating_sub)
    }

    #[inline(always)]
    fn on<const BY: usize>(self) -> Self {
        Self::of(self.cell() << 16)
    }

    #[inline(always)]
    fn back<const BY: usize>(self) -> Self {
        Self::of(self.cell() >> 16)
    }
}

/// A number for each pair of half-words of two words.
#[inline(always)]
fn of_each(a: Word, b: Word, number: impl Fn(u16, u16) -> u16) -> Word {
    let [a, b] = [a.cell(), b.cell()];
    let at = |shift: u32| u32::from(number((a >> shift) as u16, (b >> shift) as u16)) << shift;
    Word::of(at(0) | at(16))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers that are put after something is done to others.
    fn done<H: HalfWords>(numbers: &[u16], work: impl FnOnce(H) -> H) -> [u16; 32] {
        let mut out = [0; 32];
        work(H::of_half_words(numbers)).put_half_words(&mut out);
        out
    }

    /// What each operation does, number by number.
    fn check<H: HalfWords>() {
        let mut state = 1u32;
        let mut chance = || {
            state = state.wrapping_mul(0x9e37_79b1).wrapping_add(0x7f4a_7c15);
            // Small ones, great ones and those in between.
            [(state >> 16) as u16, (state >> 24) as u16, !(state >> 24) as u16][(state >> 8) as usize % 3]
        };
        for _ in 0..200 {
            let [a, b]: [[u16; 32]; 2] = core::array::from_fn(|_| core::array::from_fn(|_| chance()));
            let other = H::of_half_words(&b);
            let expected = |number: fn(u16, u16) -> u16| -> [u16; 32] {
                core::array::from_fn(|i| if i < H::COUNT { number(a[i], b[i]) } else { 0 })
            };
            assert_eq!(done::<H>(&a, |a| a.sums(other)), expected(u16::saturating_add));
            assert_eq!(done::<H>(&a, |a| a.differences(other)), expected(u16::saturating_sub));
            assert_eq!(done::<H>(&a, |a| a.greater(other)), expected(u16::max));
            macro_rules! moved {
                ($($by:literal)*) => {$(
                    if $by < H::COUNT {
                        let from = |at: Option<usize>| at.filter(|&at| at < H::COUNT).map_or(0, |at| a[at]);
                        let on = |i: usize| if i < H::COUNT { from(i.checked_sub($by)) } else { 0 };
                        assert_eq!(done::<H>(&a, |a| a.on::<$by>()), core::array::from_fn(on), "{}", $by);
                        let back = |i: usize| from(Some(i + $by));
                        assert_eq!(done::<H>(&a, |a| a.back::<$by>()), core::array::from_fn(back), "{}", $by);
                    }
                )*};
            }
            moved!(1 2 4 8 16);
        }
    }

    #[test]
    fn half_words_of_every_register_are_what_they_are_one_by_one() {
        check::<Word>();
        check::<super::super::Vector>();
        if let Some(avx2) = super::super::Avx2::detect() {
            avx2.run(check::<super::super::Wide>);
        }
        if let Some(avx512) = super::super::Avx512::detect() {
            avx512.run(check::<super::super::Widest>);
        }
    }
}
