//! The images of `structure`: of one camera, and of one size.

use crate::failure::Failure;
use crate::image_files::files;
use image::{GrayImage, RgbImage};
use stereopsis::geometry::camera::ImageSize;
use stereopsis_host::focus::stack::read;
use stereopsis_host::mock::significant_bits;

/// Images at most: all pairs of them are tried as a beginning.
const MOST: usize = 60;

/// Images of one size.
pub struct Images {
    pub names: Vec<String>,
    pub grey: Vec<GrayImage>,
    pub colours: Vec<RgbImage>,
}

impl Images {
    /// Reads what is given.
    pub fn read(patterns: &[String]) -> Result<Self, Failure> {
        let paths = files("--images", patterns)?;
        if !(2..=MOST).contains(&paths.len()) {
            let (given, count) = (given(patterns), paths.len());
            return Err(Failure::new(format!("--images {given}: {count} images; 2 to {MOST} are needed")));
        }
        let mut images = Self { names: Vec::new(), grey: Vec::new(), colours: Vec::new() };
        let bits = significant_bits(&paths);
        for path in &paths {
            let frame = read(path, bits)?;
            let size = frame.grey.dimensions();
            if let Some(first) = images.grey.first().map(GrayImage::dimensions).filter(|&first| first != size)
            {
                return Err(Failure::new(format!(
                    "{}: is {} x {} and {} is {} x {}; all images must have one size",
                    path.display(),
                    size.0,
                    size.1,
                    paths[0].display(),
                    first.0,
                    first.1
                )));
            }
            images.names.push(path.file_name().unwrap_or_default().to_string_lossy().into_owned());
            images.grey.push(frame.grey);
            images.colours.push(frame.colours);
        }
        Ok(images)
    }

    /// The size of the images, which have at most 4096 columns and rows.
    pub fn size(&self) -> ImageSize {
        let (width, height) = self.grey.first().map_or((0, 0), GrayImage::dimensions);
        ImageSize { width: width as u16, height: height as u16 }
    }
}

/// What was given, of many names the first.
pub fn given(names: &[String]) -> String {
    match names {
        [first, _, ..] => format!("{first} and {} more", names.len() - 1),
        _ => names.concat(),
    }
}
