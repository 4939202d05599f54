//! What a linked firmware must not hold.

use crate::steps::{Failure, Outcome, command, output_of};
use std::path::Path;

/// Parts of the names of what panics and of what allocates.
const FORBIDDEN: [&str; 9] =
    ["panic", "begin_unwind", "unwrap_failed", "expect_failed", "malloc", "calloc", "realloc", "rust_alloc", "sbrk"];

/// Fails when a firmware in C holds a symbol that panics or allocates.
pub fn check(program: &Path) -> Outcome {
    let listed = output_of(command("arm-none-eabi-nm", &[]).arg(program))?;
    let wrong = |what: String| Err(Failure::new(format!("{}: {what}", program.display())));
    // A program without symbols would pass for one without panics.
    if !names(&listed).any(|name| name == "stereopsis_push") {
        return wrong("nm lists no stereopsis_push".to_owned());
    }
    let found = forbidden(&listed);
    if found.is_empty() { Ok(()) } else { wrong(format!("panics or allocates: {}", found.join(", "))) }
}

/// The names in what nm prints: the last word of each line.
fn names(listed: &str) -> impl Iterator<Item = &str> {
    listed.lines().filter_map(|line| line.split_whitespace().next_back())
}

fn forbidden(listed: &str) -> Vec<&str> {
    let is_forbidden = |name: &&str| {
        let lower = name.to_lowercase();
        matches!(*name, "free" | "_free_r") || FORBIDDEN.iter().any(|part| lower.contains(part))
    };
    names(listed).filter(is_forbidden).collect()
}

#[cfg(test)]
mod tests {
    use super::forbidden;

    #[test]
    fn what_panics_or_allocates_is_found() {
        let listed = "00000040 t fail\n000003b4 T reset\n00005bf0 T _malloc_r\n000059ec T _free_r\n\
            0000410e t _ZN4core9panicking18panic_bounds_check17h4E\n         U rust_begin_unwind\n00006484 W _sbrk\n";
        let expected =
            ["_malloc_r", "_free_r", "_ZN4core9panicking18panic_bounds_check17h4E", "rust_begin_unwind", "_sbrk"];
        assert_eq!(forbidden(listed), expected);
        assert!(forbidden("00004be8 T stereopsis_push\n00000414 t freeze\n").is_empty());
    }
}
