//! The pipeline against its naive twin: every disparity, flag, deviation and confidence, to the bit, for
//! every kernel.
//!
//! * `list`: all sizes, ranges, pictures and checks; `pictures`: every kind of picture. `any`: any
//!   combination of them. `penalties`: those at the bounds.
//! * `frames`: one frame after the other, faults and changes in between. `moved`: a matcher that changes its
//!   place. `external`: rows of winners from outside.

mod any;
mod external;
mod frames;
mod list;
mod moved;
mod penalties;
mod pictures;

use image::GrayImage;
use stereopsis::camera::StereoSource;
use stereopsis::imaging::Noise;
use stereopsis::matching::{Block, Config, Fast, Kernel, Method, Sgm, SgmEdge, SgmLean};
use stereopsis::pipeline::{Pipeline, PipelineError};
use stereopsis_model::scene::SceneCamera;
use stereopsis_model::scene::pattern::Pattern;
use stereopsis_model::twin::cost::{costs, window_sums, window_sums_plain};
use stereopsis_model::twin::smooth::Seen;
use stereopsis_model::twin::{self, Answers, Picture, match_pair};

/// The capacity of the pipelines here.
const W: usize = 704;
const D: usize = 256;
/// Another number of disparities, no multiple of 32: candidates come in half-words.
const HALVES: usize = 240;
type Any<S> = Pipeline<S, W, D>;

/// A method of the core with the twin's description of it.
trait Twin: Method {
    const TWIN: twin::Method;
}

impl Twin for Fast {
    const TWIN: twin::Method = twin::Method::FAST;
}

impl Twin for Block {
    const TWIN: twin::Method = twin::Method::BLOCK;
}

impl Twin for Sgm {
    const TWIN: twin::Method = twin::Method::SGM;
}

impl Twin for SgmEdge {
    const TWIN: twin::Method = twin::Method::SGM_EDGE;
}

impl Twin for SgmLean {
    const TWIN: twin::Method = twin::Method::SGM_LEAN;
}

/// All rows of the camera's next frame.
fn rows<S: Method, C: StereoSource, const D: usize>(
    pipeline: &mut Pipeline<S, W, D>,
    camera: &mut C,
) -> Result<Answers, PipelineError<C::Error>> {
    let format = camera.format();
    let (width, height) = (usize::from(format.width), usize::from(format.height));
    let (disparity, flags, sigma_px, confidence) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut map = Answers { width, height, disparity, flags, sigma_px, confidence };
    pipeline.begin_frame(camera)?;
    let mut due = 0;
    while let Some(row) = pipeline.next_row(camera)? {
        assert_eq!(row.index(), due, "rows come in order");
        due += 1;
        map.disparity.extend_from_slice(row.disparities());
        map.flags.extend_from_slice(row.flags());
        map.confidence.extend_from_slice(row.confidences());
        map.sigma_px.extend((0..width).map(|x| row.sigma_px(x)));
        assert_eq!(row.sigma_px(width), None, "there is no pixel beside the image");
    }
    assert_eq!(due, format.height, "every row comes out");
    Ok(map)
}

/// Where two maps differ first, in words; `None` where they are equal.
fn difference(core: &Answers, twin: &Answers) -> Option<String> {
    assert_eq!((core.width, core.height), (twin.width, twin.height));
    assert_eq!(core.disparity.len(), twin.disparity.len());
    assert_eq!(core.confidence.len(), twin.confidence.len());
    let bits = |sigma: Option<f32>| sigma.map(f32::to_bits);
    let at = (0..core.disparity.len()).find(|&i| {
        core.disparity[i] != twin.disparity[i]
            || core.flags[i] != twin.flags[i]
            || bits(core.sigma_px[i]) != bits(twin.sigma_px[i])
            || core.confidence.get(i) != twin.confidence.get(i)
    })?;
    let pixel = |map: &Answers| {
        let (raw, flags) = (map.disparity[at].raw(), map.flags[at].bits());
        format!(
            "raw {raw} flags {flags:#08b} sigma {:?} confidence {:?}",
            map.sigma_px[at],
            map.confidence.get(at)
        )
    };
    let (x, y) = (at % core.width, at / core.width);
    Some(format!("column {x}, row {y}: the core says {}, the twin {}", pixel(core), pixel(twin)))
}

/// Runs the pair through the pipeline with every kernel and compares with the twin, whose answers are
/// returned.
fn compare<S: Twin, const D: usize>(
    pipeline: &mut Pipeline<S, W, D>,
    config: &Config,
    pair: &(GrayImage, GrayImage),
) -> Result<Answers, String> {
    let expected = match_pair(&S::TWIN, config, &pair.0, &pair.1);
    for kernel in Kernel::available() {
        pipeline.set_kernel(kernel).expect("an available kernel");
        pipeline.start(config).map_err(|e| format!("{config:?}: {e}"))?;
        assert_eq!(pipeline.kernel(), kernel);
        let mut camera = SceneCamera::new(pair.0.clone(), pair.1.clone());
        let map = rows(pipeline, &mut camera).map_err(|e| format!("{config:?}: {e}"))?;
        if let Some(where_first) = difference(&map, &expected) {
            return Err(format!("{} with kernel {}: {where_first}; {config:?}", S::NAME, kernel.name()));
        }
    }
    Ok(expected)
}

/// Whether an emulator runs the tests, which takes ten times as long: `cargo xtask test` says so.
fn emulated() -> bool {
    std::env::var_os("STEREOPSIS_EMULATED").is_some()
}

/// All of a long list; in an emulator every `nth` of it.
fn long<T>(list: impl IntoIterator<Item = T>, nth: usize) -> impl Iterator<Item = T> {
    list.into_iter().step_by(if emulated() { nth } else { 1 })
}

fn pipeline<S: Method>() -> Box<Any<S>> {
    Box::new(Pipeline::new())
}

#[test]
fn the_twins_window_sums_are_the_plain_ones() {
    let (left, right) = Pattern::Noise.pair(23, 17, 3);
    for scheme in [twin::Method::FAST, twin::Method::BLOCK] {
        let twin::Cost::Window { neighbours, unit } = scheme.cost else { panic!("a window") };
        for (config, left, right) in [
            (Config::for_method::<Block>(23, 17, 20), &left, &right),
            (
                Config::for_method::<Block>(3, 2, 16),
                &Pattern::Noise.pair(3, 2, 4).0,
                &Pattern::Noise.pair(3, 2, 5).1,
            ),
        ] {
            let seen = [left, right].map(|picture| Seen::new(Picture::new(picture), Noise::None));
            let costs = costs(neighbours, &config, &seen[0], &seen[1]);
            assert_eq!(window_sums(&scheme, unit, &costs), window_sums_plain(&scheme, unit, &costs));
        }
    }
}
