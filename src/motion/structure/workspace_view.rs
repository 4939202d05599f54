//! What a structure is made in.

use super::config::{PointState, ViewState};
use crate::geometry::{Real, absolute::Landmark, two_view::Correspondence};
use crate::motion::bundle::{CameraView, Observation, Workspace};
use nalgebra::Point3;

/// Memory for m views, n points and s observations, the owner's. The views' cameras are given in it;
/// everything else is overwritten.
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
    /// The observations that agree with views and points: s.
    pub kept: &'a mut [Observation<T>],
    /// What two views have in common: n.
    pub matches: &'a mut [Correspondence<T>],
    /// What a view sees of known points: n.
    pub landmarks: &'a mut [Landmark<T>],
    /// Which of those agree: n.
    pub inliers: &'a mut [bool],
    /// For the adjustment: as [`Need`](crate::motion::bundle::WorkspaceSize) says for all observations.
    pub workspace: Workspace<'a, CameraView<T>, T, 6>,
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
