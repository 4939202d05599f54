//! One program for all targets: `STEREOPSIS_FUZZ` names the one that it runs. `cargo xtask fuzz` builds and
//! starts it.

#![no_main]

use libfuzzer_sys::{Corpus, arbitrary::Unstructured, fuzz_target};
use std::sync::LazyLock;
use stereopsis_fuzz::Target;

static TARGET: LazyLock<&Target> = LazyLock::new(|| {
    let name = std::env::var("STEREOPSIS_FUZZ").unwrap_or_default();
    stereopsis_fuzz::target(&name).unwrap_or_else(|| panic!("STEREOPSIS_FUZZ={name} names no target"))
});

fuzz_target!(|data: &[u8]| -> Corpus {
    match (TARGET.run)(&mut Unstructured::new(data)) {
        Ok(()) => Corpus::Keep,
        // The bytes hold no case.
        Err(_) => Corpus::Reject,
    }
});
