//! Two cameras that see points of a known world, from matches with wrong ones among them to the pose and the
//! points.
//!
//! It knows no hardware: the same runs on the host, which compares. In a product the matches are those of
//! `stereopsis::features`, and what is here of the truth is not.

use nalgebra::{Matrix3, Point2, Point3, Vector3};
use stereopsis::geometry::{
    camera::{Camera, Pose},
    robust::{RobustConfig, RobustError, RobustFundamental, robust_fundamental},
    two_view::{Correspondence, Essential, RecoveredPose, TwoViews},
};

/// Matches.
pub const MATCHES: usize = 128;
/// Of so many matches one is wrong: its point in the second image is anywhere.
const ONE_WRONG_OF: usize = 3;
/// Columns and rows of the images, px.
const IMAGE: (f32, f32) = (640.0, 480.0);
/// Standard deviation of the right matches' coordinates, px.
const NOISE_PX: f32 = 0.3;
/// Up to where a match counts as right, px.
const THRESHOLD_PX: f32 = 1.5;

/// The cameras.
pub struct Cameras {
    /// Both of them.
    pub camera: Camera<f32>,
    /// The second one beside the first, metres.
    pub pose: Pose<f32>,
}

/// The world, and what the cameras see of it.
pub struct World {
    /// The points in camera 1, metres.
    pub points: [Point3<f32>; MATCHES],
    /// The matches.
    pub seen: [Correspondence<f32>; MATCHES],
}

/// What was found.
pub struct Found {
    /// F, and how sure it is.
    pub robust: RobustFundamental<f32>,
    /// R and the direction of t, and the vote for them.
    pub recovered: RecoveredPose<f32>,
    /// Points that were triangulated.
    pub points: usize,
}

/// How far that is from the truth.
pub struct Errors {
    /// The angle between the rotations, radians.
    pub rotation_rad: f32,
    /// The angle between the directions of t, radians.
    pub direction_rad: f32,
    /// The mean of the points' distances from the true ones, of the distances from the camera.
    pub points: f32,
    /// Right matches that were not kept.
    pub lost: usize,
    /// Wrong matches that were.
    pub kept: usize,
}

/// Why nothing was found.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Missing {
    /// The camera or its pose cannot be.
    World,
    /// The matches agree on nothing.
    Fundamental(RobustError),
    /// F is not that of the cameras.
    Pose,
}

/// Whether a match is a right one.
pub const fn is_right(at: usize) -> bool {
    at % ONE_WRONG_OF != 1
}

impl Cameras {
    /// The second camera is a third of a metre to the right of the first, turned by a few degrees.
    ///
    /// # Errors
    /// When they cannot be; which they can.
    pub fn new() -> Result<Self, Missing> {
        let camera = Camera::new(500.0, 500.0, 320.0, 240.0).map_err(|_| Missing::World)?;
        let pose = Pose::new(turn(40.0, 1.0, -2.0, 0.5), Vector3::new(0.3, -0.05, 0.1))
            .map_err(|_| Missing::World)?;
        Ok(Self { camera, pose })
    }
}

impl Default for World {
    fn default() -> Self {
        Self::new()
    }
}

impl World {
    /// Nothing yet.
    pub const fn new() -> Self {
        Self {
            points: [Point3::new(0.0, 0.0, 0.0); MATCHES],
            seen: [Correspondence::new(0.0, 0.0, 0.0, 0.0); MATCHES],
        }
    }

    /// The points of a seed, 4 m to 12 m away.
    ///
    /// # Errors
    /// When a camera does not see one; which it does.
    #[inline(never)]
    pub fn fill(&mut self, cameras: &Cameras, seed: u32) -> Result<(), Missing> {
        let mut random = Random(seed);
        for (at, (point, seen)) in self.points.iter_mut().zip(&mut self.seen).enumerate() {
            let first = random.pixel();
            let sight = cameras.camera.unproject(&first).map_err(|_| Missing::World)?;
            *point = Point3::from(sight * (4.0 + 8.0 * random.unit()));
            let second =
                cameras.camera.project(&cameras.pose.inverse_transform(point)).map_err(|_| Missing::World)?;
            let anywhere = random.pixel();
            let second = if is_right(at) { second } else { anywhere };
            let [a, b, c, d] = [first.x, first.y, second.x, second.y].map(|x| x + random.normal() * NOISE_PX);
            *seen = Correspondence::new(a, b, c, d);
        }
        Ok(())
    }

    /// F from the matches, without the cameras; `inliers` says which agree.
    ///
    /// # Errors
    /// When they agree on nothing.
    #[inline(never)]
    pub fn fundamental(&self, inliers: &mut [bool; MATCHES]) -> Result<RobustFundamental<f32>, Missing> {
        robust_fundamental(&self.seen, &RobustConfig::new(THRESHOLD_PX), inliers)
            .map_err(Missing::Fundamental)
    }

    /// The pose in F with the known cameras, and the points by it, in baselines: those of matches that agree
    /// and have one.
    ///
    /// # Errors
    /// When F is not that of the cameras.
    #[inline(never)]
    pub fn pose(
        &self,
        Cameras { camera, .. }: &Cameras,
        robust: RobustFundamental<f32>,
        inliers: &[bool; MATCHES],
        points: &mut [Option<Point3<f32>>; MATCHES],
    ) -> Result<Found, Missing> {
        let essential =
            Essential::from_fundamental(&robust.fundamental, camera, camera).map_err(|_| Missing::Pose)?;
        let essential =
            essential.refined(&self.seen, camera, camera, THRESHOLD_PX).map_err(|_| Missing::Pose)?;
        let agreeing = self.seen.iter().zip(inliers).filter(|(_, inlier)| **inlier).map(|(seen, _)| *seen);
        let recovered = essential.recover_pose(agreeing, camera, camera).map_err(|_| Missing::Pose)?;
        let views =
            TwoViews::new(*camera, *camera, recovered.pose.in_baselines()).map_err(|_| Missing::Pose)?;
        let mut count = 0;
        for ((point, seen), &inlier) in points.iter_mut().zip(&self.seen).zip(inliers) {
            *point = if inlier { views.optimal(seen).ok().map(|found| found.point) } else { None };
            count += usize::from(point.is_some());
        }
        Ok(Found { robust, recovered, points: count })
    }

    /// How far what was found is from the truth.
    #[inline(never)]
    pub fn errors(
        &self,
        Cameras { pose, .. }: &Cameras,
        found: &Found,
        inliers: &[bool; MATCHES],
        points: &[Option<Point3<f32>>; MATCHES],
    ) -> Errors {
        // The distance of two rotations is the root of two times their angle, while it is small.
        let rotation = (found.recovered.pose.rotation() - pose.rotation()).norm();
        let baseline_m = pose.translation().norm();
        let direction = found.recovered.pose.direction().into_inner() - pose.translation() / baseline_m;
        let off = points.iter().zip(&self.points).filter_map(|(point, truth)| {
            let point = (*point)? * baseline_m;
            Some((point - truth).norm() / truth.coords.norm())
        });
        let (sum, count) = off.fold((0.0, 0.0), |(sum, count), off| (sum + off, count + 1.0));
        let of = |right: bool, kept: bool| {
            inliers
                .iter()
                .enumerate()
                .filter(|&(at, &inlier)| is_right(at) == right && inlier == kept)
                .count()
        };
        Errors {
            rotation_rad: rotation * core::f32::consts::FRAC_1_SQRT_2,
            direction_rad: direction.norm(),
            points: sum / count,
            lost: of(true, false),
            kept: of(false, true),
        }
    }
}

impl Errors {
    /// Whether the estimate is as good as the noise allows, and better than by chance: within a third of a
    /// degree in rotation, two in direction, points within 6 %, at most one in eight of the right matches
    /// lost, one in eight of the wrong ones kept.
    pub fn are_small(&self) -> bool {
        let wrong = MATCHES / ONE_WRONG_OF;
        self.rotation_rad < 0.006
            && self.direction_rad < 0.035
            && self.points < 0.06
            && self.lost * 8 <= MATCHES - wrong
            && self.kept * 8 <= wrong
    }
}

/// The rotation of a quaternion of any length.
fn turn(w: f32, x: f32, y: f32, z: f32) -> Matrix3<f32> {
    let by = 2.0 / (w * w + x * x + y * y + z * z);
    Matrix3::new(
        1.0 - by * (y * y + z * z),
        by * (x * y - w * z),
        by * (x * z + w * y),
        by * (x * y + w * z),
        1.0 - by * (x * x + z * z),
        by * (y * z - w * x),
        by * (x * z - w * y),
        by * (y * z + w * x),
        1.0 - by * (x * x + y * y),
    )
}

/// Numbers that a seed repeats: a counter, its bits mixed.
struct Random(u32);

impl Random {
    #[inline(never)]
    fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9E37_79B9);
        let mut h = self.0;
        h = (h ^ (h >> 16)).wrapping_mul(0x21F0_AAAD);
        h = (h ^ (h >> 15)).wrapping_mul(0x735A_2D97);
        h ^ (h >> 15)
    }

    /// From zero to one, in steps of 2^-24.
    fn unit(&mut self) -> f32 {
        (self.bits() >> 8) as f32 / 16_777_216.0
    }

    /// Somewhere in the image.
    fn pixel(&mut self) -> Point2<f32> {
        Point2::new(self.unit() * IMAGE.0, self.unit() * IMAGE.1)
    }

    /// Nearly normally distributed, deviation one: three even ones.
    fn normal(&mut self) -> f32 {
        2.0 * (self.unit() + self.unit() + self.unit() - 1.5)
    }
}
