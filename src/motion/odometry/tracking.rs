//! Where the points are in the new frame.

use super::config::OdometryRig;
use super::engine::{FEWEST, Odometry, product};
use super::frame::Frame;
use super::inverse_depth::PointObservation;
use super::pose_estimate::{Free, PointMatch, Problem};
use super::track::{Track, UPRIGHT};
use crate::features::{Descriptor, Feature, Template};
use crate::geometry::{
    Real,
    absolute::Landmark,
    camera::Pose,
    robust::{RobustConfig, robust_resection},
};
use nalgebra::{Point2, Point3, Vector3};

/// The bits that the best feature may differ in, and of the second best the percent.
const MOST_DIFFERENT: u16 = 72;
const RATIO_PERCENT: u32 = 85;
/// A second best is another corner if it lies so far away, px.
const APART_PX: f32 = 4.0;
/// How far off a place may be that the resection keeps, px.
const RESECTION_PX: f64 = 3.0;
/// How far from the predicted place pixels are looked for, px.
const ALIGN_PX: f32 = 4.0;
/// A deviation of corners that begins with what is far off, px.
const COARSE_PX: f64 = 2.0;
/// How alike pixels have to be.
pub(super) const ALIKE: f32 = 0.8;
/// How far rows of a pair may be off each other, px.
const ROWS_PX: f32 = 1.5;

impl<T: Real, const N: usize> Odometry<T, N> {
    /// Fills the matches with the points that are seen, and says near which pose, if there is one.
    pub(super) fn track(&mut self, rig: &OdometryRig<T>, frame: &Frame<'_>) -> Option<Pose<T>> {
        let predicted =
            self.velocity.map_or(self.reported_pose, |velocity| self.reported_pose.then(&velocity));
        let near = if self.velocity.is_some() { self.config.near_px } else { self.config.far_px };
        self.recognise(rig, frame.features, &predicted, near);
        let mut pose = self.resect(rig);
        if pose.is_none() && near < self.config.far_px {
            self.recognise(rig, frame.features, &self.reported_pose.clone(), self.config.far_px);
            pose = self.resect(rig);
        }
        // Where too few have a depth it is a turn at least; where too few are recognised by their
        // descriptors, pixels may still be where they are expected.
        let mut pose = pose.or_else(|| self.turned(rig)).or(self.velocity.map(|_| predicted))?;
        self.matches.clear();
        self.pair(rig, frame, &pose, true);
        // What was recognised says by its pixels more exactly where the others are.
        let solved = Problem { matches: &self.matches, baseline: rig.baseline() }.solve(pose, Free::All);
        if solved.kept >= 2 * FEWEST && 2 * solved.kept >= self.matches.len() {
            pose = solved.pose;
        }
        self.pair(rig, frame, &pose, false);
        Some(pose)
    }

    /// Looks for each point's descriptor among the features near its predicted place, as far as it is the
    /// best of both.
    pub(super) fn recognise(
        &mut self,
        rig: &OdometryRig<T>,
        features: &[Feature],
        pose: &Pose<T>,
        near_px: f32,
    ) {
        let features = features.get(..N).unwrap_or(features);
        self.partners.fill((Descriptor::BITS + 1, 0));
        for (number, track) in (0_u16..).zip(self.tracks.iter_mut()) {
            track.now = None;
            if !track.used {
                continue;
            }
            let Some(place) = expected(track, rig, pose) else { continue };
            let (mut best, mut second, mut chosen) = (Descriptor::BITS + 1, Descriptor::BITS / 2, usize::MAX);
            let mut at = [0.0; 2];
            for (i, feature) in features.iter().enumerate() {
                if (feature.x_px - place[0]).abs() > near_px || (feature.y_px - place[1]).abs() > near_px {
                    continue;
                }
                let different = track.descriptor.distance(&feature.descriptor);
                let apart =
                    (feature.x_px - at[0]).abs() >= APART_PX || (feature.y_px - at[1]).abs() >= APART_PX;
                if different < best {
                    if apart && best < second {
                        second = best;
                    }
                    (best, chosen, at) = (different, i, [feature.x_px, feature.y_px]);
                } else if apart && different < second {
                    second = different;
                }
            }
            let clear = 100 * u32::from(best) < RATIO_PERCENT * u32::from(second);
            if best <= MOST_DIFFERENT
                && clear
                && let Some(partner) = self.partners.get_mut(chosen)
                && best < partner.0
            {
                *partner = (best, number);
                track.now = Some(at);
            }
        }
        // Of several points that took one feature the most alike has it.
        for (number, track) in (0_u16..).zip(self.tracks.iter_mut()) {
            let Some(at) = track.now else { continue };
            let same = |f: &Feature| f.x_px == at[0] && f.y_px == at[1];
            let own = features.iter().zip(&self.partners).find(|(f, partner)| partner.1 == number && same(f));
            match own {
                Some((feature, _)) => track.fresh = feature.descriptor,
                None => track.now = None,
            }
        }
    }

    /// The pose that most of what was recognised agrees with.
    fn resect(&mut self, rig: &OdometryRig<T>) -> Option<Pose<T>> {
        self.landmarks.clear();
        for track in self.tracks.iter().filter(|track| track.used && track.is_deep(0.3)) {
            let Some([x, y]) = track.now else { continue };
            let (a, r) = (track.point.at, T::ONE / track.point.at.z);
            let Ok(pixel) = rig.camera.undistort(&Point2::new(T::of(x.into()), T::of(y.into()))) else {
                continue;
            };
            let _ = self.landmarks.push(Landmark { world: Point3::new(a.x * r, a.y * r, r), pixel });
        }
        let config = RobustConfig {
            most_samples: self.config.most_samples.max(1),
            seed: self.config.seed ^ u64::from(self.frames),
            ..RobustConfig::new(T::of(RESECTION_PX))
        };
        let found = robust_resection(&self.landmarks, &rig.camera, &config, &mut self.inliers).ok()?;
        (found.inliers >= 10 && 4 * found.inliers >= self.landmarks.len()).then_some(found.pose)
    }

    /// The turn that most of what was recognised agrees with, as if all were far away; `None` of too few.
    fn turned(&mut self, rig: &OdometryRig<T>) -> Option<Pose<T>> {
        self.matches.clear();
        let sigma = T::of(COARSE_PX) / rig.focal();
        for (owner, track) in (0_u16..).zip(self.tracks.iter()) {
            let Some([x, y]) = track.now.filter(|_| track.used) else { continue };
            let Ok(at) = rig.camera.unproject(&Point2::new(T::of(x.into()), T::of(y.into()))) else {
                continue;
            };
            let observation = PointObservation { at, in_right: false, sigma };
            let _ = self.matches.push(PointMatch { point: track.point, observation, owner });
        }
        let found = Problem { matches: &self.matches, baseline: rig.baseline() }
            .solve(self.reported_pose, Free::Rotation);
        (found.kept >= 2 * FEWEST && 2 * found.kept >= self.matches.len()).then_some(found.pose)
    }

    /// Finds points by their pixels around where the pose puts them, and in the right picture: those that
    /// were recognised, or the others.
    fn pair(&mut self, rig: &OdometryRig<T>, frame: &Frame<'_>, pose: &Pose<T>, recognised: bool) {
        let sigma = T::of(self.config.sigma_px.into()) / rig.focal();
        for (owner, track) in (0_u16..).zip(self.tracks.iter_mut()) {
            if !track.used || track.now.is_some() != recognised {
                continue;
            }
            let recognised = track.now.take();
            let (Some(place), Some(moved)) = (expected(track, rig, pose), track.point.moved(pose)) else {
                continue;
            };
            let of = |x: T| x.to_f64() as f32;
            let spread = moved.by_point * track.point.covariance * moved.by_point.transpose();
            let deviation = of((spread.m11.max(spread.m22)).sqrt() * rig.focal());
            let start = match recognised {
                Some(at)
                    if (at[0] - place[0]).abs().max((at[1] - place[1]).abs())
                        < ALIGN_PX + 3.0 * deviation =>
                {
                    track.descriptor = track.fresh;
                    at
                }
                // Where a point may be anywhere along a line, its pixels are not looked for.
                _ if deviation > ALIGN_PX => continue,
                _ => place,
            };
            let by = &moved.by_point;
            let warp = product(&[[of(by.m11), of(by.m12)], [of(by.m21), of(by.m22)]], &track.warp);
            let Ok(found) = track.template.align(&frame.left, &warp, start, ALIGN_PX) else { continue };
            if found.correlation < ALIKE {
                continue;
            }
            let now = [found.x_px, found.y_px];
            let pixel = Point2::new(T::of(now[0].into()), T::of(now[1].into()));
            let Ok(observation) = rig.camera.unproject(&pixel) else { continue };
            (track.now, track.correlation) = (Some(now), found.correlation);
            let expected = rig.baseline() * moved.at.z * rig.focal();
            let disparity = disparity(rig, frame, now, of(expected));
            let third = disparity.map_or(T::ZERO, |d| T::of(d.into()) / rig.focal());
            let observation = PointObservation {
                at: Vector3::new(observation.x, observation.y, third),
                in_right: disparity.is_some(),
                sigma,
            };
            let _ = self.matches.push(PointMatch { point: track.point, observation, owner });
        }
    }
}

/// Where a point is expected, px; `None` outside of the picture's half space.
fn expected<T: Real>(track: &Track<T>, rig: &OdometryRig<T>, pose: &Pose<T>) -> Option<[f32; 2]> {
    let moved = track.point.moved(pose)?;
    let pixel = rig.camera.project(&Point3::new(moved.at.x, moved.at.y, T::ONE)).ok()?;
    Some([pixel.x.to_f64() as f32, pixel.y.to_f64() as f32])
}

/// The disparity `f (x - x')` of a place, px, near the expected one.
pub(super) fn disparity<T: Real>(
    rig: &OdometryRig<T>,
    frame: &Frame<'_>,
    [x, y]: [f32; 2],
    expected: f32,
) -> Option<f32> {
    let ((_, right_cx), right) = (rig.right?, frame.right?);
    // Columns of both pictures differ by the principal points, too.
    let offset = (right_cx - rig.camera.principal_point().0).to_f64() as f32;
    let template = Template::cut(&frame.left, x, y).ok()?;
    let found = template.align(&right, &UPRIGHT, [x - expected + offset, y], ALIGN_PX).ok()?;
    let good = found.correlation > ALIKE && (found.y_px - y).abs() < ROWS_PX;
    good.then_some(x - found.x_px + offset)
}
