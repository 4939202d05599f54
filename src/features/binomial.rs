//! Binomial 5 x 5 smoothing before descriptors are sampled.

/// A row smoothed by the weights `[1 4 6 4 1] / 16` along both axes, rounded to the nearest.
///
/// `rows` are the two above, the row, and the two below. As many are written as the rows and `out` have, but
/// for the two columns at either end, which are left as they are: no patch reaches them.
pub fn binomial5_row(rows: &[&[u8]; 5], out: &mut [u8]) {
    let width = rows.iter().fold(out.len(), |least, row| least.min(row.len()));
    #[cfg(any(stereopsis_dsp, stereopsis_vectors))]
    if width >= 8 {
        return in_fours(rows, width, out);
    }
    let [a, b, c, d, e] = rows.map(|row| row.get(..width).unwrap_or(&[]).iter());
    let mut columns =
        a.zip(b).zip(c).zip(d).zip(e).map(|((((a, b), c), d), e)| sum([a, b, c, d, e].map(|&p| p.into())));
    let mut last: [u16; 5] = [0; 5];
    for place in last.iter_mut().skip(1) {
        *place = columns.next().unwrap_or(0);
    }
    for (out, column) in out.iter_mut().skip(2).zip(columns) {
        let [_, b, c, d, e] = last;
        last = [b, c, d, e, column];
        *out = ((sum(last) + 128) >> 8) as u8;
    }
}

/// [`binomial5_row`] of the first `width` pixels four at a time, the last four moved back to end with the
/// row.
#[cfg(any(stereopsis_dsp, stereopsis_vectors))]
fn in_fours(rows: &[&[u8]; 5], width: usize, out: &mut [u8]) {
    use super::armv7em::{PIXELS, column_sums, smooth_four};
    use crate::imaging::part;
    // All of one length, which is asked for once.
    let rows = rows.map(|row| row.get(..width));
    let ([Some(a), Some(b), Some(c), Some(d), Some(e)], Some(out)) = (rows, out.get_mut(..width)) else {
        return;
    };
    let sums = |begin: usize| column_sums([a, b, c, d, e].map(|row| part(row, begin)));
    let mut write = |begin: usize, sums: [[u32; 2]; 2]| {
        if let Some(four) = out.get_mut(begin + 2..begin + 6).and_then(|out| out.first_chunk_mut()) {
            *four = smooth_four(sums);
        }
    };
    let (mut begin, mut left) = (0, sums(0));
    while begin + 2 * PIXELS <= width {
        let right = sums(begin + PIXELS);
        write(begin, [left, right]);
        (begin, left) = (begin + PIXELS, right);
    }
    let begin = width.saturating_sub(2 * PIXELS);
    write(begin, [sums(begin), sums(begin + PIXELS)]);
}

/// The weighted sum: 16 times the mean, so at most 4080 of bytes and 65280 of sums of bytes.
#[inline(always)]
fn sum([a, b, c, d, e]: [u16; 5]) -> u16 {
    a + e + 4 * (b + d) + 6 * c
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_stays_white_and_a_point_spreads() {
        let mut out = [7; 7];
        binomial5_row(&[&[255; 7]; 5], &mut out);
        assert_eq!(out, [7, 7, 255, 255, 255, 7, 7]);
        binomial5_row(&[&[0; 7], &[0; 7], &[0, 0, 0, 160, 0, 0, 0], &[0; 7], &[0; 7]], &mut out);
        // 160 x 6 x 4 / 256 and 160 x 6 x 6 / 256.
        assert_eq!(out, [7, 7, 15, 23, 15, 7, 7]);
    }

    #[test]
    fn pixels_are_the_weighted_sums_around_them() {
        const WEIGHTS: [u32; 5] = [1, 4, 6, 4, 1];
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        for width in (1..=40).cycle().take(400) {
            let rows: [[u8; 40]; 5] = core::array::from_fn(|_| core::array::from_fn(|_| random()));
            let mut out = [7; 40];
            binomial5_row(&rows.each_ref().map(|row| &row[..width]), &mut out[..width]);
            for (x, &pixel) in out[..width].iter().enumerate() {
                let sum =
                    |row: &[u8; 40]| (0..5).map(|i| WEIGHTS[i] * u32::from(row[x + i - 2])).sum::<u32>();
                let inside = x >= 2 && x + 2 < width;
                let all = || rows.iter().zip(WEIGHTS).map(|(row, weight)| weight * sum(row)).sum::<u32>();
                assert_eq!(
                    u32::from(pixel),
                    if inside { (all() + 128) / 256 } else { 7 },
                    "{x} of {width}: {rows:?}"
                );
            }
        }
    }
}
