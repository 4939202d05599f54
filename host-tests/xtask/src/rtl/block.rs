//! The block's parameters, and its simulation, built with Verilator.

use crate::steps::{Failure, Outcome, command, root, target_dir};
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use stereopsis_host::run::MethodName;

/// The methods that the block has, each at its number.
pub const METHODS: [MethodName; 3] = [MethodName::Fast, MethodName::Block, MethodName::Sgm];
/// The longest line and the most disparities of a block.
pub const MOST_WIDTH: u16 = 1280;
pub const MOST_DISPARITIES: u16 = 128;
/// The shortest line that a block takes, and the least that one has room for.
pub const LEAST_WIDTH: u16 = 16;
pub const LEAST_ROOM: u16 = 64;

/// The parameters of a block.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Block {
    /// Most pixels in a line.
    pub width: u16,
    /// Most disparities.
    pub disparities: u16,
    /// Disparities in a clock.
    pub parallel: u16,
    /// The method, one of [`METHODS`].
    pub method: MethodName,
    /// Whether the second best is sought.
    pub second_best: bool,
}

impl Block {
    /// The name of its folder.
    pub fn name(&self) -> String {
        let Self { width, disparities, parallel, method, second_best } = self;
        let second = if *second_best { "-second" } else { "" };
        format!("{method}-{width}-{disparities}-{parallel}{second}")
    }

    /// The module on top.
    pub fn top(&self) -> &'static str {
        if self.method == MethodName::Sgm { "stereo_sgm" } else { "stereo_block" }
    }

    /// The clocks of a line of so many pixels.
    pub fn clocks_of_line(&self, width: u16) -> u64 {
        let (sweeps, beyond) = if self.method == MethodName::Sgm { (2, 8) } else { (1, 7) };
        (u64::from(width) * sweeps + beyond) * u64::from(self.disparities / self.parallel)
    }

    /// The parameters, as Verilog has them.
    pub fn parameters(&self) -> Vec<(&'static str, u16)> {
        let mut parameters = vec![
            ("WIDTH", self.width),
            ("DISPARITIES", self.disparities),
            ("PARALLEL", self.parallel),
            ("SECOND_BEST", self.second_best.into()),
        ];
        // The methods over windows share a module.
        match self.method {
            MethodName::Fast => parameters.push(("METHOD", 0)),
            MethodName::Block => parameters.push(("METHOD", 1)),
            _ => {}
        }
        parameters
    }

    /// The path of the program that simulates it, built anew.
    pub fn build(&self) -> Outcome<PathBuf> {
        let folder = root().join(target_dir()).join("rtl").join(self.name());
        fs::create_dir_all(&folder).map_err(|e| Failure::new(format!("{}: {e}", folder.display())))?;
        let mut verilator = command("verilator", &["--cc", "--exe", "--build", "-Wall", "-O3", "-j", "1"]);
        verilator.args(["--x-assign", "fast", "-CFLAGS", "-O2 -std=c++14", "--prefix", "Vstereo"]);
        verilator.args(["--top-module", self.top()]);
        verilator.args(self.parameters().iter().map(|(name, value)| format!("-G{name}={value}")));
        verilator.arg("--Mdir").arg(&folder).args(sources()?).arg(fpga().join("sim/block.cpp"));
        done(&mut verilator)?;
        Ok(folder.join("Vstereo"))
    }

    /// Complains of what Verilator finds wrong in the source.
    pub fn lint(&self) -> Outcome {
        let mut verilator = command("verilator", &["--lint-only", "-Wall", "--top-module", self.top()]);
        verilator.args(self.parameters().iter().map(|(name, value)| format!("-G{name}={value}")));
        done(verilator.args(sources()?))
    }
}

/// Runs Verilator, which ends with a count of what is wrong: the first of it is told.
fn done(verilator: &mut Command) -> Outcome {
    let output = verilator.output().map_err(|e| Failure::new(format!("verilator: {e}")))?;
    if output.status.success() {
        return Ok(());
    }
    let text = String::from_utf8_lossy(&output.stderr);
    let first = text.lines().find(|line| line.starts_with('%')).or(text.lines().last());
    Err(Failure::new(format!("verilator: {}", first.unwrap_or("says nothing"))))
}

fn fpga() -> PathBuf {
    root().join("examples/fpga")
}

/// The block's files, in the order of their names.
pub fn sources() -> Outcome<Vec<PathBuf>> {
    let folder = fpga().join("rtl");
    let failed = |e| Failure::new(format!("{}: {e}", folder.display()));
    let mut files = Vec::new();
    for entry in fs::read_dir(&folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.extension().is_some_and(|extension| extension == "v") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}
