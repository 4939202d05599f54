//! Where views stand and where points are.

use super::link::Links;
use nalgebra::{Point2, Point3};
use stereopsis::geometry::{
    absolute::Landmark,
    camera::{Camera, Pose},
    two_view::{Correspondence, ScaleError},
};
use stereopsis::motion::bundle::{BundleWorkspaceView, CameraView, CrossBlock, Observation, View, ViewSlot};
use stereopsis::motion::structure::{
    PointState, StructureConfig, StructureError, StructureReport, StructureWorkspaceView, ViewState,
    structure,
};

/// The distance of two views, which is known, metres.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Length {
    /// The views.
    pub views: (usize, usize),
    /// How far they are apart.
    pub metres: f64,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Found {
    /// The poses, or why there is none.
    pub poses: Vec<Result<Pose<f64>, ViewState>>,
    /// The points, in the order of their numbers, or why there is none.
    pub points: Vec<Result<Point3<f64>, PointState>>,
    /// The observations that agree with them: root mean square of what is left, px.
    pub rms_px: f64,
    /// How.
    pub report: StructureReport<f64>,
}

/// Why there is nothing.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// No structure.
    #[error(transparent)]
    Structure(#[from] StructureError),
    /// One of the two views whose distance is known stands nowhere.
    #[error("view {0} stands nowhere, and the known distance is its own")]
    Unplaced(usize),
    /// The length is none.
    #[error(transparent)]
    Scale(#[from] ScaleError),
}

/// Views and points from what one camera saw in `views` places; in metres where a length is known, else in
/// distances of the two views that it began with.
pub fn solve(
    camera: &Camera<f64>,
    views: usize,
    links: &Links,
    threshold_px: f64,
    length: Option<Length>,
) -> Result<Found, SolveError> {
    let (n, observations) = (links.points, links.observations.as_slice());
    let mut places = vec![CameraView { camera: *camera, pose: Pose::identity() }; views];
    let (mut placements, mut states) = (vec![ViewState::Unknown; views], vec![PointState::Unknown; n]);
    let (mut points, mut kept) = (vec![Point3::origin(); n], vec![Observation::EMPTY; observations.len()]);
    let mut matches = vec![Correspondence::new(0.0, 0.0, 0.0, 0.0); n];
    let mut landmarks = vec![Landmark { world: Point3::origin(), pixel: Point2::origin() }; n];
    let mut inliers = vec![false; n];
    let memory = StructureWorkspaceView {
        views: &mut places,
        view_states: &mut placements,
        points: &mut points,
        states: &mut states,
        kept: &mut kept,
        matches: &mut matches,
        landmarks: &mut landmarks,
        inliers: &mut inliers,
        bundle: BundleWorkspaceView {
            slots: &mut vec![ViewSlot::EMPTY; views],
            terms: &mut vec![CrossBlock::EMPTY; views],
            trial_points: &mut vec![Point3::origin(); n],
            blocks: &mut vec![[[0.0; 6]; 6]; views * (views + 1) / 2],
        },
    };
    let (found, report) = structure(memory, observations, &StructureConfig::new(threshold_px))?;
    let (poses, points) = match length {
        None => (
            (0..views).map(|view| found.pose(view).copied()).collect(),
            (0..n).map(|point| found.point(point).copied()).collect(),
        ),
        Some(Length { views: pair, metres }) => {
            if let Some(view) = [pair.0, pair.1].into_iter().find(|&view| found.pose(view).is_err()) {
                return Err(SolveError::Unplaced(view));
            }
            let found = found.with_baseline(pair, metres)?;
            (
                (0..views).map(|view| found.pose(view).copied()).collect(),
                (0..n).map(|point| found.point(point).copied()).collect(),
            )
        }
    };
    let mut found = Found { poses, points, rms_px: 0.0, report };
    found.rms_px = found.residual(camera, observations, threshold_px);
    Ok(found)
}

impl Found {
    /// The root mean square of the residuals within the threshold, px.
    fn residual(&self, camera: &Camera<f64>, observations: &[Observation<f64>], threshold_px: f64) -> f64 {
        let squared = |observation: &Observation<f64>| {
            let pose = (*self.poses.get(usize::from(observation.view))?).ok()?;
            let point = (*self.points.get(observation.point as usize)?).ok()?;
            let seen = CameraView { camera: *camera, pose }.project(0, &point).ok()?;
            Some((seen - observation.pixel).norm_squared())
                .filter(|&squared| squared <= threshold_px * threshold_px)
        };
        let (sum, count) =
            observations.iter().filter_map(squared).fold((0.0, 0), |(sum, n), x| (sum + x, n + 1));
        (sum / f64::from(count.max(1))).sqrt()
    }

    /// The pose of a view that stands somewhere, in the frame of the first that does.
    pub fn beside_first(&self) -> Vec<Option<Pose<f64>>> {
        let first = self.poses.iter().find_map(|pose| pose.ok());
        let back = first.map_or_else(Pose::identity, |pose| pose.inverse());
        self.poses.iter().map(|pose| pose.ok().map(|pose| back.then(&pose))).collect()
    }

    /// By how much the middle one of the points moves in a camera that goes so far from the first view, px.
    /// `None` of no points.
    pub fn parallax_px(&self, camera: &Camera<f64>, metres: f64) -> Option<f64> {
        let mut away: Vec<_> = self.known().iter().map(|(_, point)| point.coords.norm()).collect();
        away.sort_by(f64::total_cmp);
        away.get(away.len() / 2).map(|middle| camera.focal_px().0 * metres / middle)
    }

    /// The points that are known, with their numbers, in the same frame.
    pub fn known(&self) -> Vec<(u32, Point3<f64>)> {
        let first = self.poses.iter().find_map(|pose| pose.ok()).unwrap_or_else(Pose::identity);
        let known = (0..).zip(&self.points).filter_map(|(number, point)| Some((number, point.ok()?)));
        known.map(|(number, point)| (number, first.inverse_transform(&point))).collect()
    }
}
