//! A trajectory, put together from what is known of each frame.

use crate::interpolate::between;
use stereopsis::geometry::camera::Pose;
use stereopsis::motion::odometry::{RigEstimate, State, Step};

/// A trajectory, with what is known of each pose.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// Carries a point of each frame's camera into the first one's. What is not known is laid between what
    /// is.
    pub poses: Vec<Pose<f64>>,
    /// What the core says of each frame.
    pub steps: Vec<Step<f64>>,
    /// What it says after each frame of how a pair differs from its calibration; empty of one camera.
    pub rigs: Vec<RigEstimate<f64>>,
}

impl Trajectory {
    pub(super) fn push(&mut self, step: Step<f64>) {
        let last = self.poses.last().copied().unwrap_or_else(Pose::identity);
        let mut pose = last.then(&step.motion);
        let gap = self.steps.iter().rev().take_while(|step| is_gap(step.state)).count();
        if gap > 0 && matches!(step.state, State::Found | State::Tracked | State::Uncertain | State::LeftOnly)
        {
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
    pub(super) fn refine(&mut self, a: usize, b: usize, pose: Pose<f64>) {
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
