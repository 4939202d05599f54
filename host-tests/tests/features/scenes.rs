//! Matches follow a motion that is known.

use super::{config, detect, matched, rows_aligned};
use image::{GrayImage, Luma, imageops};
use stereopsis::features::{Descriptor, Epipolar, Feature, FeatureConfig, Match, Orientation, Search};
use stereopsis_host::scene::Scene;
use stereopsis_host::scene::pattern::Pattern;

/// The share of the matches that lie within `px` of where `motion` brings the left point, and how many there are.
fn follow(lists: [&[Feature]; 2], matches: &[Match], px: f32, motion: impl Fn(f32, f32) -> [f32; 2]) -> (f32, usize) {
    let good = matches.iter().filter(|m| {
        let (left, right) = (&lists[0][usize::from(m.left)], &lists[1][usize::from(m.right)]);
        let [x, y] = motion(left.x_px, left.y_px);
        (right.x_px - x).hypot(right.y_px - y) <= px
    });
    (good.count() as f32 / matches.len().max(1) as f32, matches.len())
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
    let [left, right] = [(0, 0), (64, 32)].map(|(x, y)| imageops::crop_imm(&scene, x, y, 200, 200).to_image());
    let [left, right] = [left, right].map(|image| detect(&config(&image), &image).0);
    // Whole cells that both pictures have, away from the margins.
    let inside = |f: &&Feature, x: f32, y: f32| (x..x + 64.0).contains(&f.x_px) && (y..y + 64.0).contains(&f.y_px);
    let shifted: Vec<_> = left.iter().filter(|f| inside(f, 96.0, 64.0)).collect();
    let expected: Vec<_> = right
        .iter()
        .filter(|f| inside(f, 32.0, 32.0))
        .map(|f| Feature { x_px: f.x_px + 64.0, y_px: f.y_px + 32.0, ..*f })
        .collect();
    assert!(shifted.len() > 10, "{}", shifted.len());
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
        let matches = matched(&lists[0], &lists[1], &Search::new());
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let (share, count) = follow([&lists[0], &lists[1]], &matches, 1.5, |x, y| {
            let (x, y) = (x - 159.5, y - 159.5);
            [cosine * x - sine * y + 159.5, cosine * y + sine * x + 159.5]
        });
        table += &format!("{orientation:?} {degrees}: {share}, {count} of {}\n", lists[0].len());
        assert!(share >= 0.95 && count >= least, "{table}");
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
    let everywhere = matched(lists[0], lists[1], &Search::new());
    let (share, count) = follow(lists, &everywhere, 1.0, true_place);
    assert!(share >= 0.78 && count >= 150, "{share} of {count}");

    let along = Search { epipolar: Some(Epipolar { fundamental: rows_aligned(), tolerance_px: 1.0 }), ..Search::new() };
    let in_rows = matched(lists[0], lists[1], &along);
    let (share_in_rows, count_in_rows) = follow(lists, &in_rows, 1.0, true_place);
    assert!(share_in_rows >= 0.85 && count_in_rows >= 180, "{share_in_rows} of {count_in_rows}");
    let most_off =
        in_rows.iter().map(|m| (lists[0][usize::from(m.left)].y_px - lists[1][usize::from(m.right)].y_px).abs());
    assert!(most_off.fold(0.0, f32::max) < 1.001);

    // Corners that both cameras see are found again, and to a fraction of a pixel.
    let errors = |matches: &[Match]| {
        let mut errors: Vec<f32> = matches
            .iter()
            .map(|m| (lists[0][usize::from(m.left)].y_px - lists[1][usize::from(m.right)].y_px).abs())
            .collect();
        errors.sort_by(f32::total_cmp);
        errors[errors.len() / 2]
    };
    assert!(errors(&everywhere) <= 0.25, "{}", errors(&everywhere));
    let again = lists[0].iter().filter(|f| {
        let [x, y] = true_place(f.x_px, f.y_px);
        lists[1].iter().any(|g| (g.x_px - x).hypot(g.y_px - y) <= 1.5)
    });
    let repeated = again.count() as f32 / lists[0].len() as f32;
    println!("{share} of {count}, in rows {share_in_rows} of {count_in_rows}, found again {repeated}");
    assert!(repeated >= 0.4, "{repeated}");
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
