//! The memory of a structure in one place.

use super::config::{PointState, StructureConfig, StructureError, ViewState};
use super::incremental::{StructureReport, structure};
use super::metric::Structure;
use super::workspace_view::StructureWorkspaceView;
use crate::geometry::{
    Real,
    absolute::Landmark,
    camera::{Camera, Pose},
    two_view::Correspondence,
};
use crate::motion::bundle::{CameraView, CrossBlock, Observation, View, ViewSlot, Workspace};
use nalgebra::{Point2, Point3};

/// All that a structure of up to so many views, points and observations is made in, for a `static`.
///
/// ```
/// use stereopsis::motion::structure::StructureWorkspace;
///
/// static ROOM: StructureWorkspace<f32, 4, 64, 256> = StructureWorkspace::new();
/// assert!(StructureWorkspace::<f32, 4, 64, 256>::bytes() < 24 * 1024);
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
    slots: [ViewSlot<CameraView<T>, T, 6>; VIEWS],
    terms: [CrossBlock<T, 6>; VIEWS],
    trial_points: [Point3<T>; POINTS],
    blocks: [[[[T; 6]; 6]; VIEWS]; VIEWS],
}

impl<T: Real, const VIEWS: usize, const POINTS: usize, const OBSERVATIONS: usize>
    StructureWorkspace<T, VIEWS, POINTS, OBSERVATIONS>
{
    /// Empty.
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
            slots: [ViewSlot::EMPTY; VIEWS],
            terms: [CrossBlock::EMPTY; VIEWS],
            trial_points: [deep; POINTS],
            blocks: [[[[o; 6]; 6]; VIEWS]; VIEWS],
        }
    }

    /// Bytes that it takes.
    pub const fn bytes() -> usize {
        size_of::<Self>()
    }

    /// Finds where these cameras stand, and the points 0 to `points`, from observations sorted by point.
    pub fn find(
        &mut self,
        cameras: &[Camera<T>],
        points: usize,
        observations: &[Observation<T>],
        config: &StructureConfig<T>,
    ) -> Result<(Structure<'_, T>, StructureReport<T>), StructureError> {
        let views = self.views.get_mut(..cameras.len()).ok_or(StructureError::Memory(cameras.len()))?;
        for (view, camera) in views.iter_mut().zip(cameras) {
            *view = CameraView { camera: *camera, pose: Pose::identity() };
        }
        let memory = StructureWorkspaceView {
            views,
            view_states: self.view_states.get_mut(..cameras.len()).unwrap_or(&mut []),
            points: self.points.get_mut(..points).ok_or(StructureError::Memory(points))?,
            states: &mut self.states,
            kept: &mut self.kept,
            matches: &mut self.matches,
            landmarks: &mut self.landmarks,
            inliers: &mut self.inliers,
            workspace: Workspace {
                slots: &mut self.slots,
                terms: &mut self.terms,
                trial_points: &mut self.trial_points,
                blocks: self.blocks.as_flattened_mut(),
            },
        };
        structure(memory, observations, config)
    }
}

impl<T: Real, const VIEWS: usize, const POINTS: usize, const OBSERVATIONS: usize> Default
    for StructureWorkspace<T, VIEWS, POINTS, OBSERVATIONS>
{
    fn default() -> Self {
        Self::new()
    }
}
