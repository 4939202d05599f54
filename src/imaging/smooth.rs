//! Lines smoothed against the noise of a sensor.

/// One of five rows, smoothed down the columns, then along the line, each time with its two neighbours, which count half as
/// much: `(a + 2 b + c + 2) / 4`. It keeps 3/8 of the deviation of noise that has nothing to do with its neighbours'.
///
/// Above the first row and below the last stands the nearest of the five, and columns outside a line are the nearest inside.
/// Those numbers are written for which the rows have a pixel and `out` a place; without such a row, none.
///
/// ```
/// use stereopsis::imaging::smooth;
/// let (dark, bright) = ([0; 5], [0, 0, 160, 0, 0]);
/// let mut line = [0; 5];
/// smooth(&[&dark, &dark, &bright, &dark, &dark], 2, &mut line);
/// assert_eq!(line, [0, 20, 40, 20, 0]);
/// smooth(&[&dark, &dark, &bright, &dark, &dark], 1, &mut line);
/// assert_eq!(line, [0, 10, 20, 10, 0]);
/// ```
pub fn smooth(rows: &[&[u8]; 5], row: usize, out: &mut [u8]) {
    let near = [row.saturating_sub(1), row, (row + 1).min(4)].map(|row| rows.get(row).copied().unwrap_or(&[]));
    let width = near.iter().fold(usize::MAX, |w, row| w.min(row.len()));
    let count = out.len().min(width);
    let Some(out) = out.get_mut(..count) else { return };
    let last = width.saturating_sub(1);
    let inner = count.min(last).saturating_sub(1);
    // The inner columns in groups; the last group is moved back to end with the line.
    let begins = (0..inner / LANES).map(|group| group * LANES).chain(inner.checked_sub(LANES));
    for begin in begins {
        let around = near.map(|row| row.get(begin..).and_then(|row| row.first_chunk()).unwrap_or(&[0; AROUND]));
        if let Some(to) = out.get_mut(begin + 1..).and_then(|out| out.first_chunk_mut::<LANES>()) {
            *to = group::<LANES, AROUND>(around);
        }
    }
    // The columns at the ends one by one, and all of a line that is shorter than a group.
    let grouped = if inner < LANES { 1 } else { 1 + inner };
    for x in (0..count.min(1)).chain(grouped.min(count)..count) {
        let three = |row: &[u8]| [x.saturating_sub(1), x, (x + 1).min(last)].map(|x| row.get(x).copied().unwrap_or(0));
        if let Some(to) = out.get_mut(x) {
            [*to] = group::<1, 3>(near.map(three).each_ref());
        }
    }
}

/// Columns worked on at a time: as lanes, or as many as a loop is unrolled for.
const LANES: usize = if cfg!(any(target_pointer_width = "64", stereopsis_vectors)) { 16 } else { 4 };
/// Columns that so many smoothed ones look at.
const AROUND: usize = LANES + 2;

/// `N` columns smoothed, of which `M` = `N + 2` are given.
#[inline(always)]
fn group<const N: usize, const M: usize>(around: [&[u8; M]; 3]) -> [u8; N] {
    const { assert!(M == N + 2) };
    let quarter = |a: u16, b: u16, c: u16| (a + 2 * b + c + 2) >> 2;
    let mut down = [0; M];
    for i in 0..M {
        let [above, here, below] = around.map(|row| u16::from(row[i]));
        down[i] = quarter(above, here, below);
    }
    let mut out = [0; N];
    for i in 0..N {
        out[i] = quarter(down[i], down[i + 1], down[i + 2]) as u8;
    }
    out
}
