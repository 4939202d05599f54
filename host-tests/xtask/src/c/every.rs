//! All functions of the header in one program for a board: where it links, none of them can panic.

use crate::elf::Sizes;
use crate::steps::{Failure, Outcome, command, root, run as run_command};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The least number of functions that the header has: fewer would mean that they were not found.
const FEWEST: usize = 100;

/// Links every function of the library in a folder, by the compiler of a board and its options.
pub fn link(compiler: &str, flags: &str, build: &Path) -> Outcome {
    let names = names()?;
    let program = build.join("every");
    let mut link = command(compiler, &flags.split(' ').collect::<Vec<_>>());
    link.args(["-nostartfiles", "-T", "examples/c-firmware/board/board.ld", "-Wl,--gc-sections"]);
    link.arg("-Wl,--entry=stereopsis_abi,-z,noexecstack,--defsym=flash_start=0,--defsym=flash_bytes=1M");
    link.arg("-Wl,--defsym=ram_start=0x20000000,--defsym=stack_bytes=4K");
    // A linker script that asks for all of them.
    let wanted = build.join("every.ld");
    let all: Vec<_> = names.iter().map(String::as_str).collect();
    fs::write(&wanted, format!("EXTERN({})\n", all.join(" ")))
        .map_err(|e| Failure::new(format!("{}: {e}", wanted.display())))?;
    link.arg(&wanted);
    run_command(link.arg(build.join("libstereopsis.a")).arg("-o").arg(&program))?;
    let checked = Sizes::of(&program).and_then(|sizes| sizes.without_panics());
    checked.map_err(|e| Failure::new(format!("{}: {e}", program.display())))?;
    println!("{} functions link without a panic: {}", names.len(), program.display());
    Ok(())
}

/// The names of the functions, from the header's declarations with a prefix.
fn names() -> Outcome<BTreeSet<String>> {
    let header = root().join("src/ffi/stereopsis.h");
    let text = fs::read_to_string(&header).map_err(|e| Failure::new(format!("{}: {e}", header.display())))?;
    let names = text.split("prefix##").skip(1).filter_map(|rest| rest.split('(').next());
    let names: BTreeSet<_> = names.map(str::to_owned).collect();
    if names.len() < FEWEST {
        return Err(Failure::new(format!("the header has {} functions, expected {FEWEST}", names.len())));
    }
    Ok(names)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_header_has_functions() {
        assert!(super::names().expect("names").contains("stereopsis_line_queue_begin"));
    }
}
