//! Depths in the 16-bit samples of `depth.png`.

use crate::map::DisparityMap;
use stereopsis::depth::DepthScale;
use stereopsis::units::Disparity;

/// The unit of a sample where none is asked for, m.
pub const MILLIMETRE: f64 = 0.001;

/// A sample for each pixel of a map, 0 where there is no answer.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct DepthSamples {
    /// The samples, row by row.
    pub samples: Vec<u16>,
    /// How many answers are farther than the largest sample says, which stands for them.
    pub clamped: usize,
}

impl DepthSamples {
    /// The depths of a map in units of `unit_m`, to the nearest one.
    pub fn of(map: &DisparityMap, scale: &DepthScale, unit_m: f64) -> Self {
        let mut clamped = 0;
        let samples = map.disparity.iter().map(|&disparity| {
            if disparity.is_none() {
                return 0;
            }
            sample(disparity, scale, unit_m).unwrap_or_else(|| {
                clamped += 1;
                u16::MAX
            })
        });
        Self { samples: samples.collect(), clamped }
    }
}

/// The sample of an answer; `None` beyond the largest one.
fn sample(disparity: Disparity, scale: &DepthScale, unit_m: f64) -> Option<u16> {
    let millimetres = scale.millimetres(disparity);
    if unit_m == MILLIMETRE && millimetres.is_some() {
        return Some(millimetres.0);
    }
    let steps = (f64::from(scale.metres(disparity)?.0) / unit_m).round();
    // No answer is 0, and an answer is none of that.
    (steps <= f64::from(u16::MAX)).then_some((steps as u16).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use stereopsis::geometry::camera::RectifiedRig;
    use stereopsis::units::PixelFlags;

    #[test]
    fn what_is_too_far_is_the_farthest_and_no_answer_is_0() {
        // 100 m at a pixel of disparity.
        let scale =
            DepthScale::new(&RectifiedRig::new(1000.0, 0.1, 8.0, 8.0).expect("a rig")).expect("a scale");
        let disparity = [
            Disparity::NONE,
            Disparity::from_pixels(0),
            Disparity::from_pixels(1),
            Disparity::from_pixels(2),
            Disparity::from_pixels(1000),
        ];
        let map = DisparityMap {
            width: 5,
            height: 1,
            disparity: disparity.to_vec(),
            flags: vec![PixelFlags::CLEAR; 5],
            confidence: vec![],
            sigma_px: vec![],
        };
        let of = |unit_m| DepthSamples::of(&map, &scale, unit_m);
        assert_eq!(of(MILLIMETRE), DepthSamples { samples: vec![0, 65535, 65535, 50_000, 100], clamped: 2 });
        assert_eq!(of(1.0 / 256.0), DepthSamples { samples: vec![0, 65535, 25_600, 12_800, 26], clamped: 1 });
        assert_eq!(of(10.0), DepthSamples { samples: vec![0, 65535, 10, 5, 1], clamped: 1 });
    }
}
