//! `examples/c-firmware`, built for a core, a method and a capacity, and run.

use super::{FRAMES, ONE_OF_A_KIND, every};
use crate::elf::Sizes;
use crate::parallel;
use crate::pictures::Pictures;
use crate::setup::{QEMU_ARM, QEMU_RISCV};
use crate::steps::{Failure, Outcome, command, output_within, root, run as run_command, target_dir};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
use stereopsis_host::run::MethodName;

/// Where a program in C runs.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Core {
    /// This machine, under sanitizers.
    Host,
    /// Cortex-M4F: mps2-an386.
    M4,
    /// Cortex-M7: mps2-an500.
    M7,
    /// RISC-V without atomic instructions: virt.
    Rv32imc,
    /// RISC-V with atomic instructions: virt.
    Rv32imac,
}

/// How much is tried: each method at each size needs a library of its own for each kind of core.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Scope {
    /// One method over windows and one along paths, in small frames, and no second RISC-V.
    Sample,
    All,
}

impl Scope {
    /// The cores that are tried.
    pub fn cores(self) -> &'static [Core] {
        const ALL: [Core; 5] = [Core::Host, Core::M4, Core::M7, Core::Rv32imc, Core::Rv32imac];
        match self {
            Self::Sample => &ALL[..4],
            Self::All => &ALL,
        }
    }
}

/// How long a frame may take: under a second is usual, a program that hangs never ends.
pub const LIMIT: Duration = Duration::from_secs(120);

/// The examples that need little memory, beside the one for rectified pictures.
const BESIDE: [&str; 3] = ["raw", "interrupt", "odometry"];

/// What the desktop's programs are compiled with.
pub const SANITIZERS: &str = "-Werror -g -fsanitize=address,undefined -fno-sanitize-recover=all";

impl Core {
    fn name(self) -> &'static str {
        match self {
            Self::Host => "host",
            Self::M4 => "m4",
            Self::M7 => "m7",
            Self::Rv32imc => "rv32imc",
            Self::Rv32imac => "rv32imac",
        }
    }

    /// Whether a method is tried on it. The last core differs from the one before by instructions that no
    /// method uses.
    fn has(self, method: MethodName, width: u16, scope: Scope) -> bool {
        let is_small = width == FRAMES[0].0;
        match (self, scope) {
            (Self::Host | Self::M4 | Self::M7, Scope::All) => true,
            (Self::Host | Self::M4 | Self::M7, Scope::Sample) | (Self::Rv32imc, Scope::All) => {
                is_small && ONE_OF_A_KIND.contains(&method)
            }
            (Self::Rv32imc, Scope::Sample) => is_small && method == MethodName::Block,
            (Self::Rv32imac, _) => is_small && method == MethodName::Block && scope == Scope::All,
        }
    }

    /// The compiler and its options for one core of each kind, on which all functions are linked.
    fn compiler(self) -> Option<(&'static str, &'static str)> {
        match self {
            Self::M4 => {
                Some(("arm-none-eabi-gcc", "-mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mthumb -mfloat-abi=hard"))
            }
            Self::Rv32imc => Some((
                "riscv64-unknown-elf-gcc",
                "-march=rv32imc -mabi=ilp32 -mcmodel=medany --specs=picolibc.specs",
            )),
            _ => None,
        }
    }

    /// QEMU and its board, if it is one.
    fn qemu(self) -> Option<Command> {
        let (program, machine) = match self {
            Self::Host => return None,
            Self::M4 => (QEMU_ARM, ["-machine", "mps2-an386"].as_slice()),
            Self::M7 => (QEMU_ARM, ["-machine", "mps2-an500"].as_slice()),
            Self::Rv32imc => {
                (QEMU_RISCV, ["-machine", "virt", "-bios", "none", "-cpu", "rv32,a=off"].as_slice())
            }
            Self::Rv32imac => (QEMU_RISCV, ["-machine", "virt", "-bios", "none"].as_slice()),
        };
        let rest = ["-nographic", "-semihosting-config", "enable=on,target=native", "-kernel"];
        Some(command(program, &[machine, &rest].concat()))
    }
}

impl std::fmt::Display for Core {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// Cargo in the library's folder.
pub fn cargo(words: &str) -> Command {
    let mut cargo = command("cargo", &words.split_whitespace().collect::<Vec<_>>());
    cargo
        .current_dir(root().join("examples/c-firmware/library"))
        .env("CARGO_TARGET_DIR", cargo_folder(Core::M4));
    cargo
}

/// The CRC-32 of all disparities and flags that the example in C finds in pairs of pictures, on each of the
/// cores on which the method is tried.
///
/// A board's program is looked through for panics and allocations as well.
pub fn crc32s(runs: &[(&Pictures, MethodName, u16)], scope: Scope) -> Outcome<Vec<Vec<(Core, u32)>>> {
    let all = |cores: &[Core]| {
        let one = |&(pictures, method, disparities): &(&Pictures, MethodName, u16)| {
            let tried = cores.iter().filter(|core| core.has(method, pictures.width, scope));
            tried.map(|&core| Ok((core, crc32(core, pictures, method, disparities)?))).collect()
        };
        runs.iter().map(one).collect::<Outcome<Vec<Vec<_>>>>()
    };
    // Boards of a kind share a library: theirs is one thread's work, the desktop's another's.
    let (desktop, boards) = scope.cores().split_at(1);
    let (arm, riscv) = boards.split_at(2);
    let found = parallel::work(vec![desktop, arm, riscv], all)?;
    Ok((0..runs.len()).map(|run| found.iter().flat_map(|rows| rows[run].clone()).collect()).collect())
}

fn crc32(core: Core, pictures: &Pictures, method: MethodName, disparities: u16) -> Outcome<u32> {
    let program = program(core, method, pictures.width.max(disparities), disparities)?;
    crc32_of(core, &program, pictures)
}

/// The checksum that a program prints for pictures.
pub fn crc32_of(core: Core, program: &Path, pictures: &Pictures) -> Outcome<u32> {
    // It reads the current folder's left.pgm and right.pgm.
    let folder = temporary_folder()?;
    pictures.write(folder.path())?;
    crc32_in(core, program, folder.path())
}

/// The checksum that a program prints for the files of a folder.
pub fn crc32_in(core: Core, program: &Path, folder: &Path) -> Outcome<u32> {
    let mut run = core.qemu().map_or_else(
        || command(program, &[]),
        |mut qemu| {
            qemu.arg(program);
            qemu
        },
    );
    let printed = output_within(run.current_dir(folder), LIMIT)?;
    let crc = printed.trim().strip_prefix("crc32 ").and_then(|digits| u32::from_str_radix(digits, 16).ok());
    crc.ok_or_else(|| Failure::new(format!("{}: no crc32 in \"{}\"", program.display(), printed.trim())))
}

/// The example, built for a core and a capacity: once in a run.
pub fn program(core: Core, method: MethodName, width: u16, disparities: u16) -> Outcome<PathBuf> {
    static BUILT: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
    let built = || BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    let programs = folder().join("programs");
    let program = programs.join(format!("{core}-{method}-{width}x{disparities}"));
    if built().contains(&program) {
        return Ok(program);
    }
    let mut choices = vec![
        format!("-DSTEREOPSIS_METHOD={method}"),
        format!("-DSTEREOPSIS_WIDTH={width}"),
        format!("-DSTEREOPSIS_DISPARITIES={disparities}"),
        format!("-DSTEREOPSIS_TARGET_DIR={}", cargo_folder(core).display()),
    ];
    let flags = if core == Core::Host {
        choices.push("-DSTEREOPSIS_PROFILE=checked".to_owned());
        SANITIZERS
    } else {
        choices.push(format!("-DCMAKE_TOOLCHAIN_FILE=board/{core}.cmake"));
        "-Werror"
    };
    // The first build of a core in a run starts anew, those after it have a compiler that CMake knows.
    let build = folder().join(core.name());
    if !built().iter().any(|program| {
        program.file_name().is_some_and(|name| name.to_string_lossy().starts_with(core.name()))
    }) {
        remove(&build)?;
    }
    configure("examples/c-firmware", &build, &choices, flags)?;
    let mut names = vec!["rectified"];
    // Both cameras' remaps find room beside a small method.
    if method == MethodName::Block && width == FRAMES[0].0 {
        names.extend(BESIDE);
    }
    for name in names {
        run_command(command("cmake", &["--build"]).arg(&build).args(["--target", name]))?;
        let kept = &if name == "rectified" { program.clone() } else { beside(&program, name) };
        let keep = || fs::create_dir_all(&programs).and_then(|()| fs::copy(build.join(name), kept));
        keep().map_err(|e| Failure::new(format!("{}: {e}", kept.display())))?;
        if core != Core::Host {
            let checked = Sizes::of(kept).and_then(|sizes| sizes.without_panics());
            checked.map_err(|e| Failure::new(format!("{}: {e}", kept.display())))?;
        }
    }
    if let Some((compiler, flags)) = core.compiler()
        && method == MethodName::Block
        && width == FRAMES[0].0
    {
        every::link(compiler, flags, &build)?;
    }
    built().push(program.clone());
    Ok(program)
}

/// An example that was built with a [`program`] of [`MethodName::Block`] for the smaller frames.
pub fn beside(program: &Path, name: &str) -> PathBuf {
    program.with_extension(name)
}

/// Configures a project.
pub fn configure(source: &str, build: &Path, choices: &[String], flags: &str) -> Outcome {
    let mut configure = command("cmake", &["-S", source, "-B"]);
    run_command(configure.arg(build).args(choices).env("CFLAGS", flags).env("CXXFLAGS", flags))
}

/// Takes a folder away if it is there.
pub fn remove(folder: &Path) -> Outcome {
    match fs::remove_dir_all(folder) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
            Err(Failure::new(format!("{}: {e}", folder.display())))
        }
        _ => Ok(()),
    }
}

pub fn temporary_folder() -> Outcome<tempfile::TempDir> {
    tempfile::tempdir().map_err(|e| Failure::new(format!("a temporary folder: {e}")))
}

/// Where all of it is built.
pub fn folder() -> PathBuf {
    root().join(target_dir()).join("c")
}

/// Cargo's products for a core: the crates below the library are compiled once for each target.
pub fn cargo_folder(core: Core) -> PathBuf {
    folder().join(match core {
        Core::Host => "cargo",
        Core::M4 | Core::M7 => "cargo-boards",
        Core::Rv32imc | Core::Rv32imac => "cargo-riscv",
    })
}
