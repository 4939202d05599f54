//! Matched corners to a twentieth of a pixel: the right picture's place by alignment with the left one's
//! pixels (inverse compositional Lucas-Kanade; Baker & Matthews 2004).

use crate::correspond::Correspondences;
use image::GrayImage;
use stereopsis::features::{Feature, Template, TemplateMatch};
use stereopsis::imaging::Picture;

/// Matches around one that say how the surface is seen from the other place.
const NEIGHBOURS: usize = 12;
/// The fewest of them.
const FEWEST: usize = 6;
/// How far a neighbour may lie off the others' affine map, px.
const OFF_PX: f32 = 3.0;
/// How far an alignment may move a place, px.
const FARTHEST_PX: f32 = 1.5;
/// How alike the pixels have to be for an alignment to count.
const LEAST_CORRELATION: f32 = 0.8;

/// A linear map of offsets in the left picture to offsets in the right one.
type Warp = [[f32; 2]; 2];

/// Moves the right place of every match to where the pixels around the left one fit best, brightness and
/// contrast apart, and leaves it where they do not fit; how many were moved.
///
/// The pixels are warped by the affine map of the matches around, or by none beyond the change of scale:
/// whichever fits better.
pub fn refine(left: &GrayImage, right: &GrayImage, found: &mut Correspondences) -> usize {
    let (Some(one), Some(other)) = (picture(left), picture(right)) else { return 0 };
    let places: Vec<[f32; 4]> = found.points().collect();
    let mut moved = 0;
    for (at, place) in places.iter().enumerate() {
        let found_match = found.matches[at];
        let levels =
            (&found.left[usize::from(found_match.left)], &found.right[usize::from(found_match.right)]);
        let warps = [around(&places, at), Some(scaled(levels.0, levels.1))];
        let aligned = warps.iter().flatten().filter_map(|warp| aligned(&one, &other, place, warp));
        let best = aligned.max_by(|a, b| a.correlation.total_cmp(&b.correlation));
        if let Some(best) = best.filter(|best| best.correlation >= LEAST_CORRELATION) {
            let feature = &mut found.right[usize::from(found_match.right)];
            (feature.x_px, feature.y_px) = (best.x_px, best.y_px);
            moved += 1;
        }
    }
    moved
}

/// An image as the core sees it.
pub fn picture(image: &GrayImage) -> Option<Picture<'_>> {
    let side = |length: u32| u16::try_from(length).ok();
    Picture::new(image.as_raw(), side(image.width())?, side(image.height())?).ok()
}

fn aligned(
    left: &Picture<'_>,
    right: &Picture<'_>,
    &[x1, y1, x2, y2]: &[f32; 4],
    warp: &Warp,
) -> Option<TemplateMatch> {
    Template::cut(left, x1, y1).ok()?.align(right, warp, [x2, y2], FARTHEST_PX).ok()
}

/// The change of scale that the levels of two features say, three quarters a level.
fn scaled(left: &Feature, right: &Feature) -> Warp {
    let scale = (4.0_f32 / 3.0).powi(i32::from(right.level) - i32::from(left.level));
    [[scale, 0.0], [0.0, scale]]
}

/// The affine map of the matches around one, by least squares of those that agree with it; `None` where they
/// are few or say no map that a surface can have.
fn around(places: &[[f32; 4]], at: usize) -> Option<Warp> {
    let [x1, y1, x2, y2] = places[at];
    let mut nearest: Vec<(f32, [f32; 4])> = Vec::with_capacity(NEIGHBOURS + 1);
    for (other, place) in places.iter().enumerate() {
        let offset = [place[0] - x1, place[1] - y1, place[2] - x2, place[3] - y2];
        let squared = offset[0] * offset[0] + offset[1] * offset[1];
        if other == at || nearest.len() == NEIGHBOURS && nearest.last().is_some_and(|last| squared >= last.0)
        {
            continue;
        }
        let before = nearest.partition_point(|near| near.0 <= squared);
        nearest.insert(before, (squared, offset));
        nearest.truncate(NEIGHBOURS);
    }
    let mut kept: Vec<[f32; 4]> = nearest.into_iter().map(|(_, offset)| offset).collect();
    loop {
        let warp = least_squares(&kept)?;
        let off = |[a, b, c, d]: &[f32; 4]| {
            (warp[0][0] * a + warp[0][1] * b - c).hypot(warp[1][0] * a + warp[1][1] * b - d)
        };
        let (worst, most) =
            kept.iter().map(off).enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0));
        if most <= OFF_PX {
            let determinant = warp[0][0] * warp[1][1] - warp[0][1] * warp[1][0];
            return (0.2..5.0).contains(&determinant).then_some(warp);
        }
        kept.swap_remove(worst);
    }
}

/// The linear map of left offsets to right ones; `None` for fewer than [`FEWEST`], or on a line.
fn least_squares(offsets: &[[f32; 4]]) -> Option<Warp> {
    let sum = |f: &dyn Fn(&[f32; 4]) -> f32| offsets.iter().map(f).sum::<f32>();
    let (xx, xy, yy) = (sum(&|o| o[0] * o[0]), sum(&|o| o[0] * o[1]), sum(&|o| o[1] * o[1]));
    let determinant = xx * yy - xy * xy;
    if offsets.len() < FEWEST || determinant <= 1e-2 * (xx + yy) * (xx + yy) {
        return None;
    }
    let row = |to: usize| {
        let (a, b) = (sum(&|o| o[0] * o[to]), sum(&|o| o[1] * o[to]));
        [(yy * a - xy * b) / determinant, (xx * b - xy * a) / determinant]
    };
    Some([row(2), row(3)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_of_neighbours_is_theirs() {
        let warp = [[1.1, 0.2], [-0.1, 0.9]];
        let mut places: Vec<[f32; 4]> = (0..20)
            .map(|i| {
                let (x, y) = ((i % 5) as f32 * 7.0, (i / 5) as f32 * 9.0);
                [x, y, 40.0 + warp[0][0] * x + warp[0][1] * y, 9.0 + warp[1][0] * x + warp[1][1] * y]
            })
            .collect();
        // A wrong one among them does no harm.
        places[8][2] += 30.0;
        let found = around(&places, 7).expect("neighbours");
        for (row, truth) in found.iter().zip(&warp) {
            assert!(row.iter().zip(truth).all(|(a, b)| (a - b).abs() < 1e-4), "{found:?}");
        }
        assert!(around(&places[..5], 0).is_none());
        let line: Vec<_> = (0..20).map(|i| [i as f32, 0.0, i as f32, 0.0]).collect();
        assert!(around(&line, 3).is_none());
    }
}
