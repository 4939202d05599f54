//! Rigs from corners.

use super::{CLOSE_STANDS, SIZE, STANDS, markers, pattern, rig, stand};
use nalgebra::{Point2, Point3, Rotation3, Vector2};
use stereopsis::geometry::camera::{Distortion, Fisheye, Lens, StereoRig};
use stereopsis_host::calibrate::board::{find, find_marked};
use stereopsis_host::calibrate::scene::BoardCamera;
use stereopsis_host::calibrate::{LensModel, SolveError, View, solve, solve_paired};
use stereopsis_host::scene::Random;

/// 25 mm.
const SQUARE_M: f64 = 0.025;

/// Where the corners are, off by `sigma` px along each axis.
fn views(sigma: f64) -> Vec<View> {
    let (pattern, cameras) = (pattern(9, 6), BoardCamera::pair(&rig()));
    let mut random = Random::new(9);
    let mut off = move || sigma * random.gauss();
    let view = |(axis, place)| {
        let stands = stand(pattern, axis, place, SQUARE_M);
        let corners = [0, 1].map(|i| {
            let corners = cameras[i].corners(pattern, &stands[i]).expect("all in the image");
            corners.into_iter().map(|p| p + Vector2::new(off(), off())).collect()
        });
        View::whole(corners)
    };
    STANDS.into_iter().map(view).collect()
}

#[test]
fn a_rig_comes_back_from_exact_corners() {
    let found = solve(LensModel::Brown, pattern(9, 6), SQUARE_M, SIZE, &views(0.0)).expect("a rig");
    assert!(found.rms_px < 1e-6, "{}", found.rms_px);
    let truth = rig();
    assert!((found.rig.baseline_m() - truth.baseline_m()).abs() < 1e-8);
    assert!((found.rig.pose().rotation() - truth.pose().rotation()).amax() < 1e-7);
    for (found, truth) in found.rig.cameras().iter().zip(truth.cameras()) {
        assert!((found.matrix() - truth.matrix()).amax() < 1e-4);
        let [Lens::BrownConrady(a), Lens::BrownConrady(b)] = [found, truth].map(|camera| *camera.lens())
        else {
            panic!("another lens")
        };
        assert!(a.to_opencv().iter().zip(b.to_opencv()).all(|(a, b)| (a - b).abs() < 1e-4), "{a:?} {b:?}");
    }
    assert!(found.outliers().is_empty());
}

/// Lenses of the other models, from exact corners and from the model that has them.
#[test]
fn other_lenses_come_back_from_exact_corners() {
    let rational = Distortion::from_opencv_rational([-0.1, 0.02, 0.0006, -0.0004, 0.001, 0.15, 0.03, 0.002]);
    let fisheye = Fisheye::from_opencv([0.02, -0.008, 0.003, -0.001]);
    for (model, lens) in
        [(LensModel::Rational, Lens::from(rational)), (LensModel::Fisheye, Lens::from(fisheye))]
    {
        let pattern = pattern(9, 6);
        let cameras = rig().cameras().map(|camera| {
            let camera = camera.with_distortion(lens).expect("a lens");
            BoardCamera::new(camera, SIZE)
        });
        let view = |(axis, place)| {
            let stands = stand(pattern, axis, place, SQUARE_M);
            let corners = [0, 1].map(|i| cameras[i].corners(pattern, &stands[i]));
            let [Some(left), Some(right)] = corners else { return None };
            Some(View::whole([left, right]))
        };
        let views: Vec<_> = STANDS.into_iter().filter_map(view).collect();
        assert!(views.len() >= 8, "{model:?}: {}", views.len());
        let found = solve(model, pattern, SQUARE_M, SIZE, &views).expect("a rig");
        // Bounds on the rational model's coefficients cost a hundredth of a pixel.
        assert!(found.rms_px < 0.01, "{model:?}: {}", found.rms_px);
        // A camera by itself has the same coefficients, and fits as well.
        assert!(found.alone_px.iter().all(|&px| px < 0.01), "{model:?}: {:?}", found.alone_px);
        assert!(
            (found.rig.baseline_m() / rig().baseline_m() - 1.0).abs() < 1e-3,
            "{model:?}: {:?}",
            found.rig
        );
        let is_fisheye = matches!(found.rig.cameras()[0].lens(), Lens::Fisheye(_));
        assert_eq!(is_fisheye, model == LensModel::Fisheye);
    }
}

#[test]
fn a_rig_from_noisy_corners_is_as_near_as_it_says() {
    let sigma = 0.1;
    let views = views(sigma);
    let found = solve(LensModel::Brown, pattern(9, 6), SQUARE_M, SIZE, &views).expect("a rig");
    // Two coordinates of each corner, less one parameter each: 84 for 2160.
    let expected = sigma * (2.0_f64 * (1.0 - 84.0 / 2160.0)).sqrt();
    assert!((found.rms_px / expected - 1.0).abs() < 0.06, "{} {expected}", found.rms_px);
    let off = (found.rig.baseline_m() - rig().baseline_m()).abs();
    assert!(off < 4.0 * found.baseline_sigma_m, "{off} {}", found.baseline_sigma_m);
    assert!(found.baseline_sigma_m < 1e-4);
    for camera in 0..2 {
        let off = (found.rig.cameras()[camera].focal_px().0 - rig().cameras()[camera].focal_px().0).abs();
        assert!(off < 4.0 * found.focal_sigma_px[camera] && off < 1.0, "{off}");
    }
    // What moves no parameter is at a minimum: no other rig fits better.
    let again = solve(LensModel::Brown, pattern(9, 6), SQUARE_M, SIZE, &views[..9]).expect("a rig");
    assert!(again.rms_px < found.rms_px * 1.05);
}

/// Views of boards, each bent in its own way by so many squares, in the middle of its sides (a standard
/// deviation), with corners that are off by 0.1 px along each axis.
fn bent_views(count: usize, bend: f64, random: &mut Random) -> Vec<View> {
    let pattern = pattern(9, 6);
    let view = |(axis, place)| {
        let stands = stand(pattern, axis, place, SQUARE_M);
        let [along, down] = [(); 2].map(|()| bend * random.gauss());
        let corners = [0, 1].map(|i| {
            let corner = |p: Point2<f64>| {
                let height = along * (p.x / 4.0 - 1.0).powi(2) + down * (p.y / 2.5 - 1.0).powi(2);
                let point = stands[i].transform(&Point3::new(p.x, p.y, height));
                let seen = rig().cameras()[i].project(&point).expect("in front");
                seen + 0.1 * Vector2::new(random.gauss(), random.gauss())
            };
            pattern.places().map(corner).collect()
        });
        View::whole(corners)
    };
    STANDS.into_iter().take(count).map(view).collect()
}

/// Deviations are those of many tries: where all corners are off by themselves, and where those of one view
/// go together, for its board is bent.
#[test]
fn a_rig_is_as_far_off_as_it_says() {
    const TRIES: usize = 30;
    const WHAT: [&str; 4] = ["left focal length", "right focal length", "baseline", "yaw"];
    let (truth, mut random) = (rig(), Random::new(5));
    let numbers = |rig: &StereoRig<f64>| {
        let [left, right] = rig.cameras().each_ref().map(|camera| camera.focal_px().0);
        let turn = Rotation3::from_matrix_unchecked(rig.pose().to_opencv().0).scaled_axis();
        [left, right, rig.baseline_m(), turn.y]
    };
    for (count, bend) in [(10, 0.0), (10, 0.03), (6, 0.03), (4, 0.0)] {
        let (mut off, mut told) = ([0.0; 4], [0.0; 4]);
        for _ in 0..TRIES {
            let views = bent_views(count, bend, &mut random);
            let found = solve(LensModel::Brown, pattern(9, 6), SQUARE_M, SIZE, &views).expect("a rig");
            let errors = numbers(&found.rig).into_iter().zip(numbers(&truth));
            let [left, right] = found.focal_sigma_px;
            let sigmas = [left, right, found.baseline_sigma_m, found.yaw_rad[1]];
            for (i, ((found, truth), sigma)) in errors.zip(sigmas).enumerate() {
                off[i] += (found - truth).powi(2);
                told[i] += sigma * sigma;
            }
        }
        for (what, (off, told)) in WHAT.iter().zip(off.into_iter().zip(told)) {
            let ratio: f64 = f64::sqrt(off / told);
            assert!((0.6..1.5).contains(&ratio), "{count} views, bend {bend}, {what}: {ratio}");
        }
    }
}

#[test]
fn a_view_that_fits_badly_is_named() {
    let mut views = views(0.05);
    let mut random = Random::new(1);
    for corner in views[4].corners.iter_mut().flatten() {
        *corner += Vector2::new(random.gauss(), random.gauss());
    }
    let found = solve(LensModel::Brown, pattern(9, 6), SQUARE_M, SIZE, &views).expect("a rig");
    assert_eq!(found.outliers(), [4]);
}

/// Two pairs whose right pictures are exchanged spoil the fit so that good ones fit worst: those come back.
#[test]
fn only_what_does_not_belong_together_is_left_out() {
    let views = views(0.1);
    for (a, b) in [(1, 2), (3, 6), (0, 5)] {
        let mut mixed = views.clone();
        (mixed[a].corners[1], mixed[b].corners[1]) =
            (views[b].corners[1].clone(), views[a].corners[1].clone());
        let (found, kept) =
            solve_paired(LensModel::Brown, pattern(9, 6), SQUARE_M, SIZE, &mixed).expect("a rig");
        let others: Vec<_> = (0..views.len()).filter(|&view| view != a && view != b).collect();
        assert!(kept == others && found.rms_px < 0.2, "{a} {b}: {kept:?} {}", found.rms_px);
    }
}

#[test]
fn too_little_is_refused_or_said_to_be_uncertain() {
    let views = views(0.05);
    let few = solve(LensModel::Brown, pattern(9, 6), SQUARE_M, SIZE, &views[..2]);
    assert_eq!(few, Err(SolveError::TooFew { views: 2 }));
    // The same view again and again says nothing of the focal length.
    let same = vec![views[9].clone(); 5];
    match solve(LensModel::Brown, pattern(9, 6), SQUARE_M, SIZE, &same) {
        Ok(found) => {
            assert!(found.focal_sigma_px[0].is_nan() || found.focal_sigma_px[0] > 0.03 * 165.0, "{found:?}")
        }
        Err(error) => assert!(matches!(error, SolveError::Camera(_)), "{error}"),
    }
}

/// From pictures: what the whole way costs.
#[test]
fn a_rig_comes_back_from_pictures() {
    let (pattern, cameras) = (pattern(9, 6), BoardCamera::pair(&rig()));
    let mut random = Random::new(2);
    let view = |(axis, place)| {
        let stands = stand(pattern, axis, place, SQUARE_M);
        let corners = [0, 1].map(|i| {
            let picture = cameras[i].picture(pattern, &stands[i], 1.5, &mut random);
            find(&picture, pattern, None).expect("a board").corners
        });
        View::whole(corners)
    };
    let views: Vec<_> = STANDS.into_iter().map(view).collect();
    let found = solve(LensModel::Brown, pattern, SQUARE_M, SIZE, &views).expect("a rig");
    let (b, truth) = (found.rig.baseline_m(), rig().baseline_m());
    assert!((b / truth - 1.0).abs() < 0.005, "{b} {truth}");
    assert!(found.rms_px < 0.2, "{}", found.rms_px);
}

/// Parts of boards, other ones in the left and in the right picture, reach all borders.
#[test]
fn a_rig_comes_back_from_parts_of_boards() {
    let (pattern, markers, cameras) = (pattern(7, 5), markers("4x4_50", 0.75), BoardCamera::pair(&rig()));
    let mut random = Random::new(12);
    let view = |(axis, place)| {
        let stands = stand(pattern, axis, place, SQUARE_M);
        let boards = [0, 1].map(|i| {
            let picture = cameras[i].marked_picture(pattern, Some(&markers), &stands[i], 1.5, &mut random);
            find_marked(&picture, pattern, &markers).expect("a part of a board")
        });
        View::new(boards)
    };
    let views: Vec<_> = CLOSE_STANDS.into_iter().map(view).collect();
    let differs = views.iter().filter(|view| view.numbers[0] != view.numbers[1]).count();
    assert!(differs >= 3, "{differs}");
    let found = solve(LensModel::Brown, pattern, SQUARE_M, SIZE, &views).expect("a rig");
    let (b, truth) = (found.rig.baseline_m(), rig().baseline_m());
    assert!((b / truth - 1.0).abs() < 0.005, "{b} {truth}");
    assert!(found.rms_px < 0.2, "{}", found.rms_px);
    for (figures, view) in found.views.iter().zip(&views) {
        let counts = [0, 1].map(|i| (figures.residuals[i].len(), view.corners[i].len()));
        assert!(counts.iter().all(|(residuals, corners)| residuals == corners), "{counts:?}");
    }
}
