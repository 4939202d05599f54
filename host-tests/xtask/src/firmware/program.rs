//! One build of the firmware example: for a board, a method, a line's length and a number of disparities.

use crate::steps::{Failure, Outcome, command, root, target_dir};
use firmware_boards::Board;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use stereopsis::imaging::Noise;
use stereopsis::matching::Config;
use stereopsis_host::run::MethodName;

/// RAM that memory.x gives when nobody asks for more, bytes.
const BUDGET: usize = 64 * 1024;
/// RAM beside the pipeline: the stack, the camera, the log, bytes.
const BESIDE: usize = 3072;

/// Flags for the cores with vector instructions.
pub const VECTORS: &str = "-C target-cpu=cortex-m55";
const RISCV_VECTORS: &str = "-C target-feature=+zve32x,+zvl128b";

/// The flags that tell the crate what a core has which its target does not say.
fn flags(board: Board) -> &'static str {
    match board.core {
        "m33" => "-C target-cpu=cortex-m33",
        "m55" => VECTORS,
        "rv32v" => RISCV_VECTORS,
        _ => "",
    }
}

/// What is built.
#[derive(Clone, Copy, Debug)]
pub struct Program {
    pub board: Board,
    pub method: MethodName,
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

/// The folder of a board: all programs of a target in one, and about as many programs in each.
fn folder_of(board: Board) -> usize {
    usize::from(board.target.starts_with("thumbv8m") || board.target.starts_with("riscv"))
}

/// Cargo for a board, with its flags.
fn cargo_for(board: Board, words: &str) -> Command {
    let mut cargo = cargo(words);
    cargo.args(["--target", board.target]).env("CARGO_TARGET_DIR", folder(folder_of(board)));
    // Flags of the caller's would count in the figures.
    cargo.env_remove("CARGO_ENCODED_RUSTFLAGS").env("RUSTFLAGS", flags(board));
    cargo.env("STEREO_CORE", board.core);
    cargo
}

/// Runs cargo, which builds what an error names so.
fn build(cargo: &mut Command, name: &str) -> Outcome {
    let output = cargo.output().map_err(|e| Failure::new(format!("cargo: {e}")))?;
    if output.status.success() {
        return Ok(());
    }
    eprint!("{}", String::from_utf8_lossy(&output.stderr));
    Err(Failure::new(format!("examples/firmware does not build for {name}")))
}

/// Copies what was built, a path below the target's folder, to where the next build leaves it alone.
fn keep(board: Board, from: &str, name: &str) -> Outcome<PathBuf> {
    let kept = folder(0).join("programs");
    let (from, elf) = (folder(folder_of(board)).join(board.target).join(from), kept.join(name));
    let keep = || fs::create_dir_all(&kept).and_then(|()| fs::copy(&from, &elf));
    keep().map_err(|e| Failure::new(format!("{}: {e}", elf.display())))?;
    Ok(elf)
}

/// What an optimiser is asked for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Optimised {
    /// Opt-level 3.
    Speed,
    /// Opt-level s.
    Size,
}

impl Optimised {
    /// The name of the profile, and of its folder.
    pub fn profile(self) -> &'static str {
        match self {
            Self::Speed => "release",
            Self::Size => "small",
        }
    }
}

/// Optimisation over a whole program, as cargo spells it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Lto {
    /// All of it at once.
    Fat,
    /// By summaries of its parts.
    Thin,
    /// None.
    Off,
}

impl Lto {
    /// All there are.
    pub const ALL: [Self; 3] = [Self::Fat, Self::Thin, Self::Off];

    /// The name in a profile.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fat => "fat",
            Self::Thin => "thin",
            Self::Off => "off",
        }
    }
}

/// Builds a program that has no sizes to choose, with the features named; the linked file.
pub fn build_plain(board: Board, bin: &str, optimised: Optimised, features: &str) -> Outcome<PathBuf> {
    let _turn = FOLDERS[folder_of(board)].lock().unwrap_or_else(PoisonError::into_inner);
    let (profile, core) = (optimised.profile(), board.core);
    let name = [core, bin, profile, features]
        .iter()
        .filter(|part| !part.is_empty())
        .copied()
        .collect::<Vec<_>>()
        .join("-");
    let mut cargo = cargo_for(board, "build --locked --quiet");
    for other in ["METHOD", "NOISE", "WIDTH", "HEIGHT", "DISPARITIES"] {
        cargo.env_remove(format!("STEREO_{other}"));
    }
    // Without floating-point instructions geometry is more flash than the budget.
    cargo.env("STEREO_MEMORY", "board");
    cargo.args(["--profile", profile, "--bin", bin, "--features", "large", "--features", features]);
    build(&mut cargo, &name)?;
    keep(board, &format!("{profile}/{bin}"), &name)
}

impl Program {
    /// A program for frames of that size from cameras with little noise; the failure names the option that
    /// asks for too much.
    pub fn new(board: Board, method: MethodName, width: u16, height: u16, disparities: u16) -> Outcome<Self> {
        Self::with_more(board, method, width, height, disparities, 0)
    }

    /// A program that has so many bytes of its own beside the pipeline.
    pub fn with_more(
        board: Board,
        method: MethodName,
        width: u16,
        height: u16,
        disparities: u16,
        more: usize,
    ) -> Outcome<Self> {
        let least = Config::FEWEST_DISPARITIES;
        if width < least {
            return Err(Failure::new(format!(
                "--left: the images are {width} px wide; at least {least} are needed"
            )));
        }
        if disparities > width {
            let asked = format!("--disparities {disparities}: the images are {width} px wide");
            return Err(Failure::new(format!("{asked}; give {least} to {width}")));
        }
        // The two cameras' five lines, and some counters.
        let pipeline = method.state_bytes(width, disparities) + 10 * usize::from(width) + 64 + more;
        let (needed, there) = (pipeline + BESIDE, board.ram.1 as usize);
        if needed > there {
            return Err(Failure::new(format!(
                "--core {}: lines of {width} pixels and {disparities} disparities need {needed} bytes of \
                 RAM, QEMU's {} has {there}; give smaller images or fewer disparities",
                board.core, board.machine
            )));
        }
        Ok(Self {
            board,
            method,
            width,
            height,
            disparities,
            noise: Noise::None,
            all_memory: needed > BUDGET,
        })
    }

    /// The folder that it is built in: all programs of a target in one, and about as many programs in each.
    pub fn folder(&self) -> usize {
        folder_of(self.board)
    }

    /// Builds it. Several threads may: in a folder, one after another.
    pub fn build(&self) -> Outcome<Built> {
        let _turn = FOLDERS[self.folder()].lock().unwrap_or_else(PoisonError::into_inner);
        let name = self.to_string();
        build(&mut self.cargo("build --locked --release --quiet --bin depth"), &name)?;
        Ok(Built { program: *self, elf: keep(self.board, "release/depth", &name)? })
    }

    /// Builds another program of the same sizes, with the features named; the linked file. The budget of
    /// memory.x is the depth program's: what carries more than it gets all that the board has.
    pub fn build_other(&self, bin: &str, features: &str) -> Outcome<PathBuf> {
        let _turn = FOLDERS[self.folder()].lock().unwrap_or_else(PoisonError::into_inner);
        let name = format!("{self}-{bin}");
        let mut cargo = self.cargo("build --locked --release --quiet");
        cargo.env("STEREO_MEMORY", "board");
        build(cargo.args(["--bin", bin, "--features", features]), &name)?;
        keep(self.board, &format!("release/{bin}"), &name)
    }

    /// Builds it at another level of optimisation.
    pub fn build_as(&self, level: &str, lto: Lto) -> Outcome<Built> {
        let _turn = FOLDERS[self.folder()].lock().unwrap_or_else(PoisonError::into_inner);
        let name = format!("{self}-{level}-{}", lto.name());
        let mut cargo = self.cargo("build --locked --release --quiet --bin depth");
        cargo.env("CARGO_PROFILE_RELEASE_OPT_LEVEL", level).env("CARGO_PROFILE_RELEASE_LTO", lto.name());
        build(&mut cargo, &name)?;
        Ok(Built { program: *self, elf: keep(self.board, "release/depth", &name)? })
    }

    /// Cargo with what is built in its environment.
    pub fn cargo(&self, words: &str) -> Command {
        let mut cargo = cargo_for(self.board, words);
        cargo.env("STEREO_METHOD", self.method.name()).env("STEREO_NOISE", self.noise.name());
        for (name, value) in
            [("WIDTH", self.width), ("HEIGHT", self.height), ("DISPARITIES", self.disparities)]
        {
            cargo.env(format!("STEREO_{name}"), value.to_string());
        }
        cargo.env("STEREO_MEMORY", if self.all_memory { "board" } else { "budget" });
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
