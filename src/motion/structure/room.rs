//! The memory of a structure in one place.

use super::config::{Placement, PointState, StructureConfig, StructureError};
use super::grow::{StructureReport, structure};
use super::memory::SceneMemory;
use super::scaled::Structure;
use crate::geometry::{
    Real,
    absolute::Landmark,
    camera::{Camera, Pose},
    two_view::Correspondence,
};
use crate::motion::bundle::{CameraView, Sight, Slot, Term, View, Workspace};
use nalgebra::{Point2, Point3};

/// All that a structure of up to so many views, points and sights is made in, for a `static`.
///
/// ```
/// use stereopsis::motion::structure::StructureRoom;
///
/// static ROOM: StructureRoom<f32, 4, 64, 256> = StructureRoom::new();
/// assert!(StructureRoom::<f32, 4, 64, 256>::bytes() < 24 * 1024);
/// ```
#[derive(Debug)]
pub struct StructureRoom<T: Real, const VIEWS: usize, const POINTS: usize, const SIGHTS: usize> {
    views: [CameraView<T>; VIEWS],
    placements: [Placement; VIEWS],
    points: [Point3<T>; POINTS],
    states: [PointState; POINTS],
    kept: [Sight<T>; SIGHTS],
    matches: [Correspondence<T>; POINTS],
    landmarks: [Landmark<T>; POINTS],
    inliers: [bool; POINTS],
    slots: [Slot<CameraView<T>, T, 6>; VIEWS],
    terms: [Term<T, 6>; VIEWS],
    trial_points: [Point3<T>; POINTS],
    blocks: [[[[T; 6]; 6]; VIEWS]; VIEWS],
}

impl<T: Real, const VIEWS: usize, const POINTS: usize, const SIGHTS: usize>
    StructureRoom<T, VIEWS, POINTS, SIGHTS>
{
    /// Empty.
    pub const fn new() -> Self {
        const { assert!(VIEWS >= 2 && VIEWS <= 1 << 16, "structure is of 2 to 65536 views") };
        const { assert!(POINTS > 0 && SIGHTS > 0, "structure is of points and their sights") };
        let o = T::ZERO;
        let (flat, deep) = (Point2::new(o, o), Point3::new(o, o, o));
        Self {
            views: [CameraView::EMPTY; VIEWS],
            placements: [Placement::Unknown; VIEWS],
            points: [deep; POINTS],
            states: [PointState::Unknown; POINTS],
            kept: [Sight::EMPTY; SIGHTS],
            matches: [Correspondence { first: flat, second: flat }; POINTS],
            landmarks: [Landmark { world: deep, pixel: flat }; POINTS],
            inliers: [false; POINTS],
            slots: [Slot::EMPTY; VIEWS],
            terms: [Term::EMPTY; VIEWS],
            trial_points: [deep; POINTS],
            blocks: [[[[o; 6]; 6]; VIEWS]; VIEWS],
        }
    }

    /// Bytes that it takes.
    pub const fn bytes() -> usize {
        size_of::<Self>()
    }

    /// Finds where these cameras stand, and the points 0 to `points`, from sights sorted by point.
    pub fn find(
        &mut self,
        cameras: &[Camera<T>],
        points: usize,
        sights: &[Sight<T>],
        config: &StructureConfig<T>,
    ) -> Result<(Structure<'_, T>, StructureReport<T>), StructureError> {
        let views = self.views.get_mut(..cameras.len()).ok_or(StructureError::Memory(cameras.len()))?;
        for (view, camera) in views.iter_mut().zip(cameras) {
            *view = CameraView { camera: *camera, pose: Pose::identity() };
        }
        let memory = SceneMemory {
            views,
            placements: self.placements.get_mut(..cameras.len()).unwrap_or(&mut []),
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
        structure(memory, sights, config)
    }
}

impl<T: Real, const VIEWS: usize, const POINTS: usize, const SIGHTS: usize> Default
    for StructureRoom<T, VIEWS, POINTS, SIGHTS>
{
    fn default() -> Self {
        Self::new()
    }
}
