//! Cores as build systems describe them, and what the library is built for: no instruction that a core lacks,
//! or that faults while its FPU is off.

use super::{component, script};
use crate::c::program::{Core, cargo_folder, folder, remove};
use crate::steps::{Failure, Outcome, command, output_of, root, run as run_command};
use std::fs;
use std::path::{Path, PathBuf};

/// Settings of Zephyr's Kconfig, and the target, core and features that the module chooses for Rust.
const ZEPHYR: [(&str, [&str; 3]); 15] = [
    ("CPU_CORTEX_M0PLUS", ["thumbv6m-none-eabi", "", ""]),
    ("CPU_CORTEX_M3", ["thumbv7m-none-eabi", "", ""]),
    ("CPU_CORTEX_M4", ["thumbv7em-none-eabi", "", ""]),
    ("CPU_CORTEX_M33", [V8M, "", ""]),
    ("CPU_CORTEX_M33;FPU;FP_HARDABI", [V8M_HF, "", ""]),
    ("CPU_CORTEX_M33;ARMV8_M_DSP;FPU;FP_HARDABI", [V8M_HF, "cortex-m33", ""]),
    ("CPU_CORTEX_M33;ARMV8_M_DSP;FPU;FP_SOFTABI", [V8M, "cortex-m33", ""]),
    ("CPU_CORTEX_M55;ARMV8_M_DSP;ARMV8_1_M_MVEI;ARMV8_1_M_MVEF", [V8M, "", "+dsp"]),
    ("CPU_CORTEX_M55;ARMV8_M_DSP;ARMV8_1_M_MVEI;ARMV8_1_M_MVEF;FPU;FP_HARDABI", [V8M_HF, "cortex-m55", ""]),
    ("CPU_CORTEX_M55;ARMV8_M_DSP;ARMV8_1_M_MVEI;FPU;FP_HARDABI", [V8M_HF, "cortex-m55", "-mve.fp"]),
    ("CPU_CORTEX_M55;ARMV8_M_DSP;FPU;FP_HARDABI", [V8M_HF, "", "+dsp"]),
    ("RISCV;RISCV_ISA_EXT_M;RISCV_ISA_EXT_A;RISCV_ISA_EXT_C", ["riscv32imac-unknown-none-elf", "", ""]),
    ("RISCV;RISCV_ISA_EXT_M;RISCV_ISA_EXT_C", ["riscv32imc-unknown-none-elf", "", ""]),
    ("RISCV;RISCV_ISA_EXT_A;RISCV_ISA_EXT_C", ["riscv32i-unknown-none-elf", "", ""]),
    (
        "RISCV;RISCV_ISA_EXT_M;RISCV_ISA_EXT_A;RISCV_ISA_EXT_F;RISCV_ISA_EXT_C;FPU;FLOAT_HARD",
        ["riscv32imafc-unknown-none-elf", "", ""],
    ),
];
const V8M: &str = "thumbv8m.main-none-eabi";
const V8M_HF: &str = "thumbv8m.main-none-eabihf";
/// The one that is built and looked through as well: it has the DSP extension, and its FPU is off.
const WITHOUT_FPU: (&str, [&str; 3]) = ("CPU_CORTEX_M33;ARMV8_M_DSP", [V8M, "", "+dsp"]);
/// What the module refuses, and why.
const REFUSED: [(&str, &str); 3] = [
    ("RISCV;RISCV_ISA_RV32E;RISCV_ISA_EXT_M;RISCV_ISA_EXT_C", "an RV32E core has 16 registers"),
    (
        "RISCV;RISCV_ISA_EXT_M;RISCV_ISA_EXT_A;RISCV_ISA_EXT_F;RISCV_ISA_EXT_D;CPU_HAS_FPU_DOUBLE_PRECISION;\
         RISCV_ISA_EXT_C;FPU;FLOAT_HARD",
        "set CONFIG_FLOAT_HARD=n",
    ),
    ("CPU_CORTEX_M23", "no Rust target for this board's core"),
];
/// A board's core and its compiler's flags in PlatformIO, and what cargo is asked for.
const PLATFORMIO: [(&str, &[&str], &str); 8] = [
    ("cortex-m4", &["-mfloat-abi=softfp"], "thumbv7em-none-eabi "),
    ("cortex-m33", &[], "thumbv8m.main-none-eabi -C target-feature=+dsp"),
    ("cortex-m33", &["-mfloat-abi=hard"], "thumbv8m.main-none-eabihf -C target-cpu=cortex-m33"),
    ("cortex-m33", &["-mcpu=cortex-m33+nodsp"], "thumbv8m.main-none-eabi "),
    ("cortex-m33+nodsp", &["-mfloat-abi=hard"], "thumbv8m.main-none-eabihf "),
    ("cortex-m55", &[], "thumbv8m.main-none-eabi -C target-feature=+dsp"),
    ("cortex-m55", &["-mfloat-abi=hard"], "thumbv8m.main-none-eabihf -C target-cpu=cortex-m55"),
    ("cortex-m55+nomve", &["-mfloat-abi=hard"], "thumbv8m.main-none-eabihf -C target-feature=+dsp"),
];

/// Holds what is chosen for each core to what it has, and looks through a library for a core without an FPU.
pub fn run() -> Outcome {
    for (kconfig, chosen) in ZEPHYR {
        zephyr(kconfig, chosen)?;
    }
    for (kconfig, why) in REFUSED {
        match configured(kconfig) {
            Err(e) if e.to_string().contains(why) => {}
            Err(e) => return Err(Failure::new(format!("{kconfig} is not refused with \"{why}\": {e}"))),
            Ok(_) => return Err(Failure::new(format!("{kconfig} is not refused"))),
        }
    }
    let stub = root().join("host-tests/xtask/src/c/components/in_platformio.py");
    for (cpu, flags, expected) in PLATFORMIO {
        let mut python = script(&stub.to_string_lossy());
        python.env_remove("RUSTFLAGS").arg(component("platformio/build_stereopsis.py")).arg(folder());
        let found = output_of(python.arg(cpu).args(flags))?;
        if found.trim_end_matches('\n') != expected {
            let line = format!("PlatformIO, {cpu} {flags:?}: cargo is asked for \"{}\"", found.trim());
            return Err(Failure::new(format!("{line}, not \"{expected}\"")));
        }
    }
    let (kconfig, chosen) = WITHOUT_FPU;
    let build = zephyr(kconfig, chosen)?;
    run_command(command("cmake", &["--build"]).arg(&build).args(["--target", "stereopsis_library"]))?;
    without_fpu(&build.join("stereopsis/libstereopsis.a"))
}

/// The folder of the module's project, configured for a core, or what CMake says against it in one line.
fn configured(kconfig: &str) -> Outcome<PathBuf> {
    let build = folder().join("zephyr_core");
    remove(&build)?;
    let mut cmake = command("cmake", &["-S", "host-tests/xtask/src/c/components/zephyr_core", "-B"]);
    cmake.arg(&build).arg(format!("-DKCONFIG={kconfig}"));
    cmake.arg(format!("-DMODULE={}", component("zephyr").display()));
    cmake.arg(format!("-DSTEREOPSIS_TARGET_DIR={}", cargo_folder(Core::M4).display()));
    let ended = cmake.output().map_err(|e| Failure::new(format!("cmake: {e}")))?;
    if ended.status.success() {
        return Ok(build);
    }
    let said = String::from_utf8_lossy(&ended.stderr);
    Err(Failure::new(said.split_whitespace().collect::<Vec<_>>().join(" ")))
}

/// Configures the module for a core, and holds its choices to those expected.
fn zephyr(kconfig: &str, chosen: [&str; 3]) -> Outcome<PathBuf> {
    let build = configured(kconfig)?;
    let cache = build.join("CMakeCache.txt");
    let cache = fs::read_to_string(&cache).map_err(|e| Failure::new(format!("{}: {e}", cache.display())))?;
    for (name, expected) in ["RUST_TARGET", "CPU", "FEATURES"].into_iter().zip(chosen) {
        let entry = format!("STEREOPSIS_{name}:STRING=");
        let found = cache.lines().find_map(|line| line.strip_prefix(&entry));
        if found != Some(expected) {
            let line = format!("Zephyr module, {kconfig}: {name} is {found:?}");
            return Err(Failure::new(format!("{line}, expected \"{expected}\"")));
        }
    }
    Ok(build)
}

/// Refuses an archive with an instruction of an FPU or of vectors, whose names begin with a v; it has those
/// of the DSP extension.
fn without_fpu(archive: &Path) -> Outcome {
    let listing =
        output_of(command("arm-none-eabi-objdump", &["--disassemble", "--no-show-raw-insn"]).arg(archive))?;
    let names = || listing.lines().filter_map(|line| line.split('\t').nth(1)).map(str::trim);
    if let Some(name) = names().find(|name| name.starts_with('v')) {
        let line = format!("{}: {name} faults on a core whose FPU is off", archive.display());
        return Err(Failure::new(line));
    }
    if !names().any(|name| name.starts_with("usub8")) {
        return Err(Failure::new(format!("{}: it has no usub8", archive.display())));
    }
    println!("{}: no instruction of an FPU among {}", archive.display(), names().count());
    Ok(())
}
