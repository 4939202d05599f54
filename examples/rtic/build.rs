//! Hands the linker the board's memory.

use std::{env, fs, io, path::Path};

/// The memory map of the emulated board; a copy of this folder has its own.
const MEMORY: &str = "../../memory.x";

fn main() -> io::Result<()> {
    let out = env::var("OUT_DIR").map_err(io::Error::other)?;
    fs::copy(MEMORY, Path::new(&out).join("memory.x"))?;
    println!("cargo:rerun-if-changed={MEMORY}");
    println!("cargo:rustc-link-search={out}");
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    println!("cargo:rustc-link-arg-bins=--nmagic");
    Ok(())
}
