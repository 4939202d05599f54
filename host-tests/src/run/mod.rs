//! A stereo source through the core's pipeline, as firmware does it: the state lives in a `static`.
//!
//! In: any [`StereoSource`] of 8-bit grey lines. Out: a whole [`DisparityMap`], or the times of frames.
//!
//! * [`MethodName`]: the methods of this build. [`RunOptions`]: a method, on a kernel, in so many threads.
//! * [`run`]: one frame into a map. [`time_frames`]: several, timed.
//! * [`measure_noise`]: a frame for that alone, if [`NoiseChoice`] asks for it.
//! * [`measure_balance`]: the same for the cameras' exposures.
//! * `bands`: a frame in bands, one thread each.
//! * [`run_guarded`]: frames of a source that may fail.
//! * [`MemoryPair`]: a stereo source over two pictures in memory.

mod balance;
mod bands;
mod guarded;
mod memory;
mod noise;

pub use balance::measure_balance;
pub use guarded::{GuardedFrame, run_guarded};
pub use memory::MemoryPair;
pub use noise::{NoiseChoice, UnknownNoise, measure_noise};
pub use stereopsis_rig::method::{MethodName, UnknownMethod};

use self::bands::Bands;
use crate::map::DisparityMap;
use std::fmt;
use std::hint::black_box;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use stereopsis::camera::StereoSource;
use stereopsis::matching::{Block, Config, ConfigError, Fast, Kernel, Method, Row, Sgm, SgmEdge, SgmLean};
use stereopsis::pipeline::{Pipeline, PipelineError};
use stereopsis_rig::with_method;

/// Pixels in a line that the pipelines here have room for.
pub const MOST_WIDTH: usize = 4096;
/// Disparities that the pipelines here have room for.
pub const MOST_DISPARITIES: usize = 256;

type Host<S> = Pipeline<S, MOST_WIDTH, MOST_DISPARITIES>;

/// A method whose pipeline lives in a static, as in firmware: over a megabyte each, which no thread's stack
/// has to hold.
trait Held: Method {
    /// The pipeline.
    fn pipeline() -> &'static Mutex<Host<Self>>;
}

macro_rules! held {
    ($($method:ty),*) => {
        $(impl Held for $method {
            fn pipeline() -> &'static Mutex<Host<Self>> {
                static PIPELINE: Mutex<Host<$method>> = Mutex::new(Pipeline::new());
                &PIPELINE
            }
        })*
    };
}

held!(Fast, Block, SgmLean, Sgm, SgmEdge);

/// A pipeline that panicked while it was held is as good as new after `start`.
fn hold<S: Held>() -> MutexGuard<'static, Host<S>> {
    S::pipeline().lock().unwrap_or_else(PoisonError::into_inner)
}

/// Why a frame gave no map.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError<E: fmt::Debug + fmt::Display> {
    /// The pipeline cannot do what is asked.
    #[error("{0}")]
    Config(ConfigError),
    /// The camera failed, or the pipeline while it ran.
    #[error("{0}")]
    Pipeline(PipelineError<E>),
}

impl<E: fmt::Debug + fmt::Display> From<PipelineError<E>> for RunError<E> {
    fn from(e: PipelineError<E>) -> Self {
        Self::Pipeline(e)
    }
}

/// What came of one frame.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The results.
    pub map: DisparityMap,
    /// What they were computed with.
    pub kernel: Kernel,
    /// The pipeline's time for the frame, milliseconds: taking lines, census, matching and all checks. The
    /// uncertainties are worked out beside it.
    pub time_ms: f64,
    /// How many threads shared the frame.
    pub threads: usize,
}

/// What matches, and on what.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct RunOptions {
    /// The method.
    pub method: MethodName,
    /// The kernel; `None` is the fastest that this processor runs.
    pub kernel: Option<Kernel>,
    /// Threads, each with a band of the frame.
    pub threads: u16,
}

impl From<MethodName> for RunOptions {
    fn from(method: MethodName) -> Self {
        Self { method, kernel: None, threads: 1 }
    }
}

impl RunOptions {
    fn start<S: Method>(self, pipeline: &mut Host<S>, config: &Config) -> Result<(), ConfigError> {
        // The pipeline may have run on another one before.
        let kernel = self.kernel.unwrap_or_else(Kernel::detect);
        pipeline.set_kernel(kernel).expect("the options name one of the available kernels");
        pipeline.start(config)
    }
}

/// One frame of `camera` into a map; `progress` is told how many rows are out after each.
pub fn run<C: StereoSource<Error: fmt::Display>>(
    options: impl Into<RunOptions>,
    config: &Config,
    camera: &mut C,
    mut progress: impl FnMut(u16),
) -> Result<Outcome, RunError<C::Error>> {
    let options = options.into();
    if options.threads > 1 {
        let pair = MemoryPair::record(camera).map_err(PipelineError::from)?;
        let outcome = Bands::new(options, config, &pair).run().map_err(RunError::Config)?;
        progress(config.height);
        return Ok(outcome);
    }
    fn timed<S: Held, C: StereoSource<Error: fmt::Display>>(
        options: RunOptions,
        config: &Config,
        camera: &mut C,
        progress: &mut impl FnMut(u16),
    ) -> Result<Outcome, RunError<C::Error>> {
        let mut pipeline = hold::<S>();
        options.start(&mut pipeline, config).map_err(RunError::Config)?;
        let mut map = DisparityMap::new(usize::from(config.width), usize::from(config.height));
        let (mut kept, start) = (Duration::ZERO, Instant::now());
        frame(&mut *pipeline, camera, config.height, |row| {
            let start = Instant::now();
            map.put(usize::from(row.index()), row);
            progress(row.index() + 1);
            kept += start.elapsed();
        })?;
        let time_ms = start.elapsed().saturating_sub(kept).as_secs_f64() * 1e3;
        Ok(Outcome { map, kernel: pipeline.kernel(), time_ms, threads: 1 })
    }
    with_method!(options.method, S => timed::<S, C>(options, config, camera, &mut progress))
}

/// The first `rows` rows of a frame through a pipeline that was started, to `keep` one by one.
fn frame<S: Method, C: StereoSource<Error: fmt::Display>>(
    pipeline: &mut Host<S>,
    camera: &mut C,
    rows: u16,
    mut keep: impl FnMut(Row<'_>),
) -> Result<(), PipelineError<C::Error>> {
    pipeline.begin_frame(camera)?;
    for _ in 0..rows {
        let Some(row) = pipeline.next_row(camera)? else { break };
        keep(row);
    }
    Ok(())
}

/// The times of `frames` frames in milliseconds, after one that is left out, and the kernel that they ran on.
///
/// A frame's time is that of everything between asking the camera for it and its last row: with a
/// [`MemoryPair`] that is copying the lines, census, matching and all checks.
pub fn time_frames<C: StereoSource<Error: fmt::Display>>(
    options: impl Into<RunOptions>,
    config: &Config,
    camera: &mut C,
    frames: usize,
) -> Result<(Vec<f64>, Kernel), RunError<C::Error>> {
    let options = options.into();
    if options.threads > 1 {
        let pair = MemoryPair::record(camera).map_err(PipelineError::from)?;
        return Bands::new(options, config, &pair).time(frames).map_err(RunError::Config);
    }
    fn time<S: Method, C: StereoSource<Error: fmt::Display>>(
        options: RunOptions,
        pipeline: &mut Host<S>,
        config: &Config,
        camera: &mut C,
        frames: usize,
    ) -> Result<(Vec<f64>, Kernel), RunError<C::Error>> {
        options.start(pipeline, config).map_err(RunError::Config)?;
        let mut times_ms = Vec::with_capacity(frames);
        for frame in 0..=frames {
            let start = Instant::now();
            self::frame(pipeline, camera, config.height, |row| _ = black_box(row.disparities()))?;
            if frame > 0 {
                times_ms.push(start.elapsed().as_secs_f64() * 1e3);
            }
        }
        Ok((times_ms, pipeline.kernel()))
    }
    with_method!(options.method, S => time(options, &mut *hold::<S>(), config, camera, frames))
}
