//! How noisy a camera's pictures are, given or measured.

use std::str::FromStr;
use stereopsis::camera::{CameraError, StereoSource};
use stereopsis::imaging::{Noise, NoiseMeter};

/// The noise of the source's next frame, which is taken for that alone.
pub fn measure_noise<C: StereoSource>(source: &mut C) -> Result<NoiseMeter, CameraError<C::Error>> {
    let format = source.format();
    let [mut left, mut right] = [(); 2].map(|()| vec![0; format.line_bytes()]);
    let mut meter = NoiseMeter::new();
    source.start_frame()?;
    for _ in 0..format.height {
        source.next_lines(&mut left, &mut right)?;
        meter.line(&left);
        meter.line(&right);
    }
    Ok(meter)
}

/// Where the level of noise comes from, as an option of a command line: `auto`, `none`, `low` or `high`.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum NoiseChoice {
    /// It is measured.
    #[default]
    Auto,
    /// It is given.
    Given(Noise),
}

impl NoiseChoice {
    /// The level, and the meter if the source's next frame was taken to measure it.
    pub fn level<C: StereoSource>(
        self,
        source: &mut C,
    ) -> Result<(Noise, Option<NoiseMeter>), CameraError<C::Error>> {
        match self {
            Self::Given(noise) => Ok((noise, None)),
            Self::Auto => measure_noise(source).map(|meter| (meter.level(), Some(meter))),
        }
    }
}

/// The name is of no level of noise.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("the noise is auto, none, low or high")]
pub struct UnknownNoise;

impl FromStr for NoiseChoice {
    type Err = UnknownNoise;

    fn from_str(name: &str) -> Result<Self, UnknownNoise> {
        let given = Noise::ALL.into_iter().find(|noise| noise.name() == name).map(Self::Given);
        given.or((name == "auto").then_some(Self::Auto)).ok_or(UnknownNoise)
    }
}
