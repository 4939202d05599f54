//! A sequence through the core's odometry.

use crate::correspond::{CorrespondError, Plan, features};
use crate::interpolate::between;
use image::GrayImage;
use stereopsis::features::Orientation;
use stereopsis::geometry::camera::{Camera, Pose, RectifiedRig};
use stereopsis::imaging::{Picture, PictureError};
use stereopsis::motion::odometry::{
    Frame, MonocularOdometry, OdometryConfig, OdometryError, OdometryRig, OdometryRigError, Refinement,
    RefinementConfig, State, Step, StereoOdometry,
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
    /// Carries a point of each frame's camera into the first one's. What is not known is laid between what
    /// is.
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

/// Takes frames, left and right, until there is none, and says where the camera stood in each. The last
/// `views` are adjusted together, [`MOST_VIEWS`] at most; with fewer than two every pose stays as it was
/// told. `told` hears of every frame.
pub fn run<E, I>(
    rig: &Rig,
    frames: I,
    views: usize,
    told: impl Fn(&Step<f64>) + Send,
) -> Result<Trajectory, RunError<E>>
where
    E: std::error::Error + Send,
    I: Iterator<Item = Result<(GrayImage, Option<GrayImage>), E>> + Send,
{
    std::thread::scope(|scope| {
        let builder = std::thread::Builder::new().stack_size(STACK);
        let work =
            builder.spawn_scoped(scope, || follow(rig, frames, views, told)).map_err(RunError::Thread)?;
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
            State::Tracked | State::Found => {}
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

fn follow<E, I>(
    rig: &Rig,
    frames: I,
    views: usize,
    told: impl Fn(&Step<f64>),
) -> Result<Trajectory, RunError<E>>
where
    E: std::error::Error,
    I: Iterator<Item = Result<(GrayImage, Option<GrayImage>), E>>,
{
    let mut trajectory = Trajectory::default();
    let mut begun = None;
    for frame in frames {
        let (left, right) = frame.map_err(RunError::Source)?;
        // Pictures have at most 4096 columns and rows.
        let (width, height) = (left.width() as u16, left.height() as u16);
        let (odometry, smoother) = match &mut begun {
            Some(begun) => begun,
            begun @ None => {
                let odometry = Either::start(rig, OdometryConfig::new(width))?;
                begun.insert((odometry, Smoother::start(rig, views)?))
            }
        };
        let corners = features(&plan(), Orientation::Upright, &left)?;
        let right = right.as_ref().map(|right| Picture::new(right.as_raw(), width, height)).transpose()?;
        let frame = Frame { left: Picture::new(left.as_raw(), width, height)?, right, features: &corners };
        let step = odometry.step(&frame)?;
        told(&step);
        trajectory.push(step);
        if let Some(smoother) = smoother {
            smoother.take(odometry, &mut trajectory);
        }
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

    /// Puts frame `b` at `pose`, and those since the known frame `a` where they are beside that, or in
    /// between.
    fn refine(&mut self, a: usize, b: usize, pose: Pose<f64>) {
        let start = self.poses[a];
        for i in a + 1..b {
            self.poses[i] = if is_gap(self.steps[i].state) {
                between(&start, &pose, (i - a) as f64 / (b - a) as f64)
            } else {
                // Nothing moved.
                self.poses[i - 1]
            };
        }
        self.poses[b] = pose;
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
