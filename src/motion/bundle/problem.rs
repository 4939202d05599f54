//! The bundle adjustment problem: views, points and observations.

use super::gauge::{Freedom, Gauge};
use super::view::View;
use super::workspace::{BundleWorkspaceView, ViewSlot};
use crate::geometry::Real;
use nalgebra::{Point2, Point3};

/// Where a view sees a point.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Observation<T: Real> {
    /// Index of the point.
    pub point: u32,
    /// Index of the view.
    pub view: u16,
    /// Index of the camera in the view: 0, or 1 for the second of a rig.
    pub eye: u16,
    /// Pixel, px.
    pub pixel: Point2<T>,
}

/// Views and points that move until the observations agree with them.
#[derive(Debug)]
pub struct Problem<'a, V, T: Real> {
    /// The views.
    pub views: &'a mut [V],
    /// The points, in the world.
    pub points: &'a mut [Point3<T>],
    /// The observations, those of point 0 first, then those of point 1, and so on.
    pub observations: &'a [Observation<T>],
}

/// Why there is nothing to adjust.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum BundleError {
    /// There is no observation.
    Empty,
    /// This observation names a view that there is not.
    View(usize),
    /// This observation names a point that there is not.
    Point(usize),
    /// This observation stands behind one of a later point.
    Unsorted(usize),
    /// A coordinate of this observation is infinite or not a number.
    NotFinite(usize),
    /// What this observation shows cannot be seen there: the point is behind the camera, or it or the view is
    /// not finite.
    NotSeen(usize),
    /// The gauge names a view that there is not, or one twice, or none, or the views of its baseline are in
    /// one place.
    Gauge,
    /// A tolerance, the damping or the width of the loss is not greater than zero.
    Config,
    /// The workspace is too small; so much is needed.
    Workspace(WorkspaceSize),
}

/// The sizes of a [`BundleWorkspaceView`] for a problem.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WorkspaceSize {
    /// Slots: one for each view.
    pub slots: usize,
    /// Terms.
    pub terms: usize,
    /// Trial points: one for each point.
    pub points: usize,
    /// Blocks of the reduced matrix; not known, and zero, while the other sizes are too small.
    pub blocks: usize,
}

error_text!(BundleError {
    Self::Empty => "there is no observation",
    Self::View(at) => "observation {at} names a camera that there is not",
    Self::Point(at) => "observation {at} names a point that there is not",
    Self::Unsorted(at) => "observation {at} stands behind one of a later point",
    Self::NotFinite(at) => "a coordinate of observation {at} is not finite",
    Self::NotSeen(at) => "the point of observation {at} is not before its camera, or not finite",
    Self::Gauge => "the gauge must name views that there are, a baseline two in different places",
    Self::Config => "tolerances, damping and the loss's width must be greater than zero",
    Self::Workspace(need) =>
        "the workspace needs {} slots, {} terms, {} points and {} blocks"
            (need.slots, need.terms, need.points, need.blocks),
});

impl<T: Real> Observation<T> {
    /// Not in use.
    pub const EMPTY: Self = Self { point: 0, view: 0, eye: 0, pixel: Point2::new(T::ZERO, T::ZERO) };
}

/// The observations of each point in turn.
pub(crate) fn tracks<T: Real>(
    mut observations: &[Observation<T>],
) -> impl Iterator<Item = &[Observation<T>]> {
    // (`chunk_by` leaves a panic in a small program.)
    core::iter::from_fn(move || {
        let point = observations.first()?.point;
        let end = observations
            .iter()
            .position(|observation| observation.point != point)
            .unwrap_or(observations.len());
        let (track, rest) = observations.split_at_checked(end)?;
        observations = rest;
        Some(track)
    })
}

impl<V, T: Real> Problem<'_, V, T> {
    /// Refuses indices and numbers that cannot be.
    pub(crate) fn check(&self) -> Result<(), BundleError> {
        if self.observations.is_empty() {
            return Err(BundleError::Empty);
        }
        let mut last = 0;
        for (at, observation) in self.observations.iter().enumerate() {
            if usize::from(observation.view) >= self.views.len() {
                return Err(BundleError::View(at));
            }
            if observation.point as usize >= self.points.len() {
                return Err(BundleError::Point(at));
            }
            if observation.point < last {
                return Err(BundleError::Unsorted(at));
            }
            last = observation.point;
            if !(observation.pixel.x.is_finite() && observation.pixel.y.is_finite()) {
                return Err(BundleError::NotFinite(at));
            }
        }
        Ok(())
    }

    /// What the gauge lets view `at` do.
    pub(super) fn freedom<const N: usize>(&self, gauge: &Gauge, at: u16) -> Freedom<T>
    where
        V: View<T, N>,
    {
        let pose = |at: u16| self.views.get(usize::from(at)).map(|view| *view.pose());
        let Some(own) = pose(at) else { return Freedom::None };
        gauge.freedom(at, &own, |other| pose(other).unwrap_or(own))
    }
}

/// Checks a problem and lays out the rows of its reduced matrix, or says how much memory is missing.
pub(super) fn prepare<V: View<T, N>, T: Real, const N: usize>(
    problem: &Problem<'_, V, T>,
    gauge: &Gauge,
    workspace: &mut BundleWorkspaceView<'_, V, T, N>,
) -> Result<(), BundleError> {
    problem.check()?;
    let place = |at: u16| problem.views.get(usize::from(at)).map(|view| *view.pose().translation());
    if !gauge.is_sound(problem.views.len()) || !gauge.has_length(place) {
        return Err(BundleError::Gauge);
    }
    let longest = tracks(problem.observations).map(<[_]>::len).max().unwrap_or(0).min(problem.views.len());
    let mut need =
        WorkspaceSize { slots: problem.views.len(), terms: longest, points: problem.points.len(), blocks: 0 };
    let short = workspace.terms.len() < need.terms || workspace.trial_points.len() < need.points;
    let slots = match workspace.slots.get_mut(..need.slots) {
        Some(slots) if !short => slots,
        _ => return Err(BundleError::Workspace(need)),
    };
    for (i, (slot, view)) in slots.iter_mut().zip(problem.views.iter()).enumerate() {
        *slot = ViewSlot { first: i, trial: *view, ..ViewSlot::EMPTY };
    }
    for track in tracks(problem.observations) {
        let least = track.iter().map(|observation| usize::from(observation.view)).min().unwrap_or(0);
        for observation in track {
            if let Some(slot) = slots.get_mut(usize::from(observation.view)) {
                slot.first = slot.first.min(least);
            }
        }
    }
    for (i, slot) in slots.iter_mut().enumerate() {
        slot.offset = need.blocks;
        need.blocks = need.blocks.saturating_add(i - slot.first.min(i) + 1);
    }
    if workspace.blocks.len() < need.blocks { Err(BundleError::Workspace(need)) } else { Ok(()) }
}
