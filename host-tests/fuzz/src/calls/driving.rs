//! Obstacles, decisions, free space and the cameras' health.

use super::arena::Arena;
use super::motion::rig;
use super::stereopsis_c::*;
use super::{HEIGHT, count};
use arbitrary::{Result, Unstructured};
use std::mem::MaybeUninit;
use stereopsis::ffi::{
    CDriveConfig, CObstacleConfig, CRow, STEREOPSIS_DRIVE_BYTES, STEREOPSIS_FREE_SPACE_BYTES,
    STEREOPSIS_PAIR_MONITOR_BYTES, Status, obstacles_bytes,
};

fn config(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<*mut CObstacleConfig> {
    if u.ratio(1, 8)? {
        return a.array(u, 1);
    }
    let mut config = MaybeUninit::uninit();
    // SAFETY: the place is a configuration's, and it is filled.
    let mut config: CObstacleConfig = unsafe {
        stereopsis_obstacles_default(config.as_mut_ptr());
        config.assume_init()
    };
    if u.arbitrary()? {
        config.ground = u.int_in_range(0..=3)?;
        (config.height_mm, config.pitch_mrad) = (u.arbitrary()?, u.int_in_range(-510..=510)?);
        (config.roll_mrad, config.most_roll) = (u.int_in_range(-510..=510)?, u.arbitrary()?);
        (config.cell_width, config.cell_height) = (u.int_in_range(1..=17)?, u.int_in_range(1..=17)?);
        (config.sigma_steps, config.min_pixels) = (u.int_in_range(0..=330)?, u.arbitrary()?);
        (config.obstacle_mm, config.drop_mm, config.headroom_mm) =
            (u.arbitrary()?, u.arbitrary()?, u.arbitrary()?);
        (config.sectors, config.least_answered) = (u.int_in_range(0..=33)?, u.arbitrary()?);
        (config.most_lost, config.min_confidence) = (u.arbitrary()?, u.arbitrary()?);
        config.sky_confidence = u.arbitrary()?;
    }
    a.values(u, &[config])
}

/// A row of a floor, or of any bytes.
fn row(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<*mut CRow> {
    let n = count(u, 70)?;
    let index = u.int_in_range(0..=HEIGHT as u16)?;
    let disparities = if u.arbitrary()? {
        a.array(u, n)?
    } else {
        let floor = 32 * index.saturating_sub(8);
        a.values(u, &vec![floor; n])?
    };
    let confidences = if u.arbitrary()? { std::ptr::null_mut() } else { a.array::<u8>(u, n)? };
    let flags = if u.arbitrary()? { a.values(u, &vec![0; n])? } else { a.array::<u8>(u, n)? };
    let row = CRow { index, width: n as u16, disparities, flags, confidences };
    a.values(u, &[row])
}

pub fn obstacles(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<Status> {
    let call = u.int_in_range(0..=31)?;
    if call == 0 {
        let [columns, rows] = [u.int_in_range(0..=12)?, u.int_in_range(0..=7)?];
        let (memory, length) = a.memory(u, obstacles_bytes(columns.into(), rows.into()))?;
        let cell = a.cell(u)?;
        let rows = if u.ratio(1, 8)? { u.arbitrary()? } else { rows };
        // SAFETY: the memory has its length, or is null.
        return Ok(unsafe { stereopsis_obstacles_init(memory, length, columns, rows, cell) });
    }
    let (h, n) = (a.handle(u)?, count(u, 70)?);
    // SAFETY: arrays have as many elements as is said, or are what a call refuses.
    Ok(unsafe {
        match call {
            1..=3 => {
                let [width, height] = [u.int_in_range(0..=50)?, u.int_in_range(0..=40)?];
                let (config, rig) = (config(u, a)?, rig(u, a)?);
                stereopsis_obstacles_start(h, config, rig, width, height, u.arbitrary()?)
            }
            4 | 5 => stereopsis_obstacles_begin_frame(h),
            6 => {
                let [pitch, roll] = [u.int_in_range(-510..=510)?, u.int_in_range(-510..=510)?];
                stereopsis_obstacles_set_pose(h, pitch, roll, u.arbitrary()?)
            }
            7 => stereopsis_obstacles_deinit(h),
            8 => stereopsis_obstacles_ground(h, a.array(u, 1)?),
            9 => stereopsis_obstacles_stixels(h, a.array(u, n)?, n),
            10 => stereopsis_obstacles_sectors(h, a.array(u, n)?, n),
            11 => stereopsis_obstacles_cells(h, u.int_in_range(0..=9)?, a.array(u, n)?, n),
            12 => stereopsis_obstacles_scan(h, a.array(u, n)?, n, a.array(u, 1)?),
            13..=15 => stereopsis_obstacles_finish(h, a.array(u, 1)?),
            16 => stereopsis_obstacles_cameras(h, a.handle(u)?),
            _ => stereopsis_obstacles_push(h, row(u, a)?),
        }
    })
}

fn drive_config(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<*mut CDriveConfig> {
    if u.arbitrary()? {
        return a.array(u, 1);
    }
    let mut config = MaybeUninit::uninit();
    // SAFETY: the place is a configuration's, and it is filled.
    let config: CDriveConfig = unsafe {
        stereopsis_drive_default(config.as_mut_ptr());
        config.assume_init()
    };
    a.values(u, &[config])
}

pub fn drive(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<Status> {
    let call = u.int_in_range(0..=15)?;
    if call < 3 {
        let needed =
            [STEREOPSIS_DRIVE_BYTES, STEREOPSIS_FREE_SPACE_BYTES, STEREOPSIS_PAIR_MONITOR_BYTES][call];
        let (memory, length) = a.memory(u, needed)?;
        // SAFETY: the memory has its length, or is null.
        return Ok(unsafe {
            match call {
                0 => stereopsis_drive_init(memory, length, a.cell(u)?),
                1 => stereopsis_free_space_init(memory, length, u.arbitrary()?, u.arbitrary()?, a.cell(u)?),
                _ => stereopsis_pair_monitor_init(memory, length, u.int_in_range(0..=40)?, a.cell(u)?),
            }
        });
    }
    let n = count(u, 70)?;
    // SAFETY: as in `obstacles`.
    Ok(unsafe {
        match call {
            3 | 4 => stereopsis_drive_start(a.handle(u)?, drive_config(u, a)?),
            5 => stereopsis_drive_stopping_mm(a.handle(u)?, u.arbitrary()?, a.array(u, 1)?),
            6 | 7 => stereopsis_drive_decide(a.handle(u)?, a.handle(u)?, u.arbitrary()?, a.array(u, 1)?),
            8 => stereopsis_drive_deinit(a.handle(u)?),
            9 => stereopsis_free_space_update(a.handle(u)?, a.handle(u)?),
            10 => stereopsis_free_space_sectors(a.handle(u)?, a.array(u, n)?, n),
            11 => stereopsis_free_space_deinit(a.handle(u)?),
            12 => stereopsis_pair_monitor_push(a.handle(u)?, a.array(u, n)?, a.array(u, n)?, n),
            13 => stereopsis_pair_monitor_begin_frame(a.handle(u)?),
            14 => {
                let h = a.handle(u)?;
                stereopsis_pair_monitor_health(h, a.array(u, 1)?, a.array(u, 1)?, a.array(u, 1)?)
            }
            _ => stereopsis_pair_monitor_deinit(a.handle(u)?),
        }
    })
}
