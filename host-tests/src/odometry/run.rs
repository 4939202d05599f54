//! A sequence through the core's odometry.

use super::prepared::Prepared;
use super::trajectory::Trajectory;
use crate::correspond::CorrespondError;
use image::GrayImage;
use std::sync::mpsc::{Receiver, sync_channel};
use stereopsis::geometry::camera::{Camera, Pose, RectifiedRig};
use stereopsis::imaging::{Picture, PictureError};
use stereopsis::motion::odometry::{
    Frame, MonocularOdometry, OdometryConfig, OdometryError, OdometryRig, OdometryRigError, Refinement,
    RefinementConfig, RigEstimate, State, Step, StereoOdometry,
};

/// Points that are followed at most.
pub const POINTS: usize = 2048;
/// The odometry is made and moved on the stack.
const STACK: usize = 256 << 20;

/// The cameras.
#[derive(Clone, Copy, Debug)]
pub enum Rig {
    /// A pair with aligned rows.
    Stereo(RectifiedRig),
    /// One camera.
    Mono(Camera<f64>),
}

/// Why there is no trajectory.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError<E: std::error::Error> {
    /// The source of frames failed.
    #[error(transparent)]
    Source(E),
    /// A picture has no features for a reason.
    #[error(transparent)]
    Features(#[from] CorrespondError),
    /// The core took no frame.
    #[error(transparent)]
    Odometry(#[from] OdometryError),
    /// The rig is none.
    #[error(transparent)]
    Rig(#[from] OdometryRigError),
    /// The picture is none.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// The system gave no thread.
    #[error("no thread for the odometry: {0}")]
    Thread(std::io::Error),
}

/// Frames that are prepared before they are asked for.
const AHEAD: usize = 2;

/// How frames are gone through.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct RunConfig {
    /// The last views that are adjusted together, [`MOST_VIEWS`] at most; with fewer than two every pose
    /// stays as it was told.
    pub views: usize,
    /// Whether a pair is corrected by what its points' motion shows, once that is sure. Frames up to the 64th
    /// that came before are then gone through again.
    pub corrects_rig: bool,
}

impl Default for RunConfig {
    fn default() -> Self {
        Self { views: VIEWS, corrects_rig: true }
    }
}

/// Takes frames, left and right, until there is none, and says where the camera stood in each. `told` hears
/// of every frame. The next frames are read, and their features found, by a thread of their own.
pub fn run<E, I>(
    rig: &Rig,
    frames: I,
    config: RunConfig,
    told: impl Fn(&Step<f64>) + Send,
) -> Result<Trajectory, RunError<E>>
where
    E: std::error::Error + Send,
    I: Iterator<Item = Result<(GrayImage, Option<GrayImage>), E>> + Send,
{
    std::thread::scope(|scope| {
        let (sender, receiver) = sync_channel(AHEAD);
        let read = move || {
            let prepared = |frame: Result<_, E>| Ok(Prepared::new(frame.map_err(RunError::Source)?)?);
            // Until the frames end, or nobody waits for one any more.
            let _ = frames.map(prepared).try_for_each(|frame| sender.send(frame));
        };
        let thread = || std::thread::Builder::new().stack_size(STACK);
        thread().spawn_scoped(scope, read).map_err(RunError::Thread)?;
        let work = move || follow(rig, receiver, config, told);
        let work = thread().spawn_scoped(scope, work).map_err(RunError::Thread)?;
        work.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

/// Views that are adjusted together at most.
pub const MOST_VIEWS: usize = 12;
/// And when nobody says how many.
pub const VIEWS: usize = 8;
type Refined = Refinement<f64, MOST_VIEWS, { 2 * POINTS }, { 4 * POINTS * MOST_VIEWS }>;

/// The odometry of either kind.
enum Either {
    Stereo(Box<StereoOdometry<f64, POINTS>>),
    Mono(Box<MonocularOdometry<f64, POINTS>>),
}

impl Either {
    fn start(rig: &Rig, config: OdometryConfig) -> Result<Self, OdometryRigError> {
        match rig {
            Rig::Stereo(rig) => {
                let mut odometry = Box::<StereoOdometry<_, _>>::default();
                odometry.start(rig, config)?;
                Ok(Self::Stereo(odometry))
            }
            Rig::Mono(camera) => {
                let mut odometry = Box::<MonocularOdometry<_, _>>::default();
                odometry.start(*camera, config);
                Ok(Self::Mono(odometry))
            }
        }
    }

    /// How a pair differs from its calibration.
    fn rig(&mut self) -> Option<RigEstimate<f64>> {
        match self {
            Self::Stereo(odometry) => odometry.rig_estimate(),
            Self::Mono(_) => None,
        }
    }

    /// Lengths in metres, or in first baselines.
    fn step(&mut self, frame: &Frame<'_>) -> Result<Step<f64>, OdometryError> {
        match self {
            Self::Stereo(odometry) => odometry.step(frame),
            Self::Mono(odometry) => Ok(*odometry.step(frame)?.in_first_baselines()),
        }
    }
}

/// The last views adjusted together, and which frames they are.
struct Smoother {
    refinement: Box<Refined>,
    frames: Vec<usize>,
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
    fn take(&mut self, odometry: &Either, trajectory: &mut Trajectory) {
        let Some((step, last)) = trajectory.steps.last().zip(trajectory.steps.len().checked_sub(1)) else {
            return;
        };
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
        let adjusted = match odometry {
            Either::Stereo(odometry) => self.refinement.push(&motion, odometry.observed_points()),
            Either::Mono(odometry) => self.refinement.push(&motion, odometry.observed_points()),
        };
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

fn follow<E: std::error::Error>(
    rig: &Rig,
    frames: Receiver<Result<Prepared, RunError<E>>>,
    config: RunConfig,
    told: impl Fn(&Step<f64>),
) -> Result<Trajectory, RunError<E>> {
    let mut begun: Option<Run> = None;
    let mut first = Vec::new();
    for frame in frames {
        let frame = frame?;
        let run = match &mut begun {
            Some(run) => run,
            begun @ None => begun.insert(Run::start(rig, config, &frame.left)?),
        };
        let step = run.take(&frame)?;
        told(&step);
        if run.has_corrected {
            continue;
        }
        first.push(frame);
        if first.len() >= MOST_AGAIN {
            run.again(rig, config, first.drain(..))?;
        }
    }
    let Some(mut run) = begun else { return Ok(Trajectory::default()) };
    if !run.has_corrected {
        run.again(rig, config, first.drain(..))?;
    }
    Ok(run.trajectory)
}

/// Frames that are gone through again at most: by all of them a correction is more exact than by those that
/// it took to be sure.
const MOST_AGAIN: usize = 64;

/// A run under way.
struct Run {
    odometry: Either,
    smoother: Option<Smoother>,
    trajectory: Trajectory,
    /// Whether the first frames have been gone through again, or need not be.
    has_corrected: bool,
}

impl Run {
    fn start(rig: &Rig, run: RunConfig, left: &GrayImage) -> Result<Self, OdometryRigError> {
        // Pictures have at most 4096 columns and rows.
        let RunConfig { views, corrects_rig } = run;
        let config = OdometryConfig { corrects_rig, ..OdometryConfig::new(left.width() as u16) };
        Ok(Self {
            odometry: Either::start(rig, config)?,
            smoother: Smoother::start(rig, views)?,
            trajectory: Trajectory::default(),
            has_corrected: false,
        })
    }

    fn is_corrected(&self) -> bool {
        self.trajectory.rigs.last().is_some_and(|rig| rig.is_applied)
    }

    /// Goes through the first frames again if the pair is corrected.
    fn again<E: std::error::Error>(
        &mut self,
        rig: &Rig,
        config: RunConfig,
        frames: impl Iterator<Item = Prepared>,
    ) -> Result<(), RunError<E>> {
        self.has_corrected = true;
        if !self.is_corrected() {
            return Ok(());
        }
        if let Either::Stereo(odometry) = &mut self.odometry {
            odometry.begin_again();
        }
        self.smoother = Smoother::start(rig, config.views)?;
        self.trajectory = Trajectory::default();
        for frame in frames {
            self.take(&frame)?;
        }
        Ok(())
    }

    fn take<E: std::error::Error>(
        &mut self,
        Prepared { left, right, corners }: &Prepared,
    ) -> Result<Step<f64>, RunError<E>> {
        let (width, height) = (left.width() as u16, left.height() as u16);
        let right = right.as_ref().map(|right| Picture::new(right.as_raw(), width, height)).transpose()?;
        let frame = Frame { left: Picture::new(left.as_raw(), width, height)?, right, features: corners };
        let step = self.odometry.step(&frame)?;
        self.trajectory.push(step);
        self.trajectory.rigs.extend(self.odometry.rig());
        if let Some(smoother) = &mut self.smoother {
            smoother.take(&self.odometry, &mut self.trajectory);
        }
        Ok(step)
    }
}
