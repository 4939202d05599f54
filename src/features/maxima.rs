//! Local maxima of a row of scores, four columns at a time.

/// Columns at a time.
pub(super) const COLUMNS: usize = 4;
/// Columns that they and their neighbours lie in.
pub(super) const WITH_NEIGHBOURS: usize = COLUMNS + 2;

/// Which of four scores are more than their neighbours that come before them, and no less than those that
/// come after: the bytes that are not 0, the first column's lowest. The rows are those above, of and below
/// the scores, from one column before them to one after.
#[inline(always)]
pub(super) fn maxima_of_four(rows: [&[u8; WITH_NEIGHBOURS]; 3]) -> u32 {
    #[cfg(stereopsis_dsp)]
    return super::armv7em::maxima_of_four(rows);
    #[cfg(not(stereopsis_dsp))]
    {
        let [above, here, below] = rows;
        if here[1..=COLUMNS] == [0; COLUMNS] {
            return 0;
        }
        let triples = above.windows(3).zip(here.windows(3)).zip(below.windows(3));
        let mut marks = [0; COLUMNS];
        for (mark, ((above, here), below)) in marks.iter_mut().zip(triples) {
            let (&[a, b, c], &[d, score, e], &[f, g, h]) = (above, here, below) else { continue };
            *mark = u8::from(score > a.max(b).max(c).max(d) && score >= e.max(f).max(g).max(h));
        }
        u32::from_le_bytes(marks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_equal_neighbours_the_first() {
        let rows = [[0, 0, 0, 0, 0, 0], [0, 7, 7, 0, 9, 9], [7, 0, 0, 0, 0, 0]];
        assert_eq!(
            maxima_of_four(rows.each_ref()).to_le_bytes().map(|mark| mark != 0),
            [true, false, false, true]
        );
        let rows = [[0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 9], [0, 0, 0, 0, 0, 0]];
        assert_eq!(maxima_of_four(rows.each_ref()), 0);
    }
}
