//! From corners to a rig.

use super::board::Pattern;
use super::bundle::{Bundle, Inner, Outer, Seen};
use super::calibrated::{Calibrated, SolveError, View, ViewFigures};
use super::deviations::Deviations;
use super::lens::INNER;
use super::lens::LensModel;
use super::start;
use nalgebra::{Matrix3, Point2, Point3, Rotation3, Vector2, Vector3};
use stereopsis::geometry::camera::{Camera, ImageSize, StereoRig, StereoRigError};

/// Finds the rig that explains the views best: both cameras with lenses of a model, and the pose between
/// them.
///
/// # Panics
///
/// When a view has corners that the pattern has not.
pub fn solve(
    model: LensModel,
    pattern: Pattern,
    square_m: f64,
    size: ImageSize,
    views: &[View],
) -> Result<Calibrated, SolveError> {
    assert!(
        views.iter().flat_map(|view| view.numbers.iter().flatten()).all(|&n| n < pattern.corners()),
        "corners of the pattern"
    );
    if views.len() < Calibrated::LEAST_VIEWS {
        return Err(SolveError::TooFew { views: views.len() });
    }
    let board: Vec<Point3<f64>> = pattern.places().map(|p| Point3::new(p.x, p.y, 0.0)).collect();
    let seen: [Vec<Seen<'_>>; 2] = [0, 1].map(|i| {
        let of = |view| -> Seen<'_> {
            let View { corners, numbers }: &View = view;
            Seen { corners: &corners[i], numbers: &numbers[i] }
        };
        views.iter().map(of).collect()
    });
    let (first, second) = std::thread::scope(|scope| {
        let first = scope.spawn(|| alone(model, &board, &seen[0], size));
        let second = alone(model, &board, &seen[1], size);
        (first.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), second)
    });
    let first = first.ok_or(SolveError::Camera("left"))?;
    let second = second.ok_or(SolveError::Camera("right"))?;
    // With all that both together have: by less a camera would fit worse by itself.
    let all = std::array::from_fn(|parameter| model.has(parameter));
    let rms = |camera: &Bundle<'_>| {
        let mut camera = Bundle { free: all, ..camera.clone() };
        if camera.free != first.free {
            camera.minimise(200);
        }
        let residuals = (0..views.len()).filter_map(|view| camera.residuals(0, view));
        root(&residuals.flatten().collect::<Vec<_>>())
    };
    let alone_px = [rms(&first), rms(&second)];

    let mut both = Bundle {
        board: &board,
        model,
        seen: seen.into(),
        inner: vec![first.inner[0], second.inner[0]],
        beside: between(&first, &second).ok_or(SolveError::Camera("right"))?,
        views: first.views,
        free: first.free,
    };
    let mut cost = both.minimise(200);
    if both.free != all {
        both.free = all;
        cost = both.minimise(200);
    }
    if !cost.is_finite() {
        return Err(SolveError::Camera("right"));
    }
    result(&both, square_m, size, alone_px).map_err(SolveError::Rig)
}

/// The root mean square of residuals, px.
fn root(residuals: &[Vector2<f64>]) -> f64 {
    (residuals.iter().map(Vector2::norm_squared).sum::<f64>() / residuals.len().max(1) as f64).sqrt()
}

fn result(
    both: &Bundle<'_>,
    square_m: f64,
    size: ImageSize,
    alone_px: [f64; 2],
) -> Result<Calibrated, StereoRigError> {
    let camera = |inner: &Inner| {
        let [fx, fy, cx, cy, coefficients @ ..] = *inner;
        Camera::new(fx, fy, cx, cy).and_then(|c| c.with_distortion(both.model.lens(coefficients)))
    };
    let cameras = [camera(&both.inner[0]), camera(&both.inner[1])];
    let [Ok(left), Ok(right)] = cameras else { return Err(StereoRigError::NoBaseline) };
    let rig = StereoRig::from_opencv([left, right], both.beside.r, both.beside.t * square_m, [size; 2])?;
    let middle = both.board.iter().fold(Vector3::zeros(), |sum, p| sum + p.coords) / both.board.len() as f64;
    let views = (0..both.views.len()).map(|view| {
        let residuals = [0, 1].map(|camera| both.residuals(camera, view).unwrap_or_default());
        let pose = &both.views[view];
        let distance_m = (pose.r * middle + pose.t).norm() * square_m;
        // The board's normal, towards the camera.
        let normal = pose.r.column(2) * pose.r[(2, 2)].signum();
        let tilt_deg = [0, 1].map(|axis| normal[axis].atan2(normal.z).to_degrees());
        ViewFigures { rms_px: residuals.each_ref().map(|r| root(r)), residuals, distance_m, tilt_deg }
    });
    let views: Vec<_> = views.collect();
    let all: Vec<_> = views.iter().flat_map(|view| view.residuals.iter().flatten().copied()).collect();
    let deviations = Deviations::of(both);
    let sigma = |slopes: &[(usize, f64)]| deviations.as_ref().map_or(f64::INFINITY, |d| d.sigma(slopes));
    let focal = |camera: usize| sigma(&[(camera * INNER, 1.0)]).max(sigma(&[(camera * INNER + 1, 1.0)]));
    let along = both.beside.t.normalize();
    // What is far is seen where the turn puts it: `x' = cx' + f w_y` of cameras side by side, and `y' = cy' -
    // f w_x` of one above the other.
    let is_level = along.x.abs() >= along.y.abs();
    let (centre, axis, sign) = if is_level { (2, 1, 1.0) } else { (3, 0, -1.0) };
    let turn = 2 * INNER + axis;
    let shift = [(centre, -1.0), (INNER + centre, 1.0), (turn, sign * both.inner[1][centre - 2])];
    let turned = Rotation3::from_matrix_unchecked(both.beside.r).scaled_axis();
    Ok(Calibrated {
        rig,
        rms_px: root(&all),
        alone_px,
        views,
        focal_sigma_px: [focal(0), focal(1)],
        baseline_sigma_m: sigma(&[0, 1, 2].map(|i| (2 * INNER + 3 + i, along[i]))) * square_m,
        yaw_rad: [turned[axis], sigma(&[(turn, 1.0)])],
        disparity_sigma_px: sigma(&shift),
    })
}

/// Steps from every beginning, how many of these are gone on with, and steps of those.
const FIRST_STEPS: usize = 4;
const BEST: usize = 3;
const NEXT_STEPS: usize = 8;

/// One camera by itself.
fn alone<'a>(
    model: LensModel,
    board: &'a [Point3<f64>],
    seen: &[Seen<'a>],
    size: ImageSize,
) -> Option<Bundle<'a>> {
    let (width, height) = (f64::from(size.width), f64::from(size.height));
    let middle = Vector2::new(width - 1.0, height - 1.0) / 2.0;
    let steps = model.steps();
    let free = |parameters: &[usize]| std::array::from_fn(|i| parameters.contains(&i));
    let homographies = |of: &dyn Fn(&Point2<f64>) -> Point2<f64>| {
        let flat = |seen: &Seen<'a>| start::homography(seen.pairs(board).map(|(board, p)| (board, of(p))));
        seen.iter().map(flat).collect::<Option<Vec<_>>>()
    };
    let plain = homographies(&|p| *p);
    let zhang = plain.as_ref().and_then(|plain| start::focal_lengths(plain, middle));
    // A lens that bends much misleads homographies: then one of the usual fields of view is nearer, and
    // places as a lens has them that puts equal angles at equal ways.
    let usual = [0.3, 0.45, 0.7, 1.0, 1.6, 3.0].map(|share| Vector2::repeat(share * width));
    let bent = usual
        .into_iter()
        .filter_map(|focal| Some((focal, homographies(&|p| start::flat(p, focal.x, middle))?)));
    let straight = zhang.into_iter().chain(usual).filter_map(|focal| Some((focal, plain.clone()?)));
    let begins = straight.chain(bent).filter_map(|(focal, homographies)| {
        let inner = start::camera(focal, middle);
        let views = homographies.iter().map(|h| start::pose(&inner, h)).collect::<Option<Vec<_>>>()?;
        let (beside, seen) = (Outer::new(Matrix3::identity(), Vector3::zeros()), vec![seen.to_vec()]);
        let mut bundle =
            Bundle { board, model, seen, inner: vec![inner], beside, views, free: free(steps[0]) };
        let cost = bundle.minimise(FIRST_STEPS);
        cost.is_finite().then_some((cost, bundle))
    });
    let mut begins: Vec<_> = begins.collect();
    begins.sort_by(|a, b| a.0.total_cmp(&b.0));
    begins.truncate(BEST);
    begins.iter_mut().for_each(|(cost, bundle)| *cost = bundle.minimise(NEXT_STEPS));
    let (_, mut best) = begins.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    for (i, parameters) in steps.iter().enumerate() {
        best.free = free(parameters);
        best.minimise(if i + 1 == steps.len() { 200 } else { 40 });
    }
    Some(best)
}

/// From the first camera to the second, as most views have it: of every view's, that from which all others
/// are least far.
fn between(first: &Bundle<'_>, second: &Bundle<'_>) -> Option<Outer> {
    let all: Vec<Outer> = first
        .views
        .iter()
        .zip(&second.views)
        .map(|(a, b)| {
            let r = b.r * a.r.transpose();
            Outer::new(r, b.t - r * a.t)
        })
        .collect();
    let far = |a: &Outer, b: &Outer| {
        let turn = Rotation3::from_matrix_unchecked(a.r.transpose() * b.r).angle();
        turn * 10.0 + (a.t - b.t).norm()
    };
    let total = |one: &Outer| all.iter().map(|other| far(one, other)).sum::<f64>();
    all.iter().min_by(|a, b| total(a).total_cmp(&total(b))).copied()
}
