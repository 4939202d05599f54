//! Matches follow a motion that is known.

use super::{config, detect, matched, rows_aligned};
use image::{GrayImage, Luma, imageops};
use nalgebra::{Point2, Rotation3, Vector3};
use stereopsis::features::{Descriptor, Epipolar, Feature, FeatureConfig, Match, MatchConfig, Orientation};
use stereopsis::geometry::{
    camera::{Camera, Pose},
    robust::{RobustConfig, robust_fundamental},
    two_view::{Correspondence, Essential, Fundamental},
};
use stereopsis_host::correspond::{Plan, correspond};
use stereopsis_host::correspond_refine::refine;
use stereopsis_host::scene::Scene;
use stereopsis_host::scene::pattern::Pattern;
use stereopsis_host::two_view::off_degrees;

/// The share of the matches that lie within `px` of where `motion` brings the left point, and how many there
/// are.
fn follow(
    lists: [&[Feature]; 2],
    matches: &[Match],
    px: f32,
    motion: impl Fn(f32, f32) -> [f32; 2],
) -> (f32, usize) {
    let good = matches.iter().filter(|m| {
        let (left, right) = (&lists[0][usize::from(m.left)], &lists[1][usize::from(m.right)]);
        let [x, y] = motion(left.x_px, left.y_px);
        (right.x_px - x).hypot(right.y_px - y) <= px
    });
    (good.count() as f32 / matches.len().max(1) as f32, matches.len())
}

/// How far the matches lie from where `motion` brings their left points, px, by the median.
fn median_off(lists: [&[Feature]; 2], matches: &[Match], motion: impl Fn(f32, f32) -> [f32; 2]) -> f32 {
    let off = matches.iter().map(|m| {
        let (left, right) = (&lists[0][usize::from(m.left)], &lists[1][usize::from(m.right)]);
        let [x, y] = motion(left.x_px, left.y_px);
        (right.x_px - x).hypot(right.y_px - y)
    });
    let mut off: Vec<f32> = off.collect();
    off.sort_by(f32::total_cmp);
    off[off.len() / 2]
}

/// Spots of all sizes.
fn texture(side: u32) -> GrayImage {
    let noise = |sigma: f32, seed| imageops::blur(&Pattern::Noise.pair(side, side, seed).0, sigma);
    let (fine, coarse) = (noise(1.5, 1), noise(4.0, 2));
    GrayImage::from_fn(side, side, |x, y| {
        let [a, b] = [&fine, &coarse].map(|image| i32::from(image.get_pixel(x, y).0[0]) - 127);
        Luma([(127 + 2 * a + 6 * b).clamp(0, 255) as u8])
    })
}

#[test]
fn a_shift_by_whole_cells_shifts_all_features() {
    let scene = texture(280);
    let [left, right] =
        [(0, 0), (64, 32)].map(|(x, y)| imageops::crop_imm(&scene, x, y, 200, 200).to_image());
    let [left, right] = [left, right].map(|image| detect(&config(&image), &image).0);
    // Whole cells that both pictures have, away from the margins.
    let inside =
        |f: &&Feature, x: f32, y: f32| (x..x + 64.0).contains(&f.x_px) && (y..y + 64.0).contains(&f.y_px);
    let shifted: Vec<_> = left.iter().filter(|f| inside(f, 96.0, 64.0)).collect();
    let expected: Vec<_> = right
        .iter()
        .filter(|f| inside(f, 32.0, 32.0))
        .map(|f| Feature { x_px: f.x_px + 64.0, y_px: f.y_px + 32.0, ..*f })
        .collect();
    // Four cells with five corners each, where the texture has as many.
    assert!(shifted.len() >= 15, "{}", shifted.len());
    assert_eq!(shifted, expected.iter().collect::<Vec<_>>());
}

/// The scene turned about its middle by an angle, interpolated.
fn turned(scene: &GrayImage, degrees: f32) -> GrayImage {
    let middle = (scene.width() - 1) as f32 / 2.0;
    let (sine, cosine) = degrees.to_radians().sin_cos();
    GrayImage::from_fn(scene.width(), scene.height(), |x, y| {
        let (x, y) = (x as f32 - middle, y as f32 - middle);
        let at = [cosine * x + sine * y + middle, cosine * y - sine * x + middle];
        imageops::interpolate_bilinear(scene, at[0], at[1]).unwrap_or(Luma([127]))
    })
}

#[test]
fn matches_follow_turns() {
    let scene = texture(320);
    let mut table = String::new();
    // Least matches: upright up to 15 degrees, by the centroid all around.
    for (orientation, degrees, least) in [
        (Orientation::Upright, 5.0, 150),
        (Orientation::Upright, -10.0, 120),
        (Orientation::Upright, 15.0, 80),
        (Orientation::Centroid, 15.0, 80),
        (Orientation::Centroid, 90.0, 80),
        (Orientation::Centroid, -160.0, 80),
    ] {
        let lists = [scene.clone(), turned(&scene, degrees)]
            .map(|image| detect(&FeatureConfig { orientation, ..config(&image) }, &image).0);
        let matches = matched(&lists[0], &lists[1], &MatchConfig::new());
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let motion = |x: f32, y: f32| {
            let (x, y) = (x - 159.5, y - 159.5);
            [cosine * x - sine * y + 159.5, cosine * y + sine * x + 159.5]
        };
        let pair = [&lists[0][..], &lists[1]];
        let (share, count) = follow(pair, &matches, 1.5, motion);
        let off = median_off(pair, &matches, motion);
        table +=
            &format!("{orientation:?} {degrees}: {share}, {count} of {}, {off} px off\n", lists[0].len());
        assert!(share >= 0.9 && count >= least && off <= 0.2, "{table}");
    }
    println!("{table}");
}

#[test]
fn matches_in_a_scene_have_its_disparity() {
    let scene = Scene::small(320, 240);
    let (left, right) = scene.render();
    let truth = scene.truth();
    let lists = [left, right].map(|image| detect(&config(&image), &image).0);
    let lists = [&lists[0][..], &lists[1][..]];
    let true_place = |x: f32, y: f32| {
        let at = y.round() as usize * truth.width + x.round() as usize;
        [x - truth.disparity[at], y]
    };
    let everywhere = matched(lists[0], lists[1], &MatchConfig::new());
    let (share, count) = follow(lists, &everywhere, 1.0, true_place);
    assert!(share >= 0.85 && count >= 170, "{share} of {count}");

    let along = MatchConfig {
        epipolar: Some(Epipolar { fundamental: rows_aligned(), tolerance_px: 1.0 }),
        ..MatchConfig::new()
    };
    let in_rows = matched(lists[0], lists[1], &along);
    let (share_in_rows, count_in_rows) = follow(lists, &in_rows, 1.0, true_place);
    assert!(share_in_rows >= 0.88 && count_in_rows >= 170, "{share_in_rows} of {count_in_rows}");
    let most_off = in_rows
        .iter()
        .map(|m| (lists[0][usize::from(m.left)].y_px - lists[1][usize::from(m.right)].y_px).abs());
    assert!(most_off.fold(0.0, f32::max) < 1.001);

    // Corners that both cameras see are found again, and to a fraction of a pixel.
    let off = median_off(lists, &in_rows, true_place);
    let again = lists[0].iter().filter(|f| {
        let [x, y] = true_place(f.x_px, f.y_px);
        lists[1].iter().any(|g| (g.x_px - x).hypot(g.y_px - y) <= 1.5)
    });
    let repeated = again.count() as f32 / lists[0].len() as f32;
    println!(
        "{share} of {count}, in rows {share_in_rows} of {count_in_rows}, {off} px off, found again \
         {repeated}"
    );
    assert!(off <= 0.2 && repeated >= 0.55, "{off} px off, {repeated} found again");
}

#[test]
fn a_scene_from_two_poses_gives_the_pose() {
    let scene = Scene::small(400, 300);
    let rig = scene.rig();
    let (focal, (cx, cy)) = (f64::from(rig.focal_px()), rig.principal_point());
    let camera = Camera::new(focal, focal, cx.into(), cy.into()).expect("a camera");
    // Turned to the left, up and about the axis; to the right, down and ahead.
    let mut table = String::new();
    for (turn, step) in [([0.02, -0.10, 0.05], [0.25, 0.04, 0.1]), ([-0.03, 0.05, -0.2], [-0.15, 0.1, 0.05])]
    {
        let rotation = Rotation3::new(Vector3::from(turn));
        let pose = Pose::new(*rotation.matrix(), Vector3::from(step)).expect("a rotation");
        let [left, right] = [scene.render().0, scene.seen_from(&pose).with_noise(1.0, 7).render().0];
        let found = correspond(&Plan::default(), &left, &right).expect("pictures within the capacity");
        let seen: Vec<_> = found
            .points()
            .map(|points| points.map(f64::from))
            .map(|[x1, y1, x2, y2]| Correspondence {
                first: Point2::new(x1, y1),
                second: Point2::new(x2, y2),
            })
            .collect();
        let truth = Fundamental::from_cameras(&pose, &camera, &camera).expect("a baseline");
        let right = seen.iter().filter(|s| truth.sampson_px(s).abs() < 1.0).count();
        let mut inliers = vec![false; seen.len()];
        let robust = robust_fundamental(&seen, &RobustConfig::new(1.0), &mut inliers).expect("an estimate");
        let start = Essential::from_fundamental(&robust.fundamental, &camera, &camera).expect("rank 2");
        let essential = start.refined(&seen, &camera, &camera, 1.0).expect("rank 2");
        let kept = seen.iter().zip(&inliers).filter(|&(_, &inlier)| inlier).map(|(s, _)| *s);
        let recovered = essential.recover_pose(kept, &camera, &camera).expect("a pose");
        let (rotation, direction) = off_degrees(&recovered.pose.in_baselines(), &pose);
        table +=
            &format!("{right} of {} right, off by {rotation:.3} and {direction:.3} degrees\n", seen.len());
        assert!(right >= 200 && 10 * right >= 8 * seen.len() && rotation < 0.5 && direction < 2.0, "{table}");
    }
    println!("{table}");
}

#[test]
fn strangers_differ_in_about_half_of_the_bits() {
    let lists = [1, 2].map(|seed| {
        let image = imageops::blur(&Pattern::Noise.pair(200, 200, seed).0, 2.0);
        detect(&FeatureConfig { threshold: 2, ..config(&image) }, &image).0
    });
    let pairs = lists[0].iter().flat_map(|a| lists[1].iter().map(|b| a.descriptor.distance(&b.descriptor)));
    let (sum, count) = pairs.fold((0, 0), |(sum, count), d| (sum + u32::from(d), count + 1));
    let mean = sum as f32 / count as f32;
    let half = f32::from(Descriptor::BITS) / 2.0;
    assert!(count > 1000 && (mean - half).abs() < 6.0, "{mean} bits of {count} pairs");
}

#[test]
fn aligned_matches_are_right_to_a_twentieth_of_a_pixel() {
    // A surface seen from two places: the second picture is an affine map of the first, both sampled from one
    // four times as fine.
    let fine =
        imageops::blur(&imageops::resize(&texture(360), 1440, 1440, imageops::FilterType::CatmullRom), 2.0);
    let sampled = |map: &dyn Fn(f64, f64) -> [f64; 2]| {
        GrayImage::from_fn(300, 300, |x, y| {
            // The mean of 4 x 4 samples within a pixel.
            let samples = (0..16).map(|i| {
                let [u, v] = map(
                    f64::from(x) + f64::from(i % 4) / 4.0 - 0.375,
                    f64::from(y) + f64::from(i / 4) / 4.0 - 0.375,
                );
                let sample =
                    imageops::interpolate_bilinear(&fine, 4.0 * u as f32 + 1.5, 4.0 * v as f32 + 1.5);
                f64::from(sample.map_or(0, |pixel| pixel.0[0]))
            });
            Luma([(samples.sum::<f64>() / 16.0).round() as u8])
        })
    };
    let (a, b, c, d) = (0.93, 0.12, -0.05, 1.04);
    let left = sampled(&|x, y| [x + 30.0, y + 30.0]);
    // A point x of the second picture lies at A x + t of the first.
    let right = sampled(&|x, y| [a * x + b * y + 30.0 + 3.3, c * x + d * y + 30.0 - 2.6]);
    let determinant = a * d - b * c;
    let motion = |x: f32, y: f32| {
        let (x, y) = (f64::from(x) - 3.3, f64::from(y) + 2.6);
        [((d * x - b * y) / determinant) as f32, ((a * y - c * x) / determinant) as f32]
    };
    let mut found = correspond(&Plan::default(), &left, &right).expect("features");
    let before = median_off([&found.left, &found.right], &found.matches, motion);
    let moved = refine(&left, &right, &mut found);
    let after = median_off([&found.left, &found.right], &found.matches, motion);
    println!("{moved} of {} moved: {before:.3} px off, then {after:.3}", found.matches.len());
    assert!(found.matches.len() > 100 && 10 * moved >= 9 * found.matches.len(), "{moved}");
    assert!(after <= 0.05 && 2.0 * after < before, "{before} {after}");
    // A picture of nothing moves nothing.
    let even = GrayImage::from_pixel(300, 300, Luma([90]));
    let places: Vec<_> = found.points().collect();
    assert_eq!(refine(&left, &even, &mut found), 0);
    assert_eq!(found.points().collect::<Vec<_>>(), places);
}
