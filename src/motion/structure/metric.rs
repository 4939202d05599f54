//! Structure up to scale, and with its scale.

use super::config::{PointState, ViewState};
use crate::geometry::{Real, camera::Pose, two_view::ScaleError};
use crate::motion::bundle::CameraView;
use nalgebra::Point3;

/// Views and points in an unknown unit of length: the images are the same of a scene twice as large, seen
/// from places twice as far apart. The frame is that of the first view of the pair it began with.
#[derive(Debug)]
pub struct Structure<'a, T: Real>(Scene<'a, T>);

/// Structure in metres.
#[derive(Debug)]
pub struct MetricStructure<'a, T: Real>(Scene<'a, T>);

#[derive(Debug)]
struct Scene<'a, T: Real> {
    views: &'a mut [CameraView<T>],
    view_states: &'a [ViewState],
    points: &'a mut [Point3<T>],
    states: &'a [PointState],
}

impl<T: Real> Scene<'_, T> {
    fn pose(&self, view: usize) -> Result<&Pose<T>, ViewState> {
        match self.view_states.get(view).copied().unwrap_or(ViewState::Unknown) {
            ViewState::Registered => self.views.get(view).map(|view| &view.pose).ok_or(ViewState::Unknown),
            other => Err(other),
        }
    }

    fn point(&self, point: usize) -> Result<&Point3<T>, PointState> {
        match self.states.get(point).copied().unwrap_or(PointState::Unknown) {
            PointState::Triangulated => self.points.get(point).ok_or(PointState::Unknown),
            other => Err(other),
        }
    }

    /// All lengths times what brings `units` to `metres`.
    fn scale(&mut self, units: T, metres: T) -> Result<(), ScaleError> {
        if !(metres > T::ZERO && metres.is_finite()) {
            return Err(ScaleError::Length);
        }
        if !(units > T::ZERO && units.is_finite()) {
            return Err(ScaleError::SamePoint);
        }
        let by = metres / units;
        for view in self.views.iter_mut() {
            view.pose = Pose::of_parts(*view.pose.rotation(), view.pose.translation() * by);
        }
        self.points.iter_mut().for_each(|point| point.coords *= by);
        Ok(())
    }
}

impl<'a, T: Real> Structure<'a, T> {
    pub(super) fn new(
        views: &'a mut [CameraView<T>],
        view_states: &'a [ViewState],
        points: &'a mut [Point3<T>],
        states: &'a [PointState],
    ) -> Self {
        Self(Scene { views, view_states, points, states })
    }

    /// Where a view stands, lengths in no known unit; or why that is not known.
    pub fn pose(&self, view: usize) -> Result<&Pose<T>, ViewState> {
        self.0.pose(view)
    }

    /// Where a point is, in no known unit; or why that is not known.
    pub fn point(&self, point: usize) -> Result<&Point3<T>, PointState> {
        self.0.point(point)
    }

    /// The structure in metres, where these two views stand so far apart in truth: a known baseline, or a
    /// step of an odometry.
    pub fn with_baseline(
        mut self,
        (a, b): (usize, usize),
        metres: T,
    ) -> Result<MetricStructure<'a, T>, ScaleError> {
        let units = match (self.pose(a), self.pose(b)) {
            (Ok(a), Ok(b)) => (a.translation() - b.translation()).norm(),
            _ => return Err(ScaleError::Unknown),
        };
        self.0.scale(units, metres)?;
        Ok(MetricStructure(self.0))
    }

    /// The structure in metres, where these two points are so far apart in truth.
    pub fn with_length(
        mut self,
        (a, b): (usize, usize),
        metres: T,
    ) -> Result<MetricStructure<'a, T>, ScaleError> {
        let units = match (self.point(a), self.point(b)) {
            (Ok(a), Ok(b)) => (a - b).norm(),
            _ => return Err(ScaleError::Unknown),
        };
        self.0.scale(units, metres)?;
        Ok(MetricStructure(self.0))
    }
}

impl<T: Real> MetricStructure<'_, T> {
    /// Where a view stands, metres; or why that is not known.
    pub fn pose(&self, view: usize) -> Result<&Pose<T>, ViewState> {
        self.0.pose(view)
    }

    /// Where a point is, metres; or why that is not known.
    pub fn point(&self, point: usize) -> Result<&Point3<T>, PointState> {
        self.0.point(point)
    }
}
