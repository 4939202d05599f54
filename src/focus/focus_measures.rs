//! Focus measures: modified Laplacian (Nayar & Nakagawa 1994), Tenengrad (Krotkov 1987), Laplacian.
//!
//! Each looks at the rows above and below its own; the caller repeats the nearest row where there is none. A
//! column outside the image is the nearest one inside. Those columns are written for which all rows have a
//! pixel and `out` a place.

/// Largest number of [`binomial`].
const BINOMIAL: u32 = 16 * 255;
/// Largest number of [`modified_laplacian`] on rows of [`binomial`].
pub(super) const LAPLACIAN: u32 = 4 * BINOMIAL;
const _: () = assert!(LAPLACIAN < 1 << 14);

/// Each pixel and its eight neighbours, weighted 1, 2, 1 along and across, their sum: 16 times the
/// brightness, at most 4080. It keeps 3/8 of the deviation of noise that has nothing to do with its
/// neighbours', and rounds nothing.
pub fn binomial([above, here, below]: [&[u8]; 3], out: &mut [u16]) {
    // In whole words, as below: cores without vectors cut nothing off then.
    let down = |((&a, &b), &c): ((&u8, &u8), &u8)| u32::from(a) + 2 * u32::from(b) + u32::from(c);
    let Some(first) = above.iter().zip(here).zip(below).map(down).next() else { return };
    let (mut left, mut middle) = (first, first);
    let rights = after_first(above).iter().zip(after_first(here)).zip(after_first(below)).map(down);
    for (right, place) in rights.zip(out.iter_mut()) {
        *place = (left + 2 * middle + right) as u16;
        (left, middle) = (middle, right);
    }
    let width = above.len().min(here.len()).min(below.len());
    if let Some(place) = width.checked_sub(1).and_then(|last| out.get_mut(last)) {
        *place = (left + 3 * middle) as u16;
    }
}

/// What is to the right of the first column.
fn after_first<T>(row: &[T]) -> &[T] {
    row.get(1..).unwrap_or(&[])
}

/// The modified Laplacian `|2 b - l - r| + |2 b - a - c|` of rows of bytes or of [`binomial`] (Nayar &
/// Nakagawa 1994): the second differences along and across, which cannot cancel each other. At most 16320.
pub fn modified_laplacian<T: Copy + Into<u16>>([above, here, below]: [&[T]; 3], out: &mut [u16]) {
    let width = above.len().min(here.len()).min(below.len());
    let wide = |pixel: T| i32::from(pixel.into());
    let value = |l: i32, b: i32, r: i32, a: T, c: T| {
        ((2 * b - l - r).unsigned_abs() + (2 * b - wide(a) - wide(c)).unsigned_abs()) as u16
    };
    let Some(first) = here.first().copied().map(wide) else { return };
    let (mut left, mut middle) = (first, first);
    let rights = here.get(1..width).unwrap_or(&[]);
    for (((&right, &a), &c), place) in rights.iter().zip(above).zip(below).zip(out.iter_mut()) {
        let right = wide(right);
        *place = value(left, middle, right, a, c);
        (left, middle) = (middle, right);
    }
    let last = width
        .checked_sub(1)
        .and_then(|last| Some((*above.get(last)?, *below.get(last)?, out.get_mut(last)?)));
    if let Some((a, c, place)) = last {
        *place = value(left, middle, middle, a, c);
    }
}

/// The squared gradient of Sobel's operator, `Gx^2 + Gy^2` (Krotkov 1987, after Tenenbaum). At most 2 080
/// 800.
pub fn tenengrad([above, here, below]: [&[u8]; 3], out: &mut [u32]) {
    let column = |((&a, &b), &c): ((&u8, &u8), &u8)| {
        let [a, b, c] = [a, b, c].map(i32::from);
        (a + 2 * b + c, c - a)
    };
    let value = |l: (i32, i32), m: (i32, i32), r: (i32, i32)| {
        let (gx, gy) = (r.0 - l.0, l.1 + 2 * m.1 + r.1);
        (gx * gx + gy * gy) as u32
    };
    let mut columns = above.iter().zip(here).zip(below).map(column);
    let Some(first) = columns.next() else { return };
    let (mut left, mut middle) = (first, first);
    let mut places = out.iter_mut();
    for (right, place) in columns.zip(&mut places) {
        *place = value(left, middle, right);
        (left, middle) = (middle, right);
    }
    if let Some(place) = places.next() {
        *place = value(left, middle, middle);
    }
}

/// The Laplacian `l + r + a + c - 4 b`, -1020 to 1020.
pub fn laplacian([above, here, below]: [&[u8]; 3], out: &mut [i16]) {
    let width = above.len().min(here.len()).min(below.len());
    let mut nexts = here.iter().take(width).map(|&b| i16::from(b));
    let Some(first) = nexts.next() else { return };
    let (mut left, mut middle) = (first, first);
    let value = |l: i16, b: i16, r: i16, a: u8, c: u8| l + r + i16::from(a) + i16::from(c) - 4 * b;
    let mut places = out.iter_mut().zip(above.iter().zip(below));
    for (right, (place, (&a, &c))) in nexts.zip(&mut places) {
        *place = value(left, middle, right, a, c);
        (left, middle) = (middle, right);
    }
    if let Some((place, (&a, &c))) = places.next() {
        *place = value(left, middle, middle, a, c);
    }
}
