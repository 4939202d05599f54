//! A firmware with a panic in it does not link: the check that every other build of it passes can fail.

use super::board::M4;
use super::program::Program;
use crate::steps::{Failure, Outcome};
use stereopsis_host::run::Method;

/// The function that a panic calls and that does not exist.
const MISSING: &str = "this_firmware_can_panic";

/// Builds the example with a panic in it and wants the linker to refuse it by name.
pub fn check() -> Outcome {
    let program = Program::new(M4, Method::Block, 160, 120, 32)?;
    let output = program.cargo("build --locked --release --quiet --features panics").output();
    let output = output.map_err(|e| Failure::new(format!("cargo: {e}")))?;
    let told = String::from_utf8_lossy(&output.stderr);
    if output.status.success() {
        return Err(Failure::new("examples/firmware links with a panic in it"));
    }
    if !told.contains(MISSING) {
        eprint!("{told}");
        return Err(Failure::new(format!("examples/firmware with a panic in it fails, but not for {MISSING}")));
    }
    println!("with a panic in it examples/firmware does not link: {MISSING} is undefined");
    Ok(())
}
