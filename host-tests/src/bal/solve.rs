//! A problem through the core's bundle adjustment.

use super::{BalFault, BalProblem};
use nalgebra::Point3;
use std::mem::size_of_val;
use std::ops::ControlFlow;
use stereopsis::motion::bundle::{
    Adjustment, BundleConfig, BundleError, BundleReport, BundleWorkspaceView, CrossBlock, Problem,
    RadialView, StopReason, ViewSlot, WorkspaceSize,
};

/// A problem that is being adjusted.
pub struct Running {
    problem: BalProblem,
    adjustment: Adjustment<f64>,
    memory: Memory,
    stopped: Option<StopReason>,
}

#[derive(Default)]
struct Memory {
    slots: Vec<ViewSlot<RadialView<f64>, f64, 9>>,
    terms: Vec<CrossBlock<f64, 9>>,
    points: Vec<Point3<f64>>,
    blocks: Vec<[[f64; 9]; 9]>,
}

impl Memory {
    /// Makes room; says how many bytes there are not.
    fn grow(&mut self, need: &WorkspaceSize) -> Result<(), BalFault> {
        fn to<T: Clone>(vec: &mut Vec<T>, len: usize, fill: T) -> Result<(), BalFault> {
            let bytes = len.saturating_mul(size_of::<T>());
            vec.try_reserve_exact(len.saturating_sub(vec.len())).map_err(|_| BalFault::TooLarge(bytes))?;
            vec.resize(len, fill);
            Ok(())
        }
        to(&mut self.slots, need.slots, ViewSlot::EMPTY)?;
        to(&mut self.terms, need.terms, CrossBlock::EMPTY)?;
        to(&mut self.points, need.points, Point3::origin())?;
        to(&mut self.blocks, need.blocks, [[0.0; 9]; 9])
    }

    fn workspace(&mut self) -> BundleWorkspaceView<'_, RadialView<f64>, f64, 9> {
        let Self { slots, terms, points, blocks } = self;
        BundleWorkspaceView { slots, terms, trial_points: points, blocks }
    }
}

impl BalProblem {
    /// Checks the problem and makes room for it.
    pub fn start(mut self, config: &BundleConfig<f64>) -> Result<Running, BalFault> {
        let mut memory = Memory::default();
        // The first sizes are asked for, then the last one, which depends on them.
        for _ in 0..3 {
            let problem = Problem {
                views: &mut self.views,
                points: &mut self.points,
                observations: &self.observations,
            };
            match Adjustment::start(&problem, &mut memory.workspace(), config.clone()) {
                Err(BundleError::Workspace(need)) => memory.grow(&need)?,
                Err(BundleError::NotSeen(at)) => return Err(BalFault::NotSeen(self.order[at] as usize)),
                Err(error) => return Err(BalFault::Other(error)),
                Ok(adjustment) => return Ok(Running { problem: self, adjustment, memory, stopped: None }),
            }
        }
        Err(BalFault::TooLarge(usize::MAX))
    }
}

impl Running {
    /// One iteration: breaks when it was the last.
    pub fn iterate(&mut self) -> ControlFlow<()> {
        let BalProblem { views, points, observations, .. } = &mut self.problem;
        let mut problem = Problem { views, points, observations };
        match self.adjustment.iterate(&mut problem, &mut self.memory.workspace()) {
            ControlFlow::Continue(()) => ControlFlow::Continue(()),
            ControlFlow::Break(stop) => {
                self.stopped = Some(stop);
                ControlFlow::Break(())
            }
        }
    }

    /// What has come of it so far.
    pub fn report(&self) -> BundleReport<f64> {
        self.adjustment.report(self.stopped.unwrap_or(StopReason::Iterations))
    }

    /// The problem as it is now.
    pub fn problem(&self) -> &BalProblem {
        &self.problem
    }

    /// Bytes of the problem and of what the adjustment works in.
    pub fn bytes(&self) -> usize {
        let Memory { slots, terms, points, blocks } = &self.memory;
        let BalProblem { views, points: places, observations, order } = &self.problem;
        let work = size_of_val(&slots[..]) + size_of_val(&terms[..]) + size_of_val(&points[..]);
        let held = size_of_val(&views[..]) + size_of_val(&places[..]) + size_of_val(&observations[..]);
        work + held + size_of_val(&blocks[..]) + size_of_val(&order[..])
    }
}
