//! Hands the linker the memory of the board that a program is named after: as much as the chip has, where the
//! emulated machine has some.

use std::error::Error;
use std::path::Path;
use std::{env, fs};

/// Targets, and where their machine has its flash and its RAM.
const MACHINES: [(&str, u64, u64); 3] = [
    ("thumbv7em-none-eabihf", 0, 0x2000_0000),
    ("thumbv8m.main-none-eabihf", 0x1000_0000, 0x3800_0000),
    ("riscv32imc-unknown-none-elf", 0x8000_0000, 0x8040_0000),
];

/// Programs, and the boards whose `memory.x` says what they have.
const BOARDS: [(&str, &str); 3] = [("rp2350", "rp2350"), ("stm32h743", "stm32h743"), ("spi", "nrf5340")];

/// The ESP32-C3, whose linker script is its vendor's: flash, and the RAM that code and data share, bytes.
const ESP32C3: (u64, u64) = (4096 * 1024, 313 * 1024);

/// The names that riscv-rt's linker script uses for the two memories.
const RISCV_REGIONS: &str = "\
REGION_ALIAS(\"REGION_TEXT\", FLASH);
REGION_ALIAS(\"REGION_RODATA\", FLASH);
REGION_ALIAS(\"REGION_DATA\", RAM);
REGION_ALIAS(\"REGION_BSS\", RAM);
REGION_ALIAS(\"REGION_HEAP\", RAM);
REGION_ALIAS(\"REGION_STACK\", RAM);
";

fn main() -> Result<(), Box<dyn Error>> {
    let (out, target) = (env::var("OUT_DIR")?, env::var("TARGET")?);
    let (_, flash, ram) = MACHINES
        .into_iter()
        .find(|(name, ..)| *name == target)
        .ok_or("there is no machine for the target")?;
    fs::copy("../../../memory.x", Path::new(&out).join("memory.x"))?;
    fs::write(Path::new(&out).join("regions.x"), RISCV_REGIONS)?;
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=../../../memory.x");
    println!("cargo:rustc-link-search={out}");
    let is_riscv = target.starts_with("riscv");
    let mut lengths = if is_riscv { vec![("spi", ESP32C3)] } else { Vec::new() };
    for (program, board) in BOARDS.into_iter().filter(|_| !is_riscv) {
        let script = format!("../{board}/memory.x");
        println!("cargo:rerun-if-changed={script}");
        let text = fs::read_to_string(&script)?;
        lengths.push((program, (length(&text, "FLASH")?, length(&text, "RAM")?)));
    }
    for (program, (flash_bytes, ram_bytes)) in lengths {
        for (name, value) in [
            ("flash_origin", flash),
            ("flash_length", flash_bytes),
            ("ram_origin", ram),
            ("ram_length", ram_bytes),
        ] {
            println!("cargo:rustc-link-arg-bin={program}=--defsym=_{name}={value:#x}");
        }
    }
    let scripts: &[&str] = if is_riscv { &["memory.x", "regions.x", "link.x"] } else { &["link.x"] };
    for script in scripts {
        println!("cargo:rustc-link-arg-bins=-T{script}");
    }
    println!("cargo:rustc-link-arg-bins=--nmagic");
    Ok(())
}

/// The length of a memory in a linker script, bytes: `  RAM : ORIGIN = 0x20000000, LENGTH = 512K`.
fn length(script: &str, memory: &str) -> Result<u64, String> {
    let missing = || format!("memory.x has no length of {memory} in K");
    let line = script.lines().find(|line| line.split(':').next().is_some_and(|name| name.trim() == memory));
    let kilobytes = line.and_then(|line| line.split("LENGTH = ").nth(1)?.trim().strip_suffix('K'));
    let kilobytes: u64 = kilobytes.and_then(|number| number.parse().ok()).ok_or_else(missing)?;
    Ok(kilobytes * 1024)
}
