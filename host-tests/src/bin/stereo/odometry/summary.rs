//! What `stereo odometry` prints of a way, and how the truth is laid beside it.

use super::{Cams, NO_TIMES, OdometryArgs, PoseFormat};
use crate::failure::Failure;
use crate::rig::rig_line;
use crate::shared::remark;
use std::fmt::Write;
use std::path::PathBuf;
use stereopsis::geometry::camera::Pose;
use stereopsis::motion::odometry::State;
use stereopsis_host::command_line::one_line;
use stereopsis_host::odometry::error::{Alignment, align, ate, drift, rpe_of};
use stereopsis_host::odometry::poses;
use stereopsis_host::odometry::sequence::Sequence;
use stereopsis_host::odometry::trajectory::Trajectory;
use stereopsis_host::odometry::truth::FrameTruth;

/// The truth as the trajectory would have it: turned, moved, and of one camera scaled onto it.
pub fn beside(trajectory: &Trajectory, truth: &FrameTruth, is_stereo: bool) -> Vec<Pose<f64>> {
    let found = truth.beside(&trajectory.poses);
    let Some(s) = align(&truth.poses, &found, alignment(is_stereo)) else { return Vec::new() };
    let moved = |p: &Pose<f64>| {
        Pose::new(s.rotation * p.rotation(), s.rotation * p.translation() * s.scale + s.translation)
            .unwrap_or(*p)
    };
    truth.poses.iter().map(moved).collect()
}

/// The true poses of the frames: at their times where there are some, else line by line. Where frames are
/// missing between two, other lines than frames are refused.
pub fn true_poses(
    args: &OdometryArgs,
    times: &[f64],
    missing: Option<&[PathBuf; 2]>,
) -> Result<Option<FrameTruth>, Failure> {
    let Some(path) = &args.truth else { return Ok(None) };
    let (read, frames) = (poses::read(path)?, times.len());
    let (lines, path) = (read.poses.len(), path.display());
    if read.times_s.is_none() {
        if args.times.is_some() && args.format != PoseFormat::Tum {
            return Err(Failure::usage(NO_TIMES));
        }
        if let Some([before, after]) = missing.filter(|_| lines != frames) {
            return Err(Failure::new(format!(
                "{path}: has {lines} poses, and there are {frames} frames, of which the first that are \
                 missing are between {} and {}; leave the poses of those out, or give poses with times and \
                 --times",
                before.display(),
                after.display()
            )));
        }
        if lines != frames {
            remark(&format!("note: the truth has {lines} poses; as many as both have are compared"));
        }
        return Ok(Some(FrameTruth::by_order(&read, frames)));
    }
    if args.times.is_none() {
        if lines != frames {
            return Err(Failure::new(format!(
                "{path}: has {lines} poses with their times, and there are {frames} frames; give --times, \
                 the times of the frames"
            )));
        }
        return Ok(Some(FrameTruth::by_order(&read, frames)));
    }
    let truth = FrameTruth::at(&read, times);
    let without = frames - truth.frames.len();
    if without == frames {
        return Err(Failure::new(format!(
            "{path}: has no pose near the time of any frame; --times has to be of the same clock, in seconds"
        )));
    }
    if without > 0 {
        remark(&format!(
            "note: {without} of {frames} frames have no true pose near their time; errors are those of the \
             others"
        ));
    }
    Ok(Some(truth))
}

fn alignment(is_stereo: bool) -> Alignment {
    if is_stereo { Alignment::Rigid } else { Alignment::Similar }
}

/// What is printed at the end.
pub fn summary(
    args: &OdometryArgs,
    sequence: &Sequence,
    cameras: &Cams,
    trajectory: &Trajectory,
    truth: Option<&FrameTruth>,
) -> String {
    let (width, height) = sequence.size();
    let kind = if sequence.is_stereo() { "a pair" } else { "one camera" };
    let mut text = format!(
        "{} frames of {width} x {height} px, {kind}, {} calibration\n",
        sequence.len(),
        cameras.format
    );
    let states = [
        (State::Tracked, "tracked"),
        (State::Uncertain, "not sure"),
        (State::LeftOnly, "by the left camera alone, for the right one disagrees"),
        (State::Stationary, "still"),
        (State::RotationOnly, "turned, step not told from none"),
        (State::TranslationUnknown, "turned, step not known"),
        (State::Waiting, "waiting for a baseline, laid between others"),
        (State::Lost, "lost, laid between others"),
        (State::Found, "found again"),
        (State::Restarted, "begun anew, motion not known"),
    ];
    let counted: Vec<String> = states
        .iter()
        .map(|&(state, name)| (trajectory.count(state), name))
        .filter(|&(count, _)| count > 0)
        .map(|(count, name)| format!("{count} {name}"))
        .collect();
    let _ = writeln!(text, "frames       {}", counted.join(", "));
    if let Some(rig) = trajectory.rigs.last() {
        let _ = writeln!(text, "{}", rig_line(rig));
    }
    let unit = if sequence.is_stereo() { "m" } else { "first baselines (the unit of length is not known)" };
    let _ = writeln!(text, "way          {:.3} {unit}", trajectory.length());
    if let Some(truth) = truth {
        errors(&mut text, trajectory, truth, sequence.is_stereo());
    }
    let _ = writeln!(text, "results are in {}", one_line(&args.out.display().to_string()));
    text
}

fn errors(text: &mut String, trajectory: &Trajectory, of_frames: &FrameTruth, is_stereo: bool) {
    let (estimate, truth) = (of_frames.beside(&trajectory.poses), of_frames.poses.as_slice());
    let alignment = alignment(is_stereo);
    let Some(found) = align(&estimate, truth, alignment) else { return };
    let scale = found.scale;
    if let Some(ate) = ate(&estimate, truth, alignment) {
        let _ = writeln!(text, "ATE          {ate:.4} m RMS after alignment, scale {scale:.5}");
    }
    if let Some(rpe) = rpe_of(&estimate, truth, of_frames.steps(), scale) {
        let _ = writeln!(
            text,
            "RPE          {:.4} m, {:.4} deg RMS from frame to frame; direction {:.3} deg mean, {:.3} deg \
             worst",
            rpe.translation,
            rpe.rotation_rad.to_degrees(),
            rpe.direction_rad.to_degrees(),
            rpe.worst_direction_rad.to_degrees()
        );
    }
    for length in [5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 400.0, 800.0] {
        let Some(off) = drift(&estimate, truth, length, scale) else {
            break;
        };
        let _ = writeln!(
            text,
            "drift        over {length} m: {:.3} %, {:.5} deg/m ({} ways)",
            100.0 * off.translation,
            off.rotation_rad.to_degrees(),
            off.ways
        );
    }
}
