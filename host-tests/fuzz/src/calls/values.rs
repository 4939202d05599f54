//! Functions without a state of the library's.

use super::arena::Arena;
use super::motion::rig;
use super::stereopsis_c::*;
use super::{HEIGHT, count};
use arbitrary::{Result, Unstructured};
use stereopsis::ffi::{CBalance, CTemporal, Status};

pub fn plain(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<Status> {
    let n = count(u, 70)?;
    let row = if u.ratio(1, 8)? { u.arbitrary()? } else { u.int_in_range(0..=HEIGHT as u16)? };
    // SAFETY: arrays have as many elements as is said, or are what a call refuses.
    Ok(unsafe {
        match u.int_in_range(0..=15)? {
            0 => stereopsis_noise_clear(a.array(u, 1)?),
            1 => stereopsis_noise_line(a.array(u, 1)?, a.array(u, n)?, n),
            2 => stereopsis_noise_level(a.array(u, 1)?, a.array(u, 1)?, a.array(u, 1)?),
            3 => stereopsis_millimetres(rig(u, a)?, a.array(u, n)?, a.array(u, n)?, n),
            4 => {
                let (rig, disparities) = (rig(u, a)?, a.array(u, n)?);
                let (from, to) = (a.array::<f32>(u, n)?, a.array::<f32>(u, n)?);
                // In place, for neither, or each for itself.
                let (sigma_px, sigma_m) = match u.int_in_range(0..=3)? {
                    0 => (std::ptr::null_mut(), std::ptr::null_mut()),
                    1 => (from, from),
                    _ => (from, to),
                };
                stereopsis_metres(rig, disparities, sigma_px, a.array(u, n)?, sigma_m, n)
            }
            5 => stereopsis_points(rig(u, a)?, row, a.array(u, n)?, a.array(u, n)?, n),
            6 => stereopsis_histogram_clear(a.array(u, 1)?),
            7 => stereopsis_histogram_line(a.array(u, 1)?, row, a.array(u, n)?, n),
            8 => stereopsis_balance_between(a.array(u, 1)?, a.array(u, 1)?, a.array(u, 1)?),
            9 => {
                let balance = CBalance { offset_256ths: u.arbitrary()?, gain_256ths: u.arbitrary()? };
                stereopsis_balance_line(a.values(u, &[balance])?, a.array(u, n)?, n)
            }
            10 => {
                let block = u.int_in_range(0..=9)?;
                let (rows, disparities) = (a.array(u, n * usize::from(block))?, a.array(u, n)?);
                stereopsis_decimate(rows, block, row, disparities, n, a.array(u, n)?)
            }
            11 => stereopsis_temporal_default(a.array(u, 1)?),
            12 => stereopsis_temporal_forget(a.array(u, n)?, a.array(u, n)?, n),
            13 => {
                let config = CTemporal {
                    most_step: u.arbitrary()?,
                    shift: u.int_in_range(0..=5)?,
                    most_held: u.arbitrary()?,
                };
                let config = a.values(u, &[config])?;
                let (averages, ages) = (a.array(u, n)?, a.array(u, n)?);
                let (disparities, filtered) = (a.array(u, n)?, a.array(u, n)?);
                stereopsis_temporal_row(config, averages, ages, disparities, filtered, a.array(u, n)?, n)
            }
            14 => stereopsis_config_default(
                u.arbitrary()?,
                row,
                u.arbitrary()?,
                u.int_in_range(-1..=3)?,
                a.array(u, 1)?,
            ),
            _ => {
                let text = std::ffi::CStr::from_ptr(stereopsis_status_text(u.arbitrary()?));
                assert!(!text.is_empty());
                Status::Ok
            }
        }
    })
}
