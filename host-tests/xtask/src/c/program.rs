//! `examples/c-firmware`, built for a core, a method and a capacity, and run.

use crate::elf::Sizes;
use crate::parallel;
use crate::pictures::Pictures;
use crate::setup::QEMU_ARM;
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
}

/// All of them, in the order of [`crc32s`].
pub const CORES: [Core; 3] = [Core::Host, Core::M4, Core::M7];

/// How long a frame may take: under a second is usual, a program that hangs never ends.
pub const LIMIT: Duration = Duration::from_secs(120);

/// What the desktop's programs are compiled with.
pub const SANITIZERS: &str = "-Werror -g -fsanitize=address,undefined -fno-sanitize-recover=all";

impl Core {
    fn name(self) -> &'static str {
        match self {
            Self::Host => "host",
            Self::M4 => "m4",
            Self::M7 => "m7",
        }
    }

    /// QEMU's board, if it is one.
    fn machine(self) -> Option<&'static str> {
        match self {
            Self::Host => None,
            Self::M4 => Some("mps2-an386"),
            Self::M7 => Some("mps2-an500"),
        }
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

/// The CRC-32 of all disparities and flags that the example in C finds in pairs of pictures, on each of
/// [`CORES`].
///
/// A board's program is looked through for panics and allocations as well.
pub fn crc32s(runs: &[(&Pictures, MethodName, u16)]) -> Outcome<Vec<[u32; 3]>> {
    let all = |cores: &[Core]| {
        let one = |&(pictures, method, disparities): &_| {
            cores.iter().map(|&core| crc32(core, pictures, method, disparities)).collect::<Outcome<Vec<_>>>()
        };
        runs.iter().map(one).collect::<Outcome<Vec<_>>>()
    };
    // The boards share a library: theirs is one thread's work, the desktop's another's.
    let found = parallel::work(vec![&CORES[..1], &CORES[1..]], all)?;
    let rows = found[0].iter().zip(&found[1]).map(|(host, boards)| [host[0], boards[0], boards[1]]);
    Ok(rows.collect())
}

fn crc32(core: Core, pictures: &Pictures, method: MethodName, disparities: u16) -> Outcome<u32> {
    let program = program(core, method, pictures.width.max(disparities), disparities)?;
    crc32_of(core, &program, pictures)
}

/// The checksum that a program prints for pictures.
pub fn crc32_of(core: Core, program: &Path, pictures: &Pictures) -> Outcome<u32> {
    let mut run = command(program, &[]);
    if let Some(machine) = core.machine() {
        run = command(
            QEMU_ARM,
            &["-machine", machine, "-nographic", "-semihosting-config", "enable=on,target=native"],
        );
        run.arg("-kernel").arg(program);
    }
    // It reads the current folder's left.pgm and right.pgm.
    let folder = temporary_folder()?;
    pictures.write(folder.path())?;
    let printed = output_within(run.current_dir(folder.path()), LIMIT)?;
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
    run_command(command("cmake", &["--build"]).arg(&build).args(["--target", "depth"]))?;
    let mut programs_of = vec![("depth", program.clone())];
    // Both cameras' remaps find room beside a small method.
    if method == MethodName::Block {
        run_command(command("cmake", &["--build"]).arg(&build).args(["--target", "raw"]))?;
        programs_of.push(("raw", raw_beside(&program)));
    }
    for (name, kept) in &programs_of {
        let keep = || fs::create_dir_all(&programs).and_then(|()| fs::copy(build.join(name), kept));
        keep().map_err(|e| Failure::new(format!("{}: {e}", kept.display())))?;
        if core != Core::Host {
            let checked = Sizes::of(kept).and_then(|sizes| sizes.without_panics());
            checked.map_err(|e| Failure::new(format!("{}: {e}", kept.display())))?;
        }
    }
    built().push(program.clone());
    Ok(program)
}

/// The example for raw pictures that was built with a [`program`].
pub fn raw_beside(program: &Path) -> PathBuf {
    program.with_extension("raw")
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
    folder().join(if core == Core::Host { "cargo" } else { "cargo-boards" })
}
