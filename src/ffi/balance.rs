//! Photometric balance in C: histograms of both cameras, and the right one's grey levels mapped.
#![allow(unsafe_code)]

use super::Status;
use super::state::{checked, share_bytes};
use super::status::either;
use crate::imaging::{Balance, Histogram};
use core::slice::{from_raw_parts, from_raw_parts_mut};

/// Histogram of a frame's grey levels in the caller's memory, for the `stereopsis_histogram_` functions; its
/// contents are private.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CHistogram {
    /// Counters.
    pub words: [u64; 10],
}

/// The type of C and the histogram of Rust are as large and aligned alike; all of it are integers.
const _: () = assert!(
    size_of::<CHistogram>() == size_of::<Histogram>() && align_of::<CHistogram>() == align_of::<Histogram>()
);

/// Map from the right camera's grey levels to the left one's: `grey <- (gain grey + offset) / 256`, rounded
/// and clamped to 0 to 255.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CBalance {
    /// Offset in 256ths of a grey level.
    pub offset_256ths: i32,
    /// Gain in 256ths, 128 to 512 as estimated; 256 with an offset of 0 changes nothing.
    pub gain_256ths: u16,
}

/// Forgets all lines, as `stereopsis_histogram_clear`.
///
/// # Safety
///
/// `histogram` is null or points to a histogram's bytes, which need no content.
pub unsafe fn histogram_clear(histogram: *mut CHistogram) -> Status {
    if let Err(status) = checked(histogram) {
        return status;
    }
    // SAFETY: the caller's promise, and it is aligned.
    unsafe { histogram.cast::<Histogram>().write(Histogram::new()) };
    Status::Ok
}

/// Counts the pixels of a line, as `stereopsis_histogram_line`.
///
/// # Safety
///
/// `histogram` is null or points to a histogram, `line` is null or points to `length` bytes.
pub unsafe fn histogram_line(histogram: *mut CHistogram, row: u16, line: *const u8, length: usize) -> Status {
    let count = || {
        checked(histogram)?;
        checked(line)?;
        if length > usize::from(u16::MAX) {
            return Err(Status::TooMany);
        }
        if share_bytes(histogram.cast(), size_of::<CHistogram>(), line.cast(), length) {
            return Err(Status::Overlap);
        }
        // SAFETY: the caller's promise; both are apart, and a histogram may have any bits.
        let (histogram, line) =
            unsafe { (&mut *histogram.cast::<Histogram>(), from_raw_parts(line, length)) };
        histogram.line(row.into(), line);
        Ok(Status::Ok)
    };
    either(count())
}

/// Estimates the balance of two histograms, as `stereopsis_balance_between`.
///
/// # Safety
///
/// `left` and `right` are null or point to histograms, `balance` to a balance's bytes.
pub unsafe fn balance_between(
    left: *const CHistogram,
    right: *const CHistogram,
    balance: *mut CBalance,
) -> Status {
    let estimate = || {
        checked(left)?;
        checked(right)?;
        checked(balance)?;
        // SAFETY: the caller's promise, they are aligned, and a histogram may have any bits.
        let (left, right) = unsafe { (left.cast::<Histogram>().read(), right.cast::<Histogram>().read()) };
        let Balance { gain_256ths, offset_256ths } = Balance::between(&left, &right);
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { balance.write(CBalance { offset_256ths, gain_256ths }) };
        Ok(Status::Ok)
    };
    either(estimate())
}

/// Balances a line of the right camera in place, as `stereopsis_balance_line`.
///
/// # Safety
///
/// `balance` is null or points to a balance, `line` is null or points to `length` bytes.
pub unsafe fn balance_line(balance: *const CBalance, line: *mut u8, length: usize) -> Status {
    let map = || {
        checked(balance)?;
        checked(line)?;
        if length > isize::MAX as usize {
            return Err(Status::TooMany);
        }
        // SAFETY: the caller's promise, and it is aligned; it is copied before the line is changed.
        let CBalance { offset_256ths, gain_256ths } = unsafe { balance.read() };
        if share_bytes(balance.cast(), size_of::<CBalance>(), line.cast(), length) {
            return Err(Status::Overlap);
        }
        // SAFETY: the caller's promise.
        let line = unsafe { from_raw_parts_mut(line, length) };
        Balance { gain_256ths, offset_256ths }.line(line);
        Ok(Status::Ok)
    };
    either(map())
}
