//! How far a trajectory is off a known one.

use nalgebra::{Matrix3, Rotation3, Vector3};
use stereopsis::geometry::camera::Pose;

/// What a trajectory may be moved by before it is compared.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Alignment {
    /// Turned and moved.
    Rigid,
    /// Turned, moved, and made larger or smaller: for trajectories without a unit.
    Similar,
}

/// `x -> s R x + t`, the motion and scale that carry one trajectory onto another.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Similarity {
    /// s.
    pub scale: f64,
    /// R.
    pub rotation: Matrix3<f64>,
    /// t.
    pub translation: Vector3<f64>,
}

/// The alignment of a trajectory's places with the true ones that leaves the least squares (Umeyama 1991);
/// `None` of fewer than two places, or where all are one.
pub fn align(estimate: &[Pose<f64>], truth: &[Pose<f64>], alignment: Alignment) -> Option<Similarity> {
    let n = estimate.len().min(truth.len());
    if n < 2 {
        return None;
    }
    let mean =
        |poses: &[Pose<f64>]| poses[..n].iter().map(|p| *p.translation()).sum::<Vector3<f64>>() / n as f64;
    let (a, b) = (mean(estimate), mean(truth));
    let (mut cross, mut spread) = (Matrix3::zeros(), 0.0);
    for (p, q) in estimate.iter().zip(truth).take(n) {
        let (p, q) = (p.translation() - a, q.translation() - b);
        cross += q * p.transpose();
        spread += p.norm_squared();
    }
    let svd = cross.svd(true, true);
    let (u, v_t) = (svd.u?, svd.v_t?);
    let mut sign = Vector3::repeat(1.0);
    let least = svd.singular_values.imin();
    if u.determinant() * v_t.determinant() < 0.0 {
        sign[least] = -1.0;
    }
    let rotation = u * Matrix3::from_diagonal(&sign) * v_t;
    let scale = match alignment {
        Alignment::Rigid => 1.0,
        Alignment::Similar => svd.singular_values.dot(&sign) / spread,
    };
    let fits = scale.is_finite() && scale > 0.0;
    fits.then(|| Similarity { scale, rotation, translation: b - rotation * a * scale })
}

/// The absolute trajectory error: the root mean square of the places' distances after alignment (Sturm et al.
/// 2012).
pub fn ate(estimate: &[Pose<f64>], truth: &[Pose<f64>], alignment: Alignment) -> Option<f64> {
    let Similarity { scale, rotation, translation } = align(estimate, truth, alignment)?;
    let squares = estimate
        .iter()
        .zip(truth)
        .map(|(p, q)| (rotation * p.translation() * scale + translation - q.translation()).norm_squared());
    let n = estimate.len().min(truth.len());
    Some((squares.sum::<f64>() / n as f64).sqrt())
}

/// The relative pose error: of all motions over so many frames, what is left of the true one.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct RelativeError {
    /// The root mean square of the steps' differences, in the truth's unit.
    pub translation: f64,
    /// The root mean square of the turns, radians.
    pub rotation_rad: f64,
    /// The mean angle between the directions of the steps, radians, of those that have one.
    pub direction_rad: f64,
    /// The largest of them.
    pub worst_direction_rad: f64,
}

/// The errors of the motions over `frames` frames, with the estimate's lengths times `scale`; `None` where
/// there are none.
pub fn rpe(estimate: &[Pose<f64>], truth: &[Pose<f64>], frames: usize, scale: f64) -> Option<RelativeError> {
    let n = estimate.len().min(truth.len());
    let count = n.checked_sub(frames).filter(|_| frames > 0)?;
    rpe_of(estimate, truth, (0..count).map(|i| [i, i + frames]), scale)
}

/// The errors of the motions between these pairs of places in both trajectories.
pub fn rpe_of(
    estimate: &[Pose<f64>],
    truth: &[Pose<f64>],
    motions: impl Iterator<Item = [usize; 2]>,
    scale: f64,
) -> Option<RelativeError> {
    let (mut steps, mut turns, mut directions, mut directed, mut worst) = (0.0, 0.0, 0.0, 0, 0.0_f64);
    let mut count = 0;
    for [i, j] in motions {
        count += 1;
        let motion = |poses: &[Pose<f64>]| poses[i].inverse().then(&poses[j]);
        let (p, q) = (motion(estimate), motion(truth));
        let step = p.translation() * scale;
        let error = q.inverse().then(&Pose::new(*p.rotation(), step).unwrap_or(p));
        steps += error.translation().norm_squared();
        turns += error.angle_rad().powi(2);
        if step.norm() > 0.0 && q.translation().norm() > 0.0 {
            let angle = step.angle(q.translation());
            directions += angle;
            worst = worst.max(angle);
            directed += 1;
        }
    }
    let mean = |sum: f64| (sum / f64::from(count)).sqrt();
    (count > 0).then(|| RelativeError {
        translation: mean(steps),
        rotation_rad: mean(turns),
        direction_rad: directions / f64::from(directed.max(1)),
        worst_direction_rad: worst,
    })
}

/// What KITTI's benchmark measures: of all ways of a length along the truth, beginning with every frame, how
/// far the end is off, as a share of the length and as a turn for each unit of it, means.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct DriftError {
    /// A share of the way.
    pub translation: f64,
    /// Radians for each unit of length.
    pub rotation_rad: f64,
    /// Ways that were compared.
    pub ways: usize,
}

/// The drift over ways of `length` (Geiger, Lenz & Urtasun 2012, with every frame as a beginning).
pub fn drift(estimate: &[Pose<f64>], truth: &[Pose<f64>], length: f64, scale: f64) -> Option<DriftError> {
    let n = estimate.len().min(truth.len());
    let mut along = vec![0.0];
    for pair in truth[..n].windows(2) {
        along.push(along[along.len() - 1] + (pair[1].translation() - pair[0].translation()).norm());
    }
    let (mut steps, mut turns, mut ways) = (0.0, 0.0, 0);
    for i in 0..n {
        let Some(j) = (i..n).find(|&j| along[j] - along[i] >= length) else { break };
        let motion = |poses: &[Pose<f64>]| poses[i].inverse().then(&poses[j]);
        let (p, q) = (motion(estimate), motion(truth));
        let p = Pose::new(*p.rotation(), p.translation() * scale).unwrap_or(p);
        let error = q.inverse().then(&p);
        let way = along[j] - along[i];
        steps += error.translation().norm() / way;
        turns += error.angle_rad() / way;
        ways += 1;
    }
    let mean = |sum: f64| sum / ways as f64;
    (ways > 0).then(|| DriftError { translation: mean(steps), rotation_rad: mean(turns), ways })
}

/// A pose of a turn (about X, Y, Z; radians) and a place: for examples.
pub fn pose(turn: [f64; 3], place: [f64; 3]) -> Pose<f64> {
    let turn = Rotation3::new(Vector3::from(turn));
    Pose::new(*turn.matrix(), Vector3::from(place)).unwrap_or_else(|_| Pose::identity())
}
