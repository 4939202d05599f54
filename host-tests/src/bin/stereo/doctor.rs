//! `stereo doctor`: what this program is, and what it finds on this machine.

use crate::failure::Failure;
use crate::shared::{kernel, print};
use clap::Args;
use serde::Serialize;
use std::env::{self, consts};
use std::fmt::Write;
use std::thread;
use stereopsis::matching::Kernel;

#[derive(Debug, Args)]
pub struct DoctorArgs {
    /// Print one JSON object in place of text
    #[arg(long)]
    json: bool,
}

/// What is found. Names are those of `--json`.
#[derive(Serialize)]
struct Found {
    version: &'static str,
    /// The processor's family and the operating system that the program is built for.
    arch: &'static str,
    os: &'static str,
    /// Whether the program is built with its optimiser's checks, which are slow.
    debug_assertions: bool,
    /// The kernels that this processor runs, the fastest last.
    kernels: Vec<&'static str>,
    /// The one that is chosen.
    kernel: &'static str,
    /// What STEREO_KERNEL says, where it is set.
    stereo_kernel: Option<String>,
    /// What the processor has of what kernels are made of.
    cpu_features: Vec<&'static str>,
    /// Threads that run at a time, where the operating system says it.
    threads: Option<usize>,
}

/// The names of those that the processor has.
macro_rules! detected {
    ($detect:ident: $($name:tt),*) => {
        [$(($name, std::arch::$detect!($name))),*]
            .into_iter()
            .filter_map(|(name, has)| has.then_some(name))
            .collect()
    };
}

#[cfg(target_arch = "x86_64")]
fn cpu_features() -> Vec<&'static str> {
    detected!(
        is_x86_feature_detected: "sse2", "ssse3", "sse4.1", "avx", "avx2", "bmi2", "avx512f", "avx512bw",
        "avx512vl", "avx512vbmi"
    )
}

#[cfg(target_arch = "aarch64")]
fn cpu_features() -> Vec<&'static str> {
    detected!(is_aarch64_feature_detected: "neon", "dotprod", "i8mm", "sve", "sve2")
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
fn cpu_features() -> Vec<&'static str> {
    Vec::new()
}

pub fn run(args: &DoctorArgs) -> Result<(), Failure> {
    let asked = env::var("STEREO_KERNEL").ok();
    let chosen = asked.as_deref().map(kernel).transpose();
    let chosen = chosen.map_err(|e| Failure::new(format!("STEREO_KERNEL: {e}")))?;
    let found = Found {
        version: env!("CARGO_PKG_VERSION"),
        arch: consts::ARCH,
        os: consts::OS,
        debug_assertions: cfg!(debug_assertions),
        kernels: Kernel::available().map(Kernel::name).collect(),
        kernel: chosen.unwrap_or_else(Kernel::detect).name(),
        stereo_kernel: asked,
        cpu_features: cpu_features(),
        threads: thread::available_parallelism().ok().map(usize::from),
    };
    if args.json {
        return print(&(serde_json::to_string_pretty(&found)? + "\n"));
    }
    print(&found.describe())
}

impl Found {
    fn describe(&self) -> String {
        let list = |words: &[&str]| if words.is_empty() { "none".to_owned() } else { words.join(", ") };
        let built =
            if self.debug_assertions { "with checks, slow: build with --release" } else { "optimised" };
        let why = if self.stereo_kernel.is_some() { "STEREO_KERNEL names it" } else { "the fastest" };
        let threads = self.threads.map_or("unknown".to_owned(), |threads| threads.to_string());
        let mut text = format!("stereo       {} for {} on {}, {built}\n", self.version, self.arch, self.os);
        let _ = writeln!(text, "kernels      {}", list(&self.kernels));
        let _ = writeln!(text, "chosen       {}: {why}", self.kernel);
        let _ = writeln!(text, "processor    {}", list(&self.cpu_features));
        let _ = writeln!(text, "threads      {threads}; --threads shares a frame among them");
        text
    }
}
