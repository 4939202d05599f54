//! Levenberg-Marquardt for bundle adjustment: damping (Nielsen 1999) and the reasons to stop.

use super::gauge::Gauge;
use super::loss::Loss;
use super::problem::{BundleError, Problem, prepare};
use super::schur::{cost, propose, reduce};
use super::view::View;
use super::workspace::BundleWorkspaceView;
use crate::geometry::Real;
use core::ops::ControlFlow;

/// How a problem is adjusted.
#[derive(Clone, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BundleConfig<T> {
    /// What is held still.
    pub gauge: Gauge,
    /// How much a residual counts.
    pub loss: Loss<T>,
    /// Iterations at most. Each is a step that is tried, taken or not.
    pub most_iterations: u32,
    /// A step that lowers the cost by less than this share of it is the last one.
    pub cost_tolerance: T,
    /// A step that moves no centre and no point by more than this share of its distance from the origin, or
    /// of one, is the last.
    pub step_tolerance: T,
    /// The damping to begin with, as a share of the diagonal.
    pub damping: T,
}

/// Why an adjustment stopped.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum StopReason {
    /// Nothing is left of the cost, or of what a step could take from it, but rounding.
    Exact,
    /// The last step lowered the cost by less than the tolerance.
    Cost,
    /// The last step was shorter than the tolerance.
    Step,
    /// No step lowers the cost, however short.
    NoDescent,
    /// The iterations are used up: another one may still lower the cost.
    Iterations,
}

/// What came of an adjustment. A cost is half the sum of the losses of all observations' squared residuals,
/// px^2.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BundleReport<T> {
    /// Before the first step.
    pub initial_cost: T,
    /// After the last.
    pub cost: T,
    /// Steps that were tried.
    pub iterations: u32,
    /// Steps that were taken.
    pub steps: u32,
    /// Why there was no further one.
    pub stop: StopReason,
}

/// An adjustment that is done a step at a time.
#[derive(Clone, PartialEq, Debug)]
pub struct Adjustment<T> {
    config: BundleConfig<T>,
    initial_cost: T,
    cost: T,
    /// What rounding of the pixels makes of no cost at all.
    floor: T,
    damping: T,
    growth: T,
    iterations: u32,
    steps: u32,
}

impl<T: Real> BundleConfig<T> {
    /// Least squares, 50 iterations at most, to a millionth of the cost.
    pub fn new(gauge: Gauge) -> Self {
        Self {
            gauge,
            loss: Loss::Squares,
            most_iterations: 50,
            cost_tolerance: T::of(1e-6),
            step_tolerance: T::EPSILON,
            damping: T::of(1e-4),
        }
    }

    fn is_sound(&self) -> bool {
        let positive = |x: T| x > T::ZERO && x.is_finite();
        positive(self.cost_tolerance)
            && positive(self.step_tolerance)
            && positive(self.damping)
            && self.loss.is_sound()
    }
}

impl core::fmt::Display for StopReason {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Exact => "nothing but rounding is left to gain",
            Self::Cost => "the cost falls by less than the tolerance",
            Self::Step => "the step is shorter than the tolerance",
            Self::NoDescent => "no step lowers the cost",
            Self::Iterations => "the iterations are used up",
        })
    }
}

impl<T: Real> Adjustment<T> {
    /// Checks the problem, the configuration and the memory.
    pub fn start<V: View<T, N>, const N: usize>(
        problem: &Problem<'_, V, T>,
        workspace: &mut BundleWorkspaceView<'_, V, T, N>,
        config: BundleConfig<T>,
    ) -> Result<Self, BundleError> {
        if !config.is_sound() {
            return Err(BundleError::Config);
        }
        prepare(problem, &config.gauge, workspace)?;
        let initial_cost = cost(problem, &config.loss);
        if !initial_cost.is_finite() {
            return Err(BundleError::NotSeen(unseen(problem)));
        }
        let rounding = T::EPSILON * T::of(4.0);
        let pixels = problem
            .observations
            .iter()
            .fold(T::ZERO, |sum, observation| sum + observation.pixel.coords.norm_squared());
        let floor = T::of(0.5) * pixels * rounding * rounding;
        let damping = config.damping;
        Ok(Self {
            config,
            initial_cost,
            cost: initial_cost,
            floor,
            damping,
            growth: T::of(2.0),
            iterations: 0,
            steps: 0,
        })
    }

    /// Tries a step, and takes it when it lowers the cost. Its work depends on the problem alone.
    ///
    /// The damping follows Nielsen (1999; Madsen, Nielsen & Tingleff 2004, 3.2): with the ratio of gain to
    /// promise.
    pub fn iterate<V: View<T, N>, const N: usize>(
        &mut self,
        problem: &mut Problem<'_, V, T>,
        workspace: &mut BundleWorkspaceView<'_, V, T, N>,
    ) -> ControlFlow<StopReason> {
        if self.iterations >= self.config.most_iterations {
            return ControlFlow::Break(StopReason::Iterations);
        }
        if self.cost <= self.floor {
            return ControlFlow::Break(StopReason::Exact);
        }
        self.iterations += 1;
        let BundleConfig { gauge, loss, .. } = &self.config;
        reduce(problem, workspace, gauge, loss, self.damping);
        let proposal = match propose(problem, workspace, gauge, loss, self.damping) {
            Ok(proposal) => proposal,
            Err(_) => return self.back_off(),
        };
        let gain = self.cost - proposal.cost;
        let rounding = self.cost * T::EPSILON * T::of(4.0);
        if proposal.predicted <= rounding {
            return ControlFlow::Break(StopReason::Exact);
        }
        let ratio = gain / proposal.predicted;
        // A cost that is not a number is no gain either.
        if !(ratio > T::of(1e-3)) {
            return self.back_off();
        }
        for (view, slot) in problem.views.iter_mut().zip(workspace.slots.iter()) {
            *view = slot.trial;
        }
        for track in super::problem::tracks(problem.observations) {
            let at = track.first().map_or(0, |observation| observation.point as usize);
            if let (Some(point), Some(trial)) = (problem.points.get_mut(at), workspace.trial_points.get(at)) {
                *point = *trial;
            }
        }
        self.steps += 1;
        let before = core::mem::replace(&mut self.cost, proposal.cost);
        let turn = T::of(2.0) * ratio - T::ONE;
        self.damping *= (T::ONE - turn * turn * turn).max(T::of(1.0 / 3.0));
        self.damping = self.damping.max(T::of(1e-12));
        self.growth = T::of(2.0);
        if self.cost <= self.floor {
            ControlFlow::Break(StopReason::Exact)
        } else if gain <= before * self.config.cost_tolerance {
            ControlFlow::Break(StopReason::Cost)
        } else if proposal.moved <= self.config.step_tolerance * self.config.step_tolerance {
            ControlFlow::Break(StopReason::Step)
        } else {
            ControlFlow::Continue(())
        }
    }

    /// A shorter step next time.
    fn back_off(&mut self) -> ControlFlow<StopReason> {
        self.damping *= self.growth;
        self.growth *= T::of(2.0);
        if self.damping > T::of(1e16) {
            ControlFlow::Break(StopReason::NoDescent)
        } else {
            ControlFlow::Continue(())
        }
    }

    /// What has come of it so far, if it stopped for this reason.
    pub fn report(&self, stop: StopReason) -> BundleReport<T> {
        let Self { initial_cost, cost, iterations, steps, .. } = *self;
        BundleReport { initial_cost, cost, iterations, steps, stop }
    }
}

/// The first observation whose point is not seen.
fn unseen<V: View<T, N>, T: Real, const N: usize>(problem: &Problem<'_, V, T>) -> usize {
    let seen = |observation: &super::problem::Observation<T>| {
        let view = problem.views.get(usize::from(observation.view));
        let point = problem.points.get(observation.point as usize);
        let pixel = view.zip(point).and_then(|(view, point)| view.project(observation.eye, point).ok());
        pixel.is_some_and(|pixel| (pixel - observation.pixel).norm_squared().is_finite())
    };
    problem.observations.iter().position(|observation| !seen(observation)).unwrap_or(0)
}

/// Adjusts a problem until there is a reason to stop.
pub fn adjust<V: View<T, N>, T: Real, const N: usize>(
    problem: &mut Problem<'_, V, T>,
    workspace: &mut BundleWorkspaceView<'_, V, T, N>,
    config: BundleConfig<T>,
) -> Result<BundleReport<T>, BundleError> {
    let most = config.most_iterations;
    let mut adjustment = Adjustment::start(problem, workspace, config)?;
    for _ in 0..=most {
        if let ControlFlow::Break(stop) = adjustment.iterate(problem, workspace) {
            return Ok(adjustment.report(stop));
        }
    }
    Ok(adjustment.report(StopReason::Iterations))
}
