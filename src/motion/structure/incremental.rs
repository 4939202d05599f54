//! Incremental structure from motion: initial pair, resection, triangulation, bundle adjustment.

use super::config::{InitialPairError, PointState, StructureConfig, StructureError, ViewState};
use super::initial_pair::{Pair, pair};
use super::metric::Structure;
use super::triangulation::{agreeing, triangulate};
use super::workspace::StructureWorkspaceView;
use crate::geometry::{
    Real,
    absolute::Landmark,
    camera::{Camera, Lens, Pose},
    robust::{RobustConfig, robust_resection},
    two_view::Correspondence,
};
use crate::motion::bundle::{BundleConfig, BundleReport, Gauge, Loss, Observation, Problem, adjust, tracks};
use nalgebra::Point2;

/// Known points that a view must see.
const FEWEST_LANDMARKS: usize = 6;

/// How a structure was found.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StructureReport<T> {
    /// The two views that it began with: the first is the frame, their distance was the unit of length.
    pub pair: (u16, u16),
    /// Whether what those two have in common is on a plane: their pose is by its homography.
    pub plane: bool,
    /// Views that stand somewhere.
    pub views: usize,
    /// Points that are known.
    pub points: usize,
    /// Observations that agree with them.
    pub observations: usize,
    /// The last adjustment; its cost is half the sum of Huber's loss, px^2.
    pub bundle: BundleReport<T>,
}

/// Finds views and points from observations of which some are wrong (sorted by point, px with the lens's
/// distortion).
///
/// Bounded: robust estimates for all pairs of views, then at most one resection, one triangulation of every
/// point and one adjustment for every view.
pub fn structure<'a, T: Real>(
    mut memory: StructureWorkspaceView<'a, T>,
    observations: &[Observation<T>],
    config: &StructureConfig<T>,
) -> Result<(Structure<'a, T>, StructureReport<T>), StructureError> {
    let positive = |x: T| x > T::ZERO && x.is_finite();
    if !(positive(config.threshold_px) && positive(config.min_angle_rad) && config.most_samples > 0) {
        return Err(StructureError::Config);
    }
    if memory.views.len() < 2 {
        return Err(StructureError::Views);
    }
    if let Some(needed) = memory.missing(observations.len()) {
        return Err(StructureError::Memory(needed));
    }
    let StructureWorkspaceView { views, points, .. } = &mut memory;
    Problem { views, points, observations }.check().map_err(StructureError::Bundle)?;
    memory.view_states.fill(ViewState::Unknown);
    memory.states.fill(PointState::Unknown);
    let (first, second, found) = best_pair(&mut memory, observations, config)?;
    place(&mut memory, first, Pose::identity());
    place(&mut memory, second, found.pose.in_baselines());
    let gauge = Gauge::Baseline { held: first, other: second };
    let mut bundle = settle(&mut memory, observations, config, &gauge)?;
    for _ in 2..memory.views.len() {
        if !next_view(&mut memory, observations, config) {
            break;
        }
        bundle = settle(&mut memory, observations, config, &gauge)?;
    }
    let kept = keep(&mut memory, observations, config.threshold_px);
    let report = StructureReport {
        pair: (first, second),
        plane: found.plane,
        views: memory.view_states.iter().filter(|&&p| p == ViewState::Registered).count(),
        points: memory.states.iter().filter(|&&s| s == PointState::Triangulated).count(),
        observations: kept,
        bundle,
    };
    let StructureWorkspaceView { views, view_states, points, states, .. } = memory;
    Ok((Structure::new(views, view_states, points, states), report))
}

fn place<T: Real>(memory: &mut StructureWorkspaceView<'_, T>, at: u16, pose: Pose<T>) {
    let at = usize::from(at);
    if let (Some(view), Some(placement)) = (memory.views.get_mut(at), memory.view_states.get_mut(at)) {
        view.pose = pose;
        *placement = ViewState::Registered;
    }
}

/// The camera without its lens.
fn pinhole<T: Real>(camera: &Camera<T>) -> Camera<T> {
    // No lens is always one.
    camera.with_distortion(Lens::NONE).unwrap_or(*camera)
}

/// A view's observation without its lens.
fn undistorted<T: Real>(
    memory: &StructureWorkspaceView<'_, T>,
    observation: &Observation<T>,
) -> Option<Point2<T>> {
    memory.views.get(usize::from(observation.view))?.camera.undistort(&observation.pixel).ok()
}

/// The pair with most points at an angle.
fn best_pair<T: Real>(
    memory: &mut StructureWorkspaceView<'_, T>,
    observations: &[Observation<T>],
    config: &StructureConfig<T>,
) -> Result<(u16, u16, Pair<T>), StructureError> {
    let mut best: Option<(u16, u16, Pair<T>)> = None;
    let mut worst = (0, InitialPairError::TooFew);
    let views = memory.views.len().min(usize::from(u16::MAX)) as u16;
    for second in 1..views {
        for first in 0..second {
            let mut count = 0;
            for track in tracks(observations) {
                let of = |view: u16| track.iter().find(|observation| observation.view == view);
                let (Some(a), Some(b)) = (of(first), of(second)) else { continue };
                let (Some(a), Some(b)) = (undistorted(memory, a), undistorted(memory, b)) else { continue };
                if let Some(slot) = memory.matches.get_mut(count) {
                    *slot = Correspondence { first: a, second: b };
                    count += 1;
                }
            }
            let camera = |at: u16| memory.views.get(usize::from(at)).map(|view| pinhole(&view.camera));
            let (Some(a), Some(b)) = (camera(first), camera(second)) else { continue };
            let seen = memory.matches.get_mut(..count).unwrap_or(&mut []);
            match pair(&a, &b, seen, memory.inliers, config) {
                Ok(found) if best.as_ref().is_none_or(|(_, _, old)| found.angled > old.angled) => {
                    best = Some((first, second, found));
                }
                Ok(_) => {}
                Err(fault) if count >= worst.0 => worst = (count, fault),
                Err(_) => {}
            }
        }
    }
    best.ok_or(StructureError::NoPair(worst.1))
}

/// Triangulates all points anew, and adjusts what agrees.
fn settle<T: Real>(
    memory: &mut StructureWorkspaceView<'_, T>,
    observations: &[Observation<T>],
    config: &StructureConfig<T>,
    gauge: &Gauge,
) -> Result<BundleReport<T>, StructureError> {
    for track in tracks(observations) {
        let at = track.first().map_or(0, |observation| observation.point as usize);
        let (Some(point), Some(state)) = (memory.points.get_mut(at), memory.states.get_mut(at)) else {
            continue;
        };
        let view_states = &*memory.view_states;
        let placed = move |observation: &Observation<T>| {
            view_states.get(usize::from(observation.view)) == Some(&ViewState::Registered)
        };
        let track = track.iter().copied().filter(placed);
        match triangulate(memory.views, track, config.threshold_px, config.min_angle_rad) {
            Ok(found) => (*point, *state) = (found, PointState::Triangulated),
            Err(why) => *state = why,
        }
    }
    let kept = keep(memory, observations, config.threshold_px);
    let StructureWorkspaceView { views, points, kept: slice, bundle, .. } = memory;
    let observations = slice.get(..kept).unwrap_or(&[]);
    let mut problem = Problem { views, points, observations };
    let loss = Loss::Huber(config.threshold_px * T::of(0.5));
    let config = BundleConfig { loss, ..BundleConfig::new(gauge.clone()) };
    adjust(&mut problem, bundle, config).map_err(StructureError::Bundle)
}

/// Collects the observations that agree; how many they are.
fn keep<T: Real>(
    memory: &mut StructureWorkspaceView<'_, T>,
    observations: &[Observation<T>],
    threshold_px: T,
) -> usize {
    let mut kept = 0;
    for track in tracks(observations) {
        let at = track.first().map_or(0, |observation| observation.point as usize);
        let (Some(point), Some(PointState::Triangulated)) = (memory.points.get(at), memory.states.get(at))
        else {
            continue;
        };
        let view_states = &*memory.view_states;
        let placed = move |observation: &Observation<T>| {
            view_states.get(usize::from(observation.view)) == Some(&ViewState::Registered)
        };
        for observation in agreeing(memory.views, track.iter().copied().filter(placed), point, threshold_px) {
            if let Some(slot) = memory.kept.get_mut(kept) {
                *slot = observation;
                kept += 1;
            }
        }
    }
    kept
}

/// Places the view that sees most known points; whether there was one to try.
fn next_view<T: Real>(
    memory: &mut StructureWorkspaceView<'_, T>,
    observations: &[Observation<T>],
    config: &StructureConfig<T>,
) -> bool {
    let known = |memory: &StructureWorkspaceView<'_, T>, observation: &Observation<T>| {
        memory.states.get(observation.point as usize) == Some(&PointState::Triangulated)
    };
    let (mut most, mut next) = (0, None);
    for at in 0..memory.views.len() {
        if !matches!(memory.view_states.get(at), Some(ViewState::Unknown | ViewState::TooFew)) {
            continue;
        }
        let count = observations.iter().filter(|s| usize::from(s.view) == at && known(memory, s)).count();
        if count < FEWEST_LANDMARKS {
            if let Some(placement) = memory.view_states.get_mut(at) {
                *placement = ViewState::TooFew;
            }
        } else if count > most {
            (most, next) = (count, Some(at));
        }
    }
    let Some(next) = next else { return false };
    let mut count = 0;
    for observation in observations.iter().filter(|observation| usize::from(observation.view) == next) {
        let Some(pixel) = undistorted(memory, observation) else { continue };
        if !known(memory, observation) {
            continue;
        }
        let point = memory.points.get(observation.point as usize).copied();
        if let (Some(world), Some(slot)) = (point, memory.landmarks.get_mut(count)) {
            *slot = Landmark { world, pixel };
            count += 1;
        }
    }
    let landmarks = memory.landmarks.get(..count).unwrap_or(&[]);
    let robust = RobustConfig {
        most_samples: config.most_samples,
        seed: config.seed,
        ..RobustConfig::new(config.threshold_px)
    };
    let camera = memory.views.get(next).map(|view| pinhole(&view.camera));
    let found = camera.and_then(|camera| robust_resection(landmarks, &camera, &robust, memory.inliers).ok());
    match found.filter(|found| found.inliers >= FEWEST_LANDMARKS) {
        Some(found) => place(memory, next as u16, found.pose),
        None => {
            if let Some(placement) = memory.view_states.get_mut(next) {
                *placement = ViewState::NoAgreement;
            }
        }
    }
    true
}
