//! Answers asked for more where the image is open: a place without edges that reaches up to its first row.
//!
//! That is what a sky looks like, and a wall that goes on above the image. What costs along paths bring there
//! from the surfaces beside it has nothing against it. So in and beside an open place a row of a surface
//! counts as fewer answers for its [support](super::speckle)
//! ([`open_run`](crate::matching::Checks::open_run)), and an answer stays only where the second best costs
//! much more ([`open_margin`](crate::matching::Checks::open_margin)).
//!
//! Each four columns of a row are a block. It is smooth when none of its pixels is an edge along the row, by
//! the edges of [`fattening`](super::fattening), and its pixels' sums in the rows above and below differ by
//! as little: that is eight times the gradient down the columns. A smooth block is open when the block
//! above it was, or another one that smooth blocks of its row join it to. Only every other row is looked at:
//! that is half of the work, and half of the edges that noise makes.
//!
//! A block has a bit. With the smooth blocks of 32 as `f` and the open ones among them as `s`, the carries of
//! `f + s` run from each open block to the end of its smooth ones.

use super::confidence::has_margin;
use super::fattening::least_gradient;
use crate::matching::backend::Isa;
use crate::matching::backend::loops::{KEEPS_LOOPS, fill_bytes, keep_loop};
use crate::matching::memory::Rows5;
use crate::matching::memory::notes::Note;
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::method::Frame;
use crate::units::{Disparity, PixelFlags};
use core::ops::Range;

/// Columns of a block.
pub(super) const BLOCK: usize = 4;
/// Blocks whose bits are in a word.
const BLOCKS: usize = u32::BITS as usize;

/// Words of a row's bits.
pub(super) const fn words(width: usize) -> usize {
    width.div_ceil(BLOCK * BLOCKS)
}

/// What makes the difference of two sums of pixels positive.
const MORE: u32 = 0x400;

/// Forgets the frame before: above the first row all is open.
pub(super) fn begin(frame: &mut Frame<'_>) {
    let words = words(frame.width).min(frame.blocks.len());
    fill_bytes(part_mut(frame.blocks, ..words), u8::MAX);
}

/// Takes row `y` of the left image, whose edges are in; below the image all stays as it is.
// A function of its own, so that its registers do not stand on the stack of all stages.
#[inline(never)]
pub(super) fn take_open(frame: &mut Frame<'_>, y: usize, lines: Option<[&Rows5<'_>; 2]>) {
    if let Some([left, _]) = lines
        && frame.config.checks.look_for_open()
        && y.is_multiple_of(2)
    {
        let [above, below] = [left[1], left[3]].map(|line| part(line, ..frame.width).as_chunks().0);
        let row = Smooth { above, below, edges: frame.edges.as_chunks().0 };
        let least = u32::from(least_gradient(frame.config.noise));
        push(part_mut(frame.blocks, ..words(frame.width)), &row, least);
    }
}

/// What a row's smooth blocks are found by: the rows above and below it, and its edges.
struct Smooth<'a> {
    above: &'a [[u8; BLOCK]],
    below: &'a [[u8; BLOCK]],
    edges: &'a [[u8; BLOCK]],
}

impl Smooth<'_> {
    /// Which of the blocks of a word are smooth. The last columns, fewer than a block, are none.
    // Once, for both ways along the row.
    #[inline(never)]
    fn word(&self, word: usize, least: u32) -> u32 {
        let blocks = |row| -> &[[u8; BLOCK]] { part(row, word * BLOCKS..) };
        let above = blocks(self.above);
        let above = part(above, ..above.len().min(BLOCKS));
        let (below, edges) = (blocks(self.below), blocks(self.edges));
        let (mut bits, mut bit) = (0, 1u32);
        if !KEEPS_LOOPS
            && let (Some(above), Some(below), Some(edges)) =
                (above.first_chunk::<BLOCKS>(), below.first_chunk::<BLOCKS>(), edges.first_chunk::<BLOCKS>())
        {
            for i in 0..BLOCKS {
                bits |= u32::from(is_smooth(&above[i], &below[i], &edges[i], least)) << i;
            }
            return bits;
        }
        for ((above, below), edges) in above.iter().zip(below).zip(edges) {
            keep_loop();
            bits |= bit & 0u32.wrapping_sub(u32::from(is_smooth(above, below, edges, least)));
            bit <<= 1;
        }
        bits
    }
}

/// Whether a block has no edge, and its pixels' sums in the rows above and below differ by less than `least`.
#[inline(always)]
fn is_smooth(above: &[u8; BLOCK], below: &[u8; BLOCK], edges: &[u8; BLOCK], least: u32) -> bool {
    // Both differences are of 510 at most: with so much more neither borrows from the other.
    let both = (sums(below) + MORE * 0x1_0001).wrapping_sub(sums(above));
    let apart = both.wrapping_mul(0x1_0001) >> 16;
    let is_even = apart.wrapping_sub(2 * MORE - (least - 1)) <= 2 * (least - 1);
    is_even & (u32::from_le_bytes(*edges) & 0x0101_0101 == 0)
}

/// The sums of the even and of the odd pixels of a block, in a half-word each.
#[inline(always)]
fn sums(block: &[u8; BLOCK]) -> u32 {
    let pixels = u32::from_le_bytes(*block);
    (pixels & 0x00ff_00ff) + (pixels >> 8 & 0x00ff_00ff)
}

/// Moves the open blocks one row on.
#[inline(never)]
fn push(open: &mut [u32], row: &Smooth<'_>, least: u32) {
    let mut is_joined = 0;
    for (number, open) in open.iter_mut().enumerate() {
        keep_loop();
        let smooth = row.word(number, least);
        let to_right = filled(smooth, smooth & (*open | is_joined));
        *open = filled_back(smooth, to_right);
        is_joined = *open >> (BLOCKS - 1);
    }
    // A word that a later one opens from its first block on.
    let mut is_joined = 0;
    for (number, open) in open.iter_mut().enumerate().rev() {
        keep_loop();
        // Blocks that are joined to an open last one are open already.
        if is_joined > *open >> (BLOCKS - 1) {
            let smooth = row.word(number, least);
            *open |= filled_back(smooth, smooth & 1 << (BLOCKS - 1));
        }
        is_joined = *open & 1;
    }
}

/// The bits of `smooth` from each of the `seeds` among them up to the last one that is joined to it.
#[inline(always)]
fn filled(smooth: u32, seeds: u32) -> u32 {
    smooth & !smooth.wrapping_add(seeds) | seeds
}

/// [`filled`] the other way, down to the first bit that is joined to it.
#[inline(never)]
fn filled_back(smooth: u32, seeds: u32) -> u32 {
    // Joined across one bit, across two, four and so on.
    let (mut all, mut joined, mut by) = (seeds, smooth, core::hint::black_box(1));
    while by < BLOCKS {
        keep_loop();
        all |= joined & all >> by;
        joined &= joined >> by;
        by *= 2;
    }
    all
}

/// Does something with the columns of the blocks that are open, or beside one that is: with those that follow
/// one another at once, so that a blank image takes hardly more than another one.
// A function behind a pointer, so that this is there once.
#[inline(never)]
pub(super) fn for_columns(open: &[u32], width: usize, act: &mut dyn FnMut(Range<usize>)) {
    let mut words = part(open, ..words(width));
    // Mostly none is.
    if words.iter().all(|word| *word == 0) {
        return;
    }
    let (mut before, mut is_inside, mut begin, mut first) = (0, false, 0, 0);
    while let Some((&here, others)) = words.split_first() {
        let after = others.first().copied().unwrap_or(0);
        let bits = here | here << 1 | here >> 1 | before >> (BLOCKS - 1) | after << (BLOCKS - 1);
        // A bit where they begin, and where they have ended.
        let mut edges = bits ^ (bits << 1 | u32::from(is_inside));
        while edges != 0 {
            keep_loop();
            let column = ((first + edges.trailing_zeros() as usize) * BLOCK).min(width);
            edges &= edges - 1;
            if is_inside {
                act(begin..column);
            }
            (is_inside, begin) = (!is_inside, column);
        }
        (words, before, first) = (others, here, first + BLOCKS);
    }
    if is_inside {
        act(begin..width);
    }
}

/// Lets a row of a surface count as no more than [`open_run`](crate::matching::Checks::open_run) answers.
#[inline(never)]
pub(super) fn limit_lengths(frame: &mut Frame<'_>) {
    let most = frame.config.checks.open_run;
    if most > 0 {
        let (mut lengths, backend) = (frame.workspace.lengths(), frame.backend);
        for_columns(frame.blocks, frame.width, &mut |places| {
            backend.limit_lengths(&mut lengths, places, most)
        });
    }
}

/// Refuses the answers of `newest` whose second best costs little more, as
/// [`open_margin`](crate::matching::Checks::open_margin) says.
#[inline(never)]
pub(super) fn refuse_unsure(frame: &mut Frame<'_>, newest: usize) {
    let least = frame.config.checks.open_margin;
    if least == 0 {
        return;
    }
    let margins = frame.workspace.margins();
    let (answers, flags) = (frame.band.row_mut(newest), frame.flags.row_mut(newest));
    for_columns(frame.blocks, frame.width, &mut |places| {
        let (answers, flags) = (part_mut(answers, places.clone()), part_mut(flags, places.clone()));
        let margins = part(margins, places.clone());
        for (((answer, flags), &margin), x) in answers.iter_mut().zip(flags).zip(margins).zip(places) {
            keep_loop();
            let margin = if has_margin(frame.config, x) { margin.min(Note::MOST_MARGIN) } else { 0 };
            let refused = answer.is_some() & (margin < least);
            *flags = flags.union(PixelFlags::AMBIGUOUS.when(refused));
            *answer = Disparity::from_raw(answer.raw() | 0u16.wrapping_sub(u16::from(refused)));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORDS: usize = 3;
    const COUNT: usize = WORDS * BLOCKS;

    /// Numbers below a bound, by chance.
    fn chance() -> impl FnMut(u32) -> u32 {
        let mut state = 7u32;
        move |below| {
            state = state.wrapping_mul(0x9e37_79b1).wrapping_add(0x7f4a_7c15);
            (state >> 12) % below
        }
    }

    fn bits(blocks: &[bool; COUNT]) -> [u32; WORDS] {
        core::array::from_fn(|word| {
            let bits = (0..BLOCKS).filter(|bit| blocks[word * BLOCKS + bit]).map(|bit| 1u32 << bit);
            bits.sum()
        })
    }

    #[test]
    fn a_block_is_smooth_without_an_edge_and_where_little_changes_down_the_columns() {
        let blocks = [
            [0; 4],
            [255; 4],
            [0, 0, 0, 7],
            [8, 0, 0, 0],
            [0, 0, 9, 0],
            [2, 2, 2, 2],
            [4, 4, 4, 3],
            [4, 4, 4, 4],
            [5, 4, 4, 4],
            [255, 0, 255, 0],
            [0, 255, 0, 255],
            [100, 101, 102, 103],
        ];
        let sum = |block: [u8; 4]| block.into_iter().map(i32::from).sum::<i32>();
        for (above, below) in blocks.into_iter().flat_map(|above| blocks.map(|below| (above, below))) {
            for least in [1, 8, 16, 17] {
                for edges in [[0; 4], [0xfe; 4], [1, 0, 0, 0], [0, 0, 3, 0], [0, 0, 0, 0x81]] {
                    let row = Smooth { above: &[above], below: &[below], edges: &[edges] };
                    let is_even = (sum(above) - sum(below)).abs() < least;
                    let is_smooth = is_even && edges.iter().all(|edges| edges & 1 == 0);
                    let found = row.word(0, least as u32);
                    assert_eq!(found, u32::from(is_smooth), "{above:?} {below:?} {edges:?} {least}");
                    // All of a word at once, every fifth of them without an edge.
                    let some: [_; BLOCKS] = core::array::from_fn(|i| if i % 5 == 0 { [0; 4] } else { edges });
                    let row = Smooth { above: &[above; BLOCKS], below: &[below; BLOCKS], edges: &some };
                    let smooth = |i: usize| if i.is_multiple_of(5) { is_even } else { is_smooth };
                    let all = (0..BLOCKS).fold(0, |bits, i| bits | u32::from(smooth(i)) << i);
                    assert_eq!(row.word(0, least as u32), all, "{above:?} {below:?} {edges:?} {least}");
                }
            }
        }
    }

    #[test]
    fn smooth_blocks_are_open_that_are_joined_to_an_open_one() {
        let mut chance = chance();
        for round in 0..if cfg!(miri) { 10 } else { 600 } {
            let rough = [2, 5, 20, 90, 400][round % 5];
            let smooth: [bool; COUNT] = core::array::from_fn(|_| chance(rough) > 0);
            let rare = [1, 3, 40, 100][round % 4];
            let before: [bool; COUNT] = core::array::from_fn(|_| chance(rare) == 0);
            // A pixel of each block that is not smooth has an edge, and all bits of older rows are set.
            let edges: [[u8; BLOCK]; COUNT] = core::array::from_fn(|block| {
                let mut edges = [0xfe; BLOCK];
                edges[block % BLOCK] |= u8::from(!smooth[block]);
                edges
            });
            let row = Smooth { above: &[[9; BLOCK]; COUNT], below: &[[9; BLOCK]; COUNT], edges: &edges };
            let mut open = bits(&before);
            push(&mut open, &row, 16);
            let is_joined = |block: usize, other: usize| {
                (block.min(other)..=block.max(other)).all(|between| smooth[between])
            };
            let expected = core::array::from_fn(|block| {
                (0..COUNT).any(|other| before[other] && is_joined(block, other))
            });
            assert_eq!(open, bits(&expected), "round {round}");
        }
    }

    #[test]
    fn columns_of_open_blocks_and_of_those_beside_them_come_once() {
        let mut chance = chance();
        for round in 0..400 {
            let width = 1 + chance((COUNT * BLOCK) as u32) as usize;
            let rare = [1, 2, 6, 60, 1000][round % 5];
            let open: [bool; COUNT] = core::array::from_fn(|_| chance(rare) == 0);
            let mut counts = [0; COUNT * BLOCK];
            let words = words(width);
            assert_eq!(words, width.div_ceil(BLOCK).div_ceil(32));
            for_columns(&bits(&open), width, &mut |columns| {
                counts[columns].iter_mut().for_each(|count| *count += 1);
            });
            for (x, count) in counts.into_iter().enumerate() {
                let block = x / BLOCK;
                // What is beside the last word stands in no word of the row.
                let last = words * BLOCKS - 1;
                let is_near = (block.saturating_sub(1)..=(block + 1).min(last)).any(|block| open[block]);
                assert_eq!(count, u32::from(x < width && is_near), "{width}, column {x}");
            }
        }
    }
}
