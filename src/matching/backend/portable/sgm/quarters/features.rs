//! What a pixel's cost compares, of four pixels at a time in plain Rust.

use super::lanes::{TOP, average, over};
use crate::matching::backend::portable::sgm::features_by_four::{FourPixels, SIGNS};
use crate::matching::backend::portable::words::HAS_PRODUCTS;

/// Four bytes or two half-words in a word.
pub(in crate::matching::backend) struct WordRows;

impl FourPixels for WordRows {
    const KEEPS_ROWS: bool = HAS_PRODUCTS;

    #[inline(always)]
    fn codes(here: u32, [a, b, c, d, e, f, g, h]: [u32; 8]) -> u32 {
        let (low, turned) = (here & !TOP, !here);
        // The bit of each pixel that is not brighter than a neighbour: of the other seven bits a subtraction
        // says it where the top bits are the same.
        let bit = |neighbour: u32, bit: u32| {
            let not_less = (neighbour | TOP).wrapping_sub(low);
            let not_less = (neighbour ^ here) & (turned ^ not_less) ^ not_less;
            (not_less & TOP) >> (7 - bit)
        };
        let codes = bit(a, 0) | bit(b, 1) | bit(c, 2) | bit(d, 3);
        !(codes | bit(e, 4) | bit(f, 5) | bit(g, 6) | bit(h, 7))
    }

    #[inline(always)]
    fn cut(differences: [u32; 2], most: u32) -> u32 {
        let not_negative = |number: u32| {
            let sign = number & SIGNS;
            number & (sign - (sign >> 15))
        };
        let [even, odd] = differences.map(|difference| {
            let more = not_negative(difference + most);
            2 * most - not_negative(2 * most + SIGNS - more)
        });
        even | odd << 8
    }

    /// Of numbers of seven bits.
    #[inline(always)]
    fn ranges([before, here, next]: [u32; 3]) -> (u32, u32) {
        let (a, b) = (average(before, here), average(here, next));
        let more = over((a | TOP).wrapping_sub(b));
        let (least, greatest) = (a - more, b + more);
        let here_marked = here | TOP;
        (here - over(here_marked.wrapping_sub(least)), greatest + over(here_marked.wrapping_sub(greatest)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::backend::portable::sgm::features::{FeatureRows, PlainRows};
    use crate::matching::memory::Rows5;
    use crate::matching::memory::slices::{part, part_mut};

    fn features<R: FeatureRows>(lines: &Rows5<'_>, gradient: u8) -> [[u8; 40]; 6] {
        let width = lines[2].len();
        let mut rows = [[0; 40]; 6];
        let [along, across, census, least, greatest, halves] =
            rows.each_mut().map(|row| part_mut(row, ..width));
        R::looks(lines, width, gradient, [&mut *along, &mut *across, census]);
        R::range(across, least, greatest);
        R::halve(along, halves);
        // Those of the first four and of the last one mean nothing.
        for row in [least, greatest] {
            part_mut(row, ..width.min(4)).fill(0);
            part_mut(row, width - 1..).fill(0);
        }
        rows
    }

    #[test]
    fn words_see_what_pixels_see() {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        for width in (2..=40).cycle().take(400) {
            let flat = random() < 128;
            let lines =
                [(); 5].map(|()| [(); 40].map(|()| if flat { 100 + random() / 32 } else { random() }));
            let lines = lines.each_ref().map(|line| part(line, ..width));
            for gradient in [7, 9, 28] {
                let found = features::<WordRows>(&lines, gradient);
                assert_eq!(found, features::<PlainRows>(&lines, gradient), "{width} {gradient} {lines:?}");
            }
        }
        for (a, b) in (0..29).flat_map(|a| (0..29).map(move |b| (a, b))) {
            let numbers = [0, 0, 0, a, b, 28 - a, 28, a];
            let range = |range: fn(&[u8], &mut [u8], &mut [u8])| {
                let [mut least, mut greatest] = [[0; 8]; 2];
                range(&numbers, &mut least, &mut greatest);
                [least, greatest].map(|row| [row[4], row[5], row[6]])
            };
            assert_eq!(range(WordRows::range), range(PlainRows::range), "{a} {b}");
        }
    }
}
