//! FAST-9 corners (Rosten & Drummond 2006): nine in a row on a circle of sixteen, all brighter or all darker.
//!
//! FAST-9 of Rosten & Drummond, "Machine learning for high-speed corner detection", ECCV 2006. The decision
//! tree is not theirs: four comparisons refuse most pixels, and the score of the others is worked out the
//! same way for all of them.

use super::circle::CIRCLE;

/// Scores of one row from the three rows above it, the row and the three below: by how many grey levels the
/// weakest of nine neighbours in a row differs from the pixel, all to one side, for the best such nine; 0
/// where that is not more than `threshold`.
///
/// As many are written as the rows and `scores` have; the three columns at either end have a score of 0.
pub fn fast_scores(rows: &[&[u8]; 7], threshold: u8, scores: &mut [u8]) {
    let width = rows.iter().fold(scores.len(), |least, row| least.min(row.len()));
    let Some(scores) = scores.get_mut(..width) else { return };
    scores.fill(0);
    #[cfg(stereopsis_dsp)]
    if width >= super::armv7em::COLUMNS {
        return scores_in_fours(rows, threshold, scores);
    }
    let [a, b, c, d, e, f, g] = rows.map(|row| row.get(..width).unwrap_or(&[]).windows(7));
    let squares = a.zip(b).zip(c).zip(d).zip(e).zip(f).zip(g);
    for (score, ((((((a, b), c), d), e), f), g)) in scores.iter_mut().skip(3).zip(squares) {
        *score = score_of(&[a, b, c, d, e, f, g].map(|row| row.first_chunk().unwrap_or(&[0; 7])), threshold);
    }
}

/// [`fast_scores`] of rows of one length four pixels at a time, the last four moved back to end with the row.
#[cfg(stereopsis_dsp)]
fn scores_in_fours(rows: &[&[u8]; 7], threshold: u8, scores: &mut [u8]) {
    use super::armv7em::{COLUMNS, PIXELS, scores_of_four};
    let last = scores.len().saturating_sub(COLUMNS);
    let mut begin = 0;
    loop {
        let parts = rows.map(|row| row.get(begin..).and_then(|row| row.first_chunk()));
        let [Some(a), Some(b), Some(c), Some(d), Some(e), Some(f), Some(g)] = parts else { return };
        if let Some(four) = scores.get_mut(begin + 3..).and_then(|scores| scores.first_chunk_mut()) {
            *four = scores_of_four(&[a, b, c, d, e, f, g], threshold);
        }
        if begin >= last {
            return;
        }
        begin = last.min(begin + PIXELS);
    }
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
}
