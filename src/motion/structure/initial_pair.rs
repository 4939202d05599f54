//! Relative pose of the initial pair, and the degenerate motions that have none.

use super::config::{InitialPairError, StructureConfig};
use super::triangulation::rotation_only;
use crate::geometry::{
    Real,
    camera::Camera,
    robust::{RobustConfig, RobustError, robust_fundamental},
    two_view::{Correspondence, Essential, Homography, RelativePose, TwoViewModel, TwoViews, choose},
};
use nalgebra::{Point2, Vector3};

/// Points in common, at least.
const FEWEST: usize = 12;

/// A pose of the second view beside the first, and how good it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair<T: Real> {
    pub pose: RelativePose<T>,
    /// Points that agree and are seen at the least angle.
    pub angled: usize,
    /// Whether what both see is on a plane.
    pub plane: bool,
}

/// The pose of two views without distortion, of which `seen` are in common (undistorted px): some wrong.
pub(super) fn pair<T: Real>(
    first: &Camera<T>,
    second: &Camera<T>,
    seen: &mut [Correspondence<T>],
    inliers: &mut [bool],
    config: &StructureConfig<T>,
) -> Result<Pair<T>, InitialPairError> {
    if seen.len() < FEWEST {
        return Err(InitialPairError::TooFew);
    }
    still(first, second, seen, config)?;
    let robust = RobustConfig {
        most_samples: config.most_samples,
        seed: config.seed,
        ..RobustConfig::new(config.threshold_px)
    };
    let found = match robust_fundamental(seen, &robust, inliers) {
        Ok(found) => Some(found.fundamental),
        Err(RobustError::Plane) => None,
        // Samples of seven on a plane have no F when they are exact: the plane is looked for.
        Err(RobustError::NoAgreement) => {
            let h = Homography::from_correspondences(seen).map_err(|_| InitialPairError::NoAgreement)?;
            for (inlier, s) in inliers.iter_mut().zip(seen.iter()) {
                *inlier = h.sampson_squared_px2(s) <= config.threshold_px * config.threshold_px;
            }
            None
        }
        Err(_) => return Err(InitialPairError::NoAgreement),
    };
    let kept = compact(seen, inliers);
    let seen = seen.get_mut(..kept).unwrap_or(&mut []);
    if kept < FEWEST {
        return Err(InitialPairError::NoAgreement);
    }
    let seen = &*seen;
    let planar = match found {
        None => Some(Homography::from_correspondences(seen).map_err(|_| InitialPairError::NoAgreement)?),
        // Exact matches have the noise of their digits.
        Some(_) => match choose(seen, config.threshold_px * T::of(0.3)).map(|choice| choice.model) {
            Ok(TwoViewModel::Planar(h)) => Some(h),
            _ => None,
        },
    };
    let plane = planar.is_some();
    let pose = match (planar, found) {
        (Some(h), _) => before_plane(&h, first, second, seen)?,
        (None, Some(f)) => {
            let essential =
                Essential::from_fundamental(&f, first, second).map_err(|_| InitialPairError::NoAgreement)?;
            let essential = essential.refined(seen, first, second, config.threshold_px);
            let essential = essential.map_err(|_| InitialPairError::NoAgreement)?;
            essential
                .recover_pose(seen.iter().copied(), first, second)
                .map_err(|_| InitialPairError::SmallAngle)?
                .pose
        }
        (None, None) => return Err(InitialPairError::NoAgreement),
    };
    let views =
        TwoViews::new(*first, *second, pose.in_baselines()).map_err(|_| InitialPairError::NoAgreement)?;
    let views = views.with_min_angle(config.min_angle_rad);
    let angled =
        seen.iter().filter(|seen| views.optimal(seen).is_ok_and(|p| p.residual_px <= config.threshold_px));
    let angled = angled.count();
    if angled < FEWEST { Err(InitialPairError::SmallAngle) } else { Ok(Pair { pose, angled, plane }) }
}

/// Names what is no motion, and what a turn explains: four fifths of what is within ten thresholds of it is
/// within one.
fn still<T: Real>(
    first: &Camera<T>,
    second: &Camera<T>,
    seen: &[Correspondence<T>],
    config: &StructureConfig<T>,
) -> Result<(), InitialPairError> {
    let most = config.threshold_px * config.threshold_px;
    let near = |a: &Point2<T>, b: &Point2<T>, times: T| (a - b).norm_squared() <= most * times;
    let (wide, one) = (T::of(100.0), T::ONE);
    // Wrong ones are anywhere; of the rest nearly all.
    let explains = |within: usize, around: usize| 5 * within >= 4 * around && 2 * around >= seen.len();
    let stay = |times: T| seen.iter().filter(|s| near(&s.first, &s.second, times)).count();
    if explains(stay(one), stay(wide)) {
        return Err(InitialPairError::NoMotion);
    }
    let ray = |camera: &Camera<T>, pixel: &Point2<T>| {
        let ray = camera.unproject(pixel).unwrap_or(Vector3::z());
        ray * (T::ONE / ray.norm())
    };
    let rays = seen.iter().map(|s| (ray(first, &s.first), ray(second, &s.second)));
    let rotation = rotation_only(rays, config.threshold_px / first.focal_px().0);
    let turned = |s: &Correspondence<T>| first.project(&(rotation * ray(second, &s.second)).into()).ok();
    let (mut within, mut around) = (0, 0);
    for s in seen {
        let Some(there) = turned(s) else { continue };
        within += usize::from(near(&s.first, &there, one));
        around += usize::from(near(&s.first, &there, wide));
    }
    if explains(within, around) { Err(InitialPairError::PureRotation) } else { Ok(()) }
}

/// The motion before a plane, if there is one that has clearly more in front of the cameras than any other.
fn before_plane<T: Real>(
    h: &Homography<T>,
    first: &Camera<T>,
    second: &Camera<T>,
    seen: &[Correspondence<T>],
) -> Result<RelativePose<T>, InitialPairError> {
    let motions =
        h.recover_motions(seen.iter().copied(), first, second).map_err(|_| InitialPairError::PureRotation)?;
    let [(motion, votes), (_, others)] = motions;
    if 10 * others >= 9 * votes {
        return Err(InitialPairError::Plane);
    }
    motion.relative_pose().ok_or(InitialPairError::PureRotation)
}

/// Moves what agrees to the front; how many those are.
fn compact<T: Real>(seen: &mut [Correspondence<T>], inliers: &[bool]) -> usize {
    let mut kept = 0;
    for at in 0..seen.len() {
        if let (Some(&true), Some(&this)) = (inliers.get(at), seen.get(at))
            && let Some(slot) = seen.get_mut(kept)
        {
            *slot = this;
            kept += 1;
        }
    }
    kept
}
