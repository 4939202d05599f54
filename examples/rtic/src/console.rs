//! Text and numbers on the host's console; `core::fmt` may panic.

use core::ffi::CStr;
use semihosting::sys::arm_compat::sys_write0;

/// Text.
pub fn text(text: &CStr) {
    sys_write0(text);
}

/// A name and a number.
pub fn figure(name: &CStr, number: u32) {
    sys_write0(name);
    let (mut digits, mut rest) = ([0; 11], number);
    let mut first = digits.len() - 1; // The last byte is the end of a C string.
    for (at, digit) in digits.iter_mut().enumerate().rev().skip(1) {
        (*digit, rest, first) = (b'0' + (rest % 10) as u8, rest / 10, at);
        if rest == 0 {
            break;
        }
    }
    if let Ok(text) = CStr::from_bytes_with_nul(digits.get(first..).unwrap_or_default()) {
        sys_write0(text);
    }
}
