//! Rectified cameras in numbers on the command line.

use crate::shared::length;
use clap::Args;
use stereopsis::geometry::camera::ImageSize;

/// Rectified cameras in numbers, where there is no file.
#[derive(Clone, Debug, Args)]
pub struct TypedRig {
    #[command(flatten)]
    lens: TypedLens,
    /// Distance of the two cameras, mm
    #[arg(long, value_name = "MM", requires = "typed_lens", value_parser = length, allow_negative_numbers =
        true)]
    baseline_mm: Option<f32>,
}

/// How wide rectified cameras see, where there is no file: their centre is taken to be that of the images.
#[derive(Clone, Debug, Args)]
#[group(id = "typed_lens", multiple = false, conflicts_with = "calib", requires = "baseline_mm")]
struct TypedLens {
    /// Focal length of the rectified cameras, px, where there is no file: their centre is taken to be that of
    /// the images
    #[arg(long, value_name = "PX", value_parser = length, allow_negative_numbers = true)]
    focal_px: Option<f32>,
    /// Their horizontal field of view in place of it, degrees, 1 to 170
    #[arg(long, alias = "fov", value_name = "DEGREES", value_parser = angle, allow_negative_numbers = true)]
    field_of_view: Option<f64>,
}

impl TypedRig {
    /// Whether there are numbers.
    pub fn is_given(&self) -> bool {
        self.baseline_mm.is_some()
    }

    /// The focal length, px, and the baseline, mm, of images of a size.
    pub fn numbers(&self, size: ImageSize) -> Option<(f32, f32)> {
        let seen = self.lens.field_of_view.map(|degrees| focal_px(degrees, size.width) as f32);
        self.lens.focal_px.or(seen).zip(self.baseline_mm)
    }
}

/// The focal length of cameras that see so many degrees along their rows, px.
pub fn focal_px(degrees: f64, width: u16) -> f64 {
    f64::from(width) / 2.0 / (degrees.to_radians() / 2.0).tan()
}

/// Parses a field of view, degrees.
pub fn angle(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (1.0..=170.0).contains(value));
    value.ok_or("a number from 1 to 170 is needed")
}
