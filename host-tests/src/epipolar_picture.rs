//! Epipolar lines over the two images, side by side: a point's line goes through its partner.

use crate::colour::viridis;
use crate::matches_picture::{side_by_side, square};
use image::{Rgb, RgbImage};
use stereopsis::geometry::two_view::{Correspondence, Fundamental, Line};

/// How many matches have their lines drawn; the others have their points only.
const LINES: usize = 24;
/// A match that does not agree with the matrix.
const WRONG: Rgb<u8> = Rgb([230, 40, 40]);

/// The picture: the images half as bright, with a small square at both ends of every match, red for one that
/// is no inlier. For up to 24 inliers, spread evenly over the columns of the left image, `l = F p'` is drawn
/// in the left image and `l' = F^T p` in the right one, in the colour of their points.
pub fn epipolar_picture(
    left: &RgbImage,
    right: &RgbImage,
    fundamental: &Fundamental<f64>,
    matches: &[(Correspondence<f64>, bool)],
) -> RgbImage {
    let (mut picture, beside) = side_by_side(left, right);
    let mut inliers: Vec<_> = matches.iter().filter(|(_, inlier)| *inlier).map(|(seen, _)| *seen).collect();
    inliers.sort_by(|a, b| a.first.x.total_cmp(&b.first.x));
    let colour =
        |seen: &Correspondence<f64>| viridis(0.2 + 0.8 * (seen.first.x / f64::from(left.width())) as f32);
    for seen in (0..LINES).filter_map(|i| inliers.get(i * inliers.len() / LINES)) {
        for (line, begin, image) in [
            (fundamental.line_in_first(&seen.second), 0, left),
            (fundamental.line_in_second(&seen.first), beside, right),
        ] {
            if let Some(line) = line {
                draw(&mut picture, &line, begin, image.dimensions(), colour(seen));
            }
        }
    }
    let wrong = matches.iter().filter(|(_, inlier)| !inlier).map(|(seen, _)| (seen, WRONG));
    for (seen, colour) in wrong.chain(inliers.iter().map(|seen| (seen, colour(seen)))) {
        square(&mut picture, [seen.first.x as f32, seen.first.y as f32], colour);
        square(&mut picture, [seen.second.x as f32 + beside as f32, seen.second.y as f32], colour);
    }
    picture
}

/// The part of a line that lies in the image of this size, which begins at the column `begin` of the picture.
fn draw(picture: &mut RgbImage, line: &Line<f64>, begin: u32, (width, height): (u32, u32), colour: Rgb<u8>) {
    let [a, b, c] = (*line.coefficients()).into();
    // Along the axis to which the line is closer, so that its pixels have no gaps.
    let along_rows = a.abs() <= b.abs();
    for step in 0..if along_rows { width } else { height } {
        let at = f64::from(step);
        let across = if along_rows { -(a * at + c) / b } else { -(b * at + c) / a }.round();
        if (0.0..f64::from(if along_rows { height } else { width })).contains(&across) {
            let across = across as u32;
            let (x, y) = if along_rows { (step, across) } else { (across, step) };
            picture.put_pixel(begin + x, y, colour);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Point2};

    #[test]
    fn lines_of_aligned_rows_are_rows() {
        // The line of a point is its row.
        let rows = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
        let fundamental = Fundamental::from_matrix(&rows).expect("rank 2");
        let (left, right) = (RgbImage::new(20, 12), RgbImage::new(16, 12));
        let of = |row: f64, inlier| {
            (Correspondence { first: Point2::new(9.0, row), second: Point2::new(6.0, row) }, inlier)
        };
        let picture = epipolar_picture(&left, &right, &fundamental, &[of(4.0, true), of(9.0, false)]);
        assert_eq!(picture.dimensions(), (40, 12));
        let columns =
            |row: u32| (0..40).filter(|&x| picture.get_pixel(x, row).0 != [0; 3]).collect::<Vec<_>>();
        // All columns but the gap.
        assert_eq!(columns(4), (0..20).chain(24..40).collect::<Vec<_>>());
        // The outline of the wrong one's squares, in red.
        assert_eq!(columns(9), [7, 11, 28, 32]);
        assert_eq!(picture.get_pixel(7, 9), &WRONG);
    }
}
