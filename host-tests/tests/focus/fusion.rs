//! Stereo and focus as one depth: where stereo is blind, focus answers, and where both answer they are surer.

use image::GrayImage;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::depth::{Depth, DepthScale, fuse};
use stereopsis::focus::{FocusScale, ThinLens};
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::matching::{Block, Config};
use stereopsis::pipeline::Pipeline;
use stereopsis_host::focus::run::run;
use stereopsis_host::focus::scene::{FocusScene, Surface, texture};
use stereopsis_host::focus::stack::Frame;

const WIDTH: usize = 128;
const HEIGHT: usize = 64;
/// Focal length and baseline of the pair; the wall's disparity, px, and depth.
const FOCAL_PX: f64 = 800.0;
const BASELINE_M: f64 = 0.004;
const DISPARITY: usize = 8;
const WALL_M: f64 = FOCAL_PX * BASELINE_M / DISPARITY as f64;

/// A wall, speckled on its left and with stripes along the rows on its right, which two cameras side by side
/// see alike at every disparity.
fn wall() -> Vec<f64> {
    let speckles = texture(WIDTH + DISPARITY, HEIGHT, 2.0, 160.0, 5);
    let stripes = texture(1, HEIGHT, 2.0, 160.0, 6);
    let place = |i: usize| (i % (WIDTH + DISPARITY), i / (WIDTH + DISPARITY));
    (0..speckles.len())
        .map(|i| if place(i).0 < WIDTH / 2 { speckles[i] } else { stripes[place(i).1] })
        .collect()
}

/// What the camera sees that stands `shift` columns to the right.
fn scene(shift: usize) -> FocusScene {
    let grey =
        wall().chunks_exact(WIDTH + DISPARITY).flat_map(|row| row[shift..shift + WIDTH].to_vec()).collect();
    FocusScene {
        width: WIDTH,
        height: HEIGHT,
        lens: ThinLens::new(4e-3).expect("a lens"),
        aperture_m: 2e-3,
        pixel_m: 4e-3 / FOCAL_PX,
        reference_m: None,
        noise: 1.0,
        surfaces: vec![Surface { depth_m: vec![WALL_M; WIDTH * HEIGHT], grey }],
    }
}

fn stereo(left: &GrayImage, right: &GrayImage) -> Vec<Option<Depth>> {
    let rig = RectifiedRig::new(FOCAL_PX as f32, BASELINE_M as f32, 64.0, 32.0).expect("a rig");
    let scale = DepthScale::new(&rig).expect("depths");
    let mut pipeline = Box::new(Pipeline::<Block, 128, 16>::new());
    pipeline
        .start(&Config::for_method::<Block>(WIDTH as u16, HEIGHT as u16, 16))
        .expect("within the capacity");
    pipeline.begin().expect("a frame is due");
    let mut depths = Vec::new();
    let mut keep = |row: stereopsis::matching::Row<'_>| {
        let all = row.disparities().iter().enumerate();
        depths.extend(all.map(|(x, &d)| scale.depth(d, row.sigma_px(x)?)));
    };
    for (left, right) in left.chunks_exact(WIDTH).zip(right.chunks_exact(WIDTH)) {
        if let Some(row) = pipeline.push(left, right).expect("lines that are due") {
            keep(row);
        }
    }
    while let Some(row) = pipeline.flush().expect("whole frames") {
        keep(row);
    }
    depths
}

fn focus() -> Vec<Option<Depth>> {
    let lens = ThinLens::new(4e-3_f64).expect("a lens");
    let middle = lens.image_distance(WALL_M).expect("an image") as f32;
    let positions: Vec<f32> = (-7..=7).map(|i| middle + 6e-6 * (i as f32 + 0.3)).collect();
    let scene = scene(0);
    let frames = positions.iter().zip(0..).map(|(&image, seed)| {
        let grey = scene.render(image.into(), seed);
        Ok(Frame { colours: image::DynamicImage::ImageLuma8(grey.clone()).into_rgb8(), grey })
    });
    let found = run((WIDTH as u16, HEIGHT as u16), frames, None, false).expect("a map");
    let scale = FocusScale::new(ThinLens::new(4e-3).expect("a lens"), &positions).expect("a scale");
    found.peaks.iter().map(|peak| scale.depth(peak.as_ref().ok()?).ok()).collect()
}

#[test]
fn focus_answers_where_stereo_is_blind() {
    let sharp = scene(0).lens.image_distance(WALL_M).expect("an image");
    let [left, right] = [0, DISPARITY].map(|shift| scene(shift).render(sharp, 77 + shift as u64));
    let (stereo, focus) = (stereo(&left, &right), focus());
    let mut both = vec![None; stereo.len()];
    fuse(&stereo, &focus, &mut both);
    let part = |map: &[Option<Depth>], from: usize, to: usize| {
        let inside = (0..map.len())
            .filter(|i| (from..to).contains(&(i % WIDTH)) && (8..HEIGHT - 8).contains(&(i / WIDTH)));
        let all: Vec<_> = inside.map(|i| map[i]).collect();
        let right = |d: &Depth| (f64::from(d.depth_m) - WALL_M).abs() <= 3.0 * f64::from(d.sigma_m);
        let sigma: f32 =
            all.iter().flatten().map(|d| d.sigma_m).sum::<f32>() / all.iter().flatten().count().max(1) as f32;
        (all.iter().flatten().filter(|d| right(d)).count() as f64 / all.len() as f64, sigma)
    };
    // On the stripes and on the speckles: the share of pixels with a right answer, and the mean deviation.
    let stripes = [&stereo, &focus, &both].map(|map| part(map, 84, 120));
    let speckles = [&stereo, &focus, &both].map(|map| part(map, 24, 56));
    println!("stereo, focus, both: stripes {stripes:?}, speckles {speckles:?}");
    assert!(stripes[0].0 < 0.3 && stripes[2].0 > 0.9, "{stripes:?}");
    assert!(speckles[2].0 > 0.97 && speckles[2].1 < speckles[0].1.min(speckles[1].1), "{speckles:?}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn what_agrees_is_surer(z in 0.1..50.0_f32, a in 1e-4..0.1_f32, b in 1e-4..0.1_f32,
        off in -2.0..2.0_f32) {
        // Relative deviations, and how many of them the second is off.
        let first = Depth { depth_m: z, sigma_m: a * z };
        let other = z / (1.0 + off * b);
        let second = Depth { depth_m: other, sigma_m: b * other * other / z };
        let both = first.fused(second);
        let swapped = second.fused(first);
        prop_assert!((both.depth_m / swapped.depth_m - 1.0).abs() < 1e-5);
        let (least, most) = (z.min(other), z.max(other));
        prop_assert!(both.depth_m >= least * (1.0 - 1e-5) && both.depth_m <= most * (1.0 + 1e-5));
        // In 1 / Z, where deviations are even.
        let spread = |d: Depth| d.sigma_m / (d.depth_m * d.depth_m);
        prop_assert!(spread(both) <= spread(first).min(spread(second)) * (1.0 + 1e-5));
    }

    #[test]
    fn of_what_contradicts_the_surer_stands(z in 0.1..50.0_f32, a in 1e-4..0.01_f32, b in 1e-4..0.01_f32) {
        let [first, second] = [(z, a), (2.0 * z, b)]
            .map(|(depth_m, part)| Depth { depth_m, sigma_m: part * depth_m });
        let both = first.fused(second);
        prop_assert!(both == first || both == second);
        // Relative deviations are those of 1 / Z times Z.
        if a < 0.45 * b {
            prop_assert_eq!(both, first);
        } else if b < 1.8 * a {
            prop_assert_eq!(both, second);
        }
    }
}
