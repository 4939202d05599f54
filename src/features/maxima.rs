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
    #[cfg(any(stereopsis_dsp, stereopsis_vectors))]
    return super::armv7em::maxima_of_four(rows);
    #[cfg(not(any(stereopsis_dsp, stereopsis_vectors)))]
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

    #[test]
    fn maxima_are_those_of_the_definition() {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        let mut found = 0;
        for _ in 0..20_000 {
            // Few levels have many equal neighbours.
            let shift = [0, 5, 7][usize::from(random() % 3)];
            let rows: [[u8; WITH_NEIGHBOURS]; 3] =
                core::array::from_fn(|_| core::array::from_fn(|_| random() >> shift));
            let marks = maxima_of_four(rows.each_ref()).to_le_bytes();
            for (x, mark) in (1..).zip(marks) {
                let [above, here, below] = rows.map(|row| [row[x - 1], row[x], row[x + 1]]);
                let before = above.into_iter().chain([here[0]]).all(|score| score < here[1]);
                let after = below.into_iter().chain([here[2]]).all(|score| score <= here[1]);
                assert_eq!(mark != 0, before && after, "{x}: {rows:?}");
                found += u32::from(mark != 0);
            }
        }
        assert!(found > 5000, "{found}");
    }
}
