//! Whether matches show a camera that has only turned: then where it stands is anybody's guess.

use nalgebra::{Matrix3, Rotation3};
use stereopsis::geometry::{
    camera::Camera,
    two_view::{Correspondence, Essential, Fundamental, Homography, gric},
};

/// Matches of which fewer are explained by anything.
const FEWEST: usize = 8;
/// Rounds of a rotation that lets go of the matches that are off it.
const ROUNDS: usize = 8;

/// The degrees by which the second camera has turned, where a rotation explains the matches that agree with
/// `essential` better than it does, by Torr's criterion with pixels of `sigma_px`.
pub fn only_turned(
    seen: &[Correspondence<f64>],
    essential: &Essential<f64>,
    [first, second]: [&Camera<f64>; 2],
    sigma_px: f64,
) -> Option<f64> {
    if seen.len() < FEWEST {
        return None;
    }
    let f = Fundamental::from_essential(essential, first, second);
    let moved = gric(seen.iter().map(|s| f.sampson_squared_px2(s)), sigma_px, 3, 5);
    let mut kept = seen.to_vec();
    for _ in 0..ROUNDS {
        let rotation = rotation(&kept, [first, second])?;
        let matrix = first.matrix() * rotation.matrix() * second.inverse_matrix();
        let homography = Homography::from_matrix(&matrix).ok()?;
        let off = |s: &Correspondence<f64>| homography.sampson_squared_px2(s);
        if gric(seen.iter().map(off), sigma_px, 2, 3) <= moved {
            return Some(rotation.angle().to_degrees());
        }
        let mut all: Vec<_> = seen.iter().map(off).collect();
        all.sort_by(f64::total_cmp);
        let most = all.get(all.len() / 2)?.max(sigma_px * sigma_px) * 4.0;
        kept = seen.iter().filter(|s| off(s) <= most).copied().collect();
    }
    None
}

/// The rotation that carries the second camera's rays onto the first's with the least squares (Arun, Huang &
/// Blostein 1987).
fn rotation(seen: &[Correspondence<f64>], [first, second]: [&Camera<f64>; 2]) -> Option<Rotation3<f64>> {
    let mut products = Matrix3::zeros();
    for s in seen {
        let (p, q) = (first.unproject(&s.first).ok()?, second.unproject(&s.second).ok()?);
        products += p.normalize() * q.normalize().transpose();
    }
    let svd = products.svd(true, true);
    let (u, v) = (svd.u?, svd.v_t?);
    let mut sides = Matrix3::identity();
    sides[(2, 2)] = (u * v).determinant().signum();
    Some(Rotation3::from_matrix_unchecked(u * sides * v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Random;
    use crate::two_view::{Views, anywhere, mixed, nearby};
    use stereopsis::geometry::camera::Pose;
    use stereopsis::geometry::robust::{RobustConfig, robust_essential};

    /// How many of 20 draws are said to have only turned, with a baseline of `baseline` times half a metre,
    /// noise of 0.3 px and a fifth of the matches wrong.
    fn said(count: usize, baseline: f64) -> usize {
        (0..20)
            .filter(|&seed| {
                let mut random = Random::new(seed);
                let pose = nearby(&mut random);
                let pose = Pose::new(*pose.rotation(), pose.translation() * baseline).expect("a rotation");
                let views = Views::of(&mut random, count, pose, anywhere);
                let seen: Vec<_> = mixed(&views.seen, 0.3, 0.2, seed).into_iter().map(|(s, _)| s).collect();
                let cameras = [&views.camera; 2];
                let mut inliers = vec![false; seen.len()];
                let config = RobustConfig::new(1.0);
                let found = robust_essential(&seen, cameras[0], cameras[1], &config, &mut inliers);
                let essential = found.expect("an essential matrix").essential;
                let kept: Vec<_> =
                    seen.iter().zip(&inliers).filter(|&(_, &kept)| kept).map(|(s, _)| *s).collect();
                let angle = only_turned(&kept, &essential, cameras, 0.3);
                let truth = Rotation3::from_matrix_unchecked(*pose.rotation()).angle().to_degrees();
                assert!(angle.is_none_or(|angle| (angle - truth).abs() < 0.2), "{angle:?}, {truth}");
                angle.is_some()
            })
            .count()
    }

    #[test]
    fn a_camera_that_turns_is_told_from_one_that_moves() {
        // Without a baseline, and with one of a metre's eighth at seven metres, ten pixels.
        assert_eq!([20, 40, 200].map(|count| said(count, 0.0)), [20; 3]);
        assert_eq!([20, 40, 200].map(|count| said(count, 0.25)), [0; 3]);
    }
}
