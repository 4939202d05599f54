//! `stereo`: depth from two images by the code that runs on the microcontroller.
//!
//! Here is the list of commands. Each has a file of its own with its options, its help and what it does. They
//! use:
//!
//! * `shared`: the options that several have. `input`: images and search, checked against each other. `look`:
//!   what is seen of a pair before it is matched.
//! * `frame`: a pair through the pipeline.
//! * `image_files`: the images that a pattern names. `match_args`, `sources`: what `match` matches. `solve`:
//!   a pair into a folder. `many`, `settings`: more than one pair, and more than one way.
//! * `progress`: how far the work is.
//! * `view`, `serve`: the live page.
//! * `doctor`, `shell`: the program itself.
//! * `rectified`, `results`, `place`: what is written. `failure`: what is said when it cannot be done.

mod bench;
mod bundle;
mod calib;
mod calibrate;
mod demo;
mod doctor;
mod dump;
mod eval;
mod failure;
mod features;
mod finished;
mod focus;
mod frame;
mod fundamental;
mod image_files;
mod input;
mod inputs;
mod look;
mod many;
mod r#match;
mod match_args;
mod odometry;
mod place;
mod plan;
mod pose;
mod progress;
mod record;
mod rectified;
mod rectify;
mod replay;
mod results;
mod resume;
mod rig;
mod scale;
mod serve;
mod settings;
mod shared;
mod shell;
mod solve;
mod sources;
mod structure;
mod typed_rig;
mod uncalibrated;
mod view;
mod walk;
mod watch;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser, Subcommand};
use failure::Failure;
use shared::print;
use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;
use stereopsis_host::command_line::{one_line, usage_line};
use stereopsis_host::output::protect;
use stereopsis_host::unfinished::remove_when_interrupted;

/// What is told to one who names another command.
const COMMANDS: &str = "the commands are demo, plan, match, eval, bench, calibrate, calib, rectify, \
                        features, focus, fundamental, pose, bundle, odometry, structure, walk, record, \
                        replay, dump, view, doctor, completions and man";

/// What one who gives no command is told.
const BEGINNING: &str = "a command is missing; these are what one begins with, and --help lists all:
  stereo demo --out demo         matches a built-in scene and compares it with its true depth
  stereo match --left left.png --right right.png --disparities auto --out depth
                                 matches a rectified pair: disparity, depth, a report
  stereo calibrate --left 'left*.png' --right 'right*.png' --pattern 9x6 --square-mm 25 --out rig.yml
                                 finds two cameras and their lenses from images of a chessboard
  stereo plan --baseline-mm 60 --focal-px 420 --size 320x240 --nearest 0.4 --farthest 5
                                 says what a rig will tell, and what it takes, before it is built
  stereo eval --found depth/disparity.pfm --truth truth.pfm
                                 compares disparities with a known truth";

const EXAMPLES: &str = "Examples:
  stereo demo --out demo-out
  stereo match --left left.png --right right.png --disparities 64 --calib calib.txt --out out/scene
  stereo bench --left left.png --right right.png --disparities 64 --method fast
  stereo features --left first.png --right second.png --out matches.csv

The images of match and bench are a rectified pair; all are PNG, JPEG, PGM/PPM, TIFF, BMP or WebP, 8 or \
                        16 bit, grey or colour, up to 4096 x 4096.";

#[derive(Debug, Parser)]
#[command(
    name = "stereo",
    version,
    about = "Depth from two images, by the code that runs on the microcontroller"
)]
#[command(after_help = EXAMPLES, arg_required_else_help = false)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Match a built-in ray-traced scene and compare the answers with its true depth
    Demo(demo::DemoArgs),
    /// Say what a rig of two cameras can tell, and what it takes, before it is built
    #[command(after_help = plan::EXAMPLE)]
    Plan(plan::PlanArgs),
    /// Match a rectified pair of images: disparity, depth, a point cloud and a report
    #[command(after_help = r#match::EXAMPLE)]
    Match(match_args::MatchArgs),
    /// Compare disparities of any program, or of this one, with a known truth
    #[command(after_help = eval::EXAMPLE)]
    Eval(eval::EvalArgs),
    /// Time the matching of a rectified pair of images
    #[command(after_help = bench::EXAMPLE)]
    Bench(bench::BenchArgs),
    /// Align the rows of an unrectified pair of images, by a calibration of the two cameras
    #[command(after_help = rectify::EXAMPLE)]
    Rectify(rectify::RectifyArgs),
    /// Find two cameras, their lenses and where they stand from images of a chessboard
    #[command(after_help = calibrate::EXAMPLE)]
    Calibrate(calibrate::CalibrateArgs),
    /// Check a calibration file, or write it in another format
    #[command(after_help = calib::EXAMPLE, arg_required_else_help = false, subcommand_required = true)]
    Calib(calib::CalibArgs),
    /// Estimate the fundamental matrix of two images from matches, some of them wrong
    #[command(after_help = fundamental::EXAMPLE)]
    Fundamental(fundamental::FundamentalArgs),
    /// Estimate where the second of two known cameras stands from matches, and the points they show
    #[command(after_help = pose::EXAMPLE)]
    Pose(pose::PoseArgs),
    /// Find points of one image in another: corners, matched by what they look like
    #[command(after_help = features::EXAMPLE)]
    Features(features::FeaturesArgs),
    /// Tell depth by focus: frames of one scene with the lens in different positions
    #[command(after_help = focus::EXAMPLE)]
    Focus(focus::FocusArgs),
    /// Refine cameras and points until they agree best with what was seen: bundle adjustment of a problem in
    /// BAL's format
    #[command(after_help = bundle::EXAMPLE)]
    Bundle(bundle::BundleArgs),
    /// Make a recording of a camera from images, with faults if they are wanted
    #[command(after_help = record::EXAMPLE)]
    Record(record::RecordArgs),
    /// Play recorded lines, with the faults that they had, through the code that runs on the device
    #[command(after_help = replay::EXAMPLE)]
    Replay(replay::ReplayArgs),
    /// Tell where a camera, or a pair, went: a sequence of frames into a trajectory
    #[command(after_help = odometry::EXAMPLE)]
    Odometry(odometry::OdometryArgs),
    /// Tell where a camera stood and what it saw: pictures from several places into poses and points
    #[command(after_help = structure::EXAMPLE)]
    Structure(structure::StructureArgs),
    /// Drive through a built-in street: a sequence of frames with true poses, for odometry
    #[command(after_help = walk::EXAMPLE)]
    Walk(walk::WalkArgs),
    /// Write the rows of a stage of the matcher, for those who build it in hardware
    #[command(after_help = dump::EXAMPLE)]
    Dump(dump::DumpArgs),
    /// Show the matcher in a browser, with sliders, on your own pictures: a page that needs no network
    #[command(after_help = view::EXAMPLE)]
    View(view::ViewArgs),
    /// Say what this program is and what it finds on this machine: kernels, processor, threads
    Doctor(doctor::DoctorArgs),
    /// Print the script that completes commands and options in a shell
    #[command(after_help = shell::COMPLETIONS)]
    Completions(shell::CompletionsArgs),
    /// Write pages of the manual, one for each command
    Man(shell::ManArgs),
}

/// The exit status of a wrong command line.
const USAGE: u8 = 2;

fn main() -> ExitCode {
    remove_when_interrupted();
    let outcome = match parse(std::env::args_os()) {
        Ok(command) => {
            protect(inputs::of(inputs::after_command(std::env::args_os().skip(1))));
            run(command)
        }
        Err(Stop::Help(text)) => print(&text),
        Err(Stop::Usage(failure)) => Err(failure),
        Err(Stop::NoCommand) => {
            let _ = writeln!(io::stderr(), "stereo: {BEGINNING}");
            return ExitCode::from(USAGE);
        }
    };
    let Err(failure) = outcome else { return ExitCode::SUCCESS };
    // When standard error is closed, too, there is nobody left to tell.
    let _ = writeln!(io::stderr(), "stereo: {}", one_line(&failure.to_string()));
    if failure.is_usage() { ExitCode::from(USAGE) } else { ExitCode::FAILURE }
}

fn run(command: Command) -> Result<(), Failure> {
    match command {
        Command::Demo(args) => demo::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::Match(args) => r#match::run(&args),
        Command::Eval(args) => eval::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Fundamental(args) => fundamental::run(&args),
        Command::Pose(args) => pose::run(&args),
        Command::Rectify(args) => rectify::run(&args),
        Command::Calibrate(args) => calibrate::run(&args),
        Command::Calib(args) => calib::run(&args),
        Command::Features(args) => features::run(&args),
        Command::Focus(args) => focus::run(&args),
        Command::Bundle(args) => bundle::run(&args),
        Command::Record(args) => record::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Odometry(args) => odometry::run(&args),
        Command::Structure(args) => structure::run(&args),
        Command::Walk(args) => walk::run(&args),
        Command::Dump(args) => dump::run(&args),
        Command::View(args) => view::run(&args),
        Command::Doctor(args) => doctor::run(&args),
        Command::Completions(args) => shell::completions(&args, Cli::command()),
        Command::Man(args) => shell::man(&args, Cli::command()),
    }
}

/// Why there is no command to run.
#[derive(Debug)]
enum Stop {
    /// Help or the version was asked for: what to print.
    Help(String),
    /// The command line is wrong.
    Usage(Failure),
    /// The command line is empty.
    NoCommand,
}

/// Reads the command line.
fn parse(args: impl IntoIterator<Item = OsString>) -> Result<Command, Stop> {
    let args: Vec<_> = args.into_iter().collect();
    if args.len() < 2 {
        return Err(Stop::NoCommand);
    }
    Cli::try_parse_from(&args).map(|cli| cli.command).map_err(|error| match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => Stop::Help(error.render().to_string()),
        ErrorKind::UnknownArgument if is_image(&args, &error) => {
            Stop::Usage(Failure::usage(usage_line(&error, COMMANDS) + "; images follow --left and --right"))
        }
        _ => Stop::Usage(Failure::usage(usage_line(&error, COMMANDS))),
    })
}

/// Whether the argument that is unknown is a file's name, of a command that takes images by options.
fn is_image(args: &[OsString], error: &clap::Error) -> bool {
    let Some(ContextValue::String(unknown)) = error.get(ContextKind::InvalidArg) else { return false };
    let cli = Cli::command();
    let command = args.get(1).and_then(|name| cli.find_subcommand(name));
    let takes_images =
        |command: &clap::Command| command.get_arguments().any(|a| a.get_long() == Some("left"));
    !unknown.starts_with('-') && command.is_some_and(takes_images)
}
