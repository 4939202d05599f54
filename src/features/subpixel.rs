//! Sub-pixel corner position: the peak of the Harris response (Harris & Stephens 1988).

use super::Patch;

/// Rows and columns of gradients, of responses, and of the responses that a surface is laid through.
const GRADIENTS: usize = 7;
const RESPONSES: usize = 5;
const NEAREST: usize = 3;
/// Responses are shortened to so many bits: products of their sums stay below 2^60.
const BITS: u32 = 22;
/// A surface may have its top so far from the strongest pixel, 1/64 px.
const FARTHEST: i64 = 48;

/// How far the corner of a patch lies from the centre of the patch's middle pixel, to the right and down, in
/// steps of 1/64 px: up to 112, a pixel and three quarters.
///
/// The response of a pixel is the determinant of the sum of `g g^T` over the 3 x 3 gradients g around it, of
/// smoothed pixels: Harris's ("A combined corner and edge detector", Alvey 1988) without its trace. Of the
/// middle pixel and the eight around it the one that responds most is taken, for the segment test finds its
/// strongest pixel up to a pixel beside the corner; then the top of the quadratic surface that fits the 3 x 3
/// responses around that one best, with weights `1 2 1` along and across. Where the surface has no top, it is
/// the pixel's centre.
///
/// The test `matches_follow_turns` prints how far matches of turned pictures lie from where they should.
pub fn refine(patch: &Patch) -> [i8; 2] {
    let responses = responses(patch);
    let response = |x: usize, y: usize| responses.get(y).and_then(|row| row.get(x)).copied().unwrap_or(0);
    let middle = RESPONSES / 2;
    let (mut x, mut y) = (middle, middle);
    for (column, row) in (0..NEAREST * NEAREST).map(|i| (middle - 1 + i % NEAREST, middle - 1 + i / NEAREST))
    {
        if response(column, row) > response(x, y) {
            (x, y) = (column, row);
        }
    }
    let square = core::array::from_fn(|j| core::array::from_fn(|i| response(x + i - 1, y + j - 1)));
    let [right, down] = top(&square);
    let steps = |whole: usize, part: i64| (64 * (whole as i64 - middle as i64) + part) as i8;
    [steps(x, right), steps(y, down)]
}

/// The responses of the 5 x 5 pixels in the middle. A gradient is at most 255, so sums are below 2^20 and
/// determinants, which are never negative, below 2^39.
fn responses(patch: &Patch) -> [[i64; RESPONSES]; RESPONSES] {
    let reach = (GRADIENTS / 2) as i32;
    // Along the rows first: each of these sums is in three sums of nine.
    let rows: [[[i32; 3]; RESPONSES]; GRADIENTS] = core::array::from_fn(|y| {
        let row = |y: i32| patch.row::<{ GRADIENTS + 2 }>(y).map(i32::from);
        let y = y as i32 - reach;
        let [above, here, below] = [row(y - 1), row(y), row(y + 1)];
        let mut products = [[0; 3]; GRADIENTS];
        let columns = here.windows(3).zip(above.iter().zip(&below).skip(1));
        for (product, (across, (above, below))) in products.iter_mut().zip(columns) {
            let &[left, _, right] = across else { continue };
            let (right, down) = (right - left, below - above);
            *product = [right * right, right * down, down * down];
        }
        let mut sums = [[0; 3]; RESPONSES];
        for (sum, three) in sums.iter_mut().zip(products.windows(3)) {
            if let [a, b, c] = three {
                *sum = sum_of([a, b, c]);
            }
        }
        sums
    });
    let mut responses = [[0; RESPONSES]; RESPONSES];
    for (responses, three) in responses.iter_mut().zip(rows.windows(3)) {
        let [above, here, below] = three else { continue };
        for (response, ((a, b), c)) in responses.iter_mut().zip(above.iter().zip(here).zip(below)) {
            let [xx, xy, yy] = sum_of([a, b, c]).map(i64::from);
            *response = xx * yy - xy * xy;
        }
    }
    responses
}

/// The sum of three sums of products.
#[inline(always)]
fn sum_of([[a, b, c], [d, e, f], [g, h, i]]: [&[i32; 3]; 3]) -> [i32; 3] {
    [a + d + g, b + e + h, c + f + i]
}

/// The top of the quadratic surface through nine values, to the right of the middle one and down, in steps of
/// 1/64.
///
/// With the weighted first differences `X`, `Y` and second differences `XX`, `YY`, `XY` it is where both
/// slopes vanish: `x = (XY Y - YY X) / 2 D` and `y = (XY X - XX Y) / 2 D` with `D = XX YY - XY^2`.
fn top(square: &[[i64; NEAREST]; NEAREST]) -> [i64; 2] {
    let most = square.as_flattened().iter().fold(0, |most, &value| value.max(most));
    let shift = (i64::BITS - most.leading_zeros()).saturating_sub(BITS);
    let [[a, b, c], [d, e, f], [g, h, i]] = square.map(|row| row.map(|value| (value >> shift) as i32));
    let columns = [a + 2 * d + g, b + 2 * e + h, c + 2 * f + i];
    let rows = [a + 2 * b + c, d + 2 * e + f, g + 2 * h + i];
    let slope = |[before, _, after]: [i32; 3]| i64::from(after - before);
    let bend = |[before, here, after]: [i32; 3]| i64::from(after - 2 * here + before);
    let (x, y, xx, yy) = (slope(columns), slope(rows), bend(columns), bend(rows));
    let xy = i64::from(i - g - c + a);
    let determinant = xx * yy - xy * xy;
    if xx >= 0 || determinant <= 0 {
        return [0, 0];
    }
    // To the nearest, halves away from nothing: as far to the left as to the right.
    let steps = |above: i64| {
        let rounded = (64 * above.abs() + determinant).checked_div(2 * determinant).unwrap_or(0);
        rounded.min(FARTHEST) * above.signum()
    };
    [steps(xy * y - yy * x), steps(xy * x - xx * y)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tops_of_surfaces() {
        // 90 - 8 (x - a)^2 - 8 (y - b)^2 at -1, 0 and 1.
        let bowl = |a: f64, b: f64| -> [[i64; 3]; 3] {
            core::array::from_fn(|j| {
                core::array::from_fn(|i| {
                    let (x, y) = (i as f64 - 1.0 - a, j as f64 - 1.0 - b);
                    (90.0 - 8.0 * (x * x + y * y)) as i64
                })
            })
        };
        assert_eq!(top(&bowl(0.0, 0.0)), [0, 0]);
        assert_eq!(top(&bowl(0.25, -0.5)), [16, -32]);
        assert_eq!(top(&bowl(1.0, -1.0)), [FARTHEST, -FARTHEST]);
        // A ridge and a hollow have no top.
        assert_eq!(top(&[[1, 5, 1]; 3]), [0, 0]);
        assert_eq!(top(&[[9, 5, 9], [5, 1, 5], [9, 5, 9]]), [0, 0]);
    }
}
