//! The map: points by inverse depth in the frame of the camera, updated and added with each frame.

use super::disparity::{CORRELATED, disparity};
use super::frame::Moment;
use super::inverse_depth::InversePoint;
use super::pose_estimate::{PointMatch, Problem, WIDTH};
use super::track::{Track, product};
use crate::features::{Feature, Template};
use crate::geometry::{Real, camera::Pose, robust::stride};
use nalgebra::{Matrix3, Matrix6, Point2, Point3, Vector3};

/// Frames in which a point is missed, or disagrees, before it is dropped.
const MISSED: u8 = 4;
const WRONG: u8 = 2;
/// Templates are cut anew when they look so much larger or smaller, or so little like they did.
const GROWN: [f32; 2] = [0.6, 1.6];
const LEAST_CORRELATION: f32 = 0.9;
/// Largest ratio, of the best place along a row to any other, of what a correlation lacks to 1.
const CLEAR: f32 = 0.8;

/// Points in the frame of the camera, as many as there are places.
#[derive(Debug)]
pub(super) struct PointMap<'a, T: Real> {
    pub tracks: &'a mut [Track<T>],
}

impl<T: Real> PointMap<'_, T> {
    /// Forgets all points.
    pub fn clear(&mut self) {
        self.tracks.iter_mut().for_each(|track| track.used = false);
    }

    /// How many points are followed.
    // Unrolled at every call it takes a kilobyte of flash each time.
    #[inline(never)]
    pub fn len(&self) -> usize {
        self.tracks.iter().filter(|track| track.used).count()
    }

    /// The points that are followed.
    pub fn used_mut(&mut self) -> impl Iterator<Item = &mut Track<T>> {
        self.tracks.iter_mut().filter(|track| track.used)
    }

    /// Updates the points by what was seen of them from `pose`, and moves them into the frame of the camera
    /// there; `of_pose` is the covariance of that pose.
    pub fn update(
        &mut self,
        now: &Moment<'_, T>,
        matches: &[PointMatch<T>],
        pose: &Pose<T>,
        of_pose: &Matrix6<T>,
    ) {
        let most = T::of(WIDTH * WIDTH);
        let (rig, baseline) = (now.rig, now.rig.baseline());
        for point_match in matches {
            let Some(track) = self.tracks.get_mut(usize::from(point_match.owner)) else { continue };
            let squared = Problem { matches: &[], baseline, doubt: T::ZERO }.squared(pose, point_match);
            match squared
                .filter(|&d| d < most)
                .and_then(|_| track.point.updated(pose, &point_match.observation, baseline))
            {
                Some(point) => {
                    track.point = point;
                    track.wrong = 0;
                }
                None => {
                    track.wrong += 1;
                    track.now = None;
                }
            }
        }
        let (fx, fy) = rig.camera.focal_px();
        let ratio = (fx / fy).to_f64() as f32;
        for track in self.tracks.iter_mut().filter(|track| track.used) {
            let Some(moved) = track.point.moved(pose) else {
                track.used = false;
                continue;
            };
            let Some(point) = track.point.carried(pose, of_pose) else { continue };
            track.point = point;
            let of = |x: T| x.to_f64() as f32;
            let by = &moved.by_point;
            let step = [[of(by.m11), of(by.m12) * ratio], [of(by.m21) / ratio, of(by.m22)]];
            track.warp = product(&step, &track.warp);
            match track.now.take() {
                Some(pixel) => {
                    track.pixel = pixel;
                    track.seen = track.seen.saturating_add(1);
                    track.missed = 0;
                    let [[a, b], [c, d]] = track.warp;
                    let grown = (a * d - b * c).abs();
                    let fits = grown > GROWN[0] && grown < GROWN[1] && track.correlation > LEAST_CORRELATION;
                    if !fits && let Ok(template) = Template::cut(&now.frame.left, pixel[0], pixel[1]) {
                        track.template = template;
                        track.warp = Template::UPRIGHT;
                    }
                }
                None => {
                    track.missed += 1;
                    if let Ok(pixel) = rig.camera.project(&Point3::new(point.at.x, point.at.y, T::ONE)) {
                        track.pixel = [of(pixel.x), of(pixel.y)];
                    }
                }
            }
            let [x, y] = track.pixel;
            let (width, height) = (now.frame.left.width() as f32, now.frame.left.height() as f32);
            let outside = !(x > 0.0 && y > 0.0 && x < width && y < height);
            if track.missed > MISSED || track.wrong > WRONG || outside {
                track.used = false;
            }
        }
    }

    /// Makes points of features that are far enough from all others, as long as there is space.
    pub fn add_new(&mut self, now: &Moment<'_, T>) {
        let usual_inverse = self.usual_inverse_depth().unwrap_or(T::of(0.1));
        let features = now.frame.features;
        let count = features.len();
        // From all over the picture, for there may not be room for all: steps near the golden ratio.
        let stride = stride(count);
        let mut at = 0;
        for _ in 0..count {
            at = (at + stride) % count.max(1);
            let Some(feature) = features.get(at) else { break };
            let place = [feature.x_px, feature.y_px];
            let spacing = now.config.spacing_px;
            let near = |t: &Track<T>| {
                (t.pixel[0] - place[0]).abs() < spacing && (t.pixel[1] - place[1]).abs() < spacing
            };
            if self.tracks.iter().any(|track| track.used && near(track)) {
                continue;
            }
            let Some(track) = self.tracks.iter_mut().find(|track| !track.used) else { break };
            if let Some(fresh) = new_track(now, feature, usual_inverse) {
                *track = Track { lives: track.lives.wrapping_add(1), ..fresh };
            }
        }
    }

    /// The median of the inverse depths that are known.
    fn usual_inverse_depth(&self) -> Option<T> {
        // By halves of a range, for there is nowhere to sort.
        let deep = || {
            self.tracks.iter().filter(|track| track.used && track.is_deep(0.3)).map(|track| track.point.at.z)
        };
        let count = deep().count();
        if count < 4 {
            return None;
        }
        let below = |limit: T| deep().filter(|&r| r < limit).count();
        let (mut least, mut most) = (T::ZERO, deep().fold(T::ZERO, |most, r| most.max(r)));
        for _ in 0..24 {
            let middle = (least + most) * T::of(0.5);
            if 2 * below(middle) < count {
                least = middle;
            } else {
                most = middle;
            }
        }
        Some(most)
    }
}

/// A new point: of a pair with the depth that the right picture says, of one camera of unknown depth.
fn new_track<T: Real>(now: &Moment<'_, T>, feature: &Feature, usual_inverse: T) -> Option<Track<T>> {
    let (rig, frame, sigma) = (now.rig, now.frame, now.sigma());
    let pixel = [feature.x_px, feature.y_px];
    let template = Template::cut(&frame.left, pixel[0], pixel[1]).ok()?;
    let observation =
        rig.camera.unproject(&Point2::new(T::of(pixel[0].into()), T::of(pixel[1].into()))).ok()?;
    let point = match rig.right {
        None => InversePoint::of_unknown_depth(&observation, usual_inverse, sigma),
        Some((baseline, right_cx)) => {
            let offset = (right_cx - rig.camera.principal_point().0).to_f64() as f32;
            let here = pixel[0] + offset;
            let [_, lower] = rig.correction_px([here, pixel[1]]);
            let row = (pixel[1] + lower + 0.5).max(0.0) as usize;
            let (least, last) = (
                (here - f32::from(now.config.most_disparity_px)).max(0.0) as usize,
                (here + 2.0).max(0.0) as usize,
            );
            let along = template.match_row(&frame.right?, row, least, last).ok()?;
            let clear = 1.0 - along.correlation < CLEAR * (1.0 - along.elsewhere);
            if along.correlation < CORRELATED || !clear {
                return None;
            }
            let [correction, _] = rig.correction_px([along.x_px, pixel[1]]);
            let [disparity, _] = disparity(now, pixel, here - along.x_px + correction)?;
            let r = T::of(disparity.into()) / (rig.focal() * baseline);
            let variance = sigma * sigma;
            let of_depth = variance / (baseline * baseline);
            let covariance = Matrix3::from_diagonal(&Vector3::new(variance, variance, of_depth));
            InversePoint { at: Vector3::new(observation.x, observation.y, r), covariance }
        }
    };
    Some(Track {
        point,
        template,
        descriptor: feature.descriptor,
        pixel,
        warp: Template::UPRIGHT,
        correlation: 1.0,
        seen: 1,
        used: true,
        ..Track::EMPTY
    })
}
