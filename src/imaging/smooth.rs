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
// In flash once.
#[cfg_attr(target_pointer_width = "32", inline(never))]
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
            *to = group(around);
        }
    }
    // The columns at the ends one by one, and all of a line that is shorter than a group.
    let grouped = if inner < LANES { 1 } else { 1 + inner };
    for x in (0..count.min(1)).chain(grouped.min(count)..count) {
        let three = |row: &[u8]| [x.saturating_sub(1), x, (x + 1).min(last)].map(|x| row.get(x).copied().unwrap_or(0));
        if let Some(to) = out.get_mut(x) {
            *to = middle(near.map(three));
        }
    }
}

/// Columns worked on at a time: in so many words of four.
const WORDS: usize = if cfg!(any(target_pointer_width = "64", stereopsis_vectors)) { 4 } else { 1 };
const LANES: usize = 4 * WORDS;
/// Columns that so many smoothed ones look at.
const AROUND: usize = LANES + 2;

/// A group of columns smoothed, of four bytes in a word at a time.
#[inline(always)]
fn group(around: [&[u8; AROUND]; 3]) -> [u8; LANES] {
    let mut out = [0; LANES];
    for (word, out) in out.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let [before, here, after] = core::array::from_fn(|column| {
            let four = |row: &[u8; AROUND]| row.get(4 * word + column..).and_then(|row| row.first_chunk()).copied();
            let [above, here, below] = around.map(|row| u32::from_le_bytes(four(row).unwrap_or([0; 4])));
            quarters(above, here, below)
        });
        *out = quarters(before, here, after).to_le_bytes();
    }
    out
}

/// `(a + 2 b + c + 2) / 4` of four bytes: the average of b, rounded up, and that of a and c, rounded down. Averages of bytes need
/// no room beside them (Warren 2012, 2-5).
#[inline(always)]
fn quarters(a: u32, b: u32, c: u32) -> u32 {
    let half_of_difference = |a: u32, b: u32| (a ^ b) >> 1 & 0x7f7f_7f7f;
    let down = (a & c) + half_of_difference(a, c);
    (b | down) - half_of_difference(b, down)
}

/// One column of three smoothed.
#[inline(always)]
fn middle(around: [[u8; 3]; 3]) -> u8 {
    let quarter = |a: u16, b: u16, c: u16| (a + 2 * b + c + 2) >> 2;
    let [before, here, after] = core::array::from_fn(|i| {
        let [above, here, below] = around.map(|row| u16::from(row[i]));
        quarter(above, here, below)
    });
    quarter(before, here, after) as u8
}
