//! The C interface: the header, every misuse under sanitizers, and `examples/c-firmware` with the host's bits on a desktop
//! and on two boards in QEMU.
//!
//! Everything is built by CMake, as a user's project is. The desktop's programs run under the address and
//! undefined-behaviour sanitizers, with a library that checks its own arithmetic and pointers.

use crate::elf::Sizes;
use crate::firmware::scene::Scene;
use crate::header;
use crate::pictures::Pictures;
use crate::setup::QEMU_ARM;
use crate::steps::{Failure, Outcome, command, ended_within, output_within, root, run as run_command, target_dir};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
use stereopsis_host::run::Method;

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

/// How long a frame may take: under a second is usual, a program that hangs never ends.
const LIMIT: Duration = Duration::from_secs(120);

/// What the desktop's programs are compiled with.
const SANITIZERS: &str = "-Werror -g -fsanitize=address,undefined -fno-sanitize-recover=all";

/// Frames that the cores have to agree on: width, height, disparities.
const FRAMES: [(u16, u16, u16); 2] = [(160, 120, 32), (320, 240, 64)];

impl Core {
    const ALL: [Self; 3] = [Self::Host, Self::M4, Self::M7];

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

/// Cargo in the library's folder.
pub fn cargo(words: &str) -> Command {
    let mut cargo = command("cargo", &words.split_whitespace().collect::<Vec<_>>());
    cargo.current_dir(root().join("examples/c-firmware/library")).env("CARGO_TARGET_DIR", folder().join("cargo"));
    cargo
}

/// The test step.
pub fn run() -> Outcome {
    header::run(true)?;
    misuse()?;
    panicking_library()?;
    for (width, height, disparities) in FRAMES {
        let pictures = Pictures::of_scene(Scene { width, height })?;
        for method in Method::ALL {
            let expected = pictures.crc32(method, disparities)?;
            for core in Core::ALL {
                let found = crc32(core, &pictures, method, disparities)?;
                let what = format!("{method}, {width}x{height}, {disparities} disparities, {}", core.name());
                if found != expected {
                    let line = format!("{what}: crc32 {found:08x}, the host's pipeline has {expected:08x}");
                    return Err(Failure::new(line));
                }
                println!("{what}: crc32 {found:08x}");
            }
        }
    }
    refused()
}

/// The CRC-32 of all disparities and flags that the example in C finds in a pair of pictures.
///
/// A board's program is looked through for panics and allocations as well.
pub fn crc32(core: Core, pictures: &Pictures, method: Method, disparities: u16) -> Outcome<u32> {
    let program = program(core, method, pictures.width.max(disparities), disparities)?;
    let mut run = command(&program, &[]);
    if let Some(machine) = core.machine() {
        run = command(QEMU_ARM, &["-machine", machine, "-nographic", "-semihosting-config", "enable=on,target=native"]);
        run.arg("-kernel").arg(&program);
    }
    // It reads the current folder's left.pgm and right.pgm.
    let folder = temporary_folder()?;
    pictures.write(folder.path())?;
    let printed = output_within(run.current_dir(folder.path()), LIMIT)?;
    let crc = printed.trim().strip_prefix("crc32 ").and_then(|digits| u32::from_str_radix(digits, 16).ok());
    crc.ok_or_else(|| Failure::new(format!("{}: no crc32 in \"{}\"", program.display(), printed.trim())))
}

/// The example, built for a core and a capacity: once in a run.
fn program(core: Core, method: Method, width: u16, disparities: u16) -> Outcome<PathBuf> {
    static BUILT: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
    let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    let build = folder().join(format!("{}-{method}-{width}x{disparities}", core.name()));
    let program = build.join("depth");
    if built.contains(&program) {
        return Ok(program);
    }
    let mut choices = vec![
        format!("-DSTEREOPSIS_METHOD={method}"),
        format!("-DSTEREOPSIS_WIDTH={width}"),
        format!("-DSTEREOPSIS_DISPARITIES={disparities}"),
    ];
    if core == Core::Host {
        choices.push("-DSTEREOPSIS_PROFILE=checked".to_owned());
        cmake("examples/c-firmware", &build, &choices, SANITIZERS)?;
    } else {
        choices.push(format!("-DCMAKE_TOOLCHAIN_FILE=board/{}.cmake", core.name()));
        cmake("examples/c-firmware", &build, &choices, "-Werror")?;
        let checked = Sizes::of(&program).and_then(|sizes| sizes.without_panics());
        checked.map_err(|e| Failure::new(format!("{}: {e}", program.display())))?;
    }
    built.push(program.clone());
    Ok(program)
}

/// Configures a project anew and builds it.
fn cmake(source: &str, build: &Path, choices: &[String], flags: &str) -> Outcome {
    configure(source, build, choices, flags)?;
    run_command(command("cmake", &["--build"]).arg(build))
}

fn configure(source: &str, build: &Path, choices: &[String], flags: &str) -> Outcome {
    if build.exists() {
        fs::remove_dir_all(build).map_err(|e| Failure::new(format!("{}: {e}", build.display())))?;
    }
    // One folder for all of cargo's products: the crates below the library are compiled once for each target.
    let cargo = format!("-DSTEREOPSIS_TARGET_DIR={}", folder().join("cargo").display());
    let mut configure = command("cmake", &["-S", source, cargo.as_str(), "-B"]);
    run_command(configure.arg(build).args(choices).env("CFLAGS", flags).env("CXXFLAGS", flags))
}

fn temporary_folder() -> Outcome<tempfile::TempDir> {
    tempfile::tempdir().map_err(|e| Failure::new(format!("a temporary folder: {e}")))
}

/// Where all of it is built.
fn folder() -> PathBuf {
    root().join(target_dir()).join("c")
}

/// Every misuse has its status, in C and in C++.
fn misuse() -> Outcome {
    let build = folder().join("misuse");
    cmake("host-tests/tests/ffi", &build, &["-DSTEREOPSIS_PROFILE=checked".to_owned()], SANITIZERS)?;
    for program in ["misuse", "misuse_cpp"] {
        print!("{program}: {}", output_within(&mut command(build.join(program), &[]), LIMIT)?);
    }
    Ok(())
}

/// A library that can panic cannot be linked: it is what makes the linking of the others a proof.
fn panicking_library() -> Outcome {
    let build = folder().join("panicking");
    // The profile that checks its own arithmetic panics where the check fails.
    let choices = ["-DSTEREOPSIS_PROFILE=checked", "-DCMAKE_TOOLCHAIN_FILE=board/m4.cmake"].map(str::to_owned);
    configure("examples/c-firmware", &build, &choices, "-Werror")?;
    // The linker's own words, not their translation.
    let built = command("cmake", &["--build"]).arg(&build).env("LC_ALL", "C").output();
    let built = built.map_err(|e| Failure::new(format!("cmake --build: {e}")))?;
    let told = String::from_utf8_lossy(&built.stderr).into_owned();
    match told.lines().find(|line| line.contains("undefined reference to `the_stereopsis_library_can_panic'")) {
        Some(line) if !built.status.success() => println!("a library that can panic is refused: {line}"),
        _ => return Err(Failure::new(format!("a library that can panic was not refused for that: {}", told.trim()))),
    }
    Ok(())
}

/// A left picture that the example refuses, beside a right one of 16 pixels in 2 lines, and what it says.
const BAD: [(&[u8], &str); 9] = [
    (b"", "bad.pgm: the picture ends early"),
    (b"P2 16 2 255\n", "bad.pgm: is not a binary PGM"),
    (b"P5\n# 16 pixels\n16 2 255\n", "bad.pgm: has no size, or a comment in its head"),
    (b"P5 16x 2 255\n", "bad.pgm: has no size, or a comment in its head"),
    (b"P5 16 0 255\n", "bad.pgm: has no size, or a comment in its head"),
    (b"P5 16 2 65535\n", "bad.pgm: is not of 8 bits"),
    (b"P5 161 2 255\n", "bad.pgm: is wider than the library was built for"),
    (b"P5 16 99999 255\n", "right.pgm: is not of the left picture's size"),
    (b"P5 16 2 255\n0123456789012345678901234567890", "bad.pgm: the picture ends early"),
];

/// What the example and its build refuse, in a line that names what is wrong.
fn refused() -> Outcome {
    let (width, _, disparities) = FRAMES[0];
    let program = program(Core::Host, Method::Block, width, disparities)?;
    let folder = temporary_folder()?;
    let write = |name: &str, bytes: &[u8]| {
        fs::write(folder.path().join(name), bytes).map_err(|e| Failure::new(format!("{name}: {e}")))
    };
    let says = |arguments: &[&str], expected: &str| {
        let mut run = command(&program, arguments);
        let told = ended_within(run.current_dir(folder.path()), LIMIT)?;
        if told.status.success() || told.told.trim() != expected || !told.printed.is_empty() {
            let line = format!("the example ends with {} and says \"{}\"", told.status, told.told.trim());
            return Err(Failure::new(format!("{line}, expected \"{expected}\"")));
        }
        Ok(())
    };
    write("right.pgm", &[b"P5 16 2 255\n".as_slice(), &[0; 32]].concat())?;
    for (bytes, expected) in BAD {
        write("bad.pgm", bytes)?;
        says(&["bad.pgm", "right.pgm"], expected)?;
    }
    says(&["missing.pgm", "right.pgm"], "missing.pgm: cannot be opened")?;
    says(&[".", "right.pgm"], ".: cannot be read")?;
    says(&["right.pgm"], "usage: depth [LEFT.pgm RIGHT.pgm]")?;
    for (name, value, expected) in [
        (
            "STEREOPSIS_METHOD",
            "sobel",
            "STEREOPSIS_METHOD is \"sobel\", known are: fast, block, sgm-lean, sgm, sgm-edge",
        ),
        ("STEREOPSIS_DISPARITIES", "40", "STEREOPSIS_DISPARITIES is 40: it must be a multiple of 16"),
        ("STEREOPSIS_WIDTH", "32", "STEREOPSIS_WIDTH is 32: it must be 64 (the disparities) to 6553"),
    ] {
        let told = cargo("build --locked --release")
            .env(name, value)
            .output()
            .map_err(|e| Failure::new(format!("cargo: {e}")))?;
        if told.status.success() || !String::from_utf8_lossy(&told.stderr).contains(expected) {
            return Err(Failure::new(format!("{name}={value} was not refused with \"{expected}\"")));
        }
    }
    Ok(())
}
