//! Line queue and feature detector: lines in the caller's memory.

use super::arena::Arena;
use super::stereopsis_c::*;
use super::{WIDTH, count};
use arbitrary::{Result, Unstructured};
use stereopsis::ffi::{
    CDetection, CFeature, CLine, LineQueueHandle, Status, detector_bytes, line_queue_bytes,
};

/// Bytes of every queue's lines, so that a slot may be filled without a look at its queue.
const LINE: usize = 21;

pub fn queue(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<Status> {
    let call = u.int_in_range(0..=15)?;
    if call == 0 {
        let (memory, length) = a.memory(u, line_queue_bytes(LINE, 3))?;
        let cell = a.cell(u)?;
        let wrong = [0, 65536, usize::MAX, usize::MAX - 7];
        let line = if u.ratio(1, 8)? { *u.choose(&wrong)? } else { LINE };
        // SAFETY: the memory has its length, or is null.
        return Ok(unsafe { stereopsis_line_queue_init(memory, length, line, cell) });
    }
    let h = a.handle::<LineQueueHandle>(u)?;
    // SAFETY: arrays have as many elements as is said, or are what a call refuses. A slot is filled and read
    // while it is its side's.
    Ok(unsafe {
        match call {
            1..=4 => {
                let bytes = a.array::<*mut u8>(u, 1)?;
                let status = stereopsis_line_queue_begin(h, bytes);
                if status == Status::Ok {
                    bytes.read().write_bytes(7, LINE);
                }
                status
            }
            5..=8 => stereopsis_line_queue_finish(h, u.arbitrary()?, u.arbitrary()?, u.arbitrary()?),
            9..=11 => {
                let line = a.array::<CLine>(u, 1)?;
                let status = stereopsis_line_queue_next(h, line);
                if status == Status::Ok {
                    let bytes = std::slice::from_raw_parts(line.read().bytes, LINE);
                    assert_eq!(bytes, [7; LINE], "a line that was handed over");
                }
                status
            }
            12 | 13 => stereopsis_line_queue_done(h),
            14 => stereopsis_line_queue_overruns(h, a.array(u, 1)?),
            _ => stereopsis_line_queue_deinit(h),
        }
    })
}

/// A detection, of which some numbers are changed.
fn detection(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<*mut CDetection> {
    if u.ratio(1, 8)? {
        return a.array(u, 1);
    }
    let mut config = std::mem::MaybeUninit::uninit();
    // SAFETY: the place is a configuration's, and it is filled.
    let mut config = unsafe {
        stereopsis_detection_default(WIDTH as u16, u.int_in_range(0..=60)?, config.as_mut_ptr());
        config.assume_init()
    };
    if u.arbitrary()? {
        config.cell_px = u.int_in_range(14..=60)?;
        config.per_cell = u.int_in_range(0..=20)?;
        config.threshold = u.arbitrary()?;
        config.turned = u.arbitrary()?;
    }
    a.values(u, &[config])
}

pub fn detector(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<Status> {
    let call = u.int_in_range(0..=15)?;
    if call == 0 {
        let slots = u.int_in_range(0..=20)?;
        let width = if u.ratio(1, 8)? { u.arbitrary()? } else { WIDTH as u16 };
        let (memory, length) = a.memory(u, detector_bytes(WIDTH, usize::from(slots)))?;
        let cell = a.cell(u)?;
        // SAFETY: the memory has its length, or is null.
        return Ok(unsafe { stereopsis_detector_init(memory, length, width, slots, cell) });
    }
    let (h, n) = (a.handle(u)?, count(u, 70)?);
    // SAFETY: as in `queue`.
    Ok(unsafe {
        match call {
            1..=3 => stereopsis_detector_start(h, detection(u, a)?),
            4 => stereopsis_detector_deinit(h),
            5 => stereopsis_detector_counts(h, a.array(u, 1)?),
            _ => {
                let capacity = u.int_in_range(0..=40)?;
                let features = a.array::<CFeature>(u, capacity)?;
                stereopsis_detector_push(h, a.array(u, n)?, n, features, capacity, a.array(u, 1)?)
            }
        }
    })
}
