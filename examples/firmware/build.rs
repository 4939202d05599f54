//! Hands the linker the board's memory and the start-up code's script.

use std::path::PathBuf;
use std::{env, fs, io};

/// The memory map, beside the crate's manifest; a copy of this folder has its own.
const MEMORY: &str = "../../memory.x";

fn main() -> io::Result<()> {
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("OUT_DIR is not set"))?);
    fs::copy(MEMORY, out.join("memory.x"))?;
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    // The vector table's and the sections' alignment is the script's business, not the page size's.
    println!("cargo:rustc-link-arg-bins=--nmagic");
    println!("cargo:rerun-if-changed={MEMORY}");
    println!("cargo:rerun-if-changed=build.rs");
    Ok(())
}
