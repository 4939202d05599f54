//! Stacks of frames that a simulated lens renders of scenes of known depth.

use image::GrayImage;
use std::sync::OnceLock;
use stereopsis::focus::{FocusScale, NoFocus, ThinLens};
use stereopsis_host::focus::breathing::Agreement;
use stereopsis_host::focus::evaluation;
use stereopsis_host::focus::run::{FocusResult, run};
use stereopsis_host::focus::scene::{FocusScene, Surface, texture};
use stereopsis_host::focus::stack::Frame;

const WIDTH: usize = 160;
const HEIGHT: usize = 120;
const FRAMES: usize = 25;

/// A sweep of a lens of 4 mm from far to near, m.
fn sweep() -> Vec<f32> {
    let lens = ThinLens::new(4e-3).expect("a lens");
    let [far, near] = [1.2, 0.12].map(|object| lens.image_distance(object).expect("an image"));
    (0..FRAMES).map(|i| (far + (near - far) * i as f64 / (FRAMES - 1) as f64) as f32).collect()
}

/// Depths by how far through the sweep they are in focus, 0 to 1.
fn depth_of(share: f64) -> f64 {
    let (positions, lens) = (sweep(), ThinLens::new(4e-3).expect("a lens"));
    let [first, last] = [positions[0], positions[FRAMES - 1]].map(f64::from);
    lens.object_distance(first + (last - first) * share).expect("an object")
}

/// A slope from far to near with a square before it.
fn scene(finest: f64, contrast: f64, noise: f64) -> FocusScene {
    let all = || (0..WIDTH * HEIGHT).map(|i| (i % WIDTH, i / WIDTH));
    let slope = all().map(|(x, _)| depth_of(0.1 + 0.6 * x as f64 / WIDTH as f64)).collect();
    let inside = |x: usize, y: usize| (30..70).contains(&x) && (25..65).contains(&y);
    let square = all().map(|(x, y)| if inside(x, y) { depth_of(0.88) } else { f64::INFINITY }).collect();
    let painted = |depth_m, seed| Surface { depth_m, grey: texture(WIDTH, HEIGHT, finest, contrast, seed) };
    FocusScene {
        width: WIDTH,
        height: HEIGHT,
        lens: ThinLens::new(4e-3).expect("a lens"),
        aperture_m: 2e-3,
        pixel_m: 6e-6,
        reference_m: None,
        noise,
        surfaces: vec![painted(slope, 1), painted(square, 2)],
    }
}

fn render(scene: &FocusScene) -> Vec<GrayImage> {
    sweep().iter().zip(0..).map(|(&image, seed)| scene.render(image.into(), seed)).collect()
}

/// Answers for frames that breathe as the lens says, or not at all.
fn answer(frames: &[GrayImage], breathing: Option<&FocusScale<'_>>) -> FocusResult {
    answer_of(frames, breathing, breathing.is_some())
}

/// Answers for frames that do not breathe, where positions are known or not.
fn answer_at(frames: &[GrayImage], scale: Option<&FocusScale<'_>>) -> FocusResult {
    answer_of(frames, scale, false)
}

fn answer_of(frames: &[GrayImage], scale: Option<&FocusScale<'_>>, breathes: bool) -> FocusResult {
    let size = (frames[0].width() as u16, frames[0].height() as u16);
    let all = frames.iter().map(|grey| {
        Ok(Frame { grey: grey.clone(), colours: image::DynamicImage::ImageLuma8(grey.clone()).into_rgb8() })
    });
    run(size, all, scale, breathes).expect("a map")
}

/// The true frame of every pixel, from 1.
fn truth(scene: &FocusScene) -> Vec<f64> {
    let positions = sweep();
    let step = f64::from(positions[FRAMES - 1] - positions[0]) / (FRAMES - 1) as f64;
    scene.sharp_m().iter().map(|sharp| (sharp - f64::from(positions[0])) / step + 1.0).collect()
}

/// Median error, the share within a frame, of the answers for pixels off the border.
fn errors(found: &[f32], truth: &[f64]) -> (f64, f64) {
    let inside = |i: usize| (6..WIDTH - 6).contains(&(i % WIDTH)) && (6..HEIGHT - 6).contains(&(i / WIDTH));
    let all = found.iter().zip(truth).enumerate().filter(|(i, (found, _))| inside(*i) && found.is_finite());
    let mut off: Vec<_> = all.map(|(_, (&found, truth))| (f64::from(found) - truth).abs()).collect();
    off.sort_by(f64::total_cmp);
    (off[off.len() / 2], off.partition_point(|&e| e <= 1.0) as f64 / off.len() as f64)
}

/// The frame with the largest Laplacian, pixel by pixel, from 1.
fn plain_argmax(frames: &[GrayImage]) -> Vec<f32> {
    let laplacians: Vec<_> = frames
        .iter()
        .map(|frame| {
            stereopsis_host::twin::focus::laplacian(&stereopsis_host::twin::focus::numbers(frame)).values
        })
        .collect();
    let best =
        |i: usize| (0..frames.len()).rev().max_by_key(|&f| laplacians[f][i].abs()).unwrap_or(0) as f32 + 1.0;
    (0..WIDTH * HEIGHT).map(best).collect()
}

/// The scene with fine texture and little noise, and its frames.
pub fn usual() -> &'static (FocusScene, Vec<GrayImage>) {
    static USUAL: OnceLock<(FocusScene, Vec<GrayImage>)> = OnceLock::new();
    USUAL.get_or_init(|| {
        let scene = scene(2.0, 160.0, 1.0);
        let frames = render(&scene);
        (scene, frames)
    })
}

#[test]
fn textured_pixels_are_a_tenth_of_a_frame_off() {
    let mut table = String::new();
    // Finest detail px, contrast, noise, and what must hold.
    for (finest, contrast, noise, median, share) in
        [(2.0, 160.0, 1.0, 0.05, 0.95), (3.0, 160.0, 3.0, 0.1, 0.95)]
    {
        let (scene, frames) = match usual() {
            usual if finest == 2.0 => usual.clone(),
            _ => {
                let scene = scene(finest, contrast, noise);
                let frames = render(&scene);
                (scene, frames)
            }
        };
        let (found, truth) = (answer(&frames, None), truth(&scene));
        let ours = errors(&found.index(), &truth);
        let plain = errors(&plain_argmax(&frames), &truth);
        let answered = found.answers() as f64 / truth.len() as f64;
        table +=
            &format!("finest {finest}, noise {noise}: {ours:?}, plain {plain:?}, {answered:.3} answered\n");
        assert!(ours.0 <= median && ours.1 >= share && answered > 0.95, "{table}");
        assert!(ours.0 < 0.5 * plain.0 && ours.1 > plain.1, "{table}");
    }
    println!("{table}");
}

#[test]
fn depths_are_within_their_deviations() {
    let (scene, frames) = usual();
    let found = answer(frames, None);
    let positions = sweep();
    let scale = FocusScale::new(ThinLens::new(4e-3).expect("a lens"), &positions).expect("a scale");
    let truth = scene.truth_m();
    let depths = found.peaks.iter().zip(&truth).filter_map(|(peak, &truth)| {
        let depth = scale.depth(peak.as_ref().ok()?).ok()?;
        Some((f64::from(depth.depth_m) - truth).abs() / f64::from(depth.sigma_m))
    });
    let mut sigmas: Vec<_> = depths.collect();
    sigmas.sort_by(f64::total_cmp);
    let within = |most: f64| sigmas.partition_point(|&s| s <= most) as f64 / sigmas.len() as f64;
    println!("within one deviation {:.3}, three {:.3}", within(1.0), within(3.0));
    assert!(within(1.0) > 0.6 && within(3.0) > 0.95, "{} {}", within(1.0), within(3.0));
}

#[test]
fn the_picture_is_sharp_all_over() {
    let (scene, frames) = usual();
    let found = answer(frames, None);
    // Each pixel as the sharp picture has it, but for the blur that the best focus leaves.
    let mut sharp = scene.surfaces[0].grey.clone();
    let front = sharp.iter_mut().zip(&scene.surfaces[1].grey).zip(&scene.surfaces[1].depth_m);
    front.filter(|(_, depth)| depth.is_finite()).for_each(|((grey, near), _)| *grey = *near);
    let off = |grey: &mut dyn Iterator<Item = u8>| -> f64 {
        grey.zip(&sharp).map(|(a, b)| (f64::from(a) - b).abs()).sum::<f64>() / sharp.len() as f64
    };
    let ours = off(&mut found.picture.pixels().map(|p| p.0[0]));
    let best = frames.iter().map(|f| off(&mut f.pixels().map(|p| p.0[0]))).fold(f64::INFINITY, f64::min);
    assert!(ours < 0.7 * best, "{ours} beside {best} of the best frame");
}

#[test]
fn what_has_no_texture_has_no_answer() {
    let blank = FocusScene { noise: 2.0, ..scene(2.0, 0.0, 0.0) };
    let found = answer(&render(&blank), None);
    let share = found.answers() as f64 / found.peaks.len() as f64;
    assert!(share < 0.05, "{share} answered");
    assert!(found.peaks.contains(&Err(NoFocus::Untextured)));
    assert!(found.index().contains(&f32::INFINITY) && found.confidence().contains(&0.0));
}

#[test]
fn brighter_frames_are_no_sharper() {
    let (scene, frames) = usual();
    // The lamp flickers.
    let lit: Vec<_> = frames
        .iter()
        .enumerate()
        .map(|(i, frame)| {
            let gain = [1.0, 0.7, 0.85][i % 3];
            GrayImage::from_fn(frame.width(), frame.height(), |x, y| {
                image::Luma([(f64::from(frame.get_pixel(x, y).0[0]) * gain).round() as u8])
            })
        })
        .collect();
    let (median, share) = errors(&answer(&lit, None).index(), &truth(scene));
    assert!(median <= 0.12 && share >= 0.95, "{median} {share}");
}

#[test]
fn breathing_is_corrected_by_the_lens() {
    let positions = sweep();
    let mut scene = scene(2.0, 160.0, 1.0);
    scene.reference_m = Some(positions[0].into());
    let frames = render(&scene);
    let scale = FocusScale::new(ThinLens::new(4e-3).expect("a lens"), &positions).expect("a scale");
    let corrected = answer(&frames, Some(&scale));
    let left = answer(&frames, None);
    let [ours, plain] = [corrected, left].map(|found| errors(&found.index(), &truth(&scene)));
    println!("corrected {ours:?}, left {plain:?}");
    assert!(ours.0 <= 0.14 && ours.1 >= 0.95 && ours.0 < 0.95 * plain.0, "{ours:?} {plain:?}");
}

#[test]
fn frames_that_grow_are_reported_from_those_that_do_not() {
    let grey = texture(WIDTH, HEIGHT, 3.0, 160.0, 7);
    let seen = |scale: f64| {
        GrayImage::from_fn(WIDTH as u32, HEIGHT as u32, |x, y| {
            let place = |at: u32, size: usize| {
                let middle = (size - 1) as f64 / 2.0;
                (middle + (f64::from(at) - middle) / scale).round() as usize
            };
            image::Luma([grey[place(y, HEIGHT) * WIDTH + place(x, WIDTH)] as u8])
        })
    };
    for (scale, expected) in [(1.03, true), (1.0, false)] {
        let mut agreement = Agreement::default();
        agreement.add(&seen(1.0), &seen(scale), 1.03);
        assert_eq!(agreement.is_breathing(), expected, "{scale}");
    }
    // Four pixels along the diagonal of 200 are two in either corner.
    let telling = [1.0, 1.019, 1.021, 0.97].map(|ratio| Agreement::is_telling((160, 120), ratio));
    assert_eq!(telling, [false, false, true, true]);
}

#[test]
fn answers_are_nearer_than_those_of_the_plain_method() {
    // The largest median error of each stack with noise of 0, 2 and 10 grey levels, frames.
    let medians = [
        [0.08, 0.115, 0.25],
        [0.08, 0.125, 0.3],
        [0.08, 0.115, 0.38],
        [0.08, 0.115, 0.25],
        [0.14, 0.17, 0.25],
    ];
    let mut table = String::new();
    for (stack, medians) in evaluation::stacks().iter().zip(medians) {
        for ((noise, answered), median) in [(0.0, 0.97), (2.0, 0.97), (10.0, 0.85)].into_iter().zip(medians) {
            let frames = stack.frames(noise);
            let (ours, plain) = (stack.ours(&frames).expect("a map"), stack.plain(&frames));
            table += &format!("{}, noise {noise}: {ours:?}, plain {plain:?}\n", stack.name);
            assert!(ours.median <= median && ours.answered >= answered, "{table}");
            let least = plain.within_one.max(if noise == 0.0 { 0.975 } else { 0.91 });
            assert!(ours.median <= plain.median && ours.within_one >= least, "{table}");
        }
    }
    println!("{table}");
}

#[test]
fn what_is_in_front_is_told_in_either_order_of_the_frames() {
    let (scene, frames) = usual();
    let (positions, truth) = (sweep(), truth(scene));
    let lens = ThinLens::new(4e-3).expect("a lens");
    let mirrored = |images_m: &[f32], frames: &[GrayImage]| {
        let scale = FocusScale::new(lens, images_m).expect("a scale");
        [answer_at(frames, None), answer_at(frames, Some(&scale))].map(|found| found.index())
    };
    let (backwards_m, backwards): (Vec<_>, Vec<_>) =
        positions.iter().copied().zip(frames.iter().cloned()).rev().unzip();
    let [told, known] = mirrored(&positions, frames);
    let [backwards_told, backwards_known] = mirrored(&backwards_m, &backwards);
    let (_, share) = errors(&told, &truth);
    assert!(share >= 0.985, "{share}");
    // The answers tell what the positions say, and little depends on which frame is the first: the choice
    // among peaks that are as good, and the brightness that others are compared with.
    assert_eq!(told, known);
    assert_eq!(backwards_told, backwards_known);
    let turned: Vec<f32> = backwards_told.iter().map(|index| (FRAMES + 1) as f32 - index).collect();
    let alike = told.iter().zip(&turned).filter(|(a, b)| (**a - **b).abs() <= 0.05).count();
    assert!(alike as f64 >= 0.95 * told.len() as f64, "{alike} of {}", told.len());
}

#[test]
fn no_answer_leaves_the_stack() {
    // A slope that reaches beyond both ends of the sweep, with noise, of which planes go on.
    let all = || (0..WIDTH * HEIGHT).map(|i| i % WIDTH);
    let mut scene = scene(2.0, 120.0, 6.0);
    scene.surfaces[0].depth_m = all().map(|x| depth_of(-0.04 + 1.3 * x as f64 / WIDTH as f64)).collect();
    scene.surfaces.truncate(1);
    let index = answer(&render(&scene), None).index();
    let outside = index.iter().filter(|i| i.is_finite() && !(1.0..=FRAMES as f32).contains(i)).count();
    assert_eq!(outside, 0);
}
