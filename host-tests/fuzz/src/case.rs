//! Cases made of bytes.

use arbitrary::{Result, Unstructured};
use image::GrayImage;
use stereopsis::imaging::Noise;
use stereopsis::matching::{Block, Checks, Config, Penalties};
use stereopsis::units::Disparity;
use stereopsis_model::scene::Random;
use stereopsis_model::scene::pattern::Pattern;

/// Any checks.
pub fn checks(u: &mut Unstructured<'_>) -> Result<Checks> {
    let presets = [Checks::DENSE, Checks::DEFAULT, Checks::STRICT];
    if u.ratio(1, 4)? {
        return u.choose(&presets).copied();
    }
    Ok(Checks {
        left_right_px: u.arbitrary()?,
        uniqueness_percent: u.arbitrary()?,
        refuse_flat: u.arbitrary()?,
        texture_gradient: u.arbitrary()?,
        texture_pixels: u.arbitrary()?,
        refuse_ceiling: u.arbitrary()?,
        smoothing_radius: u.int_in_range(0..=Checks::MOST_SMOOTHING)?,
        speckle_pixels: u.arbitrary()?,
        surface_step: Disparity::from_raw(u.int_in_range(0..=33)?),
        median: u.arbitrary()?,
        fill_pixels: u.arbitrary()?,
        fill_step: Disparity::from_raw(u.arbitrary()?),
        speckle_run: u.arbitrary()?,
        fattening_slope: Disparity::from_raw(u.arbitrary()?),
        open_run: u.arbitrary()?,
        open_margin: u.int_in_range(0..=Checks::MOST_OPEN_MARGIN + 1)?,
        refuse_repeats: u.arbitrary()?,
    })
}

/// Any penalties; most of them are refused, so half are the default ones.
pub fn penalties(u: &mut Unstructured<'_>) -> Result<Penalties> {
    if u.arbitrary()? {
        return Ok(Penalties::DEFAULT);
    }
    Ok(Penalties {
        gradient: u.int_in_range(0..=Penalties::MOST_GRADIENT + 1)?,
        cost: u.int_in_range(0..=127)?,
        step: [u.int_in_range(0..=127)?, u.int_in_range(0..=127)?],
        jump: [u.int_in_range(0..=127)?, u.int_in_range(0..=127)?, u.int_in_range(0..=127)?],
        edges: u.arbitrary()?,
    })
}

/// A search in pictures of up to `width` by `height` pixels; whether it can be started is not known yet.
pub fn config(u: &mut Unstructured<'_>, [width, height]: [u16; 2], disparities: u16) -> Result<Config> {
    let (width, height) = (u.int_in_range(1..=width)?, u.int_in_range(1..=height)?);
    let disparities = u.int_in_range(Config::FEWEST_DISPARITIES..=disparities)?;
    Ok(Config {
        min_disparity: if u.arbitrary()? { 0 } else { u.int_in_range(0..=width + 1)? },
        checks: checks(u)?,
        penalties: penalties(u)?,
        confidence: u.arbitrary()?,
        min_confidence: if u.arbitrary()? { 0 } else { u.int_in_range(0..=Config::MOST_CONFIDENCE + 1)? },
        noise: *u.choose(&Noise::ALL)?,
        ..Config::for_method::<Block>(width, height, disparities)
    })
}

/// A picture: bytes as they are, over and over where they are too few.
pub fn picture(u: &mut Unstructured<'_>, width: u32, height: u32) -> Result<GrayImage> {
    let length = u.int_in_range(1..=64)?;
    let bytes = u.bytes(length.min(u.len()).max(1))?;
    let all = bytes.iter().copied().cycle().take((width * height) as usize).collect();
    GrayImage::from_raw(width, height, all).ok_or(arbitrary::Error::IncorrectFormat)
}

/// Two pictures of a pair: of a pattern, or of bytes.
pub fn pair(u: &mut Unstructured<'_>, width: u32, height: u32) -> Result<(GrayImage, GrayImage)> {
    let seed = u.arbitrary()?;
    let pattern = match u.int_in_range(0..=11)? {
        0 => Pattern::Constant(u.arbitrary()?),
        1 => Pattern::Noise,
        2 => Pattern::Saturated,
        3 => Pattern::FewLevels(u.int_in_range(1..=255)?),
        4 => Pattern::Columns(u.int_in_range(1..=40)?),
        5 => Pattern::Rows(u.int_in_range(1..=40)?),
        6 => Pattern::Checkerboard(u.int_in_range(1..=40)?),
        7 => Pattern::Ramp(u.int_in_range(0..=255)?),
        8 => return Ok((picture(u, width, height)?, picture(u, width, height)?)),
        9 => return stripes(u, width, height, seed),
        _ => Pattern::Shifted { most: u.int_in_range(0..=60)?, noise_grey: u.int_in_range(0..=12)?.into() },
    };
    Ok(pattern.pair(width, height, seed))
}

/// Upright stripes by chance, with a step of depth: the largest jumps beside the smallest costs.
fn stripes(u: &mut Unstructured<'_>, width: u32, height: u32, seed: u64) -> Result<(GrayImage, GrayImage)> {
    let (near, far, at) = (u.int_in_range(0..=40)?, u.int_in_range(0..=10)?, u.int_in_range(0..=width)?);
    let mut random = Random::new(seed);
    let line: Vec<u8> = (0..width + 64).map(|_| random.byte()).collect();
    let left = GrayImage::from_fn(width, height, |x, _| image::Luma([line[x as usize]]));
    let right = GrayImage::from_fn(width, height, |x, _| {
        let shift = if x < at { far } else { near };
        image::Luma([line[(x + shift) as usize]])
    });
    Ok((left, right))
}

/// A number of any size, many of them sane.
pub fn number(u: &mut Unstructured<'_>) -> Result<f64> {
    Ok(match u.int_in_range(0..=5)? {
        0 => f64::from_bits(u.arbitrary()?),
        1 => f32::from_bits(u.arbitrary()?).into(),
        2 => f64::from(u.arbitrary::<i16>()?),
        3 => f64::from(u.arbitrary::<i16>()?) / 32768.0,
        4 => *u.choose(&[0.0, -0.0, 1.0, -1.0, f64::INFINITY, f64::NAN, 1e300, 1e-300, 1e38, 1e-38])?,
        _ => 2.0_f64.powi(u.int_in_range(-1074..=1023)?) * if u.arbitrary()? { 1.0 } else { -1.0 },
    })
}
