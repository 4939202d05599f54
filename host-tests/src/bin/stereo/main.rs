//! `stereo`: depth from two images by the code that runs on the microcontroller.
//!
//! * `cli`, `two_view`: what is asked for. `failure`: what is said when it cannot be done.
//! * `input`: the images and the search, checked against each other. `progress`: how far it is.
//! * `matching`, `bench`, `demo`, `calibrate`, `calib`, `rectify`, `features`, `focus`, `fundamental`,
//!   `pose`, `bundle`, `odometry`, `walk`, `record`, `replay`: the commands. `files`, `place`: the results as
//!   files.

mod bench;
mod bundle;
mod calib;
mod calibrate;
mod cli;
mod demo;
mod failure;
mod features;
mod files;
mod focus;
mod fundamental;
mod input;
mod matching;
mod odometry;
mod place;
mod pose;
mod progress;
mod record;
mod rectify;
mod replay;
mod structure;
mod two_view;
mod uncalibrated;
mod walk;

use cli::Command;
use failure::Failure;
use std::io::{self, Write};
use std::process::ExitCode;
use stereopsis_host::command_line::one_line;

fn main() -> ExitCode {
    match start() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            // When standard error is closed, too, there is nobody left to tell.
            let _ = writeln!(io::stderr(), "stereo: {}", one_line(&failure.to_string()));
            ExitCode::FAILURE
        }
    }
}

fn start() -> Result<(), Failure> {
    match cli::parse(std::env::args_os()) {
        Ok(Command::Demo(args)) => demo::run(&args),
        Ok(Command::Match(args)) => matching::run(&args),
        Ok(Command::Bench(args)) => bench::run(&args),
        Ok(Command::Fundamental(args)) => fundamental::run(&args),
        Ok(Command::Pose(args)) => pose::run(&args),
        Ok(Command::Rectify(args)) => rectify::run(&args),
        Ok(Command::Calibrate(args)) => calibrate::run(&args),
        Ok(Command::Calib(args)) => calib::run(&args),
        Ok(Command::Features(args)) => features::run(&args),
        Ok(Command::Focus(args)) => focus::run(&args),
        Ok(Command::Bundle(args)) => bundle::run(&args),
        Ok(Command::Record(args)) => record::run(&args),
        Ok(Command::Replay(args)) => replay::run(&args),
        Ok(Command::Odometry(args)) => odometry::run(&args),
        Ok(Command::Structure(args)) => structure::run(&args),
        Ok(Command::Walk(args)) => walk::run(&args),
        Err(cli::Stop::Help(text)) => print(&text),
        Err(cli::Stop::Usage(failure)) => Err(failure),
    }
}

/// Writes to standard output. A reader that closed its end has what it wanted.
fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(Failure::new(format!("standard output: {e}"))),
        _ => Ok(()),
    }
}
