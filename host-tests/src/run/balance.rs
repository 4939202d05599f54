//! By how much the cameras of a pair are exposed otherwise.

use super::measure_noise;
use stereopsis::camera::{CameraError, StereoSource};
use stereopsis::imaging::{Balance, BalancedPair};

/// What the source's next frame asks for, which is taken for that alone, and the one after it is begun.
pub fn measure_balance<C: StereoSource>(source: &mut C) -> Result<Balance, CameraError<C::Error>> {
    let mut pair = BalancedPair::new(source);
    measure_noise(&mut pair)?;
    pair.start_frame()?;
    Ok(pair.balance())
}
