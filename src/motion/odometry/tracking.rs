//! Tracking: points found in a frame by descriptor, resection (PnP with RANSAC) and template alignment.

use super::config::OdometryRig;
use super::disparity::{ALIGN_PX, CORRELATED, disparity};
use super::frame::Moment;
use super::list::List;
use super::motion_model::MotionModel;
use super::point_map::PointMap;
use super::pose_estimate::{FEWEST, Free, PointMatch, Problem};
use super::track::{Track, product};
use super::whitening::PointObservation;
use crate::features::{Descriptor, Feature};
use crate::geometry::{
    Real,
    absolute::Landmark,
    camera::Pose,
    robust::{RobustConfig, robust_resection},
};
use nalgebra::{Point2, Point3, Vector3};

/// Largest Hamming distance accepted between a track's descriptor and a feature's.
const MOST_DIFFERENT: u16 = 72;
/// Largest ratio of the best distance to the second best, percent (Lowe 2004).
const RATIO_PERCENT: u32 = 85;
/// A second best is another corner if it lies so far away, px.
const APART_PX: f32 = 4.0;
/// How far off a place may be that the resection keeps, px.
const RESECTION_PX: f64 = 3.0;
/// A deviation of corners that begins with what is far off, px.
const COARSE_PX: f64 = 2.0;

/// Finds the points of the map in a frame.
#[derive(Debug)]
pub(super) struct Tracker<'a, T: Real> {
    /// The points that the last frame sees.
    pub matches: List<'a, PointMatch<T>>,
    pub landmarks: &'a mut [Landmark<T>],
    pub inliers: &'a mut [bool],
    /// By how many bits each feature differs from the track that it is most like, and that track.
    pub partners: &'a mut [(u16, u16)],
}

impl<T: Real> Tracker<'_, T> {
    /// Fills the matches with the points that the frame sees; the pose near which they say it is, if any.
    pub fn track(
        &mut self,
        now: &Moment<'_, T>,
        map: &mut PointMap<'_, T>,
        motion: &MotionModel<T>,
    ) -> Option<Pose<T>> {
        let (last, far) = (motion.reported_pose, now.config.far_px);
        let predicted = motion.predicted();
        let near = if predicted.is_some() { now.config.near_px } else { far };
        self.recognise(now, map, &predicted.unwrap_or(last), near);
        let mut pose = self.resect(now, map);
        if pose.is_none() && near < far {
            self.recognise(now, map, &last, far);
            pose = self.resect(now, map);
        }
        // Where too few have a depth it is a rotation at least; where too few are recognised by their
        // descriptors, pixels may still be where they are expected.
        let mut pose = pose.or_else(|| self.rotated(now, map, last)).or(predicted)?;
        self.matches.clear();
        self.align(now, map, &pose, true);
        // What was recognised says by its pixels more exactly where the others are.
        let solved = self.problem(now.rig.baseline()).solve(pose, Free::All);
        if solved.kept >= 2 * FEWEST && 2 * solved.kept >= self.matches.len() {
            pose = solved.pose;
        }
        self.align(now, map, &pose, false);
        Some(pose)
    }

    /// The matches as a problem of the pose.
    pub fn problem(&self, baseline: T) -> Problem<'_, T> {
        Problem { matches: &self.matches, baseline, doubt: T::ZERO }
    }

    /// Looks for each point's descriptor among the features near its predicted place, as far as it is the
    /// best of both.
    pub fn recognise(
        &mut self,
        now: &Moment<'_, T>,
        map: &mut PointMap<'_, T>,
        pose: &Pose<T>,
        near_px: f32,
    ) {
        let features = now.frame.features.get(..self.partners.len()).unwrap_or(now.frame.features);
        self.partners.fill((Descriptor::BITS + 1, 0));
        for (number, track) in (0_u16..).zip(map.tracks.iter_mut()) {
            track.now = None;
            if !track.used {
                continue;
            }
            let Some(place) = expected(track, now.rig, pose) else { continue };
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
        for (number, track) in (0_u16..).zip(map.tracks.iter_mut()) {
            let Some(at) = track.now else { continue };
            let same = |f: &Feature| f.x_px == at[0] && f.y_px == at[1];
            let own =
                features.iter().zip(self.partners.iter()).find(|(f, partner)| partner.1 == number && same(f));
            match own {
                Some((feature, _)) => track.fresh = feature.descriptor,
                None => track.now = None,
            }
        }
    }

    /// The pose that most of what was recognised agrees with.
    fn resect(&mut self, now: &Moment<'_, T>, map: &PointMap<'_, T>) -> Option<Pose<T>> {
        let mut len = 0;
        let mut landmarks = List { places: self.landmarks, len: &mut len };
        for track in map.tracks.iter().filter(|track| track.used && track.is_deep(0.3)) {
            let Some([x, y]) = track.now else { continue };
            let (a, r) = (track.point.at, T::ONE / track.point.at.z);
            let Ok(pixel) = now.rig.camera.undistort(&Point2::new(T::of(x.into()), T::of(y.into()))) else {
                continue;
            };
            landmarks.push(Landmark { world: Point3::new(a.x * r, a.y * r, r), pixel });
        }
        let config = RobustConfig {
            most_samples: now.config.most_samples.max(1),
            seed: now.config.seed ^ u64::from(now.number),
            ..RobustConfig::new(T::of(RESECTION_PX))
        };
        let found = robust_resection(&landmarks, &now.rig.camera, &config, self.inliers).ok()?;
        (found.inliers >= 10 && 4 * found.inliers >= landmarks.len()).then_some(found.pose)
    }

    /// The rotation that most of what was recognised agrees with, as if all were far away; `None` of too few.
    fn rotated(&mut self, now: &Moment<'_, T>, map: &PointMap<'_, T>, last: Pose<T>) -> Option<Pose<T>> {
        self.matches.clear();
        let sigma = T::of(COARSE_PX) / now.rig.focal();
        for (owner, track) in (0_u16..).zip(map.tracks.iter()) {
            let Some([x, y]) = track.now.filter(|_| track.used) else { continue };
            let Ok(at) = now.rig.camera.unproject(&Point2::new(T::of(x.into()), T::of(y.into()))) else {
                continue;
            };
            let observation = PointObservation { at, in_right: false, sigma };
            self.matches.push(PointMatch { point: track.point, observation, lower_px: 0.0, owner });
        }
        let found = self.problem(now.rig.baseline()).solve(last, Free::Rotation);
        (found.kept >= 2 * FEWEST && 2 * found.kept >= self.matches.len()).then_some(found.pose)
    }

    /// Finds points by their pixels around where the pose puts them, and in the right picture: those that
    /// were recognised, or the others.
    fn align(&mut self, now: &Moment<'_, T>, map: &mut PointMap<'_, T>, pose: &Pose<T>, recognised: bool) {
        let (rig, sigma) = (now.rig, now.sigma());
        for (owner, track) in (0_u16..).zip(map.tracks.iter_mut()) {
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
            let Ok(found) = track.template.align(&now.frame.left, &warp, start, ALIGN_PX) else { continue };
            if found.correlation < CORRELATED {
                continue;
            }
            let place = [found.x_px, found.y_px];
            let pixel = Point2::new(T::of(place[0].into()), T::of(place[1].into()));
            let Ok(observation) = rig.camera.unproject(&pixel) else { continue };
            (track.now, track.correlation) = (Some(place), found.correlation);
            let expected = rig.baseline() * moved.at.z * rig.focal();
            let seen = disparity(now, place, of(expected));
            let [disparity, lower] = seen.unwrap_or([0.0; 2]);
            let third = T::of(disparity.into()) / rig.focal();
            let observation = PointObservation {
                at: Vector3::new(observation.x, observation.y, third),
                in_right: seen.is_some(),
                sigma,
            };
            self.matches.push(PointMatch { point: track.point, observation, lower_px: lower, owner });
        }
    }
}

/// Where a point is expected, px; `None` outside of the picture's half space.
fn expected<T: Real>(track: &Track<T>, rig: &OdometryRig<T>, pose: &Pose<T>) -> Option<[f32; 2]> {
    let moved = track.point.moved(pose)?;
    let pixel = rig.camera.project(&Point3::new(moved.at.x, moved.at.y, T::ONE)).ok()?;
    Some([pixel.x.to_f64() as f32, pixel.y.to_f64() as f32])
}
