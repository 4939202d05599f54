//! Test programs with one mutant in them.

use super::tree::Program;
use crate::steps::{Failure, Outcome, root};
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

/// What the tests say of a mutant.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// A test failed.
    Caught,
    /// The tests took many times as long as without the mutant, or all memory that they may have.
    Ended,
    /// No test saw it.
    Missed,
}

/// The number of no mutant.
const NONE: u32 = u32::MAX;
/// The most memory of a test program, KiB.
const MOST_KIB: u32 = 4 << 20;
/// How many times the seconds that the tests take without a mutant they may take with one, and how many more.
const TIMES: u64 = 3;
const MORE_S: u64 = 5;
/// How many times that long they may take on the clock, on a machine that has other work.
const PATIENCE: u64 = 30;

/// Runs the tests without a mutant; the seconds of processors that each may take with one.
pub fn limit(programs: &[Program]) -> Outcome<u64> {
    let start = Instant::now();
    if judge(programs, NONE, 3600)? != Verdict::Missed {
        return Err(Failure::new("the tests fail without a mutant"));
    }
    let seconds = start.elapsed().as_secs_f64();
    println!("the tests take {seconds:.1} s without a mutant");
    Ok(TIMES * seconds.ceil() as u64 + MORE_S)
}

/// Runs the tests with a mutant until one fails, for so many seconds of processors at most.
pub fn judge(programs: &[Program], number: u32, limit_s: u64) -> Outcome<Verdict> {
    for program in programs {
        let path = program.path.display().to_string();
        let failed = |e: std::io::Error| Failure::new(format!("{path}: {e}"));
        // One bound at a time: a shell may take no more.
        let bounds = format!("ulimit -t {limit_s} && ulimit -v {MOST_KIB} && exec \"$0\" \"$@\"");
        let mut test = Command::new("sh");
        test.args(["-c", &bounds, &path]).args(program.words).args(["--test-threads", "1"]);
        // The long lists take a share: what is seen there alone is not seen here.
        test.env("STEREOPSIS_EMULATED", "1").env("STEREOPSIS_MUTANT", number.to_string()).current_dir(root());
        let mut test = test.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().map_err(failed)?;
        let Some(out) = test.stdout.take() else { continue };
        let (tell, told) = mpsc::channel();
        thread::spawn(move || {
            let mut lines = BufReader::new(out).lines().map_while(Result::ok);
            tell.send(lines.any(|line| line.ends_with("... FAILED")))
        });
        // Who waits for ever takes no processor.
        let seen = told.recv_timeout(Duration::from_secs(limit_s * PATIENCE));
        if seen != Ok(false) {
            test.kill().map_err(failed)?;
        }
        let status = test.wait().map_err(failed)?;
        match seen {
            Ok(true) => return Ok(Verdict::Caught),
            Ok(false) => {}
            Err(_) => return Ok(Verdict::Ended),
        }
        if !status.success() {
            // By a signal: the limit, or what the operating system refuses.
            return Ok(if status.code().is_none() { Verdict::Ended } else { Verdict::Caught });
        }
    }
    Ok(Verdict::Missed)
}
