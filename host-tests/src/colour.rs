//! Colours that the colour blind can tell apart, for pictures of results.
//!
//! * [`viridis`]: brightness grows along it, so that it reads in grey as well; far is dark violet, near
//!   bright yellow.
//! * [`FLAG_COLOURS`]: Okabe and Ito's palette, one colour for each reason without an answer of the pixel's
//!   own.
//! * [`diverging`]: blue over white to orange, for errors with a sign.

use image::{GrayImage, Rgb, RgbImage};
use stereopsis::matching::Row;
use stereopsis::units::PixelFlags;

use crate::map::{DisparityMap, quantile};

/// Where there is no answer.
pub const NO_ANSWER: Rgb<u8> = Rgb([0, 0, 0]);

/// Viridis at nine equal steps (van der Walt & Smith 2015, CC0).
const VIRIDIS: [[u8; 3]; 9] = [
    [0x44, 0x01, 0x54],
    [0x47, 0x2d, 0x7b],
    [0x3b, 0x52, 0x8b],
    [0x2c, 0x72, 0x8e],
    [0x21, 0x90, 0x8c],
    [0x27, 0xad, 0x81],
    [0x5d, 0xc8, 0x63],
    [0xaa, 0xdc, 0x32],
    [0xfd, 0xe7, 0x25],
];

/// Okabe and Ito's blue, white and vermillion.
const DIVERGING: [[u8; 3]; 3] = [[0x00, 0x72, 0xb2], [0xf7, 0xf7, 0xf7], [0xd5, 0x5e, 0x00]];

/// The colour of each reason, in the order of [`PixelFlags::NAMES`]: Okabe and Ito's sky blue, yellow, bluish
/// green, orange, blue, reddish purple and vermillion; and a grey.
pub const FLAG_COLOURS: [Rgb<u8>; 8] = [
    Rgb([0x56, 0xb4, 0xe9]),
    Rgb([0xf0, 0xe4, 0x42]),
    Rgb([0x00, 0x9e, 0x73]),
    Rgb([0xe6, 0x9f, 0x00]),
    Rgb([0x00, 0x72, 0xb2]),
    Rgb([0xcc, 0x79, 0xa7]),
    Rgb([0xd5, 0x5e, 0x00]),
    Rgb([0x60, 0x60, 0x60]),
];

/// The colour at `t`, 0 (far, dark) to 1 (near, bright).
///
/// ```
/// use stereopsis_host::colour::viridis;
/// assert_eq!(viridis(0.0).0, [0x44, 0x01, 0x54]);
/// assert_eq!(viridis(2.0).0, [0xfd, 0xe7, 0x25]);
/// ```
pub fn viridis(t: f32) -> Rgb<u8> {
    between(&VIRIDIS, t)
}

/// The colour at `t`, -1 (blue) over 0 (white) to 1 (orange).
pub fn diverging(t: f32) -> Rgb<u8> {
    between(&DIVERGING, (t + 1.0) / 2.0)
}

fn between(anchors: &[[u8; 3]], t: f32) -> Rgb<u8> {
    let last = anchors.len() - 1;
    let at = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) } * last as f32;
    let low = (at as usize).min(last - 1);
    let share = at - low as f32;
    let [from, to] = [anchors[low], anchors[low + 1]];
    Rgb([0, 1, 2]
        .map(|c| (f32::from(from[c]) + share * (f32::from(to[c]) - f32::from(from[c]))).round() as u8))
}

/// The disparities between which the colours run.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct ColourScale {
    /// What is darkest, px.
    pub far_px: f32,
    /// What is brightest, px.
    pub near_px: f32,
}

impl ColourScale {
    /// From the 2nd to the 98th of a hundred of the answers, so that a few wrong ones do not take the colours
    /// of all others; at least 1 px wide. The search range is not used: a scene often fills a small part
    /// of it.
    pub fn of(map: &DisparityMap) -> Self {
        let sorted = map.sorted();
        let far_px = quantile(&sorted, 0.02).unwrap_or(0.0);
        let near_px = quantile(&sorted, 0.98).unwrap_or(1.0);
        Self { far_px, near_px: near_px.max(far_px + 1.0) }
    }

    /// The colour of a disparity, px; black for what is not finite.
    pub fn colour(&self, disparity_px: f32) -> Rgb<u8> {
        if disparity_px.is_finite() {
            viridis((disparity_px - self.far_px) / (self.near_px - self.far_px))
        } else {
            NO_ANSWER
        }
    }

    /// A picture of disparities in px, `width` in a row; black for what is not finite.
    pub fn picture(&self, width: usize, disparity_px: &[f32]) -> RgbImage {
        picture(width, disparity_px.iter().map(|&d| self.colour(d)))
    }
}

/// The first reason without an answer, or that the answer was filled in, as an index into
/// [`PixelFlags::NAMES`]; `None` for a pixel with an answer of its own.
pub fn first_reason(map: &DisparityMap, pixel: usize) -> Option<usize> {
    let answered = map.disparity[pixel].is_some();
    let says =
        |flag: PixelFlags| map.flags[pixel].contains(flag) && (!answered || flag == PixelFlags::FILLED);
    PixelFlags::NAMES.iter().position(|(flag, _)| says(*flag))
}

/// Why pixels have no answer, or which were filled in: the first reason's colour over the left image, which
/// stays grey and pale where there are answers.
pub fn flags_picture(map: &DisparityMap, left: &RgbImage) -> RgbImage {
    picture(
        map.width,
        left.pixels().enumerate().map(|(i, Rgb([r, g, b]))| match first_reason(map, i) {
            Some(reason) => FLAG_COLOURS[reason],
            None if map.disparity[i].is_none() => NO_ANSWER,
            None => {
                let grey = (u32::from(*r) * 77 + u32::from(*g) * 150 + u32::from(*b) * 29) >> 8;
                Rgb([(110 + grey / 2) as u8; 3])
            }
        }),
    )
}

/// The flags' bytes as they are, for programs: bit 0 of a sample is the first of [`PixelFlags::NAMES`].
pub fn flags_raw(map: &DisparityMap) -> GrayImage {
    let bytes = map.flags.iter().map(|f| f.bits()).collect();
    GrayImage::from_raw(map.width as u32, map.height as u32, bytes).unwrap_or_default()
}

/// The confidences' bytes as they are, for programs.
pub fn confidence_raw(map: &DisparityMap) -> GrayImage {
    GrayImage::from_raw(map.width as u32, map.height as u32, map.confidence.clone()).unwrap_or_default()
}

/// How sure the answers are: sure is bright; black where there is none.
pub fn confidence_picture(map: &DisparityMap) -> RgbImage {
    let shade =
        |c: u8| if c > 0 { viridis(f32::from(c) / f32::from(Row::MOST_CONFIDENCE)) } else { NO_ANSWER };
    picture(map.width, map.confidence.iter().map(|&c| shade(c)))
}

/// Errors with a sign, from blue (-`limit`) over white to orange (+`limit`); black for what is not finite.
pub fn error_picture(width: usize, error: &[f32], limit: f32) -> RgbImage {
    picture(width, error.iter().map(|&e| if e.is_finite() { diverging(e / limit) } else { NO_ANSWER }))
}

fn picture(width: usize, colours: impl Iterator<Item = Rgb<u8>>) -> RgbImage {
    let samples: Vec<u8> = colours.flat_map(|c| c.0).collect();
    let height = samples.len() / (3 * width.max(1));
    RgbImage::from_raw(width as u32, height as u32, samples).unwrap_or_default()
}
