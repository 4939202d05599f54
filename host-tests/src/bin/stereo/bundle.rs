//! `stereo bundle`: a problem of bundle adjustment into its refined one.

use crate::failure::Failure;
use crate::place::Place;
use crate::shared::{print, whole};
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;
use stereopsis::motion::bundle::{BundleConfig, Gauge, Loss};
use stereopsis_host::bal::{BalError, BalProblem, Running, read_problem};

pub const EXAMPLE: &str = "Example:
  stereo bundle --problem problem-49-7776-pre.txt --out refined.txt

The problem is in BAL's format: the numbers of cameras, points and observations, then each observation \
                           (camera, point, x, y in px), each camera (rotation vector, translation, f, k1, \
                           k2) and each point. Written is the same with cameras and points refined. Printed \
                           is the cost before and after: half the sum of the squared residuals in px^2, as \
                           Ceres and SciPy say it; with --loss huber half the sum of Huber's loss, and the \
                           squares besides.";

#[derive(Debug, Args)]
pub struct BundleArgs {
    /// The problem, in BAL's format
    #[arg(long, value_name = "FILE")]
    pub problem: PathBuf,
    /// File for the refined problem; its folder is made when it is missing
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// squares, or huber, to which what is far off counts by its distance
    #[arg(long, value_name = "LOSS", default_value = "squares")]
    pub loss: LossChoice,
    /// Residual from which on huber counts by distance, px, 0.001 to 1000; 1 where none is given
    #[arg(long, value_name = "PX", value_parser = width, allow_negative_numbers = true)]
    pub width: Option<f64>,
    /// Iterations at most, 1 to 10000
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = iterations, allow_negative_numbers =
        true)]
    pub iterations: u16,
    /// The share of the cost by which the last step lowers it, 1e-15 to 0.1
    #[arg(long, value_name = "SHARE", default_value_t = 1e-6, value_parser = tolerance,
        allow_negative_numbers = true)]
    pub tolerance: f64,
}

/// How much a residual counts.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum LossChoice {
    Squares,
    Huber,
}

/// Huber's width where none is given, px.
const WIDTH: f64 = 1.0;

fn width(text: &str) -> Result<f64, &'static str> {
    within(text, 1e-3, 1e3).ok_or("a number from 0.001 to 1000 is needed")
}

fn tolerance(text: &str) -> Result<f64, &'static str> {
    within(text, 1e-15, 0.1).ok_or("a number from 1e-15 to 0.1 is needed")
}

fn within(text: &str, least: f64, most: f64) -> Option<f64> {
    text.parse().ok().filter(|value| (least..=most).contains(value))
}

fn iterations(text: &str) -> Result<u16, String> {
    whole(text, 1, 10_000)
}

pub fn run(args: &BundleArgs) -> Result<(), Failure> {
    if let (Some(width), LossChoice::Squares) = (args.width, args.loss) {
        return Err(Failure::usage(format!(
            "--width {width}: only --loss huber has a width; give --loss huber too"
        )));
    }
    let problem = read_problem(&args.problem)?;
    let place = Place::of("--out", &args.out)?;
    let config = BundleConfig {
        loss: match args.loss {
            LossChoice::Squares => Loss::Squares,
            LossChoice::Huber => Loss::Huber(args.width.unwrap_or(WIDTH)),
        },
        most_iterations: args.iterations.into(),
        cost_tolerance: args.tolerance,
        ..BundleConfig::new(Gauge::Free)
    };
    let sizes = (problem.views.len(), problem.points.len(), problem.observations.len());
    let squares = squares_of(&problem);
    let start = Instant::now();
    let fault = |fault| BalError { path: args.problem.clone(), fault };
    let mut running = problem.start(&config).map_err(fault)?;
    let bar = progress(args.iterations, sizes.2);
    while let ControlFlow::Continue(()) = running.iterate() {
        bar.set_position(running.report().iterations.into());
        bar.set_message(format!("{:.6e}", running.report().cost));
    }
    bar.finish_and_clear();
    let seconds = start.elapsed().as_secs_f64();
    place.write(|out| running.problem().write(out), None)?;
    print(&summary(args, sizes, squares, &running, seconds))
}

/// The run in lines.
fn summary(
    args: &BundleArgs,
    (cameras, points, observations): (usize, usize, usize),
    squares: f64,
    running: &Running,
    seconds: f64,
) -> String {
    let report = running.report();
    let after = squares_of(running.problem());
    let plain = |cost: f64| if cost >= 1e-3 { format!("{cost:.6}") } else { format!("{cost:.6e}") };
    let rms = |cost: f64| (2.0 * cost / observations as f64).sqrt();
    let huber = match args.loss {
        LossChoice::Squares => String::new(),
        LossChoice::Huber => format!(
            "initial loss: {}\nfinal loss: {}\nloss: half the sum of Huber's of width {} px\n",
            plain(report.initial_cost),
            plain(report.cost),
            args.width.unwrap_or(WIDTH)
        ),
    };
    format!(
        "{cameras} cameras, {points} points, {observations} observations\ninitial cost: {}\nfinal cost: \
         {}\ncost: half the sum of squared residuals, px^2; from {:.4} to {:.4} px RMS of an \
         observation\n{huber}{} iterations, {} of them steps, in {seconds:.3} s and {:.1} MB; stopped: {}\n",
        plain(squares),
        plain(after),
        rms(squares),
        rms(after),
        report.iterations,
        report.steps,
        running.bytes() as f64 / 1e6,
        report.stop
    )
}

/// Half the sum of squared residuals, px^2.
fn squares_of(problem: &BalProblem) -> f64 {
    problem.cost(&Loss::Squares)
}

/// A bar for what takes more than a moment.
fn progress(iterations: u16, observations: usize) -> ProgressBar {
    let target =
        if observations < 5000 { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(Some(iterations.into()), target);
    if let Ok(style) =
        ProgressStyle::with_template("adjusting {bar:40} {pos} of at most {len} iterations, cost {msg}")
    {
        bar.set_style(style);
    }
    bar
}
