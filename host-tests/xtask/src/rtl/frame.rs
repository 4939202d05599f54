//! Pictures through both halves: the simulated block, and the library from its winners on.

use super::block::{Block, MOST_DISPARITIES, MOST_WIDTH};
use super::simulation::Simulation;
use crate::steps::{Failure, Outcome};
use image::GrayImage;
use std::fmt;
use stereopsis::matching::{self, Config, External, Method, Row};
use stereopsis::pipeline::winners::{WinnerPipeline, WinnerRegisters};
use stereopsis_host::map::DisparityMap;
use stereopsis_host::run::MethodName;

/// The library's half, with room for every block.
type Half<S> = WinnerPipeline<S, { MOST_WIDTH as usize }, { MOST_DISPARITIES as usize }>;

/// A simulated block with the library's half behind it.
pub struct Halves {
    method: MethodName,
    device: WinnerRegisters<Simulation>,
}

impl Halves {
    /// A block that is built and started for this.
    pub fn new(block: &Block) -> Outcome<Self> {
        let simulation = Simulation::start(&block.build()?)?;
        Ok(Self { method: block.method, device: WinnerRegisters::new(simulation) })
    }

    /// The block.
    pub fn simulation(&mut self) -> &mut Simulation {
        self.device.bus()
    }

    /// Some frames of one pair of pictures through both halves, one right behind the other; the last one's
    /// rows.
    pub fn frames(
        &mut self,
        count: usize,
        config: &Config,
        pictures: [&GrayImage; 2],
    ) -> Outcome<DisparityMap> {
        match self.method {
            MethodName::Fast => frames::<matching::Fast>(&mut self.device, count, config, pictures),
            MethodName::Sgm => frames::<matching::Sgm>(&mut self.device, count, config, pictures),
            _ => frames::<matching::Block>(&mut self.device, count, config, pictures),
        }
    }
}

fn failed(what: impl fmt::Display) -> Failure {
    Failure::new(format!("the block: {what}"))
}

fn frames<S: Method>(
    device: &mut WinnerRegisters<Simulation>,
    count: usize,
    config: &Config,
    [left, right]: [&GrayImage; 2],
) -> Outcome<DisparityMap>
where
    External<S>: Method,
{
    let width = usize::from(config.width);
    let mut map = DisparityMap::new(width, config.height.into());
    let mut pipeline = Box::new(Half::<S>::new());
    pipeline.start(config, device).map_err(failed)?;
    let mut take = |row: Row<'_>| map.put(row.index().into(), row);
    for _ in 0..count {
        pipeline.begin_frame(device).map_err(failed)?;
        for (left, right) in left.as_raw().chunks_exact(width).zip(right.as_raw().chunks_exact(width)) {
            pipeline.push(left, right, device).map_err(failed)?.map(&mut take);
        }
        while let Some(row) = pipeline.flush(device).map_err(failed)? {
            take(row);
        }
    }
    Ok(map)
}
