//! Programs from the distribution's packages, by apt-get where that is possible, and from Python's.

use crate::steps::{Failure, Outcome, command, output_of, root, run, target_dir};
use std::ffi::OsStr;
use std::path::PathBuf;

/// The cross compiler whose library comes with a file of options that names it.
const RISCV_GCC: &str = "riscv64-unknown-elf-gcc";

/// The packages that have a program: one or the other, as the distribution's version goes.
fn packages_with(program: &str) -> Vec<&str> {
    match program {
        "qemu-system-riscv32" => vec!["qemu-system-misc", "qemu-system-riscv"],
        "qemu-aarch64" | "qemu-arm" => vec!["qemu-user"],
        "arm-none-eabi-gcc" => vec!["gcc-arm-none-eabi"],
        RISCV_GCC => vec!["gcc-riscv64-unknown-elf"],
        "aarch64-linux-gnu-gcc" => vec!["gcc-aarch64-linux-gnu"],
        "arm-linux-gnueabihf-gcc" => vec!["gcc-arm-linux-gnueabihf"],
        same => vec![same],
    }
}

/// The C library that a cross compiler needs: no program, and of no use without the compiler.
fn library_of(program: &str) -> Option<&'static str> {
    match program {
        "arm-none-eabi-gcc" => Some("libnewlib-arm-none-eabi"),
        RISCV_GCC => Some("picolibc-riscv64-unknown-elf"),
        "aarch64-linux-gnu-gcc" => Some("libc6-dev-arm64-cross"),
        "arm-linux-gnueabihf-gcc" => Some("libc6-dev-armhf-cross"),
        _ => None,
    }
}

/// Installs those of the programs that are not there.
pub fn install(programs: &[&str]) -> Outcome {
    let missing: Vec<_> = programs.iter().copied().filter(|program| !is_there(program)).collect();
    if missing.is_empty() {
        return Ok(());
    }
    // What fails here is told below, in one line.
    let updated = apt(&["update"]).is_ok();
    let install =
        |packages: &[&str]| apt(&[&["install", "-y", "--no-install-recommends"], packages].concat()).is_ok();
    // One call reads the lists of packages once. A distribution that lacks one of them refuses them all.
    let all: Vec<_> = missing
        .iter()
        .flat_map(|&one| packages_with(one).into_iter().take(1).chain(library_of(one)))
        .collect();
    let at_once = updated && install(&all);
    for program in missing {
        if at_once && is_there(program) {
            continue;
        }
        let found =
            updated && packages_with(program).into_iter().any(|package| install(&[package]) && runs(program));
        let library = library_of(program);
        if found && library.is_none_or(|library| install(&[library])) && is_there(program) {
            continue;
        }
        let mut names = packages_with(program).join(" or ");
        if let Some(library) = library {
            names = format!("{names} {library}");
        }
        let advice =
            format!("{program} is not installed: install it (Debian, Ubuntu: apt-get install {names})");
        return Err(Failure::new(advice));
    }
    Ok(())
}

fn apt(arguments: &[&str]) -> Outcome {
    let is_root = output_of(&mut command("id", &["-u"])).is_ok_and(|id| id.trim() == "0");
    let sudo = if is_root { [].as_slice() } else { &["sudo", "-n"] };
    let words = [sudo, &["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"], arguments].concat();
    run(&mut command(words[0], &words[1..]))
}

/// The path of a program that a Python package of that name and version has, installed by pip in an
/// environment of its own below the folder of build products.
pub fn from_python(package: &str, version: &str) -> Outcome<PathBuf> {
    let environment = root().join(target_dir()).join("python").join(format!("{package}-{version}"));
    let program = environment.join("bin").join(package);
    if runs(&program) {
        return Ok(program);
    }
    let make = || {
        run(command("python3", &["-m", "venv", "--clear"]).arg(&environment))?;
        let wanted = format!("{package}=={version}");
        run(&mut command(environment.join("bin/python"), &["-m", "pip", "install", "--quiet", &wanted]))
    };
    let advice = |e| Failure::new(format!("{e}; {package} needs Python 3 with venv and pip (python3-venv)"));
    make().map_err(advice)?;
    if runs(&program) { Ok(program) } else { Err(Failure::new(format!("{package} {version} does not run"))) }
}

fn runs(program: impl AsRef<OsStr>) -> bool {
    output_of(&mut command(program, &["--version"])).is_ok()
}

/// Whether a program runs, and has the library that it needs.
fn is_there(program: &str) -> bool {
    // The compiler says the path of a file that it has, and the mere name of one that it has not.
    let has_library = || {
        let file = if program == RISCV_GCC { "picolibc.specs" } else { "libc.a" };
        let path = output_of(&mut command(program, &[&format!("-print-file-name={file}")]));
        path.is_ok_and(|path| path.contains('/'))
    };
    runs(program) && (library_of(program).is_none() || has_library())
}
