//! A sequence through the core's odometry.

use super::prepared::Prepared;
pub use super::rig::{POINTS, Rig};
use super::smoother::{Followed, Told, smooth};
pub use super::smoother::{MOST_VIEWS, VIEWS};
use super::trajectory::Trajectory;
use crate::correspond::CorrespondError;
use image::GrayImage;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::ScopedJoinHandle;
use stereopsis::geometry::rectify::RowAlignment;
use stereopsis::imaging::{Picture, PictureError};
use stereopsis::motion::odometry::{
    Frame, MonocularOdometry, ObservedPoint, OdometryConfig, OdometryError, OdometryRig, OdometryRigError,
    RigEstimate, Step, StereoOdometry,
};

/// The odometry is made and moved on the stack.
const STACK: usize = 256 << 20;

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
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct RunConfig {
    /// The last views that are adjusted together, [`MOST_VIEWS`] at most; with fewer than two every pose
    /// stays as it was told.
    pub views: usize,
    /// Whether a pair is corrected by what its points' motion shows, once that is sure. Frames up to the 64th
    /// that came before are then gone through again.
    pub corrects_rig: bool,
    /// How the right camera of a pair is turned as the rows of its first frame say, where it is corrected.
    pub rows: Option<RowAlignment<f64>>,
}

impl Default for RunConfig {
    fn default() -> Self {
        Self { views: VIEWS, corrects_rig: true, rows: None }
    }
}

/// Takes frames, left and right, until there is none, and says where the camera stood in each. `told` hears
/// of every frame. Three threads share the work: one reads the next frames and finds their features, one
/// follows them, and one adjusts the last views together, which the second does not wait for.
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
        let (to_smoother, steps) = sync_channel(AHEAD);
        let follow = move || follow(rig, receiver, &config, told, &to_smoother);
        let following = thread().spawn_scoped(scope, follow).map_err(RunError::Thread)?;
        let smooth = move || smooth(rig, config.views, steps);
        let smoothing = thread().spawn_scoped(scope, smooth).map_err(RunError::Thread)?;
        joined(following)?;
        Ok(joined(smoothing)?)
    })
}

fn joined<T>(thread: ScopedJoinHandle<'_, T>) -> T {
    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// The odometry of either kind.
enum Either {
    Stereo(Box<StereoOdometry<f64, POINTS>>),
    Mono(Box<MonocularOdometry<f64, POINTS>>),
}

impl Either {
    fn start<E: std::error::Error>(rig: &Rig, config: &RunConfig, width: u16) -> Result<Self, RunError<E>> {
        let (corrects_rig, of_width) = (config.corrects_rig, OdometryConfig::new(width));
        let follow = OdometryConfig { corrects_rig, ..of_width };
        match rig {
            Rig::Stereo(rig) => {
                let rig = OdometryRig::stereo(rig)?;
                let rows = config.rows.filter(|_| corrects_rig);
                let mut odometry = Box::<StereoOdometry<_, _>>::default();
                odometry.as_mut_view().start(rows.map_or(rig, |rows| rig.with_rows(&rows)), follow)?;
                Ok(Self::Stereo(odometry))
            }
            Rig::Mono(camera) => {
                let mut odometry = Box::<MonocularOdometry<_, _>>::default();
                odometry.start(*camera, follow);
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

    fn observed_points(&self) -> Vec<ObservedPoint<f64>> {
        match self {
            Self::Stereo(odometry) => odometry.observed_points().collect(),
            Self::Mono(odometry) => odometry.observed_points().collect(),
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

/// Follows the frames, and hands on what is told of each.
fn follow<E: std::error::Error>(
    rig: &Rig,
    frames: Receiver<Result<Prepared, RunError<E>>>,
    config: &RunConfig,
    told: impl Fn(&Step<f64>),
    sender: &SyncSender<Told>,
) -> Result<(), RunError<E>> {
    let mut begun: Option<Follower> = None;
    let mut first = Vec::new();
    for frame in frames {
        let frame = frame?;
        let follower = match &mut begun {
            Some(follower) => follower,
            begun @ None => begun.insert(Follower::start(rig, config, &frame.left, sender)?),
        };
        told(&follower.take(&frame)?);
        if follower.has_corrected {
            continue;
        }
        first.push(frame);
        if first.len() >= MOST_AGAIN {
            follower.again(first.drain(..))?;
        }
    }
    match begun {
        Some(mut follower) if !follower.has_corrected => follower.again(first.drain(..)),
        _ => Ok(()),
    }
}

/// Frames that are gone through again at most: by all of them a correction is more exact than by those that
/// it took to be sure.
const MOST_AGAIN: usize = 64;

/// An odometry under way.
struct Follower<'a> {
    odometry: Either,
    sender: &'a SyncSender<Told>,
    is_corrected: bool,
    /// Whether the first frames have been gone through again, or need not be.
    has_corrected: bool,
}

impl<'a> Follower<'a> {
    fn start<E: std::error::Error>(
        rig: &Rig,
        config: &RunConfig,
        left: &GrayImage,
        sender: &'a SyncSender<Told>,
    ) -> Result<Self, RunError<E>> {
        // Pictures have at most 4096 columns and rows.
        let odometry = Either::start(rig, config, left.width() as u16)?;
        Ok(Self { odometry, sender, is_corrected: false, has_corrected: false })
    }

    /// Goes through the first frames again if the pair is corrected.
    fn again<E: std::error::Error>(
        &mut self,
        frames: impl Iterator<Item = Prepared>,
    ) -> Result<(), RunError<E>> {
        self.has_corrected = true;
        if !self.is_corrected {
            return Ok(());
        }
        if let Either::Stereo(odometry) = &mut self.odometry {
            odometry.begin_again();
        }
        // What is told until nobody listens is of no use.
        let _ = self.sender.send(Told::Again);
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
        let rig = self.odometry.rig();
        self.is_corrected = rig.is_some_and(|rig| rig.is_applied);
        let followed = Followed { step, rig, points: self.odometry.observed_points() };
        let _ = self.sender.send(Told::Frame(Box::new(followed)));
        Ok(step)
    }
}
