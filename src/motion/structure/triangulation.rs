//! Robust triangulation of a point from many views.

use super::config::PointState;
use crate::geometry::linear::Ldl;
use crate::geometry::{
    Real,
    linear::{cayley, skew},
};
use crate::motion::bundle::{CameraView, Observation, View};
use nalgebra::{Matrix3, Point3, Vector3};

/// Steps to the least re-projection error, at most.
const MOST_STEPS: usize = 5;

/// The point that most of these observations agree with, to a threshold, and least squares of those that do;
/// refused when no half of them, and no two, do: two wrong ones of many meet by chance.
///
/// Every pair of observations that has the least angle between its rays is a candidate, by the midpoint; the
/// one with most observations within the threshold is refined by Gauss and Newton's method.
pub(super) fn triangulate<T: Real>(
    views: &[CameraView<T>],
    track: impl Iterator<Item = Observation<T>> + Clone,
    threshold_px: T,
    min_angle_rad: T,
) -> Result<Point3<T>, PointState> {
    let ray = |observation: &Observation<T>| {
        let view = views.get(usize::from(observation.view))?;
        let observation = view.camera.unproject(&observation.pixel).ok()?;
        let observation = view.pose.rotation() * observation;
        Some((*view.pose.translation(), observation * (T::ONE / observation.norm())))
    };
    let mut best: Option<(usize, T, Point3<T>)> = None;
    let (mut seen, mut angled) = (0, false);
    for (n, a) in track.clone().enumerate() {
        seen += 1;
        let Some((from, p)) = ray(&a) else { continue };
        for b in track.clone().take(n) {
            let Some((to, q)) = ray(&b) else { continue };
            let across = p.cross(&q);
            let angle = across.norm().atan2(p.dot(&q));
            if !(angle >= min_angle_rad) {
                continue;
            }
            angled = true;
            let (apart, size) = (to - from, across.norm_squared());
            let (depth, other) = (apart.cross(&q).dot(&across) / size, apart.cross(&p).dot(&across) / size);
            if !(depth > T::ZERO && other > T::ZERO) {
                continue;
            }
            let point = Point3::from((from + p * depth + to + q * other) * T::of(0.5));
            let count = agreeing(views, track.clone(), &point, threshold_px).count();
            if count >= 2
                && best.is_none_or(|(most, widest, _)| count > most || count == most && angle > widest)
            {
                best = Some((count, angle, point));
            }
        }
    }
    let Some((_, _, point)) = best.filter(|(count, ..)| 2 * count >= seen) else {
        return Err(match (seen, angled) {
            (0 | 1, _) => PointState::Unknown,
            (_, false) => PointState::Far,
            (_, true) => PointState::Inconsistent,
        });
    };
    Ok(refined(views, track, point, threshold_px))
}

/// The observations whose residual is within the threshold.
pub(super) fn agreeing<T: Real>(
    views: &[CameraView<T>],
    track: impl Iterator<Item = Observation<T>>,
    point: &Point3<T>,
    threshold_px: T,
) -> impl Iterator<Item = Observation<T>> {
    track.filter(move |observation| {
        let seen = views
            .get(usize::from(observation.view))
            .and_then(|view| view.project(observation.eye, point).ok());
        seen.is_some_and(|seen| (seen - observation.pixel).norm_squared() <= threshold_px * threshold_px)
    })
}

fn refined<T: Real>(
    views: &[CameraView<T>],
    track: impl Iterator<Item = Observation<T>> + Clone,
    start: Point3<T>,
    threshold_px: T,
) -> Point3<T> {
    let mut point = start;
    for _ in 0..MOST_STEPS {
        let (mut normal, mut gradient) = (Matrix3::<T>::zeros(), Vector3::<T>::zeros());
        for observation in agreeing(views, track.clone(), &start, threshold_px) {
            let Some(view) = views.get(usize::from(observation.view)) else { continue };
            let Ok(jacobian) = view.jacobian(observation.eye, &point) else { return start };
            let off = jacobian.pixel - observation.pixel;
            for (row, r) in jacobian.by_point.iter().zip([off.x, off.y]) {
                let [x, y, z] = *row;
                let row = Vector3::new(x, y, z);
                normal += row * row.transpose();
                gradient += row * r;
            }
        }
        let step = Ldl::<T, 3>::new(&mut normal.into()).solve(&gradient.into());
        let [x, y, z] = step;
        let step = Vector3::new(x, y, z);
        point -= step;
        if step.norm_squared() <= T::EPSILON * point.coords.norm_squared() {
            break;
        }
    }
    let (before, after) = (start, point);
    let count = |p: &Point3<T>| agreeing(views, track.clone(), p, threshold_px).count();
    if count(&after) >= count(&before) { after } else { before }
}

/// The turn that carries observations of the second view onto those of the first best (Horn's problem by
/// Newton's method on Cayley's turn, from none); weights fall with the distance beyond the threshold.
pub(super) fn rotation_only<T: Real>(
    rays: impl Iterator<Item = (Vector3<T>, Vector3<T>)> + Clone,
    threshold_rad: T,
) -> Matrix3<T> {
    let mut rotation = Matrix3::identity();
    for _ in 0..20 {
        let (mut normal, mut gradient) = (Matrix3::<T>::zeros(), Vector3::<T>::zeros());
        for (p, q) in rays.clone() {
            let turned = rotation * q;
            let off = p - turned;
            let weight = threshold_rad / off.norm().max(threshold_rad);
            // p = (I + [w]x) R q: by w it is -[R q]x.
            let jacobian = -skew(&turned);
            normal += jacobian.tr_mul(&jacobian) * weight;
            gradient += jacobian.tr_mul(&off) * weight;
        }
        let [x, y, z] = Ldl::<T, 3>::new(&mut normal.into()).solve(&gradient.into());
        let step = Vector3::new(x, y, z);
        rotation = cayley(&step) * rotation;
        if step.norm_squared() <= T::EPSILON * T::EPSILON * T::of(64.0) {
            break;
        }
    }
    rotation
}
