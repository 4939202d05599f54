//! How far answers of rendered stacks are off, beside a plain method: the table of docs/focus.md.

use image::{GrayImage, Luma};
use stereopsis::focus::{Breathing, FocusConfig, ThinLens};
use stereopsis_host::focus::run::run;
use stereopsis_host::focus::scene::{FocusScene, Surface, texture};
use stereopsis_host::focus::stack::Frame;
use stereopsis_host::scene::Random;
use stereopsis_host::twin::focus::{modified_laplacian, numbers};

const WIDTH: usize = 160;
const HEIGHT: usize = 120;

/// A stack: what it is called, how many frames, by how many px discs of blur grow from frame to frame, and
/// the frame in which each pixel is sharp, of one surface or two.
struct Case {
    name: &'static str,
    frames: usize,
    blur_px: f64,
    finest: f64,
    contrast: f64,
    /// From 0 to 1 of the stack; infinite where the surface has a hole.
    surfaces: Vec<fn(f64, f64) -> f64>,
}

fn cases() -> [Case; 4] {
    let square = |x: f64, y: f64| if x.max(y) < 70.0 && x.min(y) > 25.0 { 0.88 } else { f64::INFINITY };
    [
        Case {
            name: "slope, square before it",
            frames: 25,
            blur_px: 0.21,
            finest: 2.0,
            contrast: 160.0,
            surfaces: vec![|x, _| 0.1 + 0.6 * x / 160.0, square],
        },
        Case {
            name: "waves in few frames",
            frames: 16,
            blur_px: 1.0,
            finest: 1.5,
            contrast: 80.0,
            surfaces: vec![|x, y| 0.5 + 0.2 * (0.08 * x).sin() + 0.15 * (0.07 * y).cos()],
        },
        Case {
            name: "cone",
            frames: 30,
            blur_px: 0.6,
            finest: 1.0,
            contrast: 120.0,
            surfaces: vec![|x, y| 0.9 - 0.009 * (x - 80.0).hypot(y - 60.0)],
        },
        Case {
            name: "steps, coarse texture",
            frames: 36,
            blur_px: 0.3,
            finest: 3.0,
            contrast: 120.0,
            surfaces: vec![|x, y| 0.15 + 0.14 * (x / 32.0).floor() + 0.06 * (y / 40.0).floor()],
        },
    ]
}

impl Case {
    /// The frames without noise, and the true one of every pixel, from 1.
    fn render(&self) -> (Vec<GrayImage>, Vec<f64>) {
        let lens = ThinLens::new(4e-3).expect("a lens");
        let [far, near] = [1.2, 0.12].map(|object| lens.image_distance(object).expect("an image"));
        let last = (self.frames - 1) as f64;
        let place = |share: f64| far + (near - far) * share;
        let depth = |share: f64| {
            if share.is_finite() { lens.object_distance(place(share)).expect("an object") } else { share }
        };
        let pixels = || (0..WIDTH * HEIGHT).map(|i| ((i % WIDTH) as f64, (i / WIDTH) as f64));
        let painted = |(share, seed): (&fn(f64, f64) -> f64, u64)| Surface {
            depth_m: pixels().map(|(x, y)| depth(share(x, y))).collect(),
            grey: texture(WIDTH, HEIGHT, self.finest, self.contrast, seed),
        };
        let pixel_m = 6e-6;
        let scene = FocusScene {
            width: WIDTH,
            height: HEIGHT,
            lens,
            // A disc's radius is half the opening by the way of the sensor over its distance.
            aperture_m: 2.0 * self.blur_px * pixel_m * 0.5 * (far + near) / ((near - far) / last),
            pixel_m,
            reference_m: None,
            noise: 0.0,
            surfaces: self.surfaces.iter().zip(1..).map(painted).collect(),
        };
        let frames = (0..self.frames).map(|i| scene.render(place(i as f64 / last), 0)).collect();
        let truth = scene.sharp_m().iter().map(|sharp| (sharp - far) / (near - far) * last + 1.0).collect();
        (frames, truth)
    }
}

/// The frame of every pixel, from 1, by the modified Laplacian in windows of 7 by 7 and a parabola through
/// the logarithms of the largest and its neighbours.
fn plain(frames: &[GrayImage]) -> Vec<f32> {
    let sums: Vec<Vec<f64>> = frames
        .iter()
        .map(|frame| {
            let measured = modified_laplacian(&numbers(frame)).values;
            let window = |x: usize, y: usize| -> i64 {
                let rows = y.saturating_sub(3)..(y + 4).min(HEIGHT);
                rows.map(|v| {
                    measured[v * WIDTH..][x.saturating_sub(3)..(x + 4).min(WIDTH)].iter().sum::<i64>()
                })
                .sum()
            };
            (0..WIDTH * HEIGHT).map(|i| ((1 + window(i % WIDTH, i / WIDTH)) as f64).ln()).collect()
        })
        .collect();
    let top = |i: usize| {
        let largest = (0..frames.len()).max_by(|&a, &b| sums[a][i].total_cmp(&sums[b][i])).unwrap_or(0);
        let middle = largest.clamp(1, frames.len() - 2);
        let [a, b, c] = [middle - 1, middle, middle + 1].map(|f| sums[f][i]);
        let bend = 2.0 * b - a - c;
        let off = if bend > 0.0 { (0.5 * (c - a) / bend).clamp(-1.0, 1.0) } else { (c - a).signum() };
        (middle as f64 + off + 1.0) as f32
    };
    (0..WIDTH * HEIGHT).map(top).collect()
}

/// Median error, the share within a frame of the answers, and the share answered, off the border.
fn errors(found: &[f32], truth: &[f64]) -> [f64; 3] {
    let inside = |i: usize| (6..WIDTH - 6).contains(&(i % WIDTH)) && (6..HEIGHT - 6).contains(&(i / WIDTH));
    let places: Vec<usize> = (0..found.len()).filter(|&i| inside(i)).collect();
    let answered = places.iter().filter(|&&i| found[i].is_finite());
    let mut off: Vec<_> = answered.map(|&i| (f64::from(found[i]) - truth[i]).abs()).collect();
    off.sort_by(f64::total_cmp);
    let count = off.len() as f64;
    [off[off.len() / 2], off.partition_point(|&e| e <= 1.0) as f64 / count, count / places.len() as f64]
}

const START: &str = "<!-- rendered stacks -->\n\n";
const END: &str = "\n<!-- end: rendered stacks -->";

#[test]
fn the_table_of_rendered_stacks() {
    let mut table =
        "| stack | noise, grey levels | median error, frames | within one | answered | plain: median | \
                     within one |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n"
            .to_owned();
    let mut numbers = Vec::new();
    for case in cases() {
        let (clean, truth) = case.render();
        for noise in [0.0, 2.0, 10.0] {
            let mut random = Random::new(9);
            let frames: Vec<GrayImage> = clean
                .iter()
                .map(|frame| {
                    GrayImage::from_fn(WIDTH as u32, HEIGHT as u32, |x, y| {
                        let grey = f64::from(frame.get_pixel(x, y).0[0]) + noise * random.gauss();
                        Luma([grey.round().clamp(0.0, 255.0) as u8])
                    })
                })
                .collect();
            let config = FocusConfig::pixels(WIDTH as u16, HEIGHT as u16);
            let stack = frames.iter().map(|grey| {
                let colours = image::DynamicImage::ImageLuma8(grey.clone()).into_rgb8();
                Ok(Frame { grey: grey.clone(), colours })
            });
            let index = run(&config, stack, |_| Ok(Breathing::NONE)).expect("a map").index();
            let last = frames.len() as f32;
            assert!(index.iter().all(|&i| !i.is_finite() || (1.0..=last).contains(&i)), "{}", case.name);
            let ([median, within, answered], [of_plain, within_plain, _]) =
                (errors(&index, &truth), errors(&plain(&frames), &truth));
            let found = [median, within, answered, of_plain, within_plain];
            let cells: Vec<String> = found.iter().map(|x| format!("{x:.3}")).collect();
            let row = format!("| {} | {noise} | {} |", case.name, cells.join(" | "));
            table += &format!("{row}\n");
            numbers.push(found);
            let (most, least) = if noise < 10.0 { (0.115, 0.9) } else { (0.4, 0.85) };
            assert!(median <= most && answered >= least, "{row}");
        }
    }
    println!("{table}");
    let page =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/focus.md")).expect("docs");
    let (_, rest) = page.split_once(START).expect("the table's start");
    let (stated, _) = rest.split_once(END).expect("its end");
    let rows: Vec<Vec<f64>> = stated
        .lines()
        .skip(2)
        .map(|row| row.split('|').skip(3).filter_map(|cell| cell.trim().parse().ok()).collect())
        .collect();
    assert_eq!(rows.len(), numbers.len(), "the table is\n{table}");
    for (stated, found) in rows.iter().zip(&numbers) {
        // Another machine's sine and logarithm round otherwise.
        let near = stated.len() == found.len() && stated.iter().zip(found).all(|(a, b)| (a - b).abs() < 0.01);
        assert!(near, "{stated:?} {found:?}; the table is\n{table}");
    }
}
