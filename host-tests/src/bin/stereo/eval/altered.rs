//! Scenes as worse cameras would have taken them.

use crate::failure::Failure;
use crate::input::Pair;
use image::{DynamicImage, GrayImage};
use stereopsis_host::eval::Scene;
use stereopsis_host::mock::MockCamera;
use stereopsis_host::real::{Alteration, frame};

/// What is wrong with the cameras, as the option says it.
pub fn alteration(text: &str) -> Result<Alteration, String> {
    let mut words = text.split(':');
    let name = words.next().unwrap_or_default();
    let numbers: Option<Vec<f64>> = words.map(|number| number.parse().ok()).collect();
    let is_within = |number: f64, least: f64, most: f64| (least..=most).contains(&number);
    match (name, numbers.as_deref().unwrap_or(&[f64::NAN])) {
        ("noise", &[sigma]) if is_within(sigma, 0.0, 100.0) => Ok(Alteration::Noise(sigma)),
        ("exposure", &[gain, offset]) if is_within(gain, 0.1, 10.0) && is_within(offset, -255.0, 255.0) => {
            Ok(Alteration::Exposure { gain, offset })
        }
        ("gamma", &[gamma]) if is_within(gamma, 0.1, 10.0) => Ok(Alteration::Gamma(gamma)),
        ("half-row", &[]) => Ok(Alteration::HalfARowLow),
        _ => {
            Err("noise:5 (grey levels, up to 100), exposure:1.2:15 (of the right image, up to 10 and 255), \
                  gamma:0.75 (of the right image, 0.1 to 10) or half-row are known"
                .to_owned())
        }
    }
}

/// A scene's pair, altered, and its images in grey as the matcher sees them; the seed is the noise's.
pub fn pair(
    scene: &Scene,
    altered: Option<Alteration>,
    seed: u64,
) -> Result<(Pair, [GrayImage; 2]), Failure> {
    let [left, right] = &scene.images;
    let mut pair = Pair::open(left, right)?;
    let grey = frame(&mut pair.camera)?;
    let Some(altered) = altered else { return Ok((pair, grey)) };
    let grey = altered.apply(grey.each_ref(), seed);
    let [a, b] = grey.each_ref().map(|grey| MockCamera::from_image(DynamicImage::ImageLuma8(grey.clone())));
    let cameras = a.zip(b).ok_or_else(|| Failure::new(format!("{}: its images are empty", scene.name)))?;
    Ok((Pair::new(cameras.into(), [left, right], pair.inputs)?, grey))
}
