//! Noise meter in memory of the caller.
#![allow(unsafe_code)]

use super::Status;
use super::config::noise_number;
use super::state::{any_shared, checked, share_bytes};
use super::status::either;
use crate::imaging;

/// Noise meter in the caller's memory, for the `stereopsis_noise_` functions; its contents are private.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CNoiseMeter {
    /// Counters.
    pub words: [u32; 65],
}

/// The type of C and the meter of Rust are 65 words each, and every bit pattern is a valid meter.
const _: () = assert!(
    size_of::<CNoiseMeter>() == size_of::<imaging::NoiseMeter>()
        && align_of::<CNoiseMeter>() == align_of::<imaging::NoiseMeter>()
);

/// Returns the meter at a pointer.
///
/// # Safety
///
/// `meter` is null or points to a meter that nothing else uses for `'a`.
unsafe fn open<'a>(meter: *mut CNoiseMeter) -> Result<&'a mut imaging::NoiseMeter, Status> {
    checked(meter)?;
    // SAFETY: the caller's promise; the layouts are the same, and words have no bits that they must not have.
    Ok(unsafe { &mut *meter.cast::<imaging::NoiseMeter>() })
}

/// Forgets all lines.
///
/// # Safety
///
/// `meter` is null or points to a meter's bytes, which need no content.
pub unsafe fn noise_clear(meter: *mut CNoiseMeter) -> Status {
    if let Err(status) = checked(meter) {
        return status;
    }
    // SAFETY: the caller's promise.
    unsafe { meter.write(CNoiseMeter { words: [0; 65] }) };
    Status::Ok
}

/// Measures a line of 8-bit grey.
///
/// # Safety
///
/// `meter` is null or points to a meter, `line` is null or points to `length` bytes beside it.
pub unsafe fn noise_line(meter: *mut CNoiseMeter, line: *const u8, length: usize) -> Status {
    if line.is_null() {
        return Status::Null;
    }
    if length > usize::from(u16::MAX) {
        return Status::TooMany;
    }
    if share_bytes(meter.cast(), size_of::<CNoiseMeter>(), line.cast(), length) {
        return Status::Overlap;
    }
    // SAFETY: the caller's promise, and both stand beside each other.
    let (meter, line) = unsafe { (open(meter), core::slice::from_raw_parts(line, length)) };
    either(meter.map(|meter| {
        meter.line(line);
        Status::Ok
    }))
}

/// Writes the noise level and the standard deviation.
///
/// # Safety
///
/// `meter` is null or points to a meter, `noise` and `sigma_16ths` are null or point to numbers.
pub unsafe fn noise_level(meter: *mut CNoiseMeter, noise: *mut u8, sigma_16ths: *mut u16) -> Status {
    if noise.is_null() {
        return Status::Null;
    }
    if !sigma_16ths.is_aligned() {
        return Status::Misaligned;
    }
    // SAFETY: the caller's promise.
    let (level, sigma) = match unsafe { open(meter) } {
        Ok(meter) => (noise_number(meter.level()), meter.sigma_16ths().unwrap_or(0)),
        Err(status) => return status,
    };
    let of_meter = (meter.cast_const().cast(), size_of::<CNoiseMeter>());
    let of_sigma =
        (sigma_16ths.cast_const().cast(), if sigma_16ths.is_null() { 0 } else { size_of::<u16>() });
    if any_shared(&[of_meter, (noise.cast_const().cast(), 1), of_sigma], &[]) {
        return Status::Overlap;
    }
    // SAFETY: the caller's promise, both are aligned, and they are apart.
    unsafe {
        noise.write(level);
        if !sigma_16ths.is_null() {
            sigma_16ths.write(sigma);
        }
    }
    Status::Ok
}
