//! Rendered focus stacks with truth, and how far answers are from it, beside the plain method: the largest
//! modified Laplacian over windows of 7 by 7, with a parabola through three logarithms (Nayar & Nakagawa
//! 1994).

use super::run::{FocusError, run};
use super::scene::{FocusScene, Surface, texture};
use super::stack::Frame;
use image::{DynamicImage, GrayImage};
use stereopsis::focus::{FocusScale, Measure, SharpnessRows, ThinLens};

const WIDTH: usize = 160;
const HEIGHT: usize = 120;

/// A stack that a simulated lens renders.
#[derive(Clone, Debug)]
pub struct RenderedStack {
    /// What it shows.
    pub name: &'static str,
    /// The scene, without noise.
    pub scene: FocusScene,
    /// Where the sensor is in each frame, m.
    pub images_m: Vec<f32>,
}

/// How far the answers for a stack are from the truth.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct FocusScore {
    /// Median error of the answers, frames.
    pub median: f64,
    /// Share of the answers within one frame.
    pub within_one: f64,
    /// Share of the pixels that have an answer.
    pub answered: f64,
}

fn lens() -> ThinLens<f64> {
    ThinLens::new(4e-3).expect("a focal length")
}

/// A sweep of that many frames from 1.2 m to 0.12 m.
fn sweep(frames: usize) -> Vec<f32> {
    let [far, near] =
        [1.2, 0.12].map(|object| lens().image_distance(object).expect("beyond the focal length"));
    (0..frames).map(|i| (far + (near - far) * i as f64 / (frames - 1) as f64) as f32).collect()
}

/// A surface in focus at the share of the sweep that `share` tells of each pixel, if it is there.
fn surface(finest: f64, contrast: f64, seed: u64, share: impl Fn(f64, f64) -> Option<f64>) -> Surface {
    let ends = sweep(2);
    let depth = |share: f64| {
        let image = f64::from(ends[0]) + f64::from(ends[1] - ends[0]) * share;
        lens().object_distance(image).expect("an image beyond the focal length")
    };
    let place = |i: usize| ((i % WIDTH) as f64 / WIDTH as f64, (i / WIDTH) as f64 / HEIGHT as f64);
    let depth_m =
        (0..WIDTH * HEIGHT).map(place).map(|(x, y)| share(x, y).map_or(f64::INFINITY, depth)).collect();
    Surface { depth_m, grey: texture(WIDTH, HEIGHT, finest, contrast, seed) }
}

/// The stacks of the table, all of one size, without noise: surfaces of several shapes and textures, fine
/// and coarse sweeps, and a lens that breathes.
pub fn stacks() -> Vec<RenderedStack> {
    let scene = |aperture_m: f64, surfaces: Vec<Surface>| FocusScene {
        width: WIDTH,
        height: HEIGHT,
        lens: lens(),
        aperture_m,
        pixel_m: 6e-6,
        reference_m: None,
        noise: 0.0,
        surfaces,
    };
    let slope = || surface(2.0, 150.0, 11, |x, _| Some(0.1 + 0.55 * x));
    let square = surface(2.0, 150.0, 12, |x, y| {
        ((0.2..0.45).contains(&x) && (0.2..0.55).contains(&y)).then_some(0.85)
    });
    let cone = surface(2.0, 150.0, 13, |x, y| {
        let radius = ((x - 0.7) * 4.0 / 3.0).hypot(y - 0.6) / 0.25;
        (radius < 1.0).then_some(0.9 - 0.2 * radius)
    });
    let waves = surface(2.0, 150.0, 14, |x, y| Some(0.5 + 0.2 * (9.0 * x).sin() * (7.0 * y).cos()));
    let weak = surface(3.0, 60.0, 15, |x, y| Some(0.2 + 0.3 * x + 0.3 * y));
    let breathing =
        FocusScene { reference_m: Some(sweep(2)[0].into()), ..scene(3e-3, vec![slope(), square.clone()]) };
    [
        ("slope, square and cone", scene(3e-3, vec![slope(), square.clone(), cone.clone()]), 40),
        ("waves", scene(3e-3, vec![waves]), 40),
        ("weak texture on a slope", scene(3e-3, vec![weak]), 40),
        ("coarse sweep", scene(6e-3, vec![slope(), square, cone]), 14),
        ("slope and square, breathing", breathing, 40),
    ]
    .map(|(name, scene, frames)| RenderedStack { name, scene, images_m: sweep(frames) })
    .into()
}

impl RenderedStack {
    /// The frames, with noise of that deviation.
    pub fn frames(&self, noise: f64) -> Vec<GrayImage> {
        let scene = FocusScene { noise, ..self.scene.clone() };
        self.images_m.iter().zip(1..).map(|(&image, seed)| scene.render(image.into(), seed)).collect()
    }

    /// The frame of each pixel, from 1, with its fraction.
    pub fn truth(&self) -> Vec<f64> {
        let (first, last) = (f64::from(self.images_m[0]), f64::from(self.images_m[self.images_m.len() - 1]));
        let step = (last - first) / (self.images_m.len() - 1) as f64;
        self.scene.sharp_m().iter().map(|sharp| (sharp - first) / step + 1.0).collect()
    }

    /// The score of this library's answers for those frames; where the sensor stood is told
    /// only of a lens that breathes, which is corrected.
    pub fn ours(&self, frames: &[GrayImage]) -> Result<FocusScore, FocusError> {
        let lens = ThinLens::new(4e-3).expect("a focal length");
        let scale = FocusScale::new(lens, &self.images_m).expect("positions that rise");
        let all = frames.iter().map(|grey| {
            Ok(Frame { grey: grey.clone(), colours: DynamicImage::ImageLuma8(grey.clone()).into_rgb8() })
        });
        let breathes = self.scene.reference_m.is_some();
        let found = run((WIDTH as u16, HEIGHT as u16), all, breathes.then_some(&scale), breathes)?;
        Ok(score(&found.index(), &self.truth()))
    }

    /// The score of the plain method, which knows of no breathing.
    pub fn plain(&self, frames: &[GrayImage]) -> FocusScore {
        score(&plain(frames), &self.truth())
    }
}

/// The score of the frames that were found, from 1, infinite where there is no answer.
pub fn score(found: &[f32], truth: &[f64]) -> FocusScore {
    let answers = found.iter().zip(truth).filter(|(found, _)| found.is_finite());
    let mut off: Vec<_> = answers.map(|(&found, truth)| (f64::from(found) - truth).abs()).collect();
    off.sort_by(f64::total_cmp);
    let share = |part: usize, all: usize| part as f64 / all.max(1) as f64;
    FocusScore {
        median: off.get(off.len() / 2).copied().unwrap_or(f64::INFINITY),
        within_one: share(off.partition_point(|&off| off <= 1.0), off.len()),
        answered: share(off.len(), truth.len()),
    }
}

/// The frame of each pixel by the plain method, from 1.
fn plain(frames: &[GrayImage]) -> Vec<f32> {
    let volume: Vec<Vec<f64>> = frames.iter().map(sharpness).collect();
    let last = frames.len() - 1;
    let peak = |i: usize| {
        let best = (0..=last).rev().max_by(|&a, &b| volume[a][i].total_cmp(&volume[b][i])).unwrap_or(0);
        if best == 0 || best == last {
            return best as f32 + 1.0;
        }
        let [a, b, c] = [best - 1, best, best + 1].map(|frame| volume[frame][i].max(1.0).ln());
        let bend = 2.0 * b - a - c;
        let off = if bend > 0.0 { (c - a) / (2.0 * bend) } else { 0.0 };
        (best as f64 + 1.0 + off) as f32
    };
    (0..WIDTH * HEIGHT).map(peak).collect()
}

fn sharpness(frame: &GrayImage) -> Vec<f64> {
    let mut rows = SharpnessRows::<WIDTH>::new();
    rows.start(WIDTH as u16, HEIGHT as u16, Measure::ModifiedLaplacian, 3);
    let mut all = Vec::new();
    for line in frame.chunks_exact(WIDTH) {
        rows.push(line, |_, row| all.extend(row.iter().map(|&sum| f64::from(sum))))
            .expect("a line that is due");
    }
    all
}
