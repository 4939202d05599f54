//! PnP with outliers: a camera's pose from points of known position, by RANSAC over P3P.

use super::config::{RobustConfig, Sampling};
use super::loss::Biweight;
use super::prosac::Sampler;
use super::ransac::{Estimator, ransac};
use super::reprojection::Reprojection;
use crate::geometry::Real;
use crate::geometry::absolute::{Landmark, P3pPoses, p3p};
use crate::geometry::camera::{Camera, Pose};
use crate::geometry::linear::covariance6;
use nalgebra::{Matrix6, Point3, Vector3};

/// Why landmarks give no pose, however many of them are left out.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RobustResectionError {
    /// Fewer than four landmarks.
    TooFew,
    /// A number is infinite or not a number.
    NotFinite,
    /// The threshold is not greater than zero, or not finite.
    Threshold,
    /// The probability of a miss is not between zero and one.
    MissProbability,
    /// No sample is allowed.
    NoSamples,
    /// The slice for the inliers is shorter than the landmarks; this many are needed.
    Inliers(usize),
    /// No sample of three gave a pose that more than three landmarks agree with: all are wrong, or on a line.
    NoAgreement,
}

error_text!(RobustResectionError {
    Self::TooFew => "a pose needs four landmarks",
    Self::NotFinite => "a coordinate is not finite",
    Self::Threshold => "the threshold must be greater than zero and finite",
    Self::MissProbability => "the probability of a miss must be between zero and one",
    Self::NoSamples => "one sample at least is needed",
    Self::Inliers(needed) => "the inliers need a slice of {needed}",
    Self::NoAgreement => "no pose has more than three landmarks agree with it",
});

/// Where a camera stands in the world, and how sure that is.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RobustResection<T: Real> {
    /// Carries a point of the camera into the world.
    pub pose: Pose<T>,
    /// The covariance of the pose to first order, if the inliers' coordinates have the deviation
    /// [`Self::rms_px`]: a rotation (radians) and a step, both along the camera's axes,
    /// `P = R exp([w]x) (P' + d) + t`. Very large where the landmarks leave the pose open.
    pub covariance: Matrix6<T>,
    /// How many landmarks are within the threshold.
    pub inliers: usize,
    /// Root mean square of a coordinate's re-projection error among them, px, corrected for the six numbers
    /// of the pose.
    pub rms_px: T,
    /// Samples of three that were drawn.
    pub samples: u32,
}

/// Landmarks of a sample, and one more that a pose has to agree with.
const MINIMUM: usize = 3;
/// Steps of the refinement of each best pose, and of the last.
const QUICK: usize = 4;
const LAST: usize = 12;

/// The pose of a camera from landmarks, some of them wrong (undistorted px); `inliers` says which agree.
///
/// Samples of three give up to four poses each ([`p3p()`]); each best one so far is refined over all
/// landmarks by least squares with weights that fall to zero at one and a half thresholds, as in
/// [`robust_fundamental`](crate::geometry::robust::robust_fundamental). Bounded by
/// [`RobustConfig::most_samples`], each sample by four passes over the landmarks, each best one by four more;
/// [`RobustConfig::sampling`] is ignored here.
pub fn robust_resection<T: Real>(
    landmarks: &[Landmark<T>],
    camera: &Camera<T>,
    config: &RobustConfig<T>,
    inliers: &mut [bool],
) -> Result<RobustResection<T>, RobustResectionError> {
    check(landmarks, config, inliers.len())?;
    let problem = Reprojection {
        landmarks,
        k: camera.matrix(),
        inverse: camera.inverse_matrix(),
        loss: Biweight::new(config.threshold_px),
    };
    let mut search = Search {
        problem: &problem,
        config,
        sampler: Sampler::new(Sampling::Uniform, config.seed, landmarks.len()),
        best: None,
        needed: config.most_samples,
    };
    let samples = ransac(&mut search, config.most_samples);
    let (pose, _) = search.best.ok_or(RobustResectionError::NoAgreement)?;
    let (pose, information) = problem.refined(pose, LAST);
    let (count, squares) = problem.within(&pose, config.threshold_px);
    if count <= MINIMUM || pose.sound().is_none() || !squares.is_finite() {
        return Err(RobustResectionError::NoAgreement);
    }
    for (inlier, landmark) in inliers.iter_mut().zip(landmarks) {
        *inlier =
            problem.squared(&pose, landmark).is_some_and(|e| e <= config.threshold_px * config.threshold_px);
    }
    let free = T::count((2 * count).saturating_sub(6).max(1));
    let rms_px = (squares / free).sqrt();
    let covariance = covariance6(&information) * (rms_px * rms_px);
    Ok(RobustResection { pose, covariance, inliers: count, rms_px, samples })
}

fn check<T: Real>(
    landmarks: &[Landmark<T>],
    config: &RobustConfig<T>,
    inliers: usize,
) -> Result<(), RobustResectionError> {
    let finite = |l: &Landmark<T>| l.world.iter().chain(l.pixel.iter()).all(|x| x.is_finite());
    if landmarks.len() <= MINIMUM {
        Err(RobustResectionError::TooFew)
    } else if inliers < landmarks.len() {
        Err(RobustResectionError::Inliers(landmarks.len()))
    } else if !(config.threshold_px > T::ZERO && config.threshold_px.is_finite()) {
        Err(RobustResectionError::Threshold)
    } else if !(config.miss_probability > T::ZERO && config.miss_probability < T::ONE) {
        Err(RobustResectionError::MissProbability)
    } else if config.most_samples == 0 {
        Err(RobustResectionError::NoSamples)
    } else if !landmarks.iter().all(finite) {
        Err(RobustResectionError::NotFinite)
    } else {
        Ok(())
    }
}

/// After so many samples of three, with a share of right landmarks, the chance that each had a wrong one is
/// as asked.
fn enough<T: Real>(share: T, config: &RobustConfig<T>) -> u32 {
    let all_right = share * share * share;
    if !(all_right < T::ONE) {
        return 1;
    }
    let samples = config.miss_probability.ln() / (T::ONE - all_right).ln();
    // Not a number and what is too large are the most, as is a share that rounds to none.
    if samples >= T::ZERO && samples < T::of(f64::from(u32::MAX)) {
        samples.to_f64() as u32 + 1
    } else {
        u32::MAX
    }
}

/// The RANSAC search, and the best pose so far with its gain.
struct Search<'a, T: Real> {
    problem: &'a Reprojection<'a, T>,
    config: &'a RobustConfig<T>,
    sampler: Sampler<MINIMUM>,
    best: Option<(Pose<T>, T)>,
    /// Samples after which a better pose is as unlikely as asked.
    needed: u32,
}

/// The poses of a sample, if it has any.
struct Poses<T: Real>(Option<P3pPoses<T>>);

impl<T: Real> AsRef<[Pose<T>]> for Poses<T> {
    fn as_ref(&self) -> &[Pose<T>] {
        self.0.as_ref().map_or(&[], P3pPoses::as_slice)
    }
}

impl<T: Real> Estimator<MINIMUM> for Search<'_, T> {
    type Model = Pose<T>;
    type Models = Poses<T>;

    fn draw(&mut self, drawn: u32) -> [usize; MINIMUM] {
        self.sampler.next(drawn)
    }

    fn models(&self, sample: &[usize; MINIMUM]) -> Poses<T> {
        let mut rays = [Vector3::z(); MINIMUM];
        let mut points = [Point3::origin(); MINIMUM];
        for ((ray, point), &place) in rays.iter_mut().zip(&mut points).zip(sample) {
            if let Some(landmark) = self.problem.landmarks.get(place) {
                *ray = self.problem.inverse * landmark.pixel.to_homogeneous();
                *point = landmark.world;
            }
        }
        Poses(p3p(&rays, &points).ok())
    }

    fn consider(&mut self, model: &Pose<T>, _sample: &[usize; MINIMUM]) {
        let Self { problem, config, .. } = *self;
        let Some(gain) = problem.gain(model, self.best.map_or(T::ZERO, |(_, gain)| gain)) else { return };
        // The refinement of a pose by its own landmarks makes it better, or it is as it was.
        let (refined, _) = problem.refined(*model, QUICK);
        let better = problem.gain(&refined, gain);
        let (pose, gain) = better.map_or((*model, gain), |better| (refined, better));
        self.best = Some((pose, gain));
        let inliers = problem.within(&pose, config.threshold_px).0;
        let share = T::count(inliers) / T::count(problem.landmarks.len());
        self.needed = self.needed.min(enough(share, config));
    }

    fn is_enough(&mut self, drawn: u32) -> bool {
        drawn >= self.needed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn what_no_pose_can_come_of_is_refused() {
        let landmarks: [_; 5] = core::array::from_fn(|i| Landmark {
            world: Point3::new(i as f64, 1.0, 2.0),
            pixel: Point2::new(3.0, i as f64),
        });
        let checked =
            |n: usize, config: RobustConfig<f64>, room: usize| check(&landmarks[..n], &config, room);
        let config = RobustConfig::new(1.0);
        assert_eq!([3, 4].map(|n| checked(n, config, n)), [Err(RobustResectionError::TooFew), Ok(())]);
        let refused = Err(RobustResectionError::Inliers(5));
        assert_eq!([4, 5, 6].map(|room| checked(5, config, room)), [refused, Ok(()), Ok(())]);
        for (threshold_px, is_one) in [
            (-1.0, false),
            (0.0, false),
            (1e-300, true),
            (f64::MAX, true),
            (f64::INFINITY, false),
            (f64::NAN, false),
        ] {
            assert_eq!(checked(5, RobustConfig::new(threshold_px), 5).is_ok(), is_one, "{threshold_px}");
        }
        for (miss_probability, is_one) in [(0.0, false), (1e-9, true), (0.999, true), (1.0, false)] {
            let config = RobustConfig { miss_probability, ..config };
            assert_eq!(checked(5, config, 5).is_ok(), is_one, "{miss_probability}");
        }
        for (most_samples, is_one) in [(0, false), (1, true), (2, true)] {
            assert_eq!(checked(5, RobustConfig { most_samples, ..config }, 5).is_ok(), is_one);
        }
    }

    #[test]
    fn four_landmarks_have_a_pose_and_three_of_them_none() {
        let camera = Camera::new(500.0, 510.0, 320.0, 240.0).expect("a camera");
        let at = [(0.3, 0.2, 2.0), (-0.4, 0.1, 3.0), (0.1, -0.5, 2.5), (-0.2, -0.3, 4.0)];
        let mut landmarks = at.map(|(x, y, z)| {
            let world = Point3::new(x, y, z);
            Landmark { world, pixel: camera.project(&world).expect("in front") }
        });
        let solve = |landmarks: &[Landmark<f64>]| {
            robust_resection(landmarks, &camera, &RobustConfig::new(1.0), &mut [false; 4])
        };
        let found = solve(&landmarks).expect("a pose");
        assert!(found.inliers == 4 && found.pose.translation().norm() < 1e-6 && found.rms_px < 1e-6);
        landmarks[2].pixel.x += 90.0;
        assert_eq!(solve(&landmarks), Err(RobustResectionError::NoAgreement));
    }

    #[test]
    fn as_many_samples_as_the_share_of_right_ones_asks_for() {
        let config = RobustConfig { miss_probability: 0.01, ..RobustConfig::new(1.0_f64) };
        // ln 0.01 / ln (1 - 1/8) is 34.5; with all right one is enough, with one in a thousand
        // 4.6 thousand millions are too many to count. With none, or with so small a share that its cube
        // taken from 1 leaves 1, no number is enough.
        let shares = [0.5, 1.0, 0.001, 1e-6, 0.0];
        assert_eq!(shares.map(|share| enough(share, &config)), [35, 1, u32::MAX, u32::MAX, u32::MAX]);
    }
}
