//! Tells the crate which instructions it is built for. Those that a 32-bit Arm core has beyond those of every
//! Cortex-M rustc does not say to a crate: the target's name and `-C target-cpu` say it here. Processors with
//! vectors for the dense path, 64-bit ones and WebAssembly with SIMD128, get one name.

use std::env;

/// Processors whose vectors (Helium) the crate has rows for.
const WITH_VECTORS: [&str; 3] = ["cortex-m52", "cortex-m55", "cortex-m85"];
/// Processors with the instructions on four bytes in a word. Those of `thumbv7em` all have them.
const WITH_DSP: [&str; 4] = ["cortex-m4", "cortex-m7", "cortex-m33", "cortex-m35p"];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=CARGO_ENCODED_RUSTFLAGS");
    for name in ["dsp", "vectors", "thumb2", "rv32m", "rvv", "portable", "simd"] {
        println!("cargo::rustc-check-cfg=cfg(stereopsis_{name})");
    }
    let target = env::var("TARGET").unwrap_or_default();
    let flags = env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default();
    match choose(&target, &flags) {
        Ok(Some(cfg)) => println!("cargo::rustc-cfg={cfg}"),
        Ok(None) if has_products() && !flags.contains("stereopsis_portable") => {
            println!("cargo::rustc-cfg=stereopsis_rv32m");
        }
        Ok(None) => {}
        Err(line) => println!("cargo::error={line}"),
    }
    if is("CARGO_CFG_TARGET_ARCH", "riscv32") && has_rvv(&flags) && !flags.contains("stereopsis_portable") {
        println!("cargo::rustc-cfg=stereopsis_rvv");
    }
    if is("CARGO_CFG_TARGET_ENDIAN", "big") {
        let why = "words of memory stand for rows of bytes";
        println!("cargo::error=stereopsis is for little-endian processors: {why}");
    }
    if has_simd() {
        println!("cargo::rustc-cfg=stereopsis_simd");
    }
}

/// Whether the target's variable `key` is a list that has `value`.
fn is(key: &str, value: &str) -> bool {
    env::var(key).is_ok_and(|list| list.split(',').any(|one| one == value))
}

/// Whether this is an RV32 with all registers that gives the upper half of a product (`mulhu`).
fn has_products() -> bool {
    let [has_m, has_few] = ["m", "e"].map(|feature| is("CARGO_CFG_TARGET_FEATURE", feature));
    is("CARGO_CFG_TARGET_ARCH", "riscv32") && has_m && !has_few
}

/// Whether the flags name vectors of RISC-V, with registers of 16 bytes at least. Rust's stable compiler
/// knows them by `-C target-feature`, and says so to no crate.
fn has_rvv(flags: &str) -> bool {
    let named =
        |feature: &str| flags.split(['\u{1f}', ',', '=']).any(|word| word.strip_prefix('+') == Some(feature));
    let has_vectors = ["zve32x", "zve32f", "zve64x", "zve64f", "zve64d"].into_iter().any(named);
    let is_long = [128, 256, 512, 1024].into_iter().any(|bits| named(&format!("zvl{bits}b")));
    named("v") || has_vectors && is_long
}

/// Whether the dense path runs in the vectors of `matching/backend/simd`.
fn has_simd() -> bool {
    is("CARGO_CFG_TARGET_POINTER_WIDTH", "64")
        || is("CARGO_CFG_TARGET_ARCH", "wasm32") && is("CARGO_CFG_TARGET_FEATURE", "simd128")
}

/// The kernel to choose for a target and the compiler's flags, or what is wrong with what the flags choose.
fn choose(target: &str, flags: &str) -> Result<Option<&'static str>, String> {
    let asked = |cfg: &str| flags.split('\u{1f}').any(|word| word.trim_start_matches("--cfg=") == cfg);
    let has = |names: &[&str]| names.iter().any(|name| flags.contains(&format!("target-cpu={name}")));
    let is_v8 = target.starts_with("thumbv8m.main");
    let has_vectors = is_v8 && (has(&WITH_VECTORS) || flags.contains("+mve"));
    let names_dsp = has(&WITH_DSP) || has(&WITH_VECTORS) || flags.contains("+dsp");
    let is_a = ["armv7-", "armv7a", "thumbv7a", "thumbv7neon"].iter().any(|name| target.starts_with(name));
    let has_dsp = target.starts_with("thumbv7em") || is_v8 && names_dsp;
    if asked("stereopsis_vectors") && !has_vectors {
        return Err(format!(
            "stereopsis_vectors: {target} with these flags has no vectors: build for \
             thumbv8m.main-none-eabihf with -C target-cpu=cortex-m55, which chooses them by itself"
        ));
    }
    if asked("stereopsis_dsp") && !has_dsp && !is_a {
        return Err(format!(
            "stereopsis_dsp: {target} with these flags has no DSP instructions: leave it out, or on an M33 \
             that has them build with -C target-cpu=cortex-m33, which chooses them by itself"
        ));
    }
    if asked("stereopsis_dsp") && asked("stereopsis_vectors") {
        return Err(
            "stereopsis_dsp and stereopsis_vectors exclude each other: a Cortex-M55 takes the second alone"
                .into(),
        );
    }
    let has_thumb2 = is_v8 || target.starts_with("thumbv7");
    if asked("stereopsis_thumb2") && !has_thumb2 {
        return Err(format!("stereopsis_thumb2: {target} has no Thumb-2 instructions: leave it out"));
    }
    let names = ["stereopsis_dsp", "stereopsis_vectors", "stereopsis_thumb2", "stereopsis_portable"];
    Ok(match (names.into_iter().any(asked), has_vectors, has_dsp) {
        (true, ..) => None,
        (_, true, _) => Some("stereopsis_vectors"),
        (_, _, true) => Some("stereopsis_dsp"),
        // What is compiled for an A-profile's system is portable if nothing is asked.
        _ => (has_thumb2 && !is_a).then_some("stereopsis_thumb2"),
    })
}
