//! Trajectories as files, a line for each frame, of the motion that carries a point of that frame's camera
//! into the first one's: KITTI's odometry benchmark writes the first three rows of its matrix, row by row,
//! the TUM RGB-D benchmark (Sturm et al. 2012) a time, a place and a quaternion, `t x y z qx qy qz qw`.

use crate::limits;
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};
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
        rotation R, or 8, t x y z qx qy qz qw", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
    },
    /// There is no line of a pose.
    #[error("{}: holds no pose; a line for each frame is needed", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// A line is no time, or not after the one before.
    #[error("{}: line {line} is no time after the one before; a number of seconds is \
        needed", path.display())]
    Time {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
    },
    /// There are more or fewer times than frames.
    #[error("{}: has {found} times; {needed} are needed, one a frame", path.display())]
    Times {
        /// The file.
        path: PathBuf,
        /// How many there are.
        found: usize,
        /// How many frames there are.
        needed: usize,
    },
}

/// A trajectory that was read.
#[derive(Clone, Debug)]
pub struct Poses {
    /// The pose of each line.
    pub poses: Vec<Pose<f64>>,
    /// The time of each, seconds, of a file in TUM's form.
    pub times_s: Option<Vec<f64>>,
}

/// Writes a trajectory as KITTI does. The first line of one that begins in the first camera is the identity,
/// exactly.
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

/// Writes a trajectory as the TUM RGB-D benchmark does: `times_s` has the time of each frame, seconds. The
/// quaternion has a real part that is not negative.
pub fn write_tum(out: &mut dyn Write, poses: &[Pose<f64>], times_s: &[f64]) -> io::Result<()> {
    for (pose, time) in poses.iter().zip(times_s) {
        let t = pose.translation();
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*pose.rotation()));
        let turn = if turn.w < 0.0 { -turn.into_inner() } else { turn.into_inner() };
        // A zero's sign says nothing.
        let numbers = [t.x, t.y, t.z, turn.i, turn.j, turn.k, turn.w]
            .map(|x| format!("{:.9}", (x * 1e9).round() / 1e9 + 0.0));
        writeln!(out, "{time:.6} {}", numbers.join(" "))?;
    }
    Ok(())
}

/// Reads the times of `frames` frames, seconds, a line each, as in KITTI's times.txt; they go on.
pub fn read_times(path: &Path, frames: usize) -> Result<Vec<f64>, PosesError> {
    let text = read_text(path)?;
    let lines = text.lines().zip(1..).filter(|(content, _)| !content.trim().is_empty());
    let mut times: Vec<f64> = Vec::new();
    for (content, line) in lines {
        let time = content.trim().parse().ok().filter(|time: &f64| time.is_finite());
        let time = time.filter(|time| times.last().is_none_or(|last| time > last));
        times.push(time.ok_or_else(|| PosesError::Time { path: path.into(), line })?);
    }
    match times.len() {
        found if found == frames => Ok(times),
        found => Err(PosesError::Times { path: path.into(), found, needed: frames }),
    }
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

/// Reads a trajectory of either form, that of its first line; empty lines and comments are passed over, and
/// rotations may have few decimals.
pub fn read(path: &Path) -> Result<Poses, PosesError> {
    let text = read_text(path)?;
    let is_pose = |content: &str| !content.trim().is_empty() && !content.trim_start().starts_with('#');
    let lines = text.lines().zip(1..).filter(|(content, _)| is_pose(content));
    let pose = |(content, line): (&str, usize)| {
        let words = content.split_ascii_whitespace().map(|word| word.parse().ok());
        let numbers = words.collect::<Option<Vec<f64>>>().filter(|n| n.iter().all(|x| x.is_finite()));
        let pose = numbers.and_then(|numbers| match numbers.len() {
            8 => Some((Some(numbers[0]), tum_pose(&numbers)?)),
            _ => Some((None, kitti_pose(&numbers)?)),
        });
        pose.ok_or_else(|| PosesError::Line { path: path.into(), line })
    };
    let (mut times, mut poses) = (Vec::new(), Vec::new());
    for (content, line) in lines {
        let (time, pose) = pose((content, line))?;
        times.extend(time);
        poses.push(pose);
        if !times.is_empty() && times.len() != poses.len() {
            return Err(PosesError::Line { path: path.into(), line });
        }
    }
    match poses.len() {
        0 => Err(PosesError::Empty { path: path.into() }),
        _ => Ok(Poses { poses, times_s: (!times.is_empty()).then_some(times) }),
    }
}

/// The pose of twelve numbers, the rows of [R | t].
fn kitti_pose(numbers: &[f64]) -> Option<Pose<f64>> {
    let n = <[f64; 12]>::try_from(numbers).ok()?;
    let r = Matrix3::new(n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10]);
    let is_rotation = (r.transpose() * r - Matrix3::identity()).amax() <= MOST_OFF && r.determinant() > 0.0;
    if !is_rotation {
        return None;
    }
    // Files of other programs have six digits or fewer.
    let nearest = Rotation3::from_matrix_eps(&r, 1e-12, 100, Rotation3::identity());
    Pose::new(*nearest.matrix(), Vector3::new(n[3], n[7], n[11])).ok()
}

/// The pose of a time, a place and a quaternion.
fn tum_pose(numbers: &[f64]) -> Option<Pose<f64>> {
    let [_, x, y, z, i, j, k, w] = <[f64; 8]>::try_from(numbers).ok()?;
    let turn = Quaternion::new(w, i, j, k);
    let is_unit = (turn.norm() - 1.0).abs() <= MOST_OFF;
    if !is_unit {
        return None;
    }
    let turn = UnitQuaternion::from_quaternion(turn).to_rotation_matrix();
    Pose::new(*turn.matrix(), Vector3::new(x, y, z)).ok()
}

fn read_text(path: &Path) -> Result<String, PosesError> {
    let bytes = limits::read(path, limits::TABLE_BYTES);
    let text =
        bytes.and_then(|bytes| String::from_utf8(bytes).map_err(|_| io::ErrorKind::InvalidData.into()));
    text.map_err(|source| PosesError::Read { path: path.into(), source })
}
