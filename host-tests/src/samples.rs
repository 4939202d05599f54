//! Disparities and depths in the 16-bit samples of `disparity.png` and `depth.png`.

use crate::map::DisparityMap;
use stereopsis::depth::DepthScale;
use stereopsis::units::Disparity;

/// The unit of a depth's sample where none is asked for, m.
pub const MILLIMETRE: f64 = 0.001;

/// A sample for each pixel of a map, 0 where there is no answer.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Samples {
    /// The samples, row by row.
    pub samples: Vec<u16>,
    /// How many answers are beyond what the largest sample says, which stands for them.
    pub clamped: usize,
}

impl Samples {
    /// The disparities of a map in 256ths of a px; an answer of 0 px is 1.
    pub fn of_disparities(map: &DisparityMap) -> Self {
        const STEP: u32 = 256 / Disparity::ONE as u32;
        Self::new(map, |disparity| u16::try_from((u32::from(disparity.raw()) * STEP).max(1)).ok())
    }

    /// The depths of a map in units of `unit_m`, to the nearest one.
    pub fn of_depths(map: &DisparityMap, scale: &DepthScale, unit_m: f64) -> Self {
        Self::new(map, |disparity| sample(disparity, scale, unit_m))
    }

    /// Samples of the answers, `None` beyond the largest one.
    fn new(map: &DisparityMap, sample: impl Fn(Disparity) -> Option<u16>) -> Self {
        let mut clamped = 0;
        let samples = map.disparity.iter().map(|&disparity| {
            if disparity.is_none() {
                return 0;
            }
            sample(disparity).unwrap_or_else(|| {
                clamped += 1;
                u16::MAX
            })
        });
        Self { samples: samples.collect(), clamped }
    }
}

/// The sample of an answer's depth; `None` beyond the largest one.
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

    /// No answer, then answers of so many px.
    fn map(px: &[u16]) -> DisparityMap {
        let answers = px.iter().map(|&px| Disparity::from_pixels(px));
        let disparity: Vec<_> = [Disparity::NONE].into_iter().chain(answers).collect();
        DisparityMap {
            width: disparity.len(),
            height: 1,
            flags: vec![PixelFlags::CLEAR; disparity.len()],
            disparity,
            confidence: vec![],
            sigma_px: vec![],
        }
    }

    #[test]
    fn an_answer_of_nothing_is_not_no_answer_and_one_of_256_px_is_counted() {
        let mut map = map(&[0, 1, 255, 256, 2000]);
        map.disparity[2] = Disparity::from_raw(33);
        let samples = vec![0, 1, 264, 65280, 65535, 65535];
        assert_eq!(Samples::of_disparities(&map), Samples { samples, clamped: 2 });
    }

    #[test]
    fn what_is_too_far_is_the_farthest_and_no_answer_is_0() {
        // 100 m at a pixel of disparity.
        let scale =
            DepthScale::new(&RectifiedRig::new(1000.0, 0.1, 8.0, 8.0).expect("a rig")).expect("a scale");
        let map = map(&[0, 1, 2, 1000]);
        let of = |unit_m| Samples::of_depths(&map, &scale, unit_m);
        assert_eq!(of(MILLIMETRE), Samples { samples: vec![0, 65535, 65535, 50_000, 100], clamped: 2 });
        assert_eq!(of(1.0 / 256.0), Samples { samples: vec![0, 65535, 25_600, 12_800, 26], clamped: 1 });
        assert_eq!(of(10.0), Samples { samples: vec![0, 65535, 10, 5, 1], clamped: 1 });
    }
}
