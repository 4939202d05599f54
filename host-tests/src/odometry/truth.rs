//! The true poses of a sequence's frames, out of a file whose lines are those of other times.

use super::poses::Poses;
use crate::interpolate::between;
use stereopsis::geometry::camera::Pose;

/// How far from a frame's time the true poses may be that it lies between, frame intervals: those of a truth
/// at the rate of the frames are nearer, also where it is not quite regular.
const NEAR: f64 = 1.5;
/// How far off the time of a true pose may be that is taken as it is, frame intervals: for times that are
/// rounded, at the truth's beginning and end.
const SAME: f64 = 0.01;

/// True poses, each of a frame.
#[derive(Clone, Debug)]
pub struct FrameTruth {
    /// The frames that have one, from 0, ascending.
    pub frames: Vec<usize>,
    /// The true pose of each of them.
    pub poses: Vec<Pose<f64>>,
}

impl FrameTruth {
    /// The poses in the order of the frames, of which there are so many, as many as both have.
    pub fn by_order(truth: &Poses, frames: usize) -> Self {
        let poses: Vec<_> = truth.poses.iter().take(frames).copied().collect();
        Self { frames: (0..poses.len()).collect(), poses }
    }

    /// The poses at the times of the frames, seconds, ascending: between the neighbours in time, along a line
    /// and about one axis, where both are within one and a half of the frames' intervals. A frame without
    /// such neighbours has no true pose. Poses without times are those of the frames in their order.
    pub fn at(truth: &Poses, times_s: &[f64]) -> Self {
        let Some(of_truth) = &truth.times_s else { return Self::by_order(truth, times_s.len()) };
        let mut timed: Vec<(f64, &Pose<f64>)> = of_truth.iter().copied().zip(&truth.poses).collect();
        timed.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut intervals: Vec<f64> = times_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
        intervals.sort_by(f64::total_cmp);
        let interval = intervals.get(intervals.len() / 2).copied().unwrap_or(0.0);
        let at = |time: f64| {
            let after = timed.partition_point(|(t, _)| *t < time);
            let next = timed.get(after).filter(|(t, _)| t - time <= NEAR * interval);
            let last = after.checked_sub(1).map(|i| &timed[i]).filter(|(t, _)| time - t <= NEAR * interval);
            match (last, next) {
                (Some((a, from)), Some((b, to))) => Some(between(from, to, (time - a) / (b - a))),
                (Some((t, pose)), None) | (None, Some((t, pose))) => {
                    ((t - time).abs() <= SAME * interval).then_some(**pose)
                }
                (None, None) => None,
            }
        };
        let known = times_s.iter().enumerate().filter_map(|(frame, time)| Some((frame, at(*time)?)));
        let (frames, poses) = known.unzip();
        Self { frames, poses }
    }

    /// The poses of another trajectory at the same frames.
    pub fn beside(&self, trajectory: &[Pose<f64>]) -> Vec<Pose<f64>> {
        self.frames.iter().filter_map(|&frame| trajectory.get(frame).copied()).collect()
    }

    /// The places in [`poses`](Self::poses) of neighbouring frames that both have one.
    pub fn steps(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let follows = |&at: &usize| self.frames[at + 1] == self.frames[at] + 1;
        (0..self.frames.len().saturating_sub(1)).filter(follows).map(|at| [at, at + 1])
    }
}
