//! Matcher, winners and rectifier: lines to rows.

use super::arena::Arena;
use super::stereopsis_c::*;
use super::{DISPARITIES, HEIGHT, WIDTH, count};
use arbitrary::{Result, Unstructured};
use stereopsis::ffi::{CConfig, CRow, CWinner, Handle, STEREOPSIS_RECORD_BYTES, Status};

/// A configuration: of a preset, of one with some fields changed, or of any bytes.
fn config(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<*mut CConfig> {
    if u.ratio(1, 8)? {
        return a.array(u, 1);
    }
    let (height, preset) = (u.int_in_range(1..=HEIGHT as u16)?, u.int_in_range(0..=2)?);
    let mut config = std::mem::MaybeUninit::uninit();
    // SAFETY: the place is a configuration's, and a preset that there is fills it.
    let mut config = unsafe {
        stereopsis_config_default(WIDTH as u16, height, DISPARITIES as u16, preset, config.as_mut_ptr());
        config.assume_init()
    };
    if u.ratio(1, 4)? {
        config.width = u.int_in_range(0..=WIDTH as u16 + 1)?;
        config.min_disparity = u.arbitrary()?;
        config.smoothing_radius = u.int_in_range(0..=9)?;
        config.speckle_pixels = u.arbitrary()?;
        config.fill_pixels = u.arbitrary()?;
        config.median = u.arbitrary()?;
        config.noise = u.int_in_range(0..=3)?;
        config.jump = u.arbitrary()?;
        config.edges = u.arbitrary()?;
    }
    config.confidence = u.arbitrary()?;
    a.values(u, &[config])
}

/// Reads the row that a call gave.
unsafe fn read(status: Status, row: *const CRow) -> Status {
    if status == Status::Ok {
        // SAFETY: the call took the place and gave a row, whose arrays hold until the next call.
        unsafe {
            let CRow { width, disparities, flags, confidences, .. } = row.read();
            let width = usize::from(width);
            let sum: u64 =
                (0..width).map(|x| u64::from(*disparities.add(x)) + u64::from(*flags.add(x))).sum();
            assert!(sum <= width as u64 * (65535 + 255));
            if !confidences.is_null() {
                let sum: u64 = (0..width).map(|x| u64::from(*confidences.add(x))).sum();
                assert!(sum <= width as u64 * 255);
            }
        }
    }
    status
}

pub fn matcher(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<Status> {
    let call = u.int_in_range(0..=19)?;
    if call < 2 {
        let (memory, length) = a.memory(u, stereopsis_size())?;
        let cell = a.cell(u)?;
        // SAFETY: the memory has its length, or is null.
        return Ok(unsafe {
            if call == 0 {
                stereopsis_init(memory, length, cell)
            } else {
                stereopsis_init_fresh(memory, length, cell)
            }
        });
    }
    let (h, n) = (a.handle::<Handle>(u)?, count(u, 70)?);
    // SAFETY: arrays have as many elements as is said, or are what a call refuses.
    Ok(unsafe {
        match call {
            2 | 3 => stereopsis_start(h, config(u, a)?),
            4 => stereopsis_restart(h, config(u, a)?),
            5 | 6 => stereopsis_begin_frame(h),
            7 => stereopsis_deinit(h),
            8 => stereopsis_mask(h, a.array(u, n)?, a.array(u, n)?, n),
            9 => stereopsis_counters(h, a.array(u, 1)?),
            10 => stereopsis_sigma_px(h, a.array(u, n)?, n),
            11 => {
                let row = a.array(u, 1)?;
                read(stereopsis_push_lost(h, u.int_in_range(-1..=4)?, row), row)
            }
            12 | 13 => {
                let row = a.array(u, 1)?;
                read(stereopsis_flush(h, row), row)
            }
            14 => stereopsis_config_noise(u.int_in_range(-1..=3)?, u.int_in_range(0..=3)?, config(u, a)?),
            _ => {
                let (left, right, row) = (a.array(u, n)?, a.array(u, n)?, a.array(u, 1)?);
                read(stereopsis_push(h, left, right, n, row), row)
            }
        }
    })
}

/// Winners of a row, sealed or not.
fn winners_of(u: &mut Unstructured<'_>, a: &mut Arena, n: usize) -> Result<*mut CWinner> {
    let winner = CWinner {
        below: u.arbitrary()?,
        cost: u.arbitrary()?,
        above: u.arbitrary()?,
        disparity: u.int_in_range(0..=DISPARITIES as u8)?,
        kept: u.int_in_range(0..=DISPARITIES as u8)?,
        second: u.arbitrary()?,
        row: 0,
        check: 0,
    };
    let mut all = vec![winner; n];
    if n > 0 {
        // SAFETY: there are as many winners.
        unsafe { stereopsis_winners_seal(all.as_mut_ptr(), n, u.int_in_range(0..=HEIGHT as u16)?) };
    }
    a.values(u, &all)
}

pub fn winners(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<Status> {
    let call = u.int_in_range(0..=15)?;
    if call == 0 {
        let (memory, length) = a.memory(u, stereopsis_winners_size())?;
        let cell = a.cell(u)?;
        // SAFETY: the memory has its length, or is null.
        return Ok(unsafe { stereopsis_winners_init(memory, length, cell) });
    }
    let (h, n) = (a.handle(u)?, count(u, 70)?);
    // SAFETY: as in `matcher`.
    Ok(unsafe {
        match call {
            1 | 2 => stereopsis_winners_start(h, config(u, a)?, a.array(u, 1)?, a.array(u, 1)?),
            3 | 4 => stereopsis_winners_begin_frame(h),
            5 => stereopsis_winners_deinit(h),
            6 => stereopsis_winners_due(h, a.array(u, 1)?),
            7 => stereopsis_winners_sigma_px(h, a.array(u, n)?, n),
            8 => stereopsis_winners_seal(a.array(u, n)?, n, u.arbitrary()?),
            9 | 10 => {
                let (winners, row) = (winners_of(u, a, n)?, a.array(u, 1)?);
                read(stereopsis_winners_flush(h, winners, n, row), row)
            }
            _ => {
                let m = if u.ratio(1, 16)? { count(u, 70)? } else { n };
                let (left, winners, row) = (a.array(u, n)?, winners_of(u, a, m)?, a.array(u, 1)?);
                read(stereopsis_winners_push(h, left, n, winners, m, row), row)
            }
        }
    })
}

/// A record of cameras that look ahead, with some bytes changed and summed again, or any bytes.
fn record(u: &mut Unstructured<'_>, a: &mut Arena, n: usize) -> Result<*mut u8> {
    if u.ratio(1, 4)? {
        return a.array(u, n);
    }
    let mut bytes = include_bytes!("../../seeds/records/rig")[..STEREOPSIS_RECORD_BYTES].to_vec();
    for _ in 0..u.int_in_range(0..=3)? {
        let at = u.int_in_range(0..=bytes.len() - 5)?;
        bytes[at] = u.arbitrary()?;
    }
    crate::records::seal(&mut bytes);
    bytes.resize(n, 0);
    a.values(u, &bytes)
}

pub fn rectifier(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<Status> {
    let call = u.int_in_range(0..=15)?;
    if call == 0 {
        let (memory, length) = a.memory(u, stereopsis_rectifier_size())?;
        let cell = a.cell(u)?;
        // SAFETY: the memory has its length, or is null.
        return Ok(unsafe { stereopsis_rectifier_init(memory, length, cell) });
    }
    let (h, n) = (a.handle(u)?, count(u, 70)?);
    let length = if u.ratio(1, 8)? { u.int_in_range(0..=400)? } else { STEREOPSIS_RECORD_BYTES };
    // SAFETY: as in `matcher`.
    Ok(unsafe {
        match call {
            1..=3 => {
                let (width, height) = (WIDTH as u16, u.int_in_range(1..=HEIGHT as u16 + 1)?);
                let alpha = if u.arbitrary()? { -1.0 } else { super::float(u)? };
                let record = record(u, a, length)?;
                let (rig, lines) = (a.array(u, 1)?, a.array(u, 1)?);
                stereopsis_rectifier_start(h, record, length, width, height, alpha, rig, lines)
            }
            4 => stereopsis_rectifier_begin_frame(h),
            5 => stereopsis_rectifier_deinit(h),
            6 => stereopsis_record_read(record(u, a, length)?, length, a.array(u, 1)?),
            7 => stereopsis_rectifier_mask(h, u.arbitrary()?, a.array(u, n)?, a.array(u, n)?, n),
            8 => stereopsis_rectifier_push_lost(h),
            9..=11 => stereopsis_rectifier_line(h, a.array(u, n)?, a.array(u, n)?, n),
            _ => stereopsis_rectifier_push(h, a.array(u, n)?, a.array(u, n)?, n),
        }
    })
}
