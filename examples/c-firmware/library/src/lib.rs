//! `libstereopsis.a`: the functions of `stereopsis.h` for one method and one capacity.
//!
//! `STEREOPSIS_METHOD`, `STEREOPSIS_WIDTH`, `STEREOPSIS_DISPARITIES`, `STEREOPSIS_HEIGHT`, `STEREOPSIS_LINES`
//! and `STEREOPSIS_PREFIX` choose them when this is built; a product may write the one line of `instance.rs`
//! here instead, `stereopsis::instantiate_c_api!(Block, width = 320, disparities = 64);`, or several of them
//! in modules of their own.

#![no_std]

// An operating system's library brings its own panic handler.
#[cfg(not(target_os = "none"))]
extern crate std;

include!(concat!(env!("OUT_DIR"), "/instance.rs"));

/// Cannot be linked: it calls a function that nobody has. A program that links this library therefore holds
/// no path that leads to a panic; the linker has dropped this function (`--gc-sections`), because nothing
/// refers to it.
#[cfg(target_os = "none")]
#[panic_handler]
#[allow(unsafe_code, reason = "the declaration of a function that does not exist")]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: the function does not exist, so it is never called.
    unsafe extern "C" {
        safe fn the_stereopsis_library_can_panic() -> !;
    }
    the_stereopsis_library_can_panic()
}
