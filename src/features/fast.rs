//! FAST-9 corners (Rosten & Drummond 2006): nine in a row on a circle of sixteen, all brighter or all darker.
//!
//! FAST-9 of Rosten & Drummond, "Machine learning for high-speed corner detection", ECCV 2006. The decision
//! tree is not theirs: four comparisons refuse most pixels, and the score of the others is worked out the
//! same way for all of them.

use super::circle::CIRCLE;
#[cfg(any(stereopsis_dsp, stereopsis_vectors, stereopsis_simd))]
use crate::imaging::part;

/// Scores of one row from the three rows above it, the row and the three below: by how many grey levels the
/// weakest of nine neighbours in a row differs from the pixel, all to one side, for the best such nine; 0
/// where that is not more than `threshold`.
///
/// As many are written as the rows and `scores` have; the three columns at either end have a score of 0.
pub fn fast_scores(rows: &[&[u8]; 7], threshold: u8, scores: &mut [u8]) {
    let width = rows.iter().fold(scores.len(), |least, row| least.min(row.len()));
    let Some(scores) = scores.get_mut(..width) else { return };
    #[cfg(any(stereopsis_dsp, stereopsis_vectors))]
    if width >= super::armv7em::COLUMNS {
        if let [a, b, c, .., d, e, f] = scores {
            (*a, *b, *c, *d, *e, *f) = (0, 0, 0, 0, 0, 0);
        }
        return scores_in_fours(rows, threshold, scores);
    }
    #[cfg(stereopsis_simd)]
    if width >= SQUARES {
        if let [a, b, c, .., d, e, f] = scores {
            (*a, *b, *c, *d, *e, *f) = (0, 0, 0, 0, 0, 0);
        }
        return scores_in_lanes(rows, threshold, scores);
    }
    scores.fill(0);
    let [a, b, c, d, e, f, g] = rows.map(|row| row.get(..width).unwrap_or(&[]).windows(7));
    let squares = a.zip(b).zip(c).zip(d).zip(e).zip(f).zip(g);
    for (score, ((((((a, b), c), d), e), f), g)) in scores.iter_mut().skip(3).zip(squares) {
        *score = score_of(&[a, b, c, d, e, f, g].map(|row| row.first_chunk().unwrap_or(&[0; 7])), threshold);
    }
}

/// [`fast_scores`] of rows of one length four pixels at a time, the last four moved back to end with the row.
///
/// Where neighbours may be darker, all brightnesses are inverted: no pixel has nine of each.
#[cfg(any(stereopsis_dsp, stereopsis_vectors))]
fn scores_in_fours(rows: &[&[u8]; 7], threshold: u8, scores: &mut [u8]) {
    use super::armv7em::{COLUMNS, PIXELS, brighter_and_darker, scores_of_four};
    use crate::dsp::max;
    let (width, least) = (scores.len(), u32::from(threshold) * 0x0101_0101);
    let (mut begin, last) = (0, width.saturating_sub(COLUMNS));
    while let Some(parts) = parts(rows, begin, width) {
        let [brighter, darker] = brighter_and_darker(&parts, least);
        let mut four = 0;
        if brighter | darker != 0 {
            four = scores_of_four(&parts, least, darker);
            // Some on an edge may have nine of either kind.
            if brighter & darker != 0 {
                four = max(four, scores_again(rows, begin, width, least, [brighter, darker]));
            }
        }
        if let Some(place) = scores.get_mut(begin + 3..begin + 7).and_then(|scores| scores.first_chunk_mut())
        {
            *place = four.to_le_bytes();
        }
        if begin >= last {
            return;
        }
        begin = last.min(begin + PIXELS);
    }
}

/// The scores of four pixels for a second time: seldom needed, and so the code for it is elsewhere.
#[cfg(any(stereopsis_dsp, stereopsis_vectors))]
#[cold]
#[inline(never)]
fn scores_again(
    rows: &[&[u8]; 7],
    begin: usize,
    width: usize,
    least: u32,
    [brighter, darker]: [u32; 2],
) -> u32 {
    use super::armv7em::scores_of_four;
    use crate::dsp::select;
    let inverted = darker & !select(0, brighter, 0, u32::MAX);
    parts(rows, begin, width).map_or(0, |parts| scores_of_four(&parts, least, inverted))
}

/// The columns of some pixels' circles in rows of `width`; `None` where they are not inside.
#[cfg(any(stereopsis_dsp, stereopsis_vectors, stereopsis_simd))]
#[inline(always)]
fn parts<'a, const N: usize>(rows: &[&'a [u8]; 7], begin: usize, width: usize) -> Option<[&'a [u8; N]; 7]> {
    let end = begin + N;
    (end <= width).then(|| rows.map(|row| part(row.get(..width).unwrap_or_default(), begin)))
}

/// Pixels side by side in a vector, and the columns of their circles.
#[cfg(stereopsis_simd)]
const LANES: usize = 16;
#[cfg(stereopsis_simd)]
const SQUARES: usize = LANES + 6;

/// [`fast_scores`] of rows of one length by vectors, the last pixels moved back to end with the row.
#[cfg(stereopsis_simd)]
fn scores_in_lanes(rows: &[&[u8]; 7], threshold: u8, scores: &mut [u8]) {
    let width = scores.len();
    let (mut begin, last) = (0, width.saturating_sub(SQUARES));
    while let Some(parts) = parts(rows, begin, width) {
        let lanes = scores_of_lanes(&parts, threshold);
        if let Some(place) = scores.get_mut(begin + 3..).and_then(|scores| scores.first_chunk_mut()) {
            *place = lanes;
        }
        if begin >= last {
            return;
        }
        begin = last.min(begin + LANES);
    }
}

/// The scores of the middles of squares side by side, as [`score_of`] has them.
#[cfg(stereopsis_simd)]
#[inline(always)]
fn scores_of_lanes(parts: &[&[u8; SQUARES]; 7], threshold: u8) -> [u8; LANES] {
    use core::array::from_fn;
    let min = |a: &[u8; LANES], b: &[u8; LANES]| from_fn(|x| a[x].min(b[x]));
    let max = |a: &[u8; LANES], b: &[u8; LANES]| from_fn(|x| a[x].max(b[x]));
    let centre: &[u8; LANES] = part(parts[3], 3);
    let ring = CIRCLE.map(|(row, column)| part::<LANES>(parts[row % 7], column));
    let value = |i: usize| ring[i & 15];
    let pairs: [[_; 2]; 4] = from_fn(|i| {
        let (a, b) = (value(2 * i), value(2 * i + 8));
        [max(a, b), min(a, b)]
    });
    let [brightest, darkest]: [[u8; LANES]; 2] = [
        pairs.iter().fold([u8::MAX; LANES], |least, [brighter, _]| min(&least, brighter)),
        pairs.iter().fold([0; LANES], |most, [_, darker]| max(&most, darker)),
    ];
    let above = |a: u8, b: u8| a.saturating_sub(b);
    let most = (0..LANES)
        .fold(0, |most, x| above(brightest[x], centre[x]).max(above(centre[x], darkest[x])).max(most));
    if most <= threshold {
        return [0; LANES];
    }
    let brighter = best_nine_of_lanes(value, min, max);
    let darker = best_nine_of_lanes(value, max, min);
    from_fn(|x| {
        let score = above(brighter[x], centre[x]).max(above(centre[x], darker[x]));
        if score > threshold { score } else { 0 }
    })
}

/// [`weakest_of_best_nine`] in vectors: the best of the weakest, by what is the weaker of two and the better.
#[cfg(stereopsis_simd)]
#[inline(always)]
fn best_nine_of_lanes<'a>(
    value: impl Fn(usize) -> &'a [u8; LANES],
    weaker: impl Fn(&[u8; LANES], &[u8; LANES]) -> [u8; LANES],
    better: impl Fn(&[u8; LANES], &[u8; LANES]) -> [u8; LANES],
) -> [u8; LANES] {
    use core::array::from_fn;
    let twos: [_; 8] = from_fn(|i| weaker(value(2 * i + 1), value(2 * i + 2)));
    let fours: [_; 8] = from_fn(|i| weaker(&twos[i], &twos[(i + 1) & 7]));
    let nine = |i: usize| {
        weaker(&weaker(&fours[i & 7], &fours[(i + 2) & 7]), &better(value(2 * i), value(2 * i + 9)))
    };
    (1..8).fold(nine(0), |best, i| better(&best, &nine(i)))
}

/// The score of the middle of a square.
#[inline(always)]
fn score_of(square: &[&[u8; 7]; 7], threshold: u8) -> u8 {
    let centre = i16::from(square[3][3]);
    let difference = |i: usize| {
        let (row, column) = CIRCLE[i & 15];
        square.get(row).and_then(|row| row.get(column)).map_or(0, |&pixel| i16::from(pixel) - centre)
    };
    // Nine of sixteen in a row hold one of every two that lie opposite to each other.
    let least = i16::from(threshold);
    let [up, right, down, left] = [0, 4, 8, 12].map(difference);
    let brighter = up.max(down).min(left.max(right)) > least;
    let darker = up.min(down).max(left.min(right)) < -least;
    if !brighter && !darker {
        return 0;
    }
    let differences: [i16; 16] = core::array::from_fn(difference);
    // Nine on a side that is out already are no more than the threshold.
    let mut best = least;
    if brighter {
        best = best.max(weakest_of_best_nine(&differences));
    }
    if darker {
        best = best.max(weakest_of_best_nine(&differences.map(|d| -d)));
    }
    // A difference of bytes is at most 255.
    if best > least { best as u8 } else { 0 }
}

/// The greatest of all minima of nine in a row, around the circle. Eight that begin at an odd place are in
/// two such nines, with the one before them and with the one after them: of these two the greater counts.
/// Places are masked, so that they are inside to a compiler that does not unroll, too.
#[inline(always)]
fn weakest_of_best_nine(values: &[i16; 16]) -> i16 {
    let value = |i: usize| values[i & 15];
    let twos: [i16; 8] = core::array::from_fn(|i| value(2 * i + 1).min(value(2 * i + 2)));
    let fours: [i16; 8] = core::array::from_fn(|i| twos[i & 7].min(twos[(i + 1) & 7]));
    (0..8).fold(i16::MIN, |best, i| {
        let eight = fours[i & 7].min(fours[(i + 2) & 7]);
        best.max(eight.min(value(2 * i).max(value(2 * i + 9))))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corner_of_a_square_is_one_and_its_edge_is_none() {
        // Bright from column 5 and row 3 on: the centre (5, 3) is the square's corner. Of (6, 3) ten
        // neighbours are dark, of (7, 3) nine, of (8, 3) seven.
        let rows: [[u8; 12]; 7] =
            core::array::from_fn(|y| core::array::from_fn(|x| if x >= 5 && y >= 3 { 90 } else { 20 }));
        let mut scores = [9; 12];
        fast_scores(&rows.each_ref().map(|row| &row[..]), 10, &mut scores);
        assert_eq!(scores, [0, 0, 0, 0, 0, 70, 70, 70, 0, 0, 0, 0]);
        fast_scores(&rows.each_ref().map(|row| &row[..]), 70, &mut scores);
        assert_eq!(scores, [0; 12]);
    }

    /// The segment test by its definition: of all nine neighbours in a row, on either side.
    fn naive(rows: &[&[u8]; 7], x: usize, threshold: u8) -> u8 {
        let centre = i16::from(rows[3][x]);
        let differences = CIRCLE.map(|(row, column)| i16::from(rows[row][x + column - 3]) - centre);
        let weakest = |i: usize, sign: i16| (i..i + 9).map(|k| sign * differences[k % 16]).min();
        let all = (0..16).flat_map(|i| [weakest(i, 1), weakest(i, -1)]).flatten();
        all.max().filter(|score| *score > threshold.into()).map_or(0, |score| score as u8)
    }

    #[test]
    fn scores_are_those_of_the_definition() {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        let mut corners = 0;
        for width in (1..=40).cycle().take(1600) {
            // Noise, noise on two levels, and extremes, of which many pixels have nine neighbours of a kind.
            let kind = random() % 3;
            let mut pixel = || match kind {
                0 => random(),
                1 => (random() & 1) * 100 + random() % 8,
                _ => [0, 255, 254, 1][usize::from(random() & 3)],
            };
            let rows: [[u8; 40]; 7] = core::array::from_fn(|_| core::array::from_fn(|_| pixel()));
            let rows = rows.each_ref().map(|row| &row[..width]);
            let threshold = [0, 5, 90, 254, 255][usize::from(random() % 5)];
            let mut scores = [7; 40];
            fast_scores(&rows, threshold, &mut scores[..width]);
            for (x, &score) in scores[..width].iter().enumerate() {
                let inside = x >= 3 && x + 3 < width;
                let expected = if inside { naive(&rows, x, threshold) } else { 0 };
                assert_eq!(score, expected, "{x} of {width}, {threshold}: {rows:?}");
                corners += u32::from(expected > 0);
            }
        }
        assert!(corners > 1000, "{corners}");
    }
}
