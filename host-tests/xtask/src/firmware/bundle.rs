//! The program `bundle` on one core: two views and 128 points from a guess to the truth, measured, and held
//! to the host's own run.

use super::plain::Tabled;
use super::program::Optimised;
use super::results::{Ran, Taken};
use crate::steps::{Failure, Outcome};
use firmware_boards::Board;
use firmware_scenes::window::{Adjusted, Outcome as Adjustment, TwoViews};
use serde::Serialize;

/// The most state, bytes.
const MOST_STATE: u64 = 24 * 1024;
/// The most stack, bytes.
const MOST_STACK: u64 = 8 * 1024;

/// What came of it. Names and units of the fields are a contract with programs that read `summary.json`.
#[derive(Serialize)]
pub struct Bundle {
    #[serde(flatten)]
    taken: Taken,
    views: usize,
    points: usize,
    /// All iterations.
    instructions: u64,
    instructions_per_iteration: u64,
    iterations: u64,
    /// The window.
    state_bytes: u64,
    initial_cost: f64,
    cost: f64,
    centre_off_ppm: u64,
    turned_off_urad: u64,
}

/// Builds the program and runs it; fails when what it finds is not what the host finds, to the bit, or not
/// the truth, and when it takes more than it may.
pub fn run(board: Board, optimised: Optimised) -> Outcome<Bundle> {
    let (window, _) = of_host()?;
    let ran = Ran::of(board, "bundle", optimised, &bytes(&window))?;
    let state_bytes = ran.figure("state_bytes")?;
    ran.within(&[
        ("bytes of state", state_bytes, MOST_STATE),
        ("bytes of stack", ran.taken.stack_bytes, MOST_STACK),
    ])?;
    let (instructions, iterations) = (ran.instructions("ticks")?, ran.figure("iterations")?);
    Ok(Bundle {
        views: window.views().len(),
        points: window.points().len(),
        instructions,
        instructions_per_iteration: instructions / iterations.max(1),
        iterations,
        state_bytes,
        initial_cost: ran.figure("initial_cost_millis")? as f64 / 1e3,
        cost: ran.figure("cost_millis")? as f64 / 1e3,
        centre_off_ppm: ran.figure("centre_off_ppm")?,
        turned_off_urad: ran.figure("turned_off_urad")?,
        taken: ran.taken,
    })
}

/// The window as the host adjusts it.
fn of_host() -> Outcome<(Box<TwoViews>, Adjustment)> {
    let mut memory = Box::new(Adjusted::new());
    let (found, _) =
        memory.run(|| 0).map_err(|e| Failure::new(format!("the host adjusts nothing: {e:?}")))?;
    if !found.is_good() {
        return Err(Failure::new("what the host finds is not the truth"));
    }
    Ok((Box::new(memory.window), found))
}

/// The bytes of `bundle.bin`: R, column by column, and t of the second view, then the points.
fn bytes(window: &TwoViews) -> Vec<u8> {
    let poses = window.views().iter().skip(1).map(|view| &view.pose);
    let poses = poses.flat_map(|pose| pose.rotation().iter().chain(pose.translation().iter()));
    poses.chain(window.points().iter().flat_map(|point| point.iter())).flat_map(|x| x.to_le_bytes()).collect()
}

impl Tabled for Bundle {
    const NAME: &'static str = "bundle";
    const COLUMNS: &'static [&'static str] = &["instructions for an iteration", "iterations", "state"];

    fn cells(&self) -> Vec<String> {
        [self.instructions_per_iteration, self.iterations, self.state_bytes].map(|n| n.to_string()).into()
    }

    fn taken(&self) -> &Taken {
        &self.taken
    }
}

impl Bundle {
    /// In a line.
    pub fn summary(&self) -> String {
        let line = format!(
            "{} instructions for an iteration, {} of them; cost {:.3} from {:.3}; state {} bytes",
            self.instructions_per_iteration, self.iterations, self.cost, self.initial_cost, self.state_bytes
        );
        self.taken.summary("bundle", &line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_truth_is_found() {
        let (window, found) = of_host().expect("a window");
        assert_eq!(bytes(&window).len(), 4 * (12 + 3 * 128));
        // chi^2 / 2 of 512 numbers less 5 + 384 unknowns, a third of the second sights without noise: below
        // 123 / 2 x 0.09.
        assert!(found.report.cost < 6.0 && found.report.initial_cost > 1000.0, "{:?}", found.report);
    }
}
