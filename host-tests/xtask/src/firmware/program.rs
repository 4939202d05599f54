//! One build of the firmware example: for a board, a method, a line's length and a number of disparities.

use super::board::Board;
use crate::steps::{Failure, Outcome, command, root, target_dir};
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use stereopsis::imaging::Noise;
use stereopsis::matching::Config;
use stereopsis_host::run::Method;

/// RAM that memory.x gives when nobody asks for more, bytes.
const BUDGET: usize = 64 * 1024;
/// RAM beside the pipeline: the stack, the camera, the log, bytes.
const BESIDE: usize = 3072;

/// Flags for the core with vector instructions: they, and the kernel that is made for them.
pub const VECTORS: &str = "-C target-cpu=cortex-m55 --cfg stereopsis_vectors";

/// Flags for the cores with the instructions on four bytes, which a Cortex-M4 and an M7 always have.
pub const DSP: &str = "--cfg stereopsis_dsp";
/// The same for a Cortex-M33, which may lack them.
pub const DSP_OF_M33: &str = "-C target-cpu=cortex-m33 --cfg stereopsis_dsp";

/// The flags that tell the crate what a core has.
fn flags(board: Board) -> &'static str {
    match board.core {
        "m4" | "m7" => DSP,
        "m33" => DSP_OF_M33,
        "m55" => VECTORS,
        _ => "",
    }
}

/// What is built.
#[derive(Clone, Copy, Debug)]
pub struct Program {
    pub board: Board,
    pub method: Method,
    pub width: u16,
    pub height: u16,
    pub disparities: u16,
    /// How noisy the cameras are.
    pub noise: Noise,
    /// Whether it takes all RAM that the board has, because the budget is too small.
    all_memory: bool,
}

/// A program, built.
pub struct Built {
    pub program: Program,
    /// The linked file.
    pub elf: PathBuf,
}

/// Cargo builds one program at a time in a folder; what comes out has the same name every time.
static FOLDERS: [Mutex<()>; 2] = [const { Mutex::new(()) }; 2];

/// Cargo in the example's folder, where its own configuration names the target.
pub fn cargo(words: &str) -> Command {
    let mut cargo = command("cargo", &words.split_whitespace().collect::<Vec<_>>());
    cargo.current_dir(root().join("examples/firmware")).env("CARGO_TARGET_DIR", folder(0));
    cargo
}

/// Where the example is built.
fn folder(at: usize) -> PathBuf {
    target_dir().join(["firmware", "firmware-too"][at])
}

impl Program {
    /// A program for frames of that size from cameras with little noise; the failure names the option that asks for too much.
    pub fn new(board: Board, method: Method, width: u16, height: u16, disparities: u16) -> Outcome<Self> {
        let least = Config::FEWEST_DISPARITIES;
        if width < least {
            return Err(Failure::new(format!(
                "--left: the images are {width} pixels wide; at least {least} are needed"
            )));
        }
        if disparities > width {
            let asked = format!("--disparities {disparities}: the images are {width} pixels wide");
            return Err(Failure::new(format!("{asked}; give {least} to {width}")));
        }
        // The two cameras' five lines, and some counters.
        let pipeline = method.state_bytes(width, disparities) + 10 * usize::from(width) + 64;
        let (needed, there) = (pipeline + BESIDE, board.ram.1 as usize);
        if needed > there {
            return Err(Failure::new(format!(
                "--core {}: lines of {width} pixels and {disparities} disparities need {needed} bytes of RAM, QEMU's {} has \
                 {there}; give smaller images or fewer disparities",
                board.core, board.machine
            )));
        }
        Ok(Self { board, method, width, height, disparities, noise: Noise::None, all_memory: needed > BUDGET })
    }

    /// The folder that it is built in: all programs of a target in one, and about as many programs in each.
    pub fn folder(&self) -> usize {
        usize::from(self.board.target.starts_with("thumbv8m") || self.board.target.starts_with("riscv"))
    }

    /// Builds it. Several threads may: in a folder, one after another.
    pub fn build(&self) -> Outcome<Built> {
        let _turn = FOLDERS[self.folder()].lock().unwrap_or_else(PoisonError::into_inner);
        let output = self.cargo("build --locked --release --quiet").output();
        let output = output.map_err(|e| Failure::new(format!("cargo: {e}")))?;
        if !output.status.success() {
            eprint!("{}", String::from_utf8_lossy(&output.stderr));
            return Err(Failure::new(format!("examples/firmware does not build for {self}")));
        }
        let kept = folder(0).join("programs");
        let elf = kept.join(format!("{self}"));
        let from = folder(self.folder()).join(self.board.target).join("release/depth");
        let keep = || fs::create_dir_all(&kept).and_then(|()| fs::copy(&from, &elf));
        keep().map_err(|e| Failure::new(format!("{}: {e}", elf.display())))?;
        Ok(Built { program: *self, elf })
    }

    /// Cargo with what is built in its environment.
    pub fn cargo(&self, words: &str) -> Command {
        let mut cargo = cargo(words);
        cargo.args(["--target", self.board.target]).env("CARGO_TARGET_DIR", folder(self.folder()));
        cargo.env("STEREO_CORE", self.board.core).env("STEREO_METHOD", self.method.name());
        cargo.env("STEREO_NOISE", self.noise.name());
        for (name, value) in [("WIDTH", self.width), ("HEIGHT", self.height), ("DISPARITIES", self.disparities)] {
            cargo.env(format!("STEREO_{name}"), value.to_string());
        }
        cargo.env("STEREO_MEMORY", if self.all_memory { "board" } else { "budget" });
        // Flags of the caller's would count in the figures.
        cargo.env_remove("CARGO_ENCODED_RUSTFLAGS").env("RUSTFLAGS", flags(self.board));
        cargo
    }

    /// Evaluations of a disparity in a frame.
    pub fn evaluations(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height) * u64::from(self.disparities)
    }
}

impl std::fmt::Display for Program {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { board, method, width, height, disparities, .. } = self;
        write!(f, "{}-{method}-{width}x{height}x{disparities}", board.core)?;
        if self.noise == Noise::None { Ok(()) } else { write!(f, "-{}", self.noise.name()) }
    }
}
