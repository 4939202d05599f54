//! The parts of docs/performance.md that are made from the code: tables of state and accuracy; and the
//! pictures.
//!
//! A table stands between `<!-- generated: NAME -->` and `<!-- end: NAME -->`, each on a line of its own.

use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::pixelcolor::Rgb565;
use embedded_graphics_simulator::{OutputSettingsBuilder, SimulatorDisplay};
use image::codecs::png::{CompressionType, FilterType as PngFilter, PngEncoder};
use image::imageops::{FilterType, replace, resize};
use image::{DynamicImage, RgbImage};
use std::sync::LazyLock;
use stereopsis::depth::{Decimator, DepthScale, DisparityColours};
use stereopsis::matching::{Block, Fast, Filter, Matcher, Method, Sgm, SgmEdge, SgmLean, state_bytes};
use stereopsis::pipeline::Pipeline;
use stereopsis::units::Disparity;
use stereopsis_host::colour::ColourScale;
use stereopsis_host::map::DisparityMap;
use stereopsis_host::report::Accuracy;
use stereopsis_host::run::{MemoryPair, MethodName, run};
use stereopsis_host::scene::{self, HardScene, Scene, Shares, Truth};

/// Where the picture stands in the repository.
pub const PICTURE: &str = ".github/demo.png";

/// What a display on the device shows, and where that stands.
pub const DISPLAY: &str = ".github/display.png";

/// Columns of each half of the picture.
const HALF_COLUMNS: u32 = 320;

/// A part's name and what makes it.
type Part = (&'static str, fn() -> String);

/// The parts of docs/performance.md that are made here.
const PARTS: [Part; 3] = [("state", state_table), ("accuracy", accuracy_table), ("hard", hard_table)];

/// Parts that need an emulator, real pairs or minutes: `cargo xtask firmware --all`, `growth`, `altered`,
/// `focus`, `rtl --synthesis` and the test `obstacles` make them.
const MADE_ELSEWHERE: [&str; 16] = [
    "firmware",
    "stages",
    "profiles",
    "pose",
    "features",
    "bundle",
    "focus",
    "focus-accuracy",
    "drive",
    "obstacles",
    "odometry",
    "rectify",
    "growth",
    "altered",
    "synthesis",
    "profile",
];

/// docs/performance.md with every part made anew; an error names what is missing or not closed.
pub fn splice(text: &str) -> Result<String, String> {
    splice_parts(text, &PARTS)
}

fn splice_parts(readme: &str, parts: &[Part]) -> Result<String, String> {
    let mut text = readme.to_owned();
    for (name, make) in parts {
        replace_part(&mut text, name, &make())?;
    }
    let elsewhere: usize =
        MADE_ELSEWHERE.iter().map(|name| text.matches(&format!("<!-- generated: {name} -->")).count()).sum();
    match text.matches("<!-- generated: ").count() - elsewhere {
        n if n == parts.len() => Ok(text),
        n => Err(format!("{n} generated parts, of which {} are known", parts.len())),
    }
}

/// Puts what is made between the lines that name a part.
pub fn replace_part(text: &mut String, name: &str, made: &str) -> Result<(), String> {
    let (begin, end) = (format!("<!-- generated: {name} -->\n"), format!("<!-- end: {name} -->"));
    let first = text.find(&begin).ok_or_else(|| format!("there is no line {}", begin.trim()))? + begin.len();
    let length = text[first..].find(&end).ok_or_else(|| format!("there is no line {end}"))?;
    text.replace_range(first..first + length, &format!("\n{made}\n"));
    Ok(())
}

/// Memory and delay of all methods in four sizes.
fn state_table() -> String {
    fn row<S: Method, const W: usize, const D: usize>() -> String {
        let (matcher, pipeline) = (size_of::<Matcher<S, W, D>>(), size_of::<Pipeline<S, W, D>>());
        assert!(matcher < pipeline && matcher <= state_bytes::<S>(W, D), "a pipeline holds its matcher");
        let most = state_bytes::<S>(W, D);
        let delay = Pipeline::<S, W, D>::LATENCY;
        format!("| `{}` | {W} | {D} | {matcher} | {pipeline} | {most} | {delay} |\n", S::NAME)
    }
    let table =
        "| method | pixels in a line | disparities | matcher | pipeline | matcher, at most | delay, lines |\n\
                     | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n"
            .to_owned();
    fn rows<S: Method>() -> String {
        [row::<S, 160, 32>(), row::<S, 320, 64>(), row::<S, 640, 64>(), row::<S, 640, 128>()].concat()
    }
    table + &[rows::<Fast>(), rows::<Block>(), rows::<SgmLean>(), rows::<Sgm>(), rows::<SgmEdge>()].concat()
}

/// The built-in scene, rendered once.
struct Demo {
    scene: Scene,
    camera: MemoryPair,
    left: RgbImage,
    truth: Truth,
}

static DEMO: LazyLock<Demo> = LazyLock::new(|| {
    let scene = Scene::demo();
    let (left, right) = scene.render();
    let truth = scene.truth();
    let camera =
        MemoryPair::new(scene.width(), left.to_vec(), right.to_vec()).expect("two pictures of one size");
    Demo { scene, camera, left: DynamicImage::ImageLuma8(left).into_rgb8(), truth }
});

impl Demo {
    fn match_with(&self, method: MethodName, filter: Filter) -> DisparityMap {
        let search = method.config(self.scene.width(), self.scene.height(), self.scene.disparities());
        let config = method.with_filter(filter, search);
        run(method, &config, &mut self.camera.clone(), |_| ()).expect("a frame").map
    }
}

/// Figures of all methods with the three filters on the built-in scene.
fn accuracy_table() -> String {
    let scale = DepthScale::new(&DEMO.scene.rig()).expect("the scene's rig");
    let mut table = "| method | filter | answered | bad2 of the answers | missed | RMS of the good | within \
                     3 sigma |\n| --- | --- | ---: | ---: | ---: | ---: | ---: |\n"
        .to_owned();
    for method in MethodName::ALL {
        for filter in Filter::ALL {
            let a = Accuracy::of(&DEMO.match_with(method, filter), &DEMO.truth, &scale);
            let filter = filter.name();
            let missed = 1.0 - a.density * (1.0 - a.bad2);
            let percent = |share: f64| format!("{:.2} %", 100.0 * share);
            table += &format!(
                "| `{method}` | `{filter}` | {} | {} | {} | {:.3} px | {} |\n",
                percent(a.density),
                percent(a.bad2),
                percent(missed),
                a.rms_good_px,
                percent(a.within_3_sigma)
            );
        }
    }
    table
}

/// One of the shares.
type Of = fn(&Shares) -> f64;

/// What all methods say of a sky, a white wall, a glossy box, thin poles and chessboards, with the filters
/// that refuse.
fn hard_table() -> String {
    let mut table =
        "| method | filter | sky: answered, near | wall: answered, near, far | glossy: near, far | \
                     poles: answered, far | boards: answered, wrong |\n\
                     | --- | --- | ---: | ---: | ---: | ---: | ---: |\n"
            .to_owned();
    let scenes = [HardScene::street(1.0, 1), HardScene::white_room(1.0, 1), HardScene::boards(1.0, 1)];
    let scenes = scenes.map(|hard| {
        let (left, right) = hard.scene.render();
        let camera = MemoryPair::new(hard.scene.width(), left.to_vec(), right.to_vec())
            .expect("two pictures of one size");
        let truth = hard.scene.truth();
        (hard, camera, truth)
    });
    for method in MethodName::ALL {
        for filter in [Filter::Default, Filter::Strict] {
            let maps = scenes.each_ref().map(|(hard, camera, _)| {
                let search = method.config(hard.scene.width(), hard.scene.height(), hard.scene.disparities());
                run(method, &method.with_filter(filter, search), &mut camera.clone(), |_| ())
                    .expect("a frame")
                    .map
            });
            // The mean over the scenes that show the part.
            let shares = |part: scene::Part, of: Of| {
                let of_scenes: Vec<_> = scenes
                    .iter()
                    .zip(&maps)
                    .filter_map(|((hard, _, truth), map)| Shares::of(hard, truth, &map.disparity, part))
                    .collect();
                format!("{:.1}", 100.0 * of_scenes.iter().map(of).sum::<f64>() / of_scenes.len() as f64)
            };
            let answered: Of = |shares| shares.answered;
            let near: Of = |shares| shares.false_near;
            let far: Of = |shares| shares.false_far;
            let wrong: Of = |shares| shares.false_near + shares.false_far;
            let cells: [(scene::Part, &[_]); 5] = [
                (scene::Part::Sky, &[answered, near]),
                (scene::Part::Wall, &[answered, near, far]),
                (scene::Part::Glossy, &[near, far]),
                (scene::Part::Pole, &[answered, far]),
                (scene::Part::Board, &[answered, wrong]),
            ];
            let cells =
                cells.map(|(part, of)| of.iter().map(|&of| shares(part, of)).collect::<Vec<_>>().join(", "));
            table += &format!("| `{method}` | `{}` | {} |\n", filter.name(), cells.join(" | "));
        }
    }
    table
}

/// The left image beside its disparity in colours, as `stereo demo` writes them, made smaller.
pub fn picture() -> RgbImage {
    let map = DEMO.match_with(MethodName::Block, Filter::Default);
    let colours = ColourScale::of(&map).picture(map.width, &map.pixels());
    let rows = HALF_COLUMNS * map.height as u32 / map.width as u32;
    let mut both = RgbImage::new(2 * HALF_COLUMNS, rows);
    replace(&mut both, &resize(&DEMO.left, HALF_COLUMNS, rows, FilterType::Triangle), 0, 0);
    // An average of two colours would be the colour of another disparity.
    replace(
        &mut both,
        &resize(&colours, HALF_COLUMNS, rows, FilterType::Nearest),
        i64::from(HALF_COLUMNS),
        0,
    );
    both
}

/// The same answers as a display of 160x120 with 16-bit colours shows them, in embedded-graphics' simulator:
/// a block of four by four to a pixel, row by row as on the device.
pub fn display() -> RgbImage {
    const MOST: usize = 640;
    let map = DEMO.match_with(MethodName::Block, Filter::Default);
    let mut display =
        SimulatorDisplay::<Rgb565>::new(Size::new((map.width / 4) as u32, (map.height / 4) as u32));
    let colours = DisparityColours::new(Disparity::from_pixels(4), Disparity::from_pixels(60));
    let mut smaller = Decimator::<MOST, 4>::new();
    smaller.begin();
    for row in map.disparity.chunks_exact(map.width) {
        let mut out = [Disparity::NONE; MOST / 4];
        if let Some(y) = smaller.push(row, &mut out) {
            let Ok(()) = colours.draw_row(&mut display, Point::new(0, y as i32), &out[..map.width / 4]);
        }
    }
    let settings = OutputSettingsBuilder::new().scale(3).pixel_spacing(1).build();
    let shown = display.to_rgb_output_image(&settings);
    let shown = shown.as_image_buffer();
    RgbImage::from_raw(shown.width(), shown.height(), shown.as_raw().to_vec()).expect("three bytes a pixel")
}

/// The picture as a file.
pub fn as_png(picture: &RgbImage) -> Vec<u8> {
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, PngFilter::Adaptive);
    picture.write_with_encoder(encoder).expect("a PNG in memory");
    bytes
}

/// The splicing, on small texts.
mod on_a_small_readme {
    use super::*;

    const PARTS: [Part; 2] = [("one", || "| 1 |\n".into()), ("two", || "| 2 |\n".into())];

    #[test]
    fn parts_must_be_there_and_closed() {
        let error = |readme| splice_parts(readme, &PARTS).unwrap_err();
        assert_eq!(error(""), "there is no line <!-- generated: one -->");
        assert_eq!(error("<!-- generated: one -->\n"), "there is no line <!-- end: one -->");
    }

    #[test]
    fn what_stands_between_the_marks_is_replaced() {
        let part = |name: &str| format!("<!-- generated: {name} -->\nold\n<!-- end: {name} -->\n");
        let readme = format!("before\n{}{}after\n", part("two"), part("one"));
        let made = splice_parts(&readme, &PARTS).expect("all parts are there");
        let expected = "before\n<!-- generated: two -->\n\n| 2 |\n\n<!-- end: two -->\n<!-- generated: one \
                        -->\n\n| 1 |\n\n<!-- end: one -->\nafter\n";
        assert_eq!(made, expected);
        assert_eq!(splice_parts(&made, &PARTS), Ok(made));
        let with_firmware = format!("{readme}{}", part("firmware"));
        assert_eq!(splice_parts(&with_firmware, &PARTS), Ok(format!("{expected}{}", part("firmware"))));
        let unknown = format!("{readme}<!-- generated: other -->\n");
        assert_eq!(splice_parts(&unknown, &PARTS).unwrap_err(), "3 generated parts, of which 2 are known");
    }
}
