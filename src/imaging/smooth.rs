//! Binomial 3x3 smoothing against sensor noise.

use core::ops::Range;

/// Smooths row `row` of five with the binomial filter `(a + 2 b + c + 2) / 4`, first vertically, then
/// horizontally, which leaves 3/8 of the standard deviation of independent noise.
///
/// Rows outside the five and columns outside the line repeat the nearest ones inside. Pixels are written for
/// every column that the rows and `out` have.
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
#[cfg_attr(not(stereopsis_simd), inline(never))]
pub fn smooth(rows: &[&[u8]; 5], row: usize, out: &mut [u8]) {
    let near =
        [row.saturating_sub(1), row, (row + 1).min(4)].map(|row| rows.get(row).copied().unwrap_or(&[]));
    let width = near.iter().fold(usize::MAX, |w, row| w.min(row.len()));
    let near = near.map(|row| row.get(..width).unwrap_or(row));
    let count = out.len().min(width);
    let Some(out) = out.get_mut(..count) else { return };
    let done = if WORDS { by_words(near, out) } else { by_columns(near, out) };
    // The columns at the ends.
    let last = width.saturating_sub(1);
    for x in (0..done.start).chain(done.end..count) {
        let [before, here, after] = [x.saturating_sub(1), x, (x + 1).min(last)].map(|x| down(&near, x));
        if let Some(to) = out.get_mut(x) {
            *to = quarters(before, here, after) as u8;
        }
    }
}

/// Smooths down one column.
// In flash once.
#[cfg_attr(not(stereopsis_simd), inline(never))]
fn down(near: &[&[u8]; 3], x: usize) -> u32 {
    let [above, middle, below] = near.map(|row| u32::from(row.get(x).copied().unwrap_or(0)));
    quarters(above, middle, below)
}

/// Whether four columns at a time are packed in a word; else the compiler vectorises.
const WORDS: bool = cfg!(not(any(stereopsis_simd, stereopsis_vectors)));

/// Smooths the columns with neighbours on both sides, and returns their range.
fn by_columns(near: [&[u8]; 3], out: &mut [u8]) -> Range<usize> {
    // The columns before, at and after each place.
    let [above, middle, below] = near.map(|row| row.windows(3));
    let inner = out.get_mut(1..).unwrap_or(&mut []).iter_mut();
    let mut end = 1;
    for (out, ((above, middle), below)) in inner.zip(above.zip(middle).zip(below)) {
        let [before, here, after] = [0, 1, 2].map(|x| quarter(above[x], middle[x], below[x]));
        *out = quarter(before, here, after);
        end += 1;
    }
    1..end
}

/// Smooths the columns in whole words that are followed by another, and returns their range.
fn by_words(near: [&[u8]; 3], out: &mut [u8]) -> Range<usize> {
    let [above, middle, below] =
        near.map(|row| row.as_chunks::<4>().0.iter().map(|four| u32::from_le_bytes(*four)));
    let mut down =
        above.zip(middle).zip(below).map(|((above, middle), below)| quarters(above, middle, below));
    let mut here = down.next().unwrap_or(0);
    // It ends with the column before the line.
    let mut before = here << 24;
    let mut end = 0;
    for (out, after) in out.as_chunks_mut::<4>().0.iter_mut().zip(down) {
        *out = quarters(here << 8 | before >> 24, here, here >> 8 | after << 24).to_le_bytes();
        (before, here) = (here, after);
        end += 4;
        // No instruction: so it is not unrolled, which would take flash and saves nothing.
        core::hint::black_box(());
    }
    0..end
}

/// `(a + 2 b + c + 2) / 4`: the average of b, rounded up, and that of a and c, rounded down.
#[inline(always)]
fn quarter(a: u8, b: u8, c: u8) -> u8 {
    let down = (a & c) + ((a ^ c) >> 1);
    (b | down) - ((b ^ down) >> 1)
}

/// [`quarter`] of four packed bytes, by byte averages without carry (Warren 2012, 2-5).
#[inline(always)]
fn quarters(a: u32, b: u32, c: u32) -> u32 {
    let half_of_difference = |a: u32, b: u32| (a ^ b) >> 1 & 0x7f7f_7f7f;
    let down = (a & c) + half_of_difference(a, c);
    (b | down) - half_of_difference(b, down)
}

#[cfg(test)]
mod tests {
    use super::{by_columns, by_words};

    #[test]
    fn words_and_columns_say_the_same() {
        let line = |seed: usize| core::array::from_fn::<u8, 41, _>(|x| (x * x * seed + 255 * (x % 3)) as u8);
        let rows = [line(7), line(91), line(46)];
        for (width, places) in
            [(41, 41), (40, 40), (39, 39), (8, 8), (7, 7), (3, 3), (41, 30), (41, 1), (2, 2), (0, 0)]
        {
            let near = rows.each_ref().map(|row| &row[..width]);
            let [mut words, mut columns] = [[0; 41]; 2];
            let inner = by_columns(near, &mut columns[..places]);
            let whole = by_words(near, &mut words[..places]);
            assert_eq!(inner, 1..places.min(width.saturating_sub(1)).max(1), "{width} columns");
            assert_eq!(whole, 0..(4 * (width / 4).saturating_sub(1)).min(places / 4 * 4), "{width} columns");
            let both = 1..inner.end.min(whole.end).max(1);
            assert_eq!(words[both.clone()], columns[both], "{width} columns");
        }
    }
}
