//! `examples/components`: the C interface as a Zephyr module, an ESP-IDF component and a library of
//! PlatformIO and the Arduino IDE. Their build files run in projects that have, in a few lines, what the
//! build system would; what comes out is linked and gives the host's bits where there is a compiler for it.

mod cores;

use super::program::{Core, cargo_folder, configure, crc32_of, folder, remove};
use crate::packages;
use crate::pictures::Pictures;
use crate::setup;
use crate::steps::{Failure, Outcome, command, output_of, root, run as run_command};
use firmware_scenes::scene::Scene;
use object::read::archive::ArchiveFile;
use std::fs;
use std::path::{Path, PathBuf};
use stereopsis_host::run::MethodName;

/// The frame, as large as the projects ask the library for.
const SCENE: Scene = Scene { width: 160, height: 120 };
const DISPARITIES: u16 = 32;
/// What the projects ask for besides.
const CHOICES: [(&str, &str); 5] =
    [("METHOD", "block"), ("WIDTH", "160"), ("DISPARITIES", "32"), ("HEIGHT", "240"), ("LINES", "33")];
const M4: &str = "-mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard -mthumb";
/// Where the linker's script puts flash, RAM and stack on that core.
const MEMORY: &str = "-Wl,--defsym=flash_start=0,--defsym=flash_bytes=64K,--defsym=ram_start=0x20000000,\
                      --defsym=stack_bytes=4K";

/// Builds all of them.
pub fn run() -> Outcome {
    packages::install(&["python3"])?;
    setup::targets(&["thumbv7em-none-eabihf", "thumbv8m.main-none-eabi", "riscv32imc-unknown-none-elf"])?;
    let pictures = Pictures::of_scene(SCENE)?;
    let expected = pictures.crc32(MethodName::Block, DISPARITIES)?;
    for (name, program) in [("Zephyr module", zephyr()?), ("Arduino library", arduino()?)] {
        let found = crc32_of(Core::M4, &program, &pictures)?;
        println!("{name}: crc32 {found:08x}");
        if found != expected {
            return Err(Failure::new(format!("{name}: the host's pipeline has crc32 {expected:08x}")));
        }
    }
    esp_idf()?;
    platformio()?;
    earlier_cmake()?;
    cores::run()
}

/// A folder of the components.
fn component(path: &str) -> PathBuf {
    root().join("examples/components").join(path)
}

/// Configures a project of the test anew.
fn project(name: &str, choices: &[String]) -> Outcome<PathBuf> {
    let build = folder().join(name);
    remove(&build)?;
    let cargo = format!("-DSTEREOPSIS_TARGET_DIR={}", cargo_folder(Core::M4).display());
    let choices = [&[cargo], choices].concat();
    configure(&format!("host-tests/xtask/src/c/components/{name}"), &build, &choices, "")?;
    Ok(build)
}

/// The example, built by the Zephyr module.
fn zephyr() -> Outcome<PathBuf> {
    let toolchain = root().join("examples/c-firmware/board/m4.cmake");
    let choices = [
        format!("-DCMAKE_TOOLCHAIN_FILE={}", toolchain.display()),
        format!("-DMODULE={}", component("zephyr").display()),
    ];
    let build = project("zephyr", &choices)?;
    run_command(command("cmake", &["--build"]).arg(&build))?;
    Ok(build.join("depth"))
}

/// The library for an ESP32-C3, built by the ESP-IDF component.
fn esp_idf() -> Outcome {
    let build = project("esp_idf", &[format!("-DCOMPONENT={}", component("esp-idf/stereopsis").display())])?;
    run_command(command("cmake", &["--build"]).arg(&build).args(["--target", "stereopsis_library"]))?;
    has_functions(&build.join("stereopsis/libstereopsis.a"))
}

/// The choices of a project with the policies of an earlier CMake, when it is configured and once more.
fn earlier_cmake() -> Outcome {
    let include = root().join("examples/c-firmware/stereopsis.cmake");
    let build = project("earlier_cmake", &[format!("-DSTEREOPSIS_CMAKE={}", include.display())])?;
    run_command(command("cmake", &[]).arg(&build))
}

/// The script of the PlatformIO library in one environment and its command for the Arduino IDE have one
/// library in common.
fn script(program: &str) -> std::process::Command {
    let mut python = command("python3", &[program]);
    for (name, value) in CHOICES {
        python.env(format!("STEREOPSIS_{name}"), value);
    }
    python.env("STEREOPSIS_TARGET_DIR", cargo_folder(Core::M4));
    python
}

/// The example, built on the library that is laid out for the Arduino IDE.
fn arduino() -> Outcome<PathBuf> {
    let library = folder().join("arduino");
    remove(&library)?;
    let build = component("platformio/build_stereopsis.py");
    let arguments = ["--cpu", "cortex-m4", "--float", "hard", "--out"];
    run_command(script(&build.to_string_lossy()).args(arguments).arg(&library))?;
    if !library.join("library.properties").exists() {
        return Err(Failure::new("the Arduino library has no library.properties"));
    }
    let compiled = library.join("src/cortex-m4/fpv4-sp-d16-hard");
    has_functions(&compiled.join("libstereopsis.a"))?;
    let firmware = root().join("examples/c-firmware");
    let program = library.join("depth");
    let mut gcc = command("arm-none-eabi-gcc", &M4.split(' ').collect::<Vec<_>>());
    let sources = ["rectified.c", "files.c", "board/startup_arm.c", "board/semihosting.c"];
    gcc.args(["-std=c99", "-O2", "-ffunction-sections", "-nostartfiles", MEMORY]);
    gcc.args(sources.map(|file| firmware.join(file)));
    gcc.arg("-I").arg(library.join("src")).arg("-T").arg(firmware.join("board/board.ld"));
    gcc.args(["-Wl,--gc-sections", "-Wl,-z,noexecstack"]).arg("-L").arg(&compiled);
    run_command(gcc.arg("-lstereopsis").arg("-o").arg(&program))?;
    Ok(program)
}

/// What the library adds to a PlatformIO project: the header, the archive and the macros.
fn platformio() -> Outcome {
    let build = component("platformio/build_stereopsis.py");
    let stub = root().join("host-tests/xtask/src/c/components/in_platformio.py");
    let added = output_of(script(&stub.to_string_lossy()).arg(&build).arg(folder().join("platformio")))?;
    let mut lines = added.lines();
    let mut line = || lines.next().unwrap_or_default();
    let (header, archive) = (Path::new(line()).join("stereopsis.h"), Path::new(line()));
    if !header.exists() {
        return Err(Failure::new(format!("PlatformIO library: there is no {}", header.display())));
    }
    has_functions(&archive.join("libstereopsis.a"))?;
    let expected = [
        "stereopsis -Wl,--gc-sections",
        "STEREOPSIS_WIDTH=160 STEREOPSIS_DISPARITIES=32 STEREOPSIS_HEIGHT=240 STEREOPSIS_LINES=33 \
         STEREOPSIS_BYTES=STEREOPSIS_BLOCK_BYTES",
    ];
    for expected in expected {
        let found = line();
        if found != expected {
            return Err(Failure::new(format!("PlatformIO library: it adds \"{found}\", not \"{expected}\"")));
        }
    }
    Ok(())
}

/// An archive that has the functions of the header.
fn has_functions(path: &Path) -> Outcome {
    let failed = |what: String| Failure::new(format!("{}: {what}", path.display()));
    let bytes = fs::read(path).map_err(|e| failed(e.to_string()))?;
    let archive = ArchiveFile::parse(bytes.as_slice()).map_err(|e| failed(e.to_string()))?;
    let mut symbols = archive.symbols().ok().flatten().into_iter().flatten().flatten();
    if symbols.any(|symbol| symbol.name() == b"stereopsis_push") {
        println!("{}: has stereopsis_push", path.display());
        return Ok(());
    }
    Err(failed("it has no stereopsis_push".to_owned()))
}
