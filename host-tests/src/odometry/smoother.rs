//! The last views of a sequence adjusted together, while the next frames are followed.

use super::rig::{POINTS, Rig};
use super::trajectory::Trajectory;
use std::sync::mpsc::Receiver;
use stereopsis::geometry::camera::Pose;
use stereopsis::motion::odometry::{
    ObservedPoint, OdometryRig, OdometryRigError, Refinement, RefinementConfig, RigEstimate, State, Step,
};

/// Views that are adjusted together at most.
pub const MOST_VIEWS: usize = 12;
/// And when nobody says how many.
pub const VIEWS: usize = 8;

/// What the odometry says.
pub(super) enum Told {
    /// Of the next frame.
    Frame(Box<Followed>),
    /// The frames so far are gone through again.
    Again,
}

/// A frame that was followed.
pub(super) struct Followed {
    pub step: Step<f64>,
    /// How a pair differs from its calibration.
    pub rig: Option<RigEstimate<f64>>,
    pub points: Vec<ObservedPoint<f64>>,
}

type Refined = Refinement<f64, MOST_VIEWS, { 2 * POINTS }, { 4 * POINTS * MOST_VIEWS }>;

/// The last views adjusted together, and which frames they are.
struct Smoother {
    refinement: Box<Refined>,
    frames: Vec<usize>,
}

/// Puts a trajectory together of all that is told, the last `views` frames adjusted together.
pub(super) fn smooth(rig: &Rig, views: usize, told: Receiver<Told>) -> Result<Trajectory, OdometryRigError> {
    let mut smoother = Smoother::start(rig, views)?;
    let mut trajectory = Trajectory::default();
    for told in told {
        match told {
            Told::Frame(frame) => {
                let Followed { step, rig, points } = *frame;
                trajectory.push(step);
                trajectory.rigs.extend(rig);
                if let Some(smoother) = &mut smoother {
                    smoother.take(&step, points, &mut trajectory);
                }
            }
            Told::Again => {
                smoother = Smoother::start(rig, views)?;
                trajectory = Trajectory::default();
            }
        }
    }
    Ok(trajectory)
}

impl Smoother {
    /// `None` of fewer than two views.
    fn start(rig: &Rig, views: usize) -> Result<Option<Self>, OdometryRigError> {
        if views < 2 {
            return Ok(None);
        }
        let rig = match rig {
            Rig::Stereo(rig) => OdometryRig::stereo(rig)?,
            Rig::Mono(camera) => OdometryRig::one(*camera),
        };
        let mut refinement = Box::<Refined>::default();
        refinement.start(&rig, RefinementConfig::new(views));
        Ok(Some(Self { refinement, frames: Vec::new() }))
    }

    /// Takes the trajectory's last frame, and makes it and those before it better.
    fn take(&mut self, step: &Step<f64>, points: Vec<ObservedPoint<f64>>, trajectory: &mut Trajectory) {
        let Some(last) = trajectory.poses.len().checked_sub(1) else { return };
        match step.state {
            State::Tracked | State::Found | State::Uncertain | State::LeftOnly => {}
            // Nothing joins what was before and what comes.
            State::First | State::Restarted => self.refinement.clear(),
            // Where there may have been a step that is not known there is none to adjust.
            State::RotationOnly | State::TranslationUnknown => return self.refinement.clear(),
            _ => return,
        }
        let motion = match (self.refinement.poses(), self.frames.last()) {
            ([], _) | (_, None) => Pose::identity(),
            (_, Some(&before)) => trajectory.poses[before].inverse().then(&trajectory.poses[last]),
        };
        let adjusted = self.refinement.push(&motion, points.into_iter());
        self.frames.push(last);
        // What cannot be adjusted stays as it was told.
        if !matches!(adjusted, Ok(Some(_))) {
            return;
        }
        let poses = self.refinement.poses();
        let frames = &self.frames[self.frames.len() - poses.len()..];
        let base = trajectory.poses[frames[0]];
        for (pair, refined) in frames.windows(2).zip(&poses[1..]) {
            trajectory.refine(pair[0], pair[1], base.then(refined));
        }
    }
}
