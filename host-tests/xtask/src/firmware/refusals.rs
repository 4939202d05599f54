//! What the firmware refuses: a panic when it is linked, a bad file when it runs. The checks that every other
//! build and run of it passes can fail.

use super::emulate;
use super::program::Program;
use crate::steps::{Failure, Outcome};
use firmware_boards::{M4, RV32};
use std::fs;
use stereopsis_host::run::MethodName;

/// The function that a panic calls and that does not exist.
const MISSING: &str = "this_firmware_can_panic";

/// Bad pairs: the left file, the right file, and what the log has to name.
const BAD: [(&[u8], &[u8], &str); 5] = [
    (b"P2 160 1 255\n", b"P5 160 1 255\n", "Left, fault: Header(NotPgm)"),
    (b"P5 16 1 255\n", b"P5 16 1 65535\n", "Right, fault: Header(Depth { largest: 65535 })"),
    (b"P5 16 1 255\n", b"P5 17 1 255\n", "Right, fault: Size { width: 17, height: 1 }"),
    (b"P5 64 1 255\n0123", b"P5 64 1 255\n0123", "Left, fault: Ends"),
    (b"P5 4096 1 255\n", b"P5 4096 1 255\n", "Width { given: 4096, most: 160 }"),
];

/// All of it.
pub fn check() -> Outcome {
    a_panic_does_not_link()?;
    for board in [M4, RV32] {
        bad_files_are_named(Program::new(board, MethodName::Block, 160, 120, 32)?)?;
    }
    Ok(())
}

/// Builds the example with a panic in it and wants the linker to refuse it by name.
fn a_panic_does_not_link() -> Outcome {
    let program = Program::new(M4, MethodName::Block, 160, 120, 32)?;
    let output = program.cargo("build --locked --release --quiet --bin depth --features panics").output();
    let output = output.map_err(|e| Failure::new(format!("cargo: {e}")))?;
    let told = String::from_utf8_lossy(&output.stderr);
    if output.status.success() {
        return Err(Failure::new("examples/firmware links with a panic in it"));
    }
    if !told.contains(MISSING) {
        eprint!("{told}");
        return Err(Failure::new(format!(
            "examples/firmware with a panic in it fails, but not for {MISSING}"
        )));
    }
    println!("with a panic in it examples/firmware does not link: {MISSING} is undefined");
    Ok(())
}

/// Runs the example on bad files and wants it to end with an error that names what is wrong.
fn bad_files_are_named(program: Program) -> Outcome {
    let built = program.build()?;
    for (left, right, named) in BAD {
        let folder = tempfile::tempdir().map_err(|e| Failure::new(e.to_string()))?;
        for (name, bytes) in [("left.pgm", left), ("right.pgm", right)] {
            fs::write(folder.path().join(name), bytes).map_err(|e| Failure::new(format!("{name}: {e}")))?;
        }
        refused(emulate::run(&built, folder.path()), named)?;
    }
    let folder = tempfile::tempdir().map_err(|e| Failure::new(e.to_string()))?;
    fs::write(folder.path().join("right.pgm"), b"P5 16 1 255\n").map_err(|e| Failure::new(e.to_string()))?;
    refused(emulate::run(&built, folder.path()), "Left, fault: Missing")?;
    println!("{program} refuses {} bad pairs of files by name", BAD.len() + 1);
    Ok(())
}

/// Wants a run to have failed with a line that has this in it.
fn refused(run: Outcome<String>, named: &str) -> Outcome {
    match run {
        Err(failure) if failure.to_string().contains(named) => Ok(()),
        Err(failure) => Err(Failure::new(format!("{failure}: it should name {named}"))),
        Ok(_) => Err(Failure::new(format!("the firmware takes bad files: it should name {named}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_named_refusal_counts() {
        assert!(refused(Err(Failure::new("x: Ends")), "Ends").is_ok());
        assert!(refused(Err(Failure::new("x: Read")), "Ends").is_err());
        assert!(refused(Ok("rows 1".into()), "Ends").is_err());
    }
}
