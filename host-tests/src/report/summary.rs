//! The figures of a run, for `summary.json` and the report.

use super::Accuracy;
use crate::command_line::words;
use crate::map::{DisparityMap, quantile};
use crate::pair::PairCheck;
use crate::rows::Rows;
use crate::run::{MethodName, Outcome};
use crate::samples::{MILLIMETRE, Samples};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;
use stereopsis::depth::DepthScale;
use stereopsis::imaging::{Balance, NoiseMeter};
use stereopsis::matching::Config;
use stereopsis::units::PixelFlags;

/// What a run was asked for and what came out. Field names are those of `summary.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// The program's version.
    pub version: &'static str,
    /// The command line, word by word.
    pub command: Vec<String>,
    /// The files that were read: the left image, the right one, then the calibration's.
    pub inputs: Vec<String>,
    /// The method's name.
    pub method: &'static str,
    /// The name of the set of checks.
    pub filter: &'static str,
    /// The kernel's name.
    pub kernel: &'static str,
    /// Pixels in a row.
    pub width: u16,
    /// Rows.
    pub height: u16,
    /// How many whole disparities were searched.
    pub disparities: u16,
    /// The smallest of them, px.
    pub min_disparity: u16,
    /// How noisy the images are taken to be: `none`, `low` or `high`.
    pub noise: &'static str,
    /// The deviation of their noise as it was measured, grey levels; absent when it was told, or when no
    /// place shows it.
    pub noise_sigma: Option<f64>,
    /// How the right image was brought to the left one's exposure; absent when it was matched as it came.
    pub balance: Option<Exposure>,
    /// Share of the pixels with an answer, 0 to 1.
    pub density: f64,
    /// Pixels with an answer.
    pub answers: usize,
    /// Pixels with each flag, by its name. A pixel may have several.
    pub flags: BTreeMap<&'static str, usize>,
    /// The answers' disparities; absent when there is none.
    pub disparity_px: Option<Spread>,
    /// Answers of more than `disparity.png` can say, whose samples are its largest one.
    pub disparity_png_clamped: usize,
    /// How sure the answers are, 1 to 207; absent when there is none. The numbers put answers in order, they
    /// are no probabilities.
    pub confidence: Option<Spread>,
    /// Bytes that the matcher's state takes for this width and range.
    pub state_bytes: usize,
    /// How many lines after its own a row came out.
    pub latency_lines: usize,
    /// The pipeline's time for the frame, files and uncertainties left out, milliseconds.
    pub time_ms: f64,
    /// Depths, when there is a calibration.
    pub depth: Option<Depth>,
    /// How well the images' rows agree; absent when too few features match.
    pub rows: Option<Rows>,
    /// What features say of the pair and of the search; absent where nothing looked.
    pub pair: Option<PairCheck>,
    /// How right the answers are, when the truth is known.
    pub accuracy: Option<Accuracy>,
    /// The least confidence that an answer keeps.
    #[serde(skip)]
    min_confidence: u8,
    /// How many threads shared the frame.
    #[serde(skip)]
    pub(super) threads: usize,
}

/// What was made of grey levels: `gain grey + offset`.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Exposure {
    /// The gain.
    pub gain: f64,
    /// The offset, grey levels.
    pub offset: f64,
}

impl Exposure {
    /// What a balance does; `None` when that is nothing.
    pub fn of(balance: Balance) -> Option<Self> {
        let [gain, offset] =
            [i32::from(balance.gain_256ths), balance.offset_256ths].map(|n| f64::from(n) / 256.0);
        (balance != Balance::NONE).then_some(Self { gain, offset })
    }
}

/// Least, middle and largest value.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Spread {
    /// The least.
    pub min: f32,
    /// Half of the values are smaller.
    pub median: f32,
    /// The largest.
    pub max: f32,
}

impl Spread {
    /// Of values in ascending order; `None` of nothing.
    pub fn of(sorted: &[f32]) -> Option<Self> {
        Some(Self {
            min: quantile(sorted, 0.0)?,
            median: quantile(sorted, 0.5)?,
            max: quantile(sorted, 1.0)?,
        })
    }
}

/// What the rig and the range can tell, and the depths that were found.
#[derive(Clone, Debug, Serialize)]
pub struct Depth {
    /// Focal length, px.
    pub focal_px: f32,
    /// Baseline, m.
    pub baseline_m: f32,
    /// What is added to a disparity before it divides, px.
    pub doffs_px: f32,
    /// Depth at the largest disparity that is answered, m. With the three fields below absent when the whole
    /// range lies at or behind infinity.
    pub nearest_m: Option<f32>,
    /// Standard deviation there, m.
    pub sigma_nearest_m: Option<f32>,
    /// Depth at the smallest disparity searched, or at 1 px of parallax, m.
    pub farthest_m: Option<f32>,
    /// Standard deviation there, m.
    pub sigma_farthest_m: Option<f32>,
    /// The depths found, m; absent when there is none.
    pub found_m: Option<Spread>,
    /// The unit of `depth.png`, m.
    pub png_unit_m: f64,
    /// Answers that are farther than `depth.png` can say, whose samples are its largest one.
    pub png_clamped: usize,
    /// The depth beyond which answers are no points of `cloud.ply`, m; absent when all are.
    pub cloud_max_m: Option<f32>,
    /// Answers that are so left out, those at infinity and behind among them.
    pub cloud_left_out: usize,
}

impl Depth {
    fn of(scale: &DepthScale, config: &Config, method: MethodName, map: &DisparityMap) -> Self {
        let range = scale.range(config, method.sigma_px());
        let mut depths: Vec<f32> = map.depth_m(scale).into_iter().filter(|z| z.is_finite()).collect();
        depths.sort_by(f32::total_cmp);
        Self {
            focal_px: scale.rig().focal_px(),
            baseline_m: scale.rig().baseline_m(),
            doffs_px: scale.rig().disparity_offset_px(),
            nearest_m: range.map(|r| r.nearest.0),
            sigma_nearest_m: range.map(|r| r.sigma_nearest.0),
            farthest_m: range.map(|r| r.farthest.0),
            sigma_farthest_m: range.map(|r| r.sigma_farthest.0),
            found_m: Spread::of(&depths),
            png_unit_m: MILLIMETRE,
            png_clamped: 0,
            cloud_max_m: range.map(|r| r.farthest.0),
            cloud_left_out: 0,
        }
    }
}

/// The confidences of the answers, in ascending order.
fn confidences(map: &DisparityMap) -> Vec<f32> {
    let mut confidences: Vec<u8> = map.confidence.iter().copied().filter(|&c| c > 0).collect();
    confidences.sort_unstable();
    confidences.into_iter().map(f32::from).collect()
}

impl Summary {
    /// The figures of `outcome`.
    pub fn new(
        method: MethodName,
        filter: &'static str,
        config: &Config,
        outcome: &Outcome,
        scale: Option<&DepthScale>,
        accuracy: Option<Accuracy>,
    ) -> Self {
        let map = &outcome.map;
        Self {
            version: env!("CARGO_PKG_VERSION"),
            command: words(),
            inputs: Vec::new(),
            method: method.name(),
            filter,
            kernel: outcome.kernel.name(),
            width: config.width,
            height: config.height,
            disparities: config.disparities,
            min_disparity: config.min_disparity,
            noise: config.noise.name(),
            noise_sigma: None,
            balance: None,
            density: map.density(),
            answers: map.answers(),
            flags: PixelFlags::NAMES.into_iter().map(|(flag, name)| (name, map.flagged(flag))).collect(),
            disparity_px: Spread::of(&map.sorted()),
            disparity_png_clamped: Samples::of_disparities(map).clamped,
            confidence: Spread::of(&confidences(map)),
            state_bytes: method.state_bytes(config.width, config.disparities),
            latency_lines: method.latency_lines(),
            time_ms: outcome.time_ms,
            depth: scale.map(|scale| Depth::of(scale, config, method, map)),
            rows: None,
            pair: None,
            accuracy,
            min_confidence: config.min_confidence,
            threads: outcome.threads,
        }
    }

    /// The same with what features say of the pair and of its rows.
    pub fn with_pair(self, pair: Option<PairCheck>, rows: Option<Rows>) -> Self {
        let pair = pair.map(|pair| pair.with_warning(rows.as_ref().and_then(Rows::warning)));
        let summary = Self { pair, rows, ..self };
        let few = summary.few_answers();
        Self { pair: summary.pair.map(|pair| pair.with_warning(few)), ..summary }
    }

    /// What is wrong with the pair and its search, and what would help: a line each.
    pub fn warnings(&self) -> &[String] {
        self.pair.as_ref().map_or(&[], |pair| &pair.warnings)
    }

    /// Why there are few answers, where there are.
    fn few_answers(&self) -> Option<String> {
        let flags = self.flags.iter().map(|(&name, &count)| (name, count));
        let pixels = usize::from(self.width) * usize::from(self.height);
        self.pair.as_ref()?.few_answers(self.answers, pixels, flags, self.min_confidence)
    }

    /// The same with the files that were read.
    pub fn with_inputs<'a>(self, inputs: impl IntoIterator<Item = &'a Path>) -> Self {
        let inputs = inputs.into_iter().map(|path| path.display().to_string()).collect();
        Self { inputs, ..self }
    }

    /// The same with the noise that a meter measured.
    pub fn with_noise(self, meter: Option<&NoiseMeter>) -> Self {
        Self {
            noise_sigma: meter.and_then(NoiseMeter::sigma_16ths).map(|sigma| f64::from(sigma) / 16.0),
            ..self
        }
    }

    /// The same with what was done to the right image.
    pub fn with_balance(self, balance: Balance) -> Self {
        Self { balance: Exposure::of(balance), ..self }
    }
}
