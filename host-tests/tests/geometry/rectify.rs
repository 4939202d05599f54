//! Rectification: beside OpenCV's figures, on rigs of any pose, and what is refused.

use crate::views::seeded;
use nalgebra::{Matrix3, Point2, Point3, Rotation3, Vector3};
use proptest::prelude::*;
use stereopsis::geometry::{
    camera::{Camera, Distortion, ImageSize, Pose, StereoRig},
    rectify::{Axis, Crop, Rectification, RectifyError},
};

fn camera([fx, fy, cx, cy]: [f64; 4], lens: [f64; 5]) -> Camera<f64> {
    let camera = Camera::new(fx, fy, cx, cy).expect("a camera");
    camera.with_distortion(Distortion::from_opencv(lens)).expect("a lens")
}

/// A rig with what `cv2.stereoRectify` (OpenCV 5.0.0) says of it.
struct Figures {
    cameras: [Camera<f64>; 2],
    size: ImageSize,
    /// As OpenCV writes them: a rotation vector, and T in metres.
    turn: [f64; 3],
    t: [f64; 3],
    axis: Axis,
    /// R1, row by row.
    first: [f64; 9],
    middle: (f64, f64),
    /// With alpha -1, 0 and 1.
    focal: [f64; 3],
}

fn figures() -> [Figures; 3] {
    let small = ImageSize { width: 320, height: 240 };
    [
        Figures {
            cameras: [
                camera([610.0, 600.0, 318.5, 241.2], [-0.31, 0.11, 0.0008, -0.0004, -0.02]),
                camera([605.0, 598.0, 324.1, 236.7], [-0.29, 0.09, -0.0006, 0.0011, -0.01]),
            ],
            size: ImageSize { width: 640, height: 480 },
            turn: [0.012, -0.021, 0.008],
            t: [-0.12, 0.0031, 0.0024],
            axis: Axis::Horizontal,
            first: [
                0.9985904234861186,
                -0.03417583470990474,
                -0.040610078105017634,
                0.03392758192188552,
                0.9994012498396483,
                -0.006786825758957076,
                0.040817708249583404,
                0.005399457457001286,
                0.9991520207417998,
            ],
            middle: (347.5737113952637, 239.39891052246094),
            focal: [599.0, 590.0339287829939, 463.56125440789964],
        },
        Figures {
            cameras: [
                camera([200.0, 199.0, 158.0, 121.5], [-0.15, 0.03, 0.0, 0.0, 0.0]),
                camera([201.0, 202.0, 162.5, 117.0], [-0.16, 0.035, 0.001, -0.0005, 0.0]),
            ],
            size: small,
            turn: [-0.02, 0.05, 0.017],
            t: [-0.06, 0.001, -0.004],
            axis: Axis::Horizontal,
            first: [
                0.9926471368605767,
                -0.035372638217772076,
                0.11576026152360691,
                0.03421995066106442,
                0.9993431144991558,
                0.011930401497086707,
                -0.11610623006218732,
                -0.007881368449830497,
                0.9932055312834822,
            ],
            middle: (125.4155387878418, 118.90623474121094),
            focal: [200.5, 196.40496350179683, 142.78858062805216],
        },
        Figures {
            cameras: [
                camera([300.0, 310.0, 160.2, 118.4], [-0.1, 0.02, 0.001, 0.0, 0.0]),
                camera([305.0, 308.0, 158.8, 122.0], [-0.12, 0.03, 0.0, 0.001, 0.0]),
            ],
            size: small,
            turn: [0.03, -0.01, -0.02],
            t: [0.002, -0.08, 0.003],
            axis: Axis::Vertical,
            first: [
                0.998960280034865,
                0.0451205078584616,
                -0.006519101414973361,
                -0.04545658728236451,
                0.9967136811682226,
                -0.06704876169424341,
                0.0034724033903018197,
                0.06727538586054466,
                0.9977284023580815,
            ],
            middle: (160.0137062072754, 138.81763172149658),
            focal: [302.5, 329.74897626948524, 266.26330273696504],
        },
    ]
}

impl Figures {
    fn rig(&self) -> StereoRig<f64> {
        let turn = Rotation3::new(Vector3::from(self.turn)).into_inner();
        StereoRig::from_opencv(self.cameras, turn, Vector3::from(self.t), [self.size; 2]).expect("a rig")
    }
}

#[test]
fn agrees_with_opencv() {
    for (i, figures) in figures().into_iter().enumerate() {
        for (crop, focal, share) in [
            (Crop::Natural, figures.focal[0], 1e-9),
            // OpenCV looks at nine points of a side, its corners a pixel farther, and takes single
            // precision.
            (Crop::Alpha(0.0), figures.focal[1], 0.01),
            (Crop::Alpha(1.0), figures.focal[2], 0.03),
        ] {
            let rectified =
                Rectification::new(&figures.rig(), crop, figures.size).expect("it can be rectified");
            assert_eq!(rectified.axis(), figures.axis);
            let off = (rectified.warps()[0].rotation() - Matrix3::from_row_slice(&figures.first)).amax();
            assert!(off < 1e-9, "rig {i}: {off:e}");
            let (cx, cy) = rectified.camera().principal_point();
            let (u, v) = figures.middle;
            let f = rectified.camera().focal_px().0;
            assert!((cx - u).abs() < 1.5 && (cy - v).abs() < 1.5, "rig {i}: ({cx}, {cy}), OpenCV ({u}, {v})");
            assert!((f / focal - 1.0).abs() <= share, "rig {i}, {crop:?}: {f} px, OpenCV {focal} px");
            // OpenCV's Q with a positive baseline.
            let q = rectified.q();
            let t = Vector3::from(figures.t).norm();
            assert!((q.m43 * t - 1.0).abs() < 1e-12 && q.m34 == f && q.m14 == -cx && q.m24 == -cy);
        }
    }
}

#[test]
fn nothing_black_at_alpha_nought_and_all_seen_at_one() {
    for figures in figures() {
        let none_lost =
            Rectification::new(&figures.rig(), Crop::Alpha(0.0), figures.size).expect("rectified");
        let report = none_lost.report();
        assert!(report.common > 0.999, "{report:?}");
        let all = Rectification::new(&figures.rig(), Crop::Alpha(1.0), figures.size).expect("rectified");
        let (right, bottom) = (f64::from(figures.size.width - 1), f64::from(figures.size.height - 1));
        for warp in all.warps() {
            for i in 0..=64 {
                let part = f64::from(i) / 64.0;
                for raw in [
                    (part * right, 0.0),
                    (part * right, bottom),
                    (0.0, part * bottom),
                    (right, part * bottom),
                ] {
                    let there =
                        warp.rectify(&Point2::new(raw.0, raw.1)).expect("the lens has a sight for it");
                    let is_in =
                        (-0.5..=right + 0.5).contains(&there.x) && (-0.5..=bottom + 0.5).contains(&there.y);
                    assert!(is_in, "{raw:?} is at {there}");
                }
            }
        }
        assert!(all.report().seen.iter().zip(report.seen).all(|(&all, none)| all < none));
    }
}

#[test]
fn the_report_says_what_a_turn_costs() {
    let size = ImageSize { width: 320, height: 240 };
    let straight = camera([300.0, 300.0, 159.5, 119.5], [0.0; 5]);
    let turned = |degrees: f64| {
        let roll = Rotation3::from_axis_angle(&Vector3::z_axis(), degrees.to_radians()).into_inner();
        let pose = Pose::new(roll, Vector3::new(0.06, 0.0, 0.0)).expect("a pose");
        let rig = StereoRig::new([straight; 2], pose, [size; 2]).expect("a rig");
        Rectification::new(&rig, Crop::Natural, size).expect("rectified").report()
    };
    let still = turned(0.0);
    assert_eq!((still.rows, still.common), ([2; 2], 1.0));
    assert!(still.largest_warp_px.iter().all(|&px| px < 1e-9));
    // The baseline is along the first camera's X: the second turns. 319 columns times sin 2 degrees are 11.1
    // rows.
    let rolled = turned(2.0);
    assert!(rolled.rows[0] == 2 && (12..=14).contains(&rolled.rows[1]), "{rolled:?}");
    // A corner is 199 px from the middle, and 2 degrees of that 6.9 px.
    assert!((6.5..7.0).contains(&rolled.largest_warp_px[1]), "{rolled:?}");
    assert!(rolled.common < 1.0 && rolled.common > 0.95);
    assert!((still.field_of_view_rad[0] - 2.0 * (159.5_f64 / 300.0).atan()).abs() < 1e-9);
    assert!((still.row_error_px(0.3) - 0.3).abs() < 1e-12);
}

#[test]
fn what_cannot_be_rectified_is_refused_by_name() {
    let size = ImageSize { width: 320, height: 240 };
    let one = camera([300.0, 300.0, 159.5, 119.5], [0.0; 5]);
    let of = |t: [f64; 3], turn: [f64; 3], crop| {
        let turn = Rotation3::new(Vector3::from(turn)).into_inner();
        let rig = StereoRig::new([one; 2], Pose::new(turn, Vector3::from(t)).expect("a pose"), [size; 2]);
        Rectification::new(&rig.expect("a rig"), crop, size).map(|_| ())
    };
    let natural = Crop::Natural;
    assert_eq!(of([-0.1, 0.0, 0.0], [0.0; 3], natural), Err(RectifyError::Swapped(Axis::Horizontal)));
    assert_eq!(of([0.0, -0.1, 0.01], [0.0; 3], natural), Err(RectifyError::Swapped(Axis::Vertical)));
    assert_eq!(of([0.01, 0.0, 0.1], [0.0; 3], natural), Err(RectifyError::Forward));
    assert_eq!(of([0.1, 0.0, 0.0], [0.0, 2.0, 0.0], natural), Err(RectifyError::Apart));
    assert_eq!(of([0.1, 0.0, 0.0], [0.0; 3], Crop::Alpha(1.1)), Err(RectifyError::Alpha));
    assert_eq!(of([0.1, 0.0, 0.0], [0.0; 3], Crop::Alpha(f64::NAN)), Err(RectifyError::Alpha));
    assert_eq!(of([0.1, 0.0, 0.0], [0.0; 3], natural), Ok(()));
}

proptest! {
    #![proptest_config(seeded())]

    /// A point of space is on one row of both rectified images, at the disparity of its depth, and warps lead
    /// to where the cameras see it.
    #[test]
    fn rows_are_aligned(
        turn in [-0.1..0.1_f64, -0.15..0.15, -0.1..0.1],
        t in (0.05..0.2_f64, -0.02..0.02_f64, -0.02..0.02_f64),
        lens in [-0.3..0.1_f64, -0.05..0.05, -0.002..0.002, -0.002..0.002, 0.0..0.01],
        point in (-0.3..0.3_f64, -0.2..0.2_f64, 1.5..5.0_f64),
        vertical in any::<bool>(),
    ) {
        let size = ImageSize { width: 640, height: 480 };
        let cameras = [camera([500.0, 510.0, 322.0, 236.0], lens),
            camera([505.0, 498.0, 317.0, 243.0], [0.05, 0.0, 0.0, 0.0, 0.0])];
        let t = if vertical { Vector3::new(t.1, t.0, t.2) } else { Vector3::new(t.0, t.1, t.2) };
        let pose = Pose::new(Rotation3::new(Vector3::from(turn)).into_inner(), t).expect("a pose");
        let rig = StereoRig::new(cameras, pose, [size; 2]).expect("a rig");
        let rectified = Rectification::new(&rig, Crop::Natural, size).expect("rectified");
        let first = Point3::new(point.0 * point.2, point.1 * point.2, point.2);
        let sights = [first, pose.inverse_transform(&first)];
        let seen: Vec<_> = rectified.warps().iter().zip(sights).map(|(warp, point)| {
            let raw = warp.camera().project(&point).expect("in front");
            let there = warp.rectify(&raw).expect("a sight");
            let back = warp.source(&there).expect("in front");
            assert!((back.pixel - raw).norm() < 1e-3, "{} {raw}", back.pixel);
            there
        }).collect();
        let (along, across) = if vertical { (1, 0) } else { (0, 1) };
        prop_assert!((seen[0][across] - seen[1][across]).abs() < 2e-3, "{seen:?}");
        let depth = (rectified.warps()[0].rotation() * first.coords).z;
        let disparity = rectified.camera().focal_px().0 * rectified.baseline_m() / depth;
        prop_assert!((seen[0][along] - seen[1][along] - disparity).abs() < 2e-3);
        let drawn = rectified.rig().expect("a rig").depth_m(disparity as f32).expect("in front");
        prop_assert!((f64::from(drawn) - depth).abs() < 1e-4 * depth);
    }
}
