//! Trajectories as KITTI's odometry benchmark writes them: a line for each frame, the first three rows of the
//! matrix that carries a point of that frame's camera into the first one's, row by row.

use crate::limits;
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use stereopsis::geometry::camera::Pose;
use stereopsis::motion::odometry::{RigEstimate, State, Step};

/// Why a file is no trajectory.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PosesError {
    /// The file cannot be read.
    #[error("{}: cannot be read ({source}); give a text file of poses", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// A line is no pose.
    #[error("{}: line {line} is no pose; 12 numbers are needed, the rows of [R | t] with a \
        rotation R", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
    },
}

/// Writes a trajectory. The first line of one that begins in the first camera is the identity, exactly.
pub fn write(out: &mut dyn Write, poses: &[Pose<f64>]) -> io::Result<()> {
    for pose in poses {
        let (r, t) = (pose.rotation(), pose.translation());
        let rows = (0..3).flat_map(|i| [r[(i, 0)], r[(i, 1)], r[(i, 2)], t[i]]);
        // A zero's sign says nothing.
        let numbers: Vec<String> = rows.map(|x| format!("{:.9e}", x + 0.0)).collect();
        writeln!(out, "{}", numbers.join(" "))?;
    }
    Ok(())
}

/// What a frame's state is called in files.
pub const fn name(state: State) -> &'static str {
    match state {
        State::First => "first",
        State::Waiting => "waiting",
        State::Tracked => "tracked",
        State::Uncertain => "uncertain",
        State::LeftOnly => "left_only",
        State::Stationary => "still",
        State::RotationOnly => "turned",
        State::TranslationUnknown => "step_unknown",
        State::Lost => "lost",
        State::Found => "found",
        State::Restarted => "restarted",
        _ => "unknown",
    }
}

/// Writes a line for each frame: its number from 0, its state, the points that are followed, found and agree,
/// and the largest standard deviations of the turn (degrees) and of the step (the unit of the poses); nothing
/// where nothing is known.
pub fn write_states(out: &mut dyn Write, steps: &[Step<f64>], rigs: &[RigEstimate<f64>]) -> io::Result<()> {
    writeln!(out, "frame,state,points,found,agree,sigma_turn_deg,sigma_step,rig_px,sigma_rig_px")?;
    for (frame, step) in steps.iter().enumerate() {
        let sigma = |from: usize, by: f64| {
            let variance = (from..from + 3).map(|i| step.covariance[(i, i)]).fold(0.0, f64::max);
            // What is not known has a very large one.
            if variance < 1e9 { format!("{:.3e}", variance.sqrt() * by) } else { String::new() }
        };
        let Step { points, found, inliers, .. } = step;
        let (turn, shift) = (sigma(0, 1_f64.to_degrees()), sigma(3, 1.0));
        // Nothing is known of the pair before two views were compared.
        let rig = rigs.get(frame).filter(|rig| rig.pairs > 0);
        let rig = rig.map_or(",".to_owned(), |rig| format!("{:.3},{:.3}", rig.disparity_px, rig.sigma_px));
        writeln!(out, "{frame},{},{points},{found},{inliers},{turn},{shift},{rig}", name(step.state))?;
    }
    Ok(())
}

/// How far off a rotation's columns may be from length one and from right angles: of two decimals.
const MOST_OFF: f64 = 0.02;

/// Reads a trajectory; empty lines are passed over, and rotations may have few decimals.
pub fn read(path: &Path) -> Result<Vec<Pose<f64>>, PosesError> {
    let bytes = limits::read(path, limits::TABLE_BYTES);
    let text =
        bytes.and_then(|bytes| String::from_utf8(bytes).map_err(|_| io::ErrorKind::InvalidData.into()));
    let text = text.map_err(|source| PosesError::Read { path: path.into(), source })?;
    let lines = text.lines().zip(1..).filter(|(content, _)| !content.trim().is_empty());
    let pose = |(content, line): (&str, usize)| {
        let numbers: Vec<f64> =
            content.split_ascii_whitespace().filter_map(|word| word.parse().ok()).collect();
        let found = <[f64; 12]>::try_from(numbers).ok().filter(|n| n.iter().all(|x| x.is_finite()));
        let pose = found.and_then(|n| {
            let r = Matrix3::new(n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10]);
            if !((r.transpose() * r - Matrix3::identity()).amax() <= MOST_OFF && r.determinant() > 0.0) {
                return None;
            }
            // Files of other programs have six digits or fewer.
            let nearest = Rotation3::from_matrix_eps(&r, 1e-12, 100, Rotation3::identity());
            Pose::new(*nearest.matrix(), Vector3::new(n[3], n[7], n[11])).ok()
        });
        pose.ok_or_else(|| PosesError::Line { path: path.into(), line })
    };
    lines.map(pose).collect()
}
