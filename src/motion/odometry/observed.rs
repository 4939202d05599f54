//! Observations of the last frame, for who wants more of it than a pose.

use super::config::OdometryRig;
use super::pose_estimate::PointMatch;
use super::track::Track;
use crate::geometry::Real;
use nalgebra::{Point2, Vector3};

/// A point that the last frame saw.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ObservedPoint<T: Real> {
    /// Place in the odometry's memory, and how often that was given to a point before: together they
    /// name it.
    pub name: (u16, u16),
    /// Where it is seen, px.
    pub pixel: Point2<T>,
    /// Disparity u - u' without the offset of the principal points, px, where the right picture shows
    /// it.
    pub disparity_px: Option<T>,
    /// `(X / Z, Y / Z, 1 / Z)` in this camera's frame, after all that was seen of it.
    pub inverse: Vector3<T>,
}

/// The points that the last frame saw and that agree with its pose, then its new ones.
pub(super) fn observed_points<'a, T: Real>(
    rig: Option<&OdometryRig<T>>,
    tracks: &'a [Track<T>],
    matches: &'a [PointMatch<T>],
) -> impl Iterator<Item = ObservedPoint<T>> + 'a {
    let (focal, baseline) = rig.map_or((T::ONE, T::ZERO), |rig| (rig.focal(), rig.baseline()));
    let point = move |slot: u16, track: &Track<T>, disparity: Option<T>| {
        let [x, y] = track.pixel.map(|x| T::of(x.into()));
        let (name, pixel) = ((slot, track.lives), Point2::new(x, y));
        ObservedPoint { name, pixel, disparity_px: disparity.map(|d| d * focal), inverse: track.point.at }
    };
    let is_seen = |track: &&Track<T>| track.is_followed();
    let followed = matches.iter().filter_map(move |found| {
        let track = tracks.get(usize::from(found.owner)).filter(is_seen).filter(|track| track.seen > 1)?;
        Some(point(found.owner, track, found.observation.in_right.then_some(found.observation.at.z)))
    });
    let fresh = (0_u16..).zip(tracks).filter(move |(_, track)| is_seen(track) && track.seen == 1);
    // Their depths are what the right picture says.
    followed.chain(fresh.map(move |(slot, track)| {
        point(slot, track, (baseline > T::ZERO).then(|| track.point.at.z * baseline))
    }))
}
