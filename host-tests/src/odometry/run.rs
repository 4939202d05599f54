//! A sequence through the core's odometry.

use super::poses::between;
use crate::correspond::{CorrespondError, Plan, features};
use image::GrayImage;
use stereopsis::features::Orientation;
use stereopsis::geometry::{Camera, Pose, RectifiedRig};
use stereopsis::imaging::{Picture, PictureError};
use stereopsis::motion::odometry::{
    Frame, MonocularOdometry, OdometryConfig, OdometryError, OdometryRigError, State, Step, StereoOdometry,
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

/// A trajectory, with what is known of each pose.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// Carries a point of each frame's camera into the first one's. What is not known is laid between what is.
    pub poses: Vec<Pose<f64>>,
    /// What the core says of each frame.
    pub steps: Vec<Step<f64>>,
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

/// How corners are found: as many as are followed, on the full picture.
pub fn plan() -> Plan {
    Plan { corners: 1500, threshold: 8, levels: 1, ..Plan::default() }
}

/// Takes frames, left and right, until there is none, and says where the camera stood in each; `told` hears of every frame.
pub fn run<E, I>(rig: &Rig, frames: I, told: impl Fn(&Step<f64>) + Send) -> Result<Trajectory, RunError<E>>
where
    E: std::error::Error + Send,
    I: Iterator<Item = Result<(GrayImage, Option<GrayImage>), E>> + Send,
{
    std::thread::scope(|scope| {
        let builder = std::thread::Builder::new().stack_size(STACK);
        let work = builder.spawn_scoped(scope, || follow(rig, frames, told)).map_err(RunError::Thread)?;
        work.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

/// The odometry of either kind.
enum Either {
    Stereo(Box<StereoOdometry<f64, POINTS>>),
    Mono(Box<MonocularOdometry<f64, POINTS>>),
}

fn follow<E, I>(rig: &Rig, frames: I, told: impl Fn(&Step<f64>)) -> Result<Trajectory, RunError<E>>
where
    E: std::error::Error,
    I: Iterator<Item = Result<(GrayImage, Option<GrayImage>), E>>,
{
    let mut odometry = match rig {
        Rig::Stereo(_) => Either::Stereo(Box::default()),
        Rig::Mono(_) => Either::Mono(Box::default()),
    };
    let mut trajectory = Trajectory::default();
    let mut begun = false;
    for frame in frames {
        let (left, right) = frame.map_err(RunError::Source)?;
        // Pictures have at most 4096 columns and rows.
        let (width, height) = (left.width() as u16, left.height() as u16);
        if !begun {
            let config = OdometryConfig::new(width);
            match (&mut odometry, rig) {
                (Either::Stereo(odometry), Rig::Stereo(rig)) => odometry.start(rig, config)?,
                (Either::Mono(odometry), Rig::Mono(camera)) => odometry.start(*camera, config),
                _ => {}
            }
            begun = true;
        }
        let corners = features(&plan(), Orientation::Upright, &left)?;
        let right = right.as_ref().map(|right| Picture::new(right.as_raw(), width, height)).transpose()?;
        let frame = Frame { left: Picture::new(left.as_raw(), width, height)?, right, features: &corners };
        let step = match &mut odometry {
            Either::Stereo(odometry) => odometry.step(&frame)?,
            // In units of the first baseline.
            Either::Mono(odometry) => *odometry.step(&frame)?.in_first_baselines(),
        };
        told(&step);
        trajectory.push(step);
    }
    Ok(trajectory)
}

impl Trajectory {
    fn push(&mut self, step: Step<f64>) {
        let last = self.poses.last().copied().unwrap_or_else(Pose::identity);
        let mut pose = last.then(&step.motion);
        let gap = self.steps.iter().rev().take_while(|step| is_gap(step.state)).count();
        if gap > 0 && matches!(step.state, State::Found | State::Tracked) {
            // The motion since the last known pose: the frames in between lie on the way.
            let from = self.poses.len() - gap - 1;
            let start = self.poses[from];
            for (i, pose_between) in self.poses[from + 1..].iter_mut().enumerate() {
                *pose_between = between(&start, &pose, (i + 1) as f64 / (gap + 1) as f64);
            }
        }
        if step.state == State::Restarted {
            // Nothing joins what was before and what comes: as fast as before is the best guess.
            let known = self.poses.len() - gap.min(self.poses.len());
            if known >= 2 {
                let (before, at) = (self.poses[known - 2], self.poses[known - 1]);
                let motion = before.inverse().then(&at);
                let mut guess = at;
                for pose in &mut self.poses[known..] {
                    guess = guess.then(&motion);
                    *pose = guess;
                }
                pose = guess.then(&motion);
            }
        }
        self.poses.push(pose);
        self.steps.push(step);
    }

    /// How many frames are in a state.
    pub fn count(&self, state: State) -> usize {
        self.steps.iter().filter(|step| step.state == state).count()
    }

    /// The length of the way.
    pub fn length(&self) -> f64 {
        self.poses.windows(2).map(|pair| (pair[1].translation() - pair[0].translation()).norm()).sum()
    }
}

/// Whether a frame's motion is told by a later one.
fn is_gap(state: State) -> bool {
    matches!(state, State::Lost | State::Waiting)
}
