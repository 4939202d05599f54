//! What is in a linked firmware, of Rust or of C: bytes of flash and RAM, whose they are, and what must not
//! be there.

use crate::steps::{Failure, Outcome};
use object::{Object, ObjectSection, ObjectSymbol, SectionFlags, SectionIndex, SectionKind, SymbolKind};
use rustc_demangle::demangle;
use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::path::Path;

/// Sections in RAM whose size is known when the program is linked.
const STATIC_RAM: [&str; 3] = [".data", ".bss", ".uninit"];

/// What a program takes.
#[derive(Clone, Debug)]
pub struct Sizes {
    /// Bytes of `.data`, `.bss` and `.uninit`.
    pub static_ram: u64,
    /// Bytes of all that is kept in flash, by section.
    pub flash_sections: BTreeMap<String, u64>,
    /// Bytes of flash that the dense path takes, see [`is_dense`].
    pub dense_flash: u64,
    /// Names of the machinery of panics.
    pub panics: Vec<String>,
    /// Names of an allocator.
    pub allocations: Vec<String>,
}

impl Sizes {
    /// Reads a linked file; fails when it holds nothing of the library, or does not say so.
    pub fn of(path: &Path) -> Outcome<Self> {
        let sizes = Self::of_any(path)?;
        // A program without symbols would pass for one without panics.
        if sizes.dense_flash == 0 {
            return Err(Failure::new(format!("{}: it has no symbols of the library", path.display())));
        }
        Ok(sizes)
    }

    /// Reads a linked file that may hold nothing of the library.
    pub fn of_any(path: &Path) -> Outcome<Self> {
        let failed = |what: String| Failure::new(format!("{}: {what}", path.display()));
        let bytes = fs::read(path).map_err(|e| failed(e.to_string()))?;
        let file = object::File::parse(bytes.as_slice()).map_err(|e| failed(e.to_string()))?;
        let mut flash_sections = BTreeMap::new();
        let mut kept: Vec<SectionIndex> = Vec::new();
        let mut static_ram = 0;
        for section in file.sections() {
            let name = section.name().map_err(|e| failed(e.to_string()))?;
            if STATIC_RAM.contains(&name) {
                static_ram += section.size();
            }
            let SectionFlags::Elf { sh_flags, .. } = section.flags() else { continue };
            let is_allocated = sh_flags.contains(object::elf::SHF_ALLOC);
            let is_bits = section.kind() != SectionKind::UninitializedData && section.file_range().is_some();
            if is_allocated && is_bits && section.size() > 0 {
                flash_sections.insert(name.to_owned(), section.size());
                kept.push(section.index());
            }
        }
        // One piece of code may have several names.
        let mut pieces: HashMap<u64, (u64, bool)> = HashMap::new();
        let (mut panics, mut allocations) = (Vec::new(), Vec::new());
        for symbol in file.symbols() {
            let Some(index) = symbol.section_index() else { continue };
            let name = symbol.name().map_err(|e| failed(e.to_string()))?;
            let name = format!("{:#}", demangle(name));
            if !kept.contains(&index) || name.is_empty() || name.starts_with('$') {
                continue;
            }
            let piece = pieces.entry(symbol.address()).or_default();
            *piece = (piece.0.max(symbol.size()), piece.1 || is_dense(&name));
            if is_panic(&name) {
                panics.push(name);
            } else if is_allocation(&name) {
                allocations.push(name);
            }
        }
        let dense_flash = pieces.values().filter(|(_, dense)| *dense).map(|(size, _)| size).sum();
        Ok(Self { static_ram, flash_sections, dense_flash, panics, allocations })
    }

    /// Fails when there is anything of a panic or of an allocator.
    pub fn without_panics(&self) -> Outcome {
        let found = [self.panics.as_slice(), &self.allocations].concat();
        if found.is_empty() {
            Ok(())
        } else {
            Err(Failure::new(format!("it panics or allocates: {}", found.join(", "))))
        }
    }

    /// Bytes of flash in all.
    pub fn flash(&self) -> u64 {
        self.flash_sections.values().sum()
    }
}

/// A function in a linked file.
pub struct Function {
    /// Its path.
    pub name: String,
    /// Its first byte and how many there are.
    pub place: (u64, u64),
}

/// The functions of the crate `stereopsis` in a linked file.
pub fn functions_of_the_library(path: &Path) -> Outcome<Vec<Function>> {
    let failed = |what: String| Failure::new(format!("{}: {what}", path.display()));
    let bytes = fs::read(path).map_err(|e| failed(e.to_string()))?;
    let file = object::File::parse(bytes.as_slice()).map_err(|e| failed(e.to_string()))?;
    let functions = file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text && symbol.size() > 0);
    let functions = functions.filter_map(|symbol| {
        let name = format!("{:#}", demangle(symbol.name().ok()?));
        // The lowest bit of an address in Thumb code says that it is.
        let place = (symbol.address() & !1, symbol.size());
        name.trim_start_matches('<').starts_with("stereopsis::").then_some(Function { name, place })
    });
    Ok(functions.collect())
}

/// Whether a symbol belongs to the dense path, from the camera's lines to checked rows. These do:
///
/// * functions and constants of the crate `stereopsis`, but for how its errors are logged;
/// * `begin` and `next` of the program, into which the compiler may have put some of it;
/// * constants without a name, and functions of `core`, whosever they are;
/// * the compiler's own routines: copying, filling, division.
///
/// So it is a little more than the path rather than less.
fn is_dense(name: &str) -> bool {
    let path = name.trim_start_matches(['<', '&', '[']);
    let is_logging = name.contains(" as defmt::");
    let crates = ["stereopsis::", "core::", "compiler_builtins::", "depth::begin", "depth::next"];
    let unnamed = [".Lanon", "anon.", ".L__unnamed", "str."];
    let is_unnamed = unnamed.iter().any(|start| name.starts_with(start));
    !is_logging && (crates.iter().any(|start| path.starts_with(start)) || is_unnamed || is_builtin(name))
}

/// Whether a C name is one of the compiler's routines.
fn is_builtin(name: &str) -> bool {
    let copies = ["memcpy", "memmove", "memset", "memcmp", "bcmp"];
    let ends = [
        "si2", "si3", "si4", "di2", "di3", "di4", "ti2", "ti3", "sf2", "sf3", "df2", "df3", "si", "di", "sf",
        "df",
    ];
    let is_c = !name.contains("::");
    copies.contains(&name)
        || name.starts_with("__aeabi_")
        || (is_c && name.starts_with("__") && ends.iter().any(|end| name.ends_with(end)))
}

/// Whether a symbol is of the machinery of panics.
fn is_panic(name: &str) -> bool {
    ["panic", "begin_unwind", "unwrap_failed", "expect_failed", "slice_error_fail", "index_len_fail"]
        .iter()
        .any(|part| name.contains(part))
}

/// Whether a symbol is of an allocator.
fn is_allocation(name: &str) -> bool {
    let parts = ["__rust_alloc", "__rust_realloc", "__rust_dealloc", "__rg_", "__rdl_", "handle_alloc_error"];
    // A C library has them with a struct of its own too: `_malloc_r`.
    let names = ["malloc", "calloc", "realloc", "free", "sbrk"];
    let c_name = name.trim_start_matches('_').trim_end_matches("_r");
    name.trim_start_matches(['<', '&']).starts_with("alloc::")
        || parts.iter().any(|part| name.contains(part))
        || names.contains(&c_name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_have_owners() {
        assert!(is_dense("stereopsis::imaging::census::census_ring8"));
        assert!(is_dense("<stereopsis::pipeline::Pipeline<S,_,_>>::next_row"));
        assert!(is_dense(".Lanon.5f7f.3") && is_dense("__aeabi_memcpy") && is_dense("__udivmoddi4"));
        assert!(!is_dense(
            "<stereopsis::matching::matcher::MatchError as defmt::traits::Format>::_format_data"
        ));
        assert!(!is_dense(
            "<stereopsis_firmware::camera::timed::Timed<C> as stereopsis::camera::StereoSource>::next"
        ));
        assert!(
            !is_dense("stereopsis_firmware::stack::paint") && !is_dense("Reset") && !is_dense("__INTERRUPTS")
        );
    }

    #[test]
    fn panics_and_allocators_are_known() {
        assert!(is_panic("core::panicking::panic_bounds_check") && is_panic("__rustc::rust_begin_unwind"));
        assert!(is_panic("core::option::expect_failed") && !is_panic("stereopsis::pipeline"));
        assert!(is_allocation("__rustc::__rust_alloc") && is_allocation("alloc::raw_vec::grow"));
        assert!(
            is_allocation("malloc") && !is_allocation("stereopsis::free_list") && !is_allocation("freeze")
        );
        assert!(["_malloc_r", "_free_r", "__sbrk", "_sbrk_r", "free"].iter().all(|name| is_allocation(name)));
    }
}
