//! The slope of the surface around a point of a view, from the depths of its neighbours.

use nalgebra::{Matrix2, Point2, Vector2};

/// Neighbours that say the slope.
const NEIGHBOURS: usize = 12;
/// The fewest of them that have to agree.
const FEWEST: usize = 5;
/// How far a neighbour's inverse depth may lie off the plane of the others, as a share.
const OFF: f64 = 0.02;
/// The steepest slope that is believed: the share by which the inverse depth changes a pixel.
const STEEPEST: f64 = 0.02;

/// Where a view shows points, and how deep they are.
pub(super) struct Surface(Vec<(Point2<f64>, f64)>);

impl Surface {
    pub(super) fn new(depths: Vec<(Point2<f64>, f64)>) -> Self {
        Self(depths)
    }

    /// By which share the inverse depth changes a pixel to the right and a pixel down, for a plane (whose
    /// inverse depth is linear in the picture) through a point of that depth and nearest to its neighbours;
    /// those off it are left out one after the other. `None` where too few are on one.
    pub(super) fn slope(&self, pixel: &Point2<f64>, depth: f64) -> Option<[f64; 2]> {
        let squared = |other: &(Point2<f64>, f64)| (other.0 - pixel).norm_squared();
        let mut nearest: Vec<&(Point2<f64>, f64)> = self.0.iter().filter(|o| squared(o) > 0.25).collect();
        if nearest.len() > NEIGHBOURS {
            nearest.select_nth_unstable_by(NEIGHBOURS, |a, b| squared(a).total_cmp(&squared(b)));
            nearest.truncate(NEIGHBOURS);
        }
        let mut kept: Vec<(Vector2<f64>, f64)> =
            nearest.into_iter().map(|o| (o.0 - pixel, depth / o.1 - 1.0)).collect();
        while kept.len() >= FEWEST {
            let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
            for (offset, share) in &kept {
                normal += offset * offset.transpose();
                right += offset * *share;
            }
            let slope = normal.try_inverse()? * right;
            let off = kept.iter().map(|(offset, share)| (offset.dot(&slope) - share).abs());
            let (worst, most) = off.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
            if most <= OFF {
                return (slope.norm() < STEEPEST).then_some([slope.x, slope.y]);
            }
            kept.swap_remove(worst);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_of_a_plane_is_found() {
        // Inverse depth 0.2 + 0.001 x - 0.0005 y, and one neighbour that is before it.
        let inverse = |x: f64, y: f64| 0.2 + 0.001 * x - 0.0005 * y;
        let mut depths: Vec<_> = (0..20)
            .map(|i| (f64::from(i % 5) * 4.0 - 8.0, f64::from(i / 5) * 4.0 - 7.0))
            .map(|(x, y)| (Point2::new(x, y), 1.0 / inverse(x, y)))
            .collect();
        depths[7].1 *= 0.5;
        let slope = Surface::new(depths.clone()).slope(&Point2::origin(), 5.0).expect("neighbours");
        assert!((slope[0] - 0.005).abs() < 1e-9 && (slope[1] + 0.0025).abs() < 1e-9, "{slope:?}");
        depths.truncate(3);
        assert!(Surface::new(depths).slope(&Point2::origin(), 5.0).is_none());
    }
}
