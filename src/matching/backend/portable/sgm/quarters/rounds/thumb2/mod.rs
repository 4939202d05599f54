//! Rounds in the instructions of a Cortex-M3, which know no bytes side by side: `plain` says what each makes.
//! Each is a function that stands alone, for its registers are all that there are. What is said of
//! instructions is for four words.
//!
//! `0x80808080` is the top bit of each lane. A constant of one byte four times is part of an instruction, and
//! a shift as well: numbers are cut out first and shifted where they are used.

/// One instruction.
macro_rules! op {
    ($name:literal, $first:literal $(, $other:literal)*) => {
        concat!($name, " ", $first, $(", ", $other,)* "\n")
    };
}

/// Makes `$over` what the first of two numbers, a marked one, is over the second, of their `$difference`. 3
/// instructions.
macro_rules! over {
    ($over:literal, $difference:literal) => {
        concat!(
            op!("and", $over, $difference, "#0x80808080"),
            op!("sub", $over, $over, $over, "lsr #7"),
            op!("and", $over, $over, $difference),
        )
    };
}

/// Makes the marked number the lesser of it and another one. 5 instructions.
macro_rules! lesser {
    ($marked:literal, $other:literal) => {
        concat!(op!("sub", "r10", $marked, $other), over!("r11", "r10"), op!("sub", $marked, $marked, "r11"),)
    };
}

/// Makes a word of the same byte four times of a number. 2 instructions.
macro_rules! splat {
    ($number:literal) => {
        concat!(
            op!("orr", $number, $number, $number, "lsl #8"),
            op!("orr", $number, $number, $number, "lsl #16"),
        )
    };
}

mod costs;
mod paths;
mod winner;

pub(in super::super) use costs::enter;
pub(in super::super) use paths::{along, average_two, down};
pub(in super::super) use winner::winner;

#[cfg(test)]
mod tests {
    use super::super::plain;
    use super::*;
    use crate::matching::backend::portable::sgm::features::Looks;
    use crate::matching::backend::portable::sgm::quarters::columns::FOUR;
    use crate::matching::backend::portable::sgm::quarters::lanes::splat;
    use crate::matching::backend::portable::sgm::quarters::others::{Costs, Others};
    use crate::matching::backend::portable::sgm::quarters::steps::Steps;
    use crate::matching::memory::winners::Found;
    use crate::matching::method::Sgm;
    use crate::matching::method::SgmEdge;
    use crate::matching::penalties::Penalties;
    use core::cell::Cell;

    /// Words of a column.
    const SIZES: [usize; 6] = [4, 8, 12, 16, 32, 64];
    const MOST: usize = 64;

    /// Bytes up to a bound, in words (Marsaglia's xorshift).
    struct Draw(u32);

    impl Draw {
        fn byte(&mut self, most: u32) -> u8 {
            for shift in [13, -17, 5] {
                self.0 ^= if shift > 0 { self.0 << shift } else { self.0 >> -shift };
            }
            ((self.0 >> 8) % (most + 1)) as u8
        }

        fn words<const N: usize>(&mut self, most: u32) -> [u32; N] {
            core::array::from_fn(|_| u32::from_le_bytes([0; 4].map(|_| self.byte(most))))
        }
    }

    fn cells(words: &mut [u32]) -> &[Cell<u32>] {
        Cell::from_mut(words).as_slice_of_cells()
    }

    /// Changes of brightness on both sides of every edge.
    fn changes(penalties: &Penalties) -> impl Iterator<Item = u8> {
        penalties.edges.into_iter().flat_map(|edge| [edge - 1, edge, edge + 1]).chain([0, 255])
    }

    #[test]
    fn paths_are_those_in_plain_rust() {
        let penalties = Penalties::DEFAULT;
        let mut draw = Draw(1);
        for words in SIZES {
            let steps = Steps::new(&penalties, words);
            for change in changes(&penalties) {
                // The margin at least; a path's costs are none under the least, and leave room for a step.
                let least = draw.byte(20).into();
                let costs = draw.words::<MOST>(16).map(|word| word + splat(19));
                let path = draw.words::<MOST>(89).map(|word| word + splat(least));
                let sums = draw.words::<MOST>(109);
                let from = (change, least);
                for in_place in [false, true] {
                    let [mut found, mut expected] = [(path, sums); 2];
                    let both = [
                        (along as fn(&_, _, &_, &_, &_) -> _, &mut found),
                        (plain::along as fn(&_, _, &_, &_, &_) -> _, &mut expected),
                    ];
                    let [found_least, expected_least] = both.map(|(along, (path, sums))| {
                        let path = cells(&mut path[..words]);
                        let to = if in_place { path } else { cells(&mut sums[..words]) };
                        along(&steps, from, &costs[..words], path, to)
                    });
                    assert_eq!((found, found_least), (expected, expected_least), "{words} {change}");
                }
                let [mut found, mut expected] = [(path, sums); 2];
                down(
                    &steps,
                    from,
                    &costs[..words],
                    cells(&mut found.0[..words]),
                    cells(&mut found.1[..words]),
                );
                let (path, sums) = &mut expected;
                plain::down(
                    &steps,
                    from,
                    &costs[..words],
                    cells(&mut path[..words]),
                    cells(&mut sums[..words]),
                );
                assert_eq!(found, expected, "{words} {change}");
            }
        }
    }

    #[test]
    fn averages_and_winners_are_those_in_plain_rust() {
        let mut draw = Draw(2);
        for words in SIZES {
            for most in [0, 1, 2, 50, 109] {
                let [mut one, mut other] = [0; 2].map(|_| draw.words::<MOST>(most));
                let candidates = usize::from(draw.byte(4 * words as u32 - 1)) + 1;
                // Lanes that are no candidate cost more, as where they are searched.
                let mut sums = draw.words::<MOST>(2 * most);
                for place in 0..4 * words - candidates {
                    let lane = 0xff << (8 * (place / words));
                    (one[place % words], sums[place % words]) =
                        (one[place % words] | lane, sums[place % words] | lane);
                }
                let found = winner([&one[..words], &sums[..words]], candidates, 0);
                let expected = plain::winner([&one[..words], &sums[..words]], candidates, 0);
                let parts = |found: Found| (found.disparity, found.cost, found.beside);
                assert_eq!(parts(found), parts(expected), "{words} {most} {candidates}");
                one = draw.words(most);
                let (mut in_plain, mut second) = ([0; MOST], [0; MOST]);
                let both = [cells(&mut one[..words]), cells(&mut other[..words])];
                let found = average_two(both, cells(&mut second[..words]));
                assert_eq!(found, plain::average_two(both, cells(&mut in_plain[..words])), "{words} {most}");
                assert_eq!(second, in_plain, "{words} {most}");
                assert_eq!(average_two(both, both[0]), found, "{words} {most}");
                assert_eq!(one[..words], in_plain[..words], "{words} {most}");
            }
        }
    }

    #[test]
    fn costs_are_those_in_plain_rust() {
        const WIDTH: usize = 11;
        let mut draw = Draw(3);
        for words in SIZES {
            let mut rows = [0; 3 * WIDTH];
            rows.iter_mut().enumerate().for_each(|(i, look)| {
                *look = draw.byte(if i < 2 * WIDTH { 14 } else { 255 });
            });
            let brightness: [u8; WIDTH] = core::array::from_fn(|_| draw.byte(255));
            let [along, across, census] = [0, 1, 2].map(|row| &rows[row * WIDTH..(row + 1) * WIDTH]);
            let left = Looks { rows: &rows, along, across, census, brightness: &brightness };
            let costs = Costs { left, rounds: words / FOUR, most: splat(16), margin: splat(19) };
            let others: [Others; MOST + WIDTH] = core::array::from_fn(|_| {
                let [[least], [wide], [across], [census], [brightness]] =
                    [7, 7, 14, 255, 127].map(|most| draw.words::<1>(most));
                // 128 less the greatest, which is no less than the least.
                [least | splat(128), splat(128) - least - wide, across, census, brightness]
            });
            for x in [0, 3, WIDTH - 1] {
                let columns = draw.words::<{ MOST * WIDTH }>(35).map(|word| word | splat(16));
                let [mut found, mut expected] = [columns; 2];
                let end = words * (WIDTH - x);
                enter::<Sgm, 0, false>(&costs, x, &others[..words + WIDTH], &mut found[..end]);
                plain::enter::<Sgm, 0, false>(&costs, x, &others[..words + WIDTH], &mut expected[..end]);
                assert!(found == expected && found[..end] != columns[..end], "{words} {x}");
                enter::<SgmEdge, 0, false>(&costs, x, &others[..words + WIDTH], &mut found[..end]);
                plain::enter::<SgmEdge, 0, false>(&costs, x, &others[..words + WIDTH], &mut expected[..end]);
                assert!(found == expected, "{words} {x}, within edges");
            }
        }
    }
}
