//! Named, timed steps and the commands in them.

use std::ffi::OsStr;
use std::fmt;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// What went wrong, in one line.
#[derive(Debug)]
pub struct Failure(String);

impl Failure {
    /// A failure with this line.
    pub fn new(line: impl Into<String>) -> Self {
        Self(line.into())
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// A chore's outcome.
pub type Outcome<T = ()> = Result<T, Failure>;

/// Runs steps one after another, says which and how long each took, and ends at the first failure.
pub struct Steps {
    only: Option<String>,
    taken: Vec<Taken>,
}

/// A step that is done: seconds on the clock and of processors.
struct Taken {
    name: String,
    seconds: f64,
    of_processors: f64,
}

impl Steps {
    /// All steps, or only those with words in their names.
    pub fn new(only: Option<String>) -> Self {
        Self { only, taken: Vec::new() }
    }

    /// Runs a step.
    pub fn step(&mut self, name: &str, work: impl FnOnce() -> Outcome) -> Outcome {
        if self.only.as_ref().is_some_and(|only| !name.contains(only.as_str())) {
            return Ok(());
        }
        println!("\n==> {name}");
        let (start, processors) = (Instant::now(), processor_seconds());
        let done = work();
        let (seconds, of_processors) = (start.elapsed().as_secs_f64(), processor_seconds() - processors);
        match done {
            Ok(()) => {
                println!("<== {name}: {seconds:.1} s, {of_processors:.1} s of processors");
                self.taken.push(Taken { name: name.to_owned(), seconds, of_processors });
                Ok(())
            }
            Err(Failure(line)) => {
                Err(Failure(format!("step \"{name}\" failed after {seconds:.1} s: {line}")))
            }
        }
    }

    /// Whether only some of the steps were asked for.
    pub fn is_part(&self) -> bool {
        self.only.is_some()
    }

    /// Prints every step with its time; fails when there was none, and says so when there were others.
    pub fn summary(&self) -> Outcome {
        let line = |seconds: f64, of_processors: f64, name: &str| {
            println!("{seconds:7.1} s {of_processors:7.1} s of processors  {name}");
        };
        println!();
        for taken in &self.taken {
            line(taken.seconds, taken.of_processors, &taken.name);
        }
        let sum = |of: fn(&Taken) -> f64| self.taken.iter().map(of).sum::<f64>();
        line(sum(|taken| taken.seconds), sum(|taken| taken.of_processors), "in all");
        match &self.only {
            Some(only) if self.taken.is_empty() => {
                Err(Failure::new(format!("no step has \"{only}\" in its name")))
            }
            Some(_) => {
                println!("the other steps: NOT RUN");
                Ok(())
            }
            None => Ok(()),
        }
    }
}

/// Seconds that processors have worked for this program and those that it waited for; 0 where the operating
/// system does not say it as Linux does.
fn processor_seconds() -> f64 {
    const TICKS_A_SECOND: f64 = 100.0;
    let text = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // Behind the program's name: the state is the third field; user and system ticks, its own and its
    // children's, are the fourteenth to the seventeenth.
    let fields = text.rsplit(')').next().unwrap_or_default().split_whitespace();
    fields.skip(11).take(4).filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() / TICKS_A_SECOND
}

/// The repository's root.
pub fn root() -> &'static Path {
    // The manifest's folder is host-tests/xtask.
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap_or(Path::new("."))
}

/// The folder of build products: cargo's own variable, else `target` at the root.
pub fn target_dir() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// A command at the repository's root.
pub fn command(program: impl AsRef<OsStr>, arguments: &[&str]) -> Command {
    let mut command = Command::new(program);
    command.args(arguments).current_dir(root()).stdin(Stdio::null());
    command
}

/// Cargo at the repository's root.
pub fn cargo(arguments: &[&str]) -> Command {
    command("cargo", arguments)
}

/// Runs a command, its output passed through.
pub fn run(command: &mut Command) -> Outcome {
    println!("$ {}", words(command));
    let status = command.status().map_err(|e| Failure(format!("{}: {e}", words(command))))?;
    if status.success() { Ok(()) } else { Err(Failure(format!("{}: {status}", words(command)))) }
}

/// Runs a command quietly; what it printed.
pub fn output_of(command: &mut Command) -> Outcome<String> {
    let output = command.output().map_err(|e| Failure(format!("{}: {e}", words(command))))?;
    if !output.status.success() {
        let stderr = String::from_utf8_lossy(&output.stderr);
        let last = stderr.lines().last().unwrap_or_default();
        return Err(Failure(format!("{}: {}: {last}", words(command), output.status)));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// What came of a program that has ended.
pub struct Ended {
    /// How it ended.
    pub status: ExitStatus,
    /// What it wrote on standard output.
    pub stdout: String,
    /// What it wrote on standard error.
    pub stderr: String,
}

/// Runs a program that prints little and may hang; fails when it does not end within `limit`.
pub fn ended_within(command: &mut Command, limit: Duration) -> Outcome<Ended> {
    let failed = |e: std::io::Error, command: &Command| Failure(format!("{}: {e}", words(command)));
    let spawned = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let mut child = spawned.map_err(|e| failed(e, command))?;
    let start = Instant::now();
    // The text is far shorter than a pipe holds, so it can be read once the program is done.
    let status = loop {
        match child.try_wait().map_err(|e| failed(e, command))? {
            Some(status) => break status,
            None if start.elapsed() < limit => std::thread::sleep(Duration::from_millis(5)),
            None => {
                child.kill().and_then(|()| child.wait()).map_err(|e| failed(e, command))?;
                return Err(Failure(format!("{} did not end within {} s", words(command), limit.as_secs())));
            }
        }
    };
    let (mut stdout, mut stderr) = (String::new(), String::new());
    if let (Some(mut out), Some(mut err)) = (child.stdout.take(), child.stderr.take()) {
        let read = out.read_to_string(&mut stdout).and_then(|_| err.read_to_string(&mut stderr));
        read.map_err(|e| failed(e, command))?;
    }
    Ok(Ended { status, stdout, stderr })
}

/// What a program printed that prints little and may hang, if it ended well within `limit`.
pub fn output_within(command: &mut Command, limit: Duration) -> Outcome<String> {
    let Ended { status, stdout, stderr } = ended_within(command, limit)?;
    if status.success() {
        return Ok(stdout);
    }
    Err(Failure(format!("{}: {status}: {} {}", words(command), stdout.trim(), stderr.trim())))
}

/// A command's words, as typed.
fn words(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words.map(OsStr::to_string_lossy).collect::<Vec<_>>().join(" ")
}
