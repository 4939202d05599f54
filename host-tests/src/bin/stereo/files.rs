//! The files that `match` and `demo` write. Names and formats are a contract with programs that read them.

use crate::failure::Failure;
use image::codecs::png::PngEncoder;
use image::{EncodableLayout, ImageBuffer, ImageError, Luma, Pixel, PixelWithColorType, RgbImage};
use serde::Serialize;
use std::ffi::OsStr;
use std::io::{self, Write};
use std::ops::Deref;
use std::path::Path;
use stereopsis::depth::DepthScale;
use stereopsis::units::Disparity;
use stereopsis_host::colour::{ColourScale, confidence_raw, flags_raw};
use stereopsis_host::map::DisparityMap;
use stereopsis_host::output::{OutputError, Staging};
use stereopsis_host::pfm;
use stereopsis_host::ply::{self, ColouredPoint};
use stereopsis_host::report::Report;

/// What is written only with a calibration. A run without one takes the files of an earlier run with it away.
pub const WITH_DEPTH: [&str; 3] = ["depth.pfm", "depth.png", "cloud.ply"];

/// Writes one file, whole or not at all: `value` as JSON.
pub fn json_file(path: &Path, value: &impl Serialize) -> Result<(), Failure> {
    let no_file =
        || Failure::new(format!("--out {}: is not a file; name a file for the result", path.display()));
    let name = path.file_name().and_then(OsStr::to_str).filter(|_| !path.is_dir()).ok_or_else(no_file)?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut staging = Staging::new(folder)?;
    staging.write(name, |out| json(out, value))?;
    Ok(staging.commit(&[])?)
}

/// Writes all files of a run but those of the truth.
pub fn write(
    staging: &mut Staging,
    report: &Report<'_>,
    scale: Option<&DepthScale>,
) -> Result<(), OutputError> {
    let map = report.map;
    let pixels = map.pixels();
    staging.write("disparity.pfm", |out| pfm::write(out, map.width, &pixels))?;
    staging.write("disparity.png", |out| {
        png(out, &grey16(map, map.disparity.iter().map(|&d| disparity_sample(d))))
    })?;
    let colour = ColourScale::of(map).picture(map.width, &pixels);
    staging.write("disparity_colour.png", |out| png(out, &colour))?;
    staging.write("flags.png", |out| png(out, &flags_raw(map)))?;
    staging.write("confidence.png", |out| png(out, &confidence_raw(map)))?;
    staging.write("summary.json", |out| json(out, report.summary))?;
    if let Some(scale) = scale {
        let [depth_pfm, depth_png, cloud] = WITH_DEPTH;
        staging.write(depth_pfm, |out| pfm::write(out, map.width, &map.depth_m(scale)))?;
        let millimetres = map.disparity.iter().map(|&d| scale.millimetres(d).0);
        staging.write(depth_png, |out| png(out, &grey16(map, millimetres)))?;
        staging.write(cloud, |out| ply::write(out, &points(map, scale, report.left)))?;
    }
    staging.write("report.html", |out| report.write(out))
}

/// A picture as PNG.
pub fn png<P, C>(out: &mut dyn Write, picture: &ImageBuffer<P, C>) -> io::Result<()>
where
    P: Pixel + PixelWithColorType,
    [P::Subpixel]: EncodableLayout,
    C: Deref<Target = [P::Subpixel]>,
{
    picture.write_with_encoder(PngEncoder::new(out)).map_err(|error| match error {
        ImageError::IoError(e) => e,
        e => io::Error::other(e),
    })
}

/// A value as JSON.
pub fn json(out: &mut dyn Write, value: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, value)?;
    out.write_all(b"\n")
}

/// Disparity x 256 in 16 bits, where 0 says that there is none: an answer of 0 px becomes 1, and one of 256
/// px and more the largest sample.
fn disparity_sample(disparity: Disparity) -> u16 {
    const STEP: u32 = 256 / Disparity::ONE as u32;
    let sample = u32::from(disparity.raw()) * STEP;
    if disparity.is_some() { u16::try_from(sample.max(1)).unwrap_or(u16::MAX) } else { 0 }
}

fn grey16(map: &DisparityMap, samples: impl Iterator<Item = u16>) -> ImageBuffer<Luma<u16>, Vec<u16>> {
    ImageBuffer::from_raw(map.width as u32, map.height as u32, samples.collect()).unwrap_or_default()
}

/// The answered pixels in space, with the left image's colours.
fn points(map: &DisparityMap, scale: &DepthScale, left: &RgbImage) -> Vec<ColouredPoint> {
    let colours = left.enumerate_pixels();
    let all = map.disparity.iter().zip(colours).filter_map(|(&d, (u, v, colour))| {
        // Images have at most 4096 columns and rows.
        let point = scale.point(u as u16, v as u16, d)?;
        Some(ColouredPoint { position_m: [point.x, point.y, point.z], colour: colour.0 })
    });
    all.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_of_nothing_is_not_no_answer() {
        let samples =
            [Disparity::NONE, Disparity::from_raw(0), Disparity::from_raw(33), Disparity::from_pixels(255)];
        assert_eq!(samples.map(disparity_sample), [0, 1, 264, 65280]);
        assert_eq!(disparity_sample(Disparity::from_pixels(256)), u16::MAX);
        assert_eq!(disparity_sample(Disparity::MAX), u16::MAX);
    }
}
