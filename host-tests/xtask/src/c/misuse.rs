//! What the C interface and its build refuse.

use super::program::{
    Core, LIMIT, SANITIZERS, cargo, cargo_folder, configure, folder, program, remove, temporary_folder,
};
use crate::steps::{Failure, Outcome, command, ended_within, output_within, run as run_command};
use std::fs;
use stereopsis_host::run::MethodName;

/// CMake's choice of the folder that cargo builds in.
fn cargo_in(core: Core) -> String {
    format!("-DSTEREOPSIS_TARGET_DIR={}", cargo_folder(core).display())
}

/// Every misuse has its status, in C and in C++.
pub fn statuses() -> Outcome {
    let build = folder().join("misuse");
    let choices = ["-DSTEREOPSIS_PROFILE=checked".to_owned(), cargo_in(Core::Host)];
    remove(&build)?;
    configure("host-tests/tests/ffi", &build, &choices, SANITIZERS)?;
    run_command(command("cmake", &["--build"]).arg(&build))?;
    for program in [
        "misuse",
        "misuse_raw",
        "misuse_queue",
        "misuse_two_views",
        "misuse_features",
        "misuse_motion",
        "misuse_obstacles",
        "misuse_winners",
    ] {
        for program in [program.to_owned(), format!("{program}_cpp")] {
            print!("{program}: {}", output_within(&mut command(build.join(&program), &[]), LIMIT)?);
        }
    }
    Ok(())
}

/// What valgrind says of a value that was never written.
const UNWRITTEN: &str = "depends on uninitialised value";

/// What is created in memory that was never written does not read it: valgrind finds nothing there, and finds
/// what `stereopsis_init` reads.
pub fn fresh_memory() -> Outcome {
    let build = folder().join("fresh");
    remove(&build)?;
    // The library of the other tests, without sanitizers: it is compiled already.
    let choices = ["-DSTEREOPSIS_PROFILE=checked".to_owned(), cargo_in(Core::Host)];
    configure("host-tests/tests/ffi", &build, &choices, "-Werror -g")?;
    run_command(command("cmake", &["--build"]).arg(&build).args(["--target", "fresh"]))?;
    let watched = |arguments: &[&str]| {
        let mut valgrind = command("valgrind", &["--quiet", "--error-exitcode=9", "--leak-check=full"]);
        ended_within(valgrind.arg(build.join("fresh")).args(arguments), LIMIT)
    };
    let (fresh, control) = (watched(&[])?, watched(&["read"])?);
    let is_clean = fresh.status.success() && fresh.stderr.is_empty() && !fresh.stdout.is_empty();
    if !is_clean {
        let line = format!("fresh memory: {}: {} {}", fresh.status, fresh.stdout, fresh.stderr);
        return Err(Failure::new(line.split_whitespace().collect::<Vec<_>>().join(" ")));
    }
    if control.status.success() || !control.stderr.contains(UNWRITTEN) {
        return Err(Failure::new("valgrind does not find that stereopsis_init reads memory"));
    }
    println!("memory that was never written is not read: {}", fresh.stdout.trim());
    Ok(())
}

/// A library that can panic cannot be linked: it is what makes the linking of the others a proof.
pub fn panicking_library() -> Outcome {
    let build = folder().join("panicking");
    // The profile that checks its own arithmetic panics where the check fails.
    let choices =
        ["-DSTEREOPSIS_PROFILE=checked", "-DCMAKE_TOOLCHAIN_FILE=board/m4.cmake", &cargo_in(Core::M4)];
    let choices = choices.map(str::to_owned);
    remove(&build)?;
    configure("examples/c-firmware", &build, &choices, "-Werror")?;
    // The linker's own words, not their translation.
    let built = command("cmake", &["--build"]).arg(&build).env("LC_ALL", "C").output();
    let built = built.map_err(|e| Failure::new(format!("cmake --build: {e}")))?;
    let stderr = String::from_utf8_lossy(&built.stderr).into_owned();
    match stderr
        .lines()
        .find(|line| line.contains("undefined reference to `the_stereopsis_library_can_panic'"))
    {
        Some(line) if !built.status.success() => println!("a library that can panic is refused: {line}"),
        _ => {
            return Err(Failure::new(format!(
                "a library that can panic was not refused for that: {}",
                stderr.trim()
            )));
        }
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
pub fn refused() -> Outcome {
    let (width, _, disparities) = super::FRAMES[0];
    let program = program(Core::Host, MethodName::Block, width, disparities)?;
    let folder = temporary_folder()?;
    let write = |name: &str, bytes: &[u8]| {
        fs::write(folder.path().join(name), bytes).map_err(|e| Failure::new(format!("{name}: {e}")))
    };
    let says = |arguments: &[&str], expected: &str| {
        let mut run = command(&program, arguments);
        let ended = ended_within(run.current_dir(folder.path()), LIMIT)?;
        if ended.status.success() || ended.stderr.trim() != expected || !ended.stdout.is_empty() {
            let line = format!("the example ends with {} and says \"{}\"", ended.status, ended.stderr.trim());
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
    says(&["right.pgm"], "usage: rectified [LEFT.pgm RIGHT.pgm]")?;
    for (name, value, expected) in [
        (
            "STEREOPSIS_METHOD",
            "sobel",
            "STEREOPSIS_METHOD is \"sobel\", known are: fast, block, sgm-lean, sgm, sgm-edge",
        ),
        ("STEREOPSIS_DISPARITIES", "40", "STEREOPSIS_DISPARITIES is 40: it must be a multiple of 16"),
        ("STEREOPSIS_WIDTH", "32", "STEREOPSIS_WIDTH is 32: it must be 64 (the disparities) to 6553"),
        ("STEREOPSIS_HEIGHT", "1", "STEREOPSIS_HEIGHT is 1: it must be 2 to 4096"),
        ("STEREOPSIS_LINES", "2", "STEREOPSIS_LINES is 2: it must be 3 to 4097"),
        ("STEREOPSIS_PREFIX", "1_", "STEREOPSIS_PREFIX is \"1_\": it must begin a name in C"),
    ] {
        let ended = cargo("build --locked --release")
            .env(name, value)
            .output()
            .map_err(|e| Failure::new(format!("cargo: {e}")))?;
        if ended.status.success() || !String::from_utf8_lossy(&ended.stderr).contains(expected) {
            return Err(Failure::new(format!("{name}={value} was not refused with \"{expected}\"")));
        }
    }
    Ok(())
}
