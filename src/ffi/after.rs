//! What is done with a row of disparities in C: decimation, and the filter over frames.
//!
//! Neither has a state of its own: the memory that a frame leaves for the next one is arrays of the caller.
#![allow(unsafe_code)]

use super::Status;
use super::points::overlap;
use super::state::{any_shared, checked};
use super::status::either;
use crate::depth::{Provenance, TemporalConfig, TemporalFilterView, shrink};
use crate::units::Disparity;
use core::num::NonZero;
use core::slice::{from_raw_parts, from_raw_parts_mut};

/// Origin: there is no answer, neither now nor in the last frames.
pub const STEREOPSIS_ORIGIN_NOTHING: u8 = 0;
/// Origin: the answer is this frame's alone, the first here or far from the average.
pub const STEREOPSIS_ORIGIN_NEW: u8 = 1;
/// Origin: the answer is the average of this frame's and earlier ones.
pub const STEREOPSIS_ORIGIN_AVERAGED: u8 = 2;
/// Origin: the answer is of an earlier frame, as this one has none.
pub const STEREOPSIS_ORIGIN_HELD: u8 = 3;

/// The constants are literals for the header; these assertions check their values.
const _: () = {
    assert!(STEREOPSIS_ORIGIN_NOTHING == Provenance::Nothing as u8);
    assert!(STEREOPSIS_ORIGIN_NEW == Provenance::New as u8);
    assert!(STEREOPSIS_ORIGIN_AVERAGED == Provenance::Averaged as u8);
    assert!(STEREOPSIS_ORIGIN_HELD == Provenance::Held as u8);
};

/// Smoothing and holding of the filter over frames, filled by `stereopsis_temporal_default`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CTemporal {
    /// Largest difference of answers of one surface, in 1/32 px.
    pub most_step: u16,
    /// Weight `1 / 2^shift` of a new answer in the average: 0 does not smooth, at most 4.
    pub shift: u8,
    /// Number of frames for which an answer is held where there is none.
    pub most_held: u8,
}

/// Fills a configuration, as `stereopsis_temporal_default`.
///
/// # Safety
///
/// `config` is null or points to a configuration's bytes.
pub unsafe fn temporal_default(config: *mut CTemporal) -> Status {
    if let Err(status) = checked(config) {
        return status;
    }
    let TemporalConfig { most_step, shift, most_held } = TemporalConfig::default();
    // SAFETY: the caller's promise, and it is aligned.
    unsafe { config.write(CTemporal { most_step, shift, most_held }) };
    Status::Ok
}

/// Forgets the frames before, as `stereopsis_temporal_forget`.
///
/// # Safety
///
/// `averages` and `ages` are null or point to `count` elements each, which need no content.
pub unsafe fn temporal_forget(averages: *mut u16, ages: *mut u8, count: usize) -> Status {
    let forget = || {
        checked(averages)?;
        checked(ages)?;
        if count > isize::MAX as usize / size_of::<u16>() {
            return Err(Status::TooMany);
        }
        if overlap(averages, ages, count) {
            return Err(Status::Overlap);
        }
        // SAFETY: the caller's promise. All ones are no answer.
        unsafe {
            averages.write_bytes(0xFF, count);
            ages.write_bytes(0, count);
        }
        Ok(Status::Ok)
    };
    either(forget())
}
const _: () = assert!(Disparity::NONE.raw() == 0xFFFF);

/// Filters a row, as `stereopsis_temporal_row`.
///
/// # Safety
///
/// `config` is null or points to a configuration, the arrays are null or point to `count` elements each.
pub unsafe fn temporal_row(
    config: *const CTemporal,
    [averages, filtered]: [*mut u16; 2],
    [ages, origins]: [*mut u8; 2],
    disparities: *const u16,
    count: usize,
) -> Status {
    let filter = || {
        checked(config)?;
        for words in [averages.cast_const(), filtered, disparities] {
            checked(words)?;
        }
        checked(ages)?;
        checked(origins)?;
        // SAFETY: the caller's promise, and it is aligned.
        let CTemporal { most_step, shift, most_held } = unsafe { config.read() };
        if shift > 4 {
            return Err(Status::Shift);
        }
        if count > isize::MAX as usize / size_of::<u16>() {
            return Err(Status::TooMany);
        }
        let written = [
            (averages.cast_const().cast(), 2 * count),
            (filtered.cast_const().cast(), 2 * count),
            (ages.cast_const().cast(), count),
            (origins.cast_const().cast(), count),
        ];
        if any_shared(&written, &[(disparities.cast(), 2 * count)]) {
            return Err(Status::Overlap);
        }
        // SAFETY: the caller's promise, and no two of them overlap. Origins are all 0, which is one, before
        // they are taken for that; disparities may have any bits.
        let (averages, ages, disparities, filtered, origins) = unsafe {
            origins.write_bytes(0, count);
            (
                from_raw_parts_mut(averages.cast::<Disparity>(), count),
                from_raw_parts_mut(ages, count),
                from_raw_parts(disparities.cast::<Disparity>(), count),
                from_raw_parts_mut(filtered.cast::<Disparity>(), count),
                from_raw_parts_mut(origins.cast::<Provenance>(), count),
            )
        };
        let config = TemporalConfig { most_step, shift, most_held };
        // A row is a picture of its own: both parts have its length.
        let mut view = TemporalFilterView::new(config, count, averages, ages).map_err(|_| Status::TooMany)?;
        view.row(0, disparities, filtered, origins);
        Ok(Status::Ok)
    };
    either(filter())
}

/// Takes a row into blocks of `block` x `block` pixels, as `stereopsis_decimate`.
///
/// # Safety
///
/// `rows` is null or points to `block * count` words, `disparities` to `count`, and `smaller` to
/// `count / block`.
pub unsafe fn decimate(
    rows: *mut u16,
    block: u16,
    row: u16,
    disparities: *const u16,
    count: usize,
    smaller: *mut u16,
) -> Status {
    let take = || {
        for words in [rows.cast_const(), disparities, smaller] {
            checked(words)?;
        }
        let block = NonZero::new(block).filter(|block| (2..=8).contains(&block.get()));
        let block = block.ok_or(Status::Block)?;
        let side = NonZero::<usize>::from(block);
        let count = usize::from(u16::try_from(count).map_err(|_| Status::TooMany)?);
        let (all, few) = (2 * side.get() * count, 2 * (count / side));
        let written = [(rows.cast_const().cast(), all), (smaller.cast_const().cast(), few)];
        if any_shared(&written, &[(disparities.cast(), 2 * count)]) {
            return Err(Status::Overlap);
        }
        let place = row % block;
        // SAFETY: the caller's promise: the row's place is inside of the rows, and both are apart.
        unsafe { disparities.copy_to_nonoverlapping(rows.add(usize::from(place) * count), count) };
        if place + 1 < block.get() {
            return Ok(Status::NoRowYet);
        }
        // SAFETY: the caller's promise, and both are apart; disparities may have any bits.
        let (rows, smaller) = unsafe {
            (
                from_raw_parts(rows.cast::<Disparity>().cast_const(), side.get() * count),
                from_raw_parts_mut(smaller.cast::<Disparity>(), count / side),
            )
        };
        shrink(rows, count, count, side, smaller);
        Ok(Status::Ok)
    };
    either(take())
}
