//! Depth from focus and the motion of a pair.

use super::arena::Arena;
use super::stereopsis_c::*;
use super::{HEIGHT, WIDTH, count, float};
use arbitrary::{Result, Unstructured};
use std::mem::MaybeUninit;
use stereopsis::ffi::{
    CFeature, CFocusConfig, COdometryConfig, CPicture, CRig, Status, focus_bytes, odometry_bytes,
};

fn focus_config(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<*mut CFocusConfig> {
    if u.ratio(1, 8)? {
        return a.array(u, 1);
    }
    let mut config = MaybeUninit::uninit();
    // SAFETY: the place is a configuration's, and it is filled.
    let mut config: CFocusConfig = unsafe {
        stereopsis_focus_default(WIDTH as u16, u.int_in_range(0..=HEIGHT as u16)?, config.as_mut_ptr());
        config.assume_init()
    };
    if u.arbitrary()? {
        config.cell_px = u.int_in_range(0..=50)?;
        config.radius = u.int_in_range(0..=70)?;
        config.exposure_varies = u.arbitrary()?;
    }
    a.values(u, &[config])
}

pub fn focus(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<Status> {
    let call = u.int_in_range(0..=15)?;
    if call == 0 {
        let (columns, cells) = (u.int_in_range(0..=20)?, u.int_in_range(0..=60)?);
        let (memory, length) = a.memory(u, focus_bytes(WIDTH, usize::from(columns), cells as usize))?;
        let cell = a.cell(u)?;
        let cells = if u.ratio(1, 8)? { u.arbitrary()? } else { cells };
        // SAFETY: the memory has its length, or is null.
        return Ok(unsafe { stereopsis_focus_init(memory, length, WIDTH as u16, columns, cells, cell) });
    }
    let (h, n) = (a.handle(u)?, count(u, 70)?);
    // SAFETY: arrays have as many elements as is said, or are what a call refuses.
    Ok(unsafe {
        match call {
            1 | 2 => stereopsis_focus_start(h, focus_config(u, a)?),
            3 => stereopsis_focus_begin_frame(h, if u.arbitrary()? { 1.0 } else { float(u)? }),
            4 => stereopsis_focus_finish(h),
            5 => stereopsis_focus_row(h, u.int_in_range(0..=HEIGHT as u16)?, a.array(u, n)?, n),
            6 => stereopsis_focus_deinit(h),
            _ => stereopsis_focus_push(h, a.array(u, n)?, n),
        }
    })
}

/// A rig, likely or not.
pub fn rig(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<*mut CRig> {
    let mut rig = CRig { focal_px: 50.0, baseline_m: 0.1, cx: 20.0, cy: 12.0, cx_right: 20.0 };
    if u.ratio(1, 4)? {
        rig.focal_px = float(u)?;
        rig.baseline_m = float(u)?;
        rig.cx_right = float(u)?;
    }
    a.values(u, &[rig])
}

fn odometry_config(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<*mut COdometryConfig> {
    if u.ratio(1, 8)? {
        return a.array(u, 1);
    }
    let mut config = MaybeUninit::uninit();
    // SAFETY: the place is a configuration's, and it is filled.
    let mut config: COdometryConfig = unsafe {
        stereopsis_odometry_default(WIDTH as u16, config.as_mut_ptr());
        config.assume_init()
    };
    config.most_samples = u.int_in_range(0..=200)?;
    if u.ratio(1, 4)? {
        (config.far_px, config.near_px) = (float(u)?, float(u)?);
        (config.sigma_px, config.spacing_px) = (float(u)?, float(u)?);
        config.most_disparity_px = u.arbitrary()?;
    }
    a.values(u, &[config])
}

/// A picture of bytes, most often of the one size.
fn picture(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<*mut CPicture> {
    let size = if u.ratio(1, 8)? { [u.int_in_range(0..=50)?, u.int_in_range(0..=30)?] } else { [40, 24] };
    let [width, height] = size;
    let pixels = a.array::<u8>(u, usize::from(width) * usize::from(height))?.cast_const();
    a.values(u, &[CPicture { pixels, width, height }])
}

/// Features in and around the picture.
pub fn features(u: &mut Unstructured<'_>, a: &mut Arena, count: usize) -> Result<*mut CFeature> {
    let mut all = Vec::new();
    for _ in 0..count {
        let place = if u.ratio(1, 16)? {
            [float(u)?, float(u)?]
        } else {
            [u.int_in_range(0..=80)?, u.int_in_range(0..=48)?].map(|half: u8| f32::from(half) / 2.0)
        };
        let level = if u.ratio(1, 16)? { u.arbitrary()? } else { 0 };
        let [x_px, y_px] = place;
        all.push(CFeature { descriptor: [u.arbitrary()?; 8], x_px, y_px, score: u.arbitrary()?, level });
    }
    a.values(u, &all)
}

pub fn odometry(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<Status> {
    let call = u.int_in_range(0..=7)?;
    if call == 0 {
        let points = if u.ratio(1, 8)? { u.arbitrary()? } else { u.int_in_range(16..=24)? };
        let (memory, length) = a.memory(u, odometry_bytes(usize::from(points.min(30))))?;
        let cell = a.cell(u)?;
        // SAFETY: the memory has its length, or is null.
        return Ok(unsafe { stereopsis_odometry_init(memory, length, points, cell) });
    }
    let h = a.handle(u)?;
    // SAFETY: as in `focus`.
    Ok(unsafe {
        match call {
            1 | 2 => stereopsis_odometry_start(h, rig(u, a)?, odometry_config(u, a)?),
            3 => stereopsis_odometry_deinit(h),
            _ => {
                let count = u.int_in_range(0..=30)?;
                let (left, right) = (picture(u, a)?, picture(u, a)?);
                let features = features(u, a, count)?;
                stereopsis_odometry_step(h, left, right, features, count, a.array(u, 1)?)
            }
        }
    })
}
