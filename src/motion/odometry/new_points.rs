//! New points, where there are none.

use super::config::OdometryRig;
use super::engine::Odometry;
use super::frame::Frame;
use super::inverse_depth::InversePoint;
use super::track::{Track, UPRIGHT};
use super::tracking::{ALIKE, disparity};
use crate::features::{Feature, Template};
use crate::geometry::Real;
use nalgebra::{Matrix3, Point2, Vector3};

/// By how much the best place along a row has to be more alike than any other, of what is missing to one.
const CLEAR: f32 = 0.8;

impl<T: Real, const N: usize> Odometry<T, N> {
    /// Makes points of features that are far enough from all others, as long as there is room.
    pub(super) fn add_new_points(&mut self, rig: &OdometryRig<T>, frame: &Frame<'_>) {
        let usual = self.usual_depth().unwrap_or(T::of(0.1));
        let features = frame.features;
        let count = features.len();
        // From all over the picture, for there may not be room for all: steps near the golden ratio.
        let stride = stride(count);
        let mut at = 0;
        for _ in 0..count {
            at = (at + stride) % count.max(1);
            let Some(feature) = features.get(at) else { break };
            let place = [feature.x_px, feature.y_px];
            let spacing = self.config.spacing_px;
            let near = |t: &Track<T>| {
                (t.pixel[0] - place[0]).abs() < spacing && (t.pixel[1] - place[1]).abs() < spacing
            };
            if self.tracks.iter().any(|track| track.used && near(track)) {
                continue;
            }
            let most = self.config.most_disparity_px;
            let sigma = T::of(self.config.sigma_px.into()) / rig.focal();
            let Some(track) = self.tracks.iter_mut().find(|track| !track.used) else { break };
            if let Some(fresh) = fresh(rig, frame, feature, most, usual, sigma) {
                *track = Track { lives: track.lives.wrapping_add(1), ..fresh };
            }
        }
    }
}

fn fresh<T: Real>(
    rig: &OdometryRig<T>,
    frame: &Frame<'_>,
    feature: &Feature,
    most: u16,
    usual: T,
    sigma: T,
) -> Option<Track<T>> {
    let pixel = [feature.x_px, feature.y_px];
    let template = Template::cut(&frame.left, pixel[0], pixel[1]).ok()?;
    let observation =
        rig.camera.unproject(&Point2::new(T::of(pixel[0].into()), T::of(pixel[1].into()))).ok()?;
    let point = match rig.right {
        None => super::engine::unknown(observation, usual, sigma),
        Some((baseline, right_cx)) => {
            let offset = (right_cx - rig.camera.principal_point().0).to_f64() as f32;
            let here = pixel[0] + offset;
            let row = (pixel[1] + 0.5) as usize;
            let (least, last) = ((here - f32::from(most)).max(0.0) as usize, (here + 2.0).max(0.0) as usize);
            let along = template.match_row(&frame.right?, row, least, last).ok()?;
            let clear = 1.0 - along.correlation < CLEAR * (1.0 - along.elsewhere);
            if along.correlation < ALIKE || !clear {
                return None;
            }
            let disparity = disparity(rig, frame, pixel, here - along.x_px)?;
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
        warp: UPRIGHT,
        correlation: 1.0,
        seen: 1,
        used: true,
        ..Track::EMPTY
    })
}

/// A step that meets all numbers below `n` before it meets one again.
fn stride(n: usize) -> usize {
    let start = (n as u64 * 159 / 257).max(1) as usize;
    let common = |mut a: usize, mut b: usize| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    (start..n).find(|&step| common(step, n) == 1).unwrap_or(1)
}
