//! A pipeline for each method, as firmware has one, and what is done with them.

use crate::message::Message;
use crate::pair::Pair;
use crate::settings::{self, Settings};
use std::fmt::Display;
use stereopsis::camera::{CameraError, StereoSource};
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::geometry::rectify::Rectification;
use stereopsis::imaging::{BalancedPair, Noise, NoiseMeter, RectifiedPair, RemapPair};
use stereopsis::matching::{Block, Config, Fast, Kernel, Method, Row, Sgm, SgmEdge, SgmLean};
use stereopsis::pipeline::Pipeline;
use stereopsis::units::Disparity;

/// Pixels in a row that there is room for.
pub const MOST_WIDTH: usize = 4096;
/// Disparities that there is room for.
const MOST_DISPARITIES: usize = 256;
/// Raw lines that the remaps hold at once, and slots of their tables: as many as `stereo rectify` has.
const REMAP_LINES: usize = 1025;
const REMAP_SLOTS: usize = 300_000;

type Held<S> = Pipeline<S, MOST_WIDTH, MOST_DISPARITIES>;

/// What is seen and what is told of a pair: rows of `width` pixels, `height` of them.
pub struct Planes<'a> {
    /// Pixels in a row.
    pub width: u16,
    /// Rows.
    pub height: u16,
    /// The grey values of both pictures.
    pub pictures: [&'a [u8]; 2],
    /// 1 where rectified pictures show something, else 0; none of others.
    pub masks: Option<[&'a [u8]; 2]>,
    /// The bits of [`PixelFlags`](stereopsis::units::PixelFlags).
    pub flags: &'a mut [u8],
    /// As [`Row::confidences`]; 0 where they are not asked for.
    pub confidences: &'a mut [u8],
    /// In steps of 1/32 px; [`Disparity::NONE`] for no answer.
    pub disparities: &'a mut [u16],
    /// In millimetres, 0 for none.
    pub depths: &'a mut [u16],
    /// As [`Row::sigma_px`], px; 0 where there is no answer.
    pub sigmas: &'a mut [f32],
    /// The one row whose `sigmas` are told, a third of a frame's time for all of them; none for every row.
    pub sigma_row: Option<u16>,
}

impl<'a> Planes<'a> {
    fn pair(&self) -> Pair<'a> {
        let pair = Pair::new(self.width, self.height, self.pictures);
        match self.masks {
            Some(masks) => pair.with_masks(masks),
            None => pair,
        }
    }

    fn put(&mut self, row: &Row<'_>) {
        let width = usize::from(self.width);
        let first = usize::from(row.index()) * width;
        let here = first..first + width;
        let planes = (self.disparities.get_mut(here.clone()), self.flags.get_mut(here.clone()));
        let more = (self.confidences.get_mut(here.clone()), self.sigmas.get_mut(here));
        let ((Some(disparities), Some(flags)), (Some(confidences), Some(sigmas))) = (planes, more) else {
            return;
        };
        for (to, from) in disparities.iter_mut().zip(row.disparities()) {
            *to = from.raw();
        }
        for (to, from) in flags.iter_mut().zip(row.flags()) {
            *to = from.bits();
        }
        confidences.fill(0);
        // Of a row whose confidences are not asked for there are none.
        for (to, from) in confidences.iter_mut().zip(row.confidences()) {
            *to = *from;
        }
        if self.sigma_row.is_none_or(|told| told == row.index()) {
            for (x, to) in sigmas.iter_mut().enumerate() {
                *to = row.sigma_px(x).unwrap_or(0.0);
            }
        }
    }
}

/// The pipelines, the remaps and the settings: all zero at first, so that the module's file has none of it.
pub struct Session {
    /// What is asked for.
    pub settings: Settings,
    /// What was wrong last, in one line.
    pub message: Message,
    remaps: RemapPair<MOST_WIDTH, REMAP_LINES, REMAP_SLOTS>,
    fast: Held<Fast>,
    block: Held<Block>,
    lean: Held<SgmLean>,
    sgm: Held<Sgm>,
    edge: Held<SgmEdge>,
}

/// Does something with the pipeline of the method that the settings name.
macro_rules! with_pipeline {
    ($session:ident, $pipeline:ident => $work:expr) => {
        match settings::method(&$session.settings) {
            0 => {
                let $pipeline = &mut $session.fast;
                $work
            }
            1 => {
                let $pipeline = &mut $session.block;
                $work
            }
            2 => {
                let $pipeline = &mut $session.lean;
                $work
            }
            4 => {
                let $pipeline = &mut $session.edge;
                $work
            }
            _ => {
                let $pipeline = &mut $session.sgm;
                $work
            }
        }
    };
}

impl Session {
    /// Pipelines that were not started.
    pub const fn new() -> Self {
        Self {
            settings: [0; settings::COUNT],
            message: Message::new(),
            remaps: RemapPair::empty(),
            fast: Pipeline::new(),
            block: Pipeline::new(),
            lean: Pipeline::new(),
            sgm: Pipeline::new(),
            edge: Pipeline::new(),
        }
    }

    /// Sets checks and penalties to those that the settings name.
    pub fn preset(&mut self) {
        fn of<S: Method>(_: &Held<S>, settings: &mut Settings) {
            settings::preset::<S>(settings);
        }
        let mut all = self.settings;
        with_pipeline!(self, pipeline => of(pipeline, &mut all));
        self.settings = all;
    }

    /// Takes the warps of a rectification, for [`Self::rectify`]. What is wrong is said by the message.
    pub fn set_warps(&mut self, rectification: &Rectification<f64>) -> bool {
        self.message.clear();
        let set = self.remaps.set(rectification);
        set.map_err(|error| self.message.set(&format_args!("the pictures cannot be rectified: {error}")))
            .is_ok()
    }

    /// Rectifies raw pictures with the warps that were set, line by line, with masks of what they show. What
    /// is wrong is said by the message.
    pub fn rectify(&mut self, raw: Pair<'_>, pictures: [&mut [u8]; 2], masks: [&mut [u8]; 2]) -> bool {
        self.message.clear();
        let width = usize::from(raw.format().width).max(1);
        let ([left, right], [left_mask, right_mask]) = (pictures, masks);
        let lines = left.chunks_exact_mut(width).zip(right.chunks_exact_mut(width));
        let masks = left_mask.chunks_exact_mut(width).zip(right_mask.chunks_exact_mut(width));
        let work = || -> Result<(), String> {
            let mut pair = RectifiedPair::new(raw, &mut self.remaps).map_err(|e| e.to_string())?;
            let say = |error: CameraError<_>| error.to_string();
            pair.start_frame().map_err(say)?;
            for ((left, right), (left_mask, right_mask)) in lines.zip(masks) {
                pair.next_lines(left, right).map_err(say)?;
                for (to, from) in [left_mask, right_mask].into_iter().zip(pair.valid()) {
                    to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
                }
            }
            Ok(())
        };
        let done = work();
        done.map_err(|error| self.message.set(&error)).is_ok()
    }

    /// Measures how noisy the pictures are, balanced if the settings say so, and notes it in the settings.
    pub fn measure(&mut self, planes: &Planes<'_>) -> Noise {
        let mut pair = planes.pair();
        let measured = if settings::balances(&self.settings) {
            let mut balanced = BalancedPair::new(pair);
            // The first frame shows the exposures.
            meter(&mut balanced).and_then(|_| meter(&mut balanced))
        } else {
            meter(&mut pair)
        };
        let noise = measured.map_or(Noise::None, |meter| meter.level());
        settings::set_noise(&mut self.settings, noise);
        noise
    }

    /// Matches the pictures into the other planes, with confidences or without, which take a third of the
    /// time; the milliseconds of the pipeline alone, by a clock of milliseconds. What is wrong is said by the
    /// message.
    pub fn run(&mut self, planes: &mut Planes<'_>, confidence: bool, now: fn() -> f64) -> Option<f64> {
        self.message.clear();
        let config = settings::config(&self.settings, planes.width, planes.height);
        let config = Config { confidence, ..config };
        let last = u32::from(config.min_disparity) + u32::from(config.disparities);
        if last > u32::from(planes.width) {
            let width = planes.width;
            self.message.set(&format_args!("the search ends at {last} px: the pictures are {width} px wide"));
            return None;
        }
        let mut pair = planes.pair();
        let wrong = &mut self.message;
        if settings::balances(&self.settings) {
            let mut balanced = BalancedPair::new(pair);
            // Planes have all their lines.
            let _ = meter(&mut balanced);
            with_pipeline!(self, pipeline => frame(pipeline, &config, &mut balanced, planes, now, wrong))
        } else {
            with_pipeline!(self, pipeline => frame(pipeline, &config, &mut pair, planes, now, wrong))
        }
    }

    /// The depths of the disparities, for cameras of a focal length, a baseline, and a distance between their
    /// principal points. What is wrong is said by the message.
    pub fn depth(&mut self, planes: &mut Planes<'_>, focal_px: f32, baseline_m: f32, offset_px: f32) -> bool {
        self.message.clear();
        let rig = RectifiedRig::with_offset(focal_px, baseline_m, 0.0, 0.0, offset_px);
        let scale = match rig.map(|rig| DepthScale::new(&rig)) {
            Ok(Ok(scale)) => scale,
            Ok(Err(error)) => {
                self.message.set(&error);
                return false;
            }
            Err(error) => {
                self.message.set(&error);
                return false;
            }
        };
        for (depth, &steps) in planes.depths.iter_mut().zip(planes.disparities.iter()) {
            *depth = scale.millimetres(Disparity::from_raw(steps)).0;
        }
        true
    }

    /// The kernel's name.
    pub fn kernel() -> &'static str {
        Kernel::detect().name()
    }
}

impl Default for Session {
    fn default() -> Self {
        Self::new()
    }
}

/// The noise of the source's next frame.
fn meter<C: StereoSource>(source: &mut C) -> Result<NoiseMeter, CameraError<C::Error>> {
    let format = source.format();
    let mut lines = [[0; MOST_WIDTH]; 2];
    let [left, right] = &mut lines;
    let mut meter = NoiseMeter::new();
    let width = usize::from(format.width).min(MOST_WIDTH);
    source.start_frame()?;
    for _ in 0..format.height {
        source.next_lines(left, right)?;
        meter.line(left.get(..width).unwrap_or_default());
        meter.line(right.get(..width).unwrap_or_default());
    }
    Ok(meter)
}

/// One frame: the milliseconds of the pipeline; none where something is wrong.
fn frame<S: Method, C: StereoSource>(
    pipeline: &mut Held<S>,
    config: &Config,
    source: &mut C,
    planes: &mut Planes<'_>,
    now: fn() -> f64,
    wrong: &mut Message,
) -> Option<f64>
where
    C::Error: Display,
{
    let mut say = |error: &dyn Display| wrong.set(error);
    pipeline.start(config).map_err(|e| say(&e)).ok()?;
    pipeline.begin_frame(source).map_err(|e| say(&e)).ok()?;
    let mut time_ms = 0.0;
    loop {
        let start = now();
        let row = pipeline.next_row(source).map_err(|e| say(&e)).ok()?;
        time_ms += now() - start;
        let Some(row) = row else { return Some(time_ms) };
        planes.put(&row);
    }
}
