//! The stack measured: painted at the start, looked at in the end.

use core::ptr;

/// What unused stack is painted with.
const PAINT: u32 = 0xC5A5_5A5C;
/// Bytes below the caller that are left alone: the frame of the painter.
const MARGIN: usize = 256;

#[allow(unsafe_code)]
unsafe extern "C" {
    /// Where the stack begins, growing down: the start-up code's linker script says it.
    static _stack_start: u32;
    /// The end of what the linker gave out: the stack must not come this far.
    static __euninit: u32;
}

/// The lowest address that the stack may have, and the first above it, multiples of 4.
fn bounds() -> (usize, usize) {
    ((&raw const __euninit).addr(), (&raw const _stack_start).addr())
}

/// Paints all of the stack that is free. To be called first of all.
#[inline(never)]
#[allow(unsafe_code)]
pub fn paint() {
    let here = 0u32;
    let (lowest, _) = bounds();
    let free = (&raw const here).addr().saturating_sub(MARGIN);
    for address in (lowest..free).step_by(4) {
        // SAFETY: between the linker's last variable and this function's frame there is nothing but free
        // stack.
        unsafe { ptr::with_exposed_provenance_mut::<u32>(address).write_volatile(PAINT) }
    }
}

/// The most bytes of stack that were in use since it was painted.
#[inline(never)]
#[allow(unsafe_code)]
pub fn used() -> usize {
    let (lowest, start) = bounds();
    // SAFETY: all of this is RAM that the stack has to itself.
    let is_painted =
        |address: &usize| unsafe { ptr::with_exposed_provenance::<u32>(*address).read_volatile() } == PAINT;
    let first_used = (lowest..start).step_by(4).find(|address| !is_painted(address));
    start - first_used.unwrap_or(start)
}
