//! The workspace of structure from motion: owned for a `static`, and the view of it that the algorithm takes.

use super::config::{PointState, StructureError, ViewState};
use crate::geometry::{
    Real,
    absolute::Landmark,
    camera::{Camera, Pose},
    two_view::Correspondence,
};
use crate::motion::bundle::{BundleWorkspace, BundleWorkspaceView, CameraView, Observation, View};
use nalgebra::{Point2, Point3};

/// The memory of structure from motion for up to so many views, points and observations, for a `static`.
///
/// ```
/// use stereopsis::motion::structure::StructureWorkspace;
///
/// static WORKSPACE: StructureWorkspace<f32, 4, 64, 256> = StructureWorkspace::new();
/// assert!(size_of::<StructureWorkspace<f32, 4, 64, 256>>() < 24 * 1024);
/// ```
#[derive(Debug)]
pub struct StructureWorkspace<T: Real, const VIEWS: usize, const POINTS: usize, const OBSERVATIONS: usize> {
    views: [CameraView<T>; VIEWS],
    view_states: [ViewState; VIEWS],
    points: [Point3<T>; POINTS],
    states: [PointState; POINTS],
    kept: [Observation<T>; OBSERVATIONS],
    matches: [Correspondence<T>; POINTS],
    landmarks: [Landmark<T>; POINTS],
    inliers: [bool; POINTS],
    bundle: BundleWorkspace<CameraView<T>, T, 6, VIEWS, POINTS>,
}

/// A borrowed [`StructureWorkspace`] of any size, or slices of the caller's own, for m views, n points and s
/// observations. The views' cameras are given in it; everything else is overwritten.
#[derive(Debug)]
pub struct StructureWorkspaceView<'a, T: Real> {
    /// The cameras: m. Their poses come out.
    pub views: &'a mut [CameraView<T>],
    /// What is known of each view: m.
    pub view_states: &'a mut [ViewState],
    /// The points: n.
    pub points: &'a mut [Point3<T>],
    /// What is known of each point: n.
    pub states: &'a mut [PointState],
    /// The inliers among the observations: s.
    pub kept: &'a mut [Observation<T>],
    /// The correspondences of two views: n.
    pub matches: &'a mut [Correspondence<T>],
    /// The triangulated points that a view sees: n.
    pub landmarks: &'a mut [Landmark<T>],
    /// The inliers of a robust estimate: n.
    pub inliers: &'a mut [bool],
    /// The workspace of the bundle adjustment: as [`WorkspaceSize`](crate::motion::bundle::WorkspaceSize)
    /// says for all observations.
    pub bundle: BundleWorkspaceView<'a, CameraView<T>, T, 6>,
}

impl<T: Real, const VIEWS: usize, const POINTS: usize, const OBSERVATIONS: usize>
    StructureWorkspace<T, VIEWS, POINTS, OBSERVATIONS>
{
    /// A workspace that is not in use.
    pub const fn new() -> Self {
        const { assert!(VIEWS >= 2 && VIEWS <= 1 << 16, "structure is of 2 to 65536 views") };
        const { assert!(POINTS > 0 && OBSERVATIONS > 0, "structure is of points and their observations") };
        let o = T::ZERO;
        let (flat, deep) = (Point2::new(o, o), Point3::new(o, o, o));
        Self {
            views: [CameraView::EMPTY; VIEWS],
            view_states: [ViewState::Unknown; VIEWS],
            points: [deep; POINTS],
            states: [PointState::Unknown; POINTS],
            kept: [Observation::EMPTY; OBSERVATIONS],
            matches: [Correspondence { first: flat, second: flat }; POINTS],
            landmarks: [Landmark { world: deep, pixel: flat }; POINTS],
            inliers: [false; POINTS],
            bundle: BundleWorkspace::EMPTY,
        }
    }

    /// The view of the workspace for these cameras and the points 0 to `points`, which
    /// [`structure()`](super::structure()) takes.
    pub fn as_mut_view(
        &mut self,
        cameras: &[Camera<T>],
        points: usize,
    ) -> Result<StructureWorkspaceView<'_, T>, StructureError> {
        let m = cameras.len();
        let views = self.views.get_mut(..m).ok_or(StructureError::Memory(m))?;
        for (view, camera) in views.iter_mut().zip(cameras) {
            *view = CameraView { camera: *camera, pose: Pose::identity() };
        }
        Ok(StructureWorkspaceView {
            views,
            view_states: self.view_states.get_mut(..m).unwrap_or(&mut []),
            points: self.points.get_mut(..points).ok_or(StructureError::Memory(points))?,
            states: &mut self.states,
            kept: &mut self.kept,
            matches: &mut self.matches,
            landmarks: &mut self.landmarks,
            inliers: &mut self.inliers,
            bundle: self.bundle.as_mut_view(),
        })
    }
}

impl<T: Real> StructureWorkspaceView<'_, T> {
    /// The length that is missing somewhere, if one is.
    pub(super) fn missing(&self, observations: usize) -> Option<usize> {
        let (views, points) = (self.views.len(), self.points.len());
        let short = [self.states.len(), self.matches.len(), self.landmarks.len(), self.inliers.len()];
        if self.view_states.len() < views {
            Some(views)
        } else if short.iter().any(|&len| len < points) {
            Some(points)
        } else if self.kept.len() < observations {
            Some(observations)
        } else {
            None
        }
    }
}

impl<T: Real, const VIEWS: usize, const POINTS: usize, const OBSERVATIONS: usize> Default
    for StructureWorkspace<T, VIEWS, POINTS, OBSERVATIONS>
{
    fn default() -> Self {
        Self::new()
    }
}
