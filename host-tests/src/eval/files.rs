//! The files that are compared.

use super::EvalError;
use crate::limits;
use crate::pfm::{self, FloatMap};
use image::DynamicImage;
use std::path::Path;
use stereopsis::geometry::camera::RectifiedRig;

/// How a file holds disparities: as PFM in its own unit, or as a PNG of 8 or 16 bits in steps, where 0 says
/// that there is none.
#[derive(Clone, Copy, Debug)]
pub struct DisparityFile {
    /// Steps of a PNG in a pixel, or in a metre.
    pub scale: f64,
    /// The rig, where the file holds depths in metres: `d = f b / Z - doffs`.
    pub depths_of: Option<RectifiedRig>,
}

impl DisparityFile {
    /// A file of disparities as KITTI has them, and `match`: a step is 1/256 px.
    pub const KITTI: Self = Self { scale: 256.0, depths_of: None };

    /// Disparities in px, infinite where there is none.
    pub fn read(&self, path: &Path) -> Result<FloatMap, EvalError> {
        let failed = |what: String| EvalError::new(path, what);
        let bytes = bytes(path)?;
        let mut map =
            if bytes.starts_with(b"P") && bytes.get(1).is_some_and(|b| b.eq_ignore_ascii_case(&b'f')) {
                pfm::read(&mut bytes.as_slice()).map_err(|e| failed(e.to_string()))?
            } else {
                self.steps(&bytes).map_err(failed)?
            };
        for value in &mut map.values {
            let is_none = !value.is_finite() || *value < 0.0;
            *value = match &self.depths_of {
                _ if is_none => f32::INFINITY,
                Some(_) if *value == 0.0 => f32::INFINITY,
                Some(rig) => rig.focal_px() * rig.baseline_m() / *value - rig.disparity_offset_px(),
                None => *value,
            };
        }
        Ok(map)
    }

    /// The same of a file that has to have the size of a truth.
    pub fn read_beside(&self, path: &Path, truth: &FloatMap) -> Result<FloatMap, EvalError> {
        let map = self.read(path)?;
        same_size(path, (map.width, map.height), (truth.width, truth.height))?;
        Ok(map)
    }

    /// A picture's samples.
    fn steps(&self, bytes: &[u8]) -> Result<FloatMap, String> {
        let image = limits::picture(bytes);
        let image = image.map_err(|e| format!("is neither PFM nor a picture of disparities ({e})"))?;
        let samples: Vec<u16> = match &image {
            DynamicImage::ImageLuma16(samples) => samples.to_vec(),
            DynamicImage::ImageLuma8(_) if self.depths_of.is_none() && self.scale >= Self::KITTI.scale => {
                let too_few = format!("has 8 bits, so that no step of 1/{} px is over a pixel", self.scale);
                return Err(too_few + "; say how many steps are a pixel: --found-scale, --truth-scale");
            }
            DynamicImage::ImageLuma8(samples) => samples.iter().copied().map(u16::from).collect(),
            _ => return Err("is a picture in colours; disparities are grey, of 8 or 16 bits".to_owned()),
        };
        let steps = |sample: u16| match sample {
            0 => f32::INFINITY,
            _ => (f64::from(sample) / self.scale) as f32,
        };
        Ok(FloatMap {
            width: image.width() as usize,
            height: image.height() as usize,
            values: samples.into_iter().map(steps).collect(),
        })
    }
}

/// What is known of a scene, px.
#[derive(Clone, Debug)]
pub struct Truth {
    /// The disparities of the pixels that are scored, 0 of the others.
    pub scored: FloatMap,
    /// Those of the pixels that only the left camera sees, 0 of the others, where a mask tells them apart.
    pub occluded: Option<Vec<f32>>,
}

impl Truth {
    /// Reads a truth. Pixels are left out of which nothing is known, and the first columns; where a mask is
    /// not 255 they are occluded.
    pub fn read(
        path: &Path,
        file: &DisparityFile,
        mask_file: Option<&Path>,
        first_column: u16,
    ) -> Result<Self, EvalError> {
        let mut scored = file.read(path)?;
        let width = scored.width.max(1);
        for (at, value) in scored.values.iter_mut().enumerate() {
            if !value.is_finite() || at % width < usize::from(first_column) {
                *value = 0.0;
            }
        }
        let mut occluded = None;
        if let Some(path) = mask_file {
            let mut behind = vec![0.0; scored.values.len()];
            let seen = mask(path, &scored)?;
            for ((value, behind), _) in
                scored.values.iter_mut().zip(&mut behind).zip(seen).filter(|(_, seen)| *seen != u8::MAX)
            {
                *behind = std::mem::take(value);
            }
            occluded = Some(behind);
        }
        // Disparities of 0 and less are not scored.
        if !scored.values.iter().any(|value| *value > 0.0) {
            return Err(EvalError::new(path, "no pixel of it is known and seen by both cameras"));
        }
        Ok(Self { scored, occluded })
    }
}

/// A file's bytes, of which there may be as many as of the largest image.
fn bytes(path: &Path) -> Result<Vec<u8>, EvalError> {
    let cannot = |e| EvalError::new(path, format!("cannot be read ({e})"));
    limits::read(path, limits::IMAGE_BYTES).map_err(cannot)
}

/// The bytes of a mask beside a map: 255 where a pixel is scored.
pub fn mask(path: &Path, beside: &FloatMap) -> Result<Vec<u8>, EvalError> {
    let image = limits::picture(&bytes(path)?);
    let image = image.map_err(|e| EvalError::new(path, format!("is no picture ({e})")))?;
    let (given, wanted) = ((image.width() as usize, image.height() as usize), (beside.width, beside.height));
    same_size(path, given, wanted)?;
    Ok(image.into_luma8().into_raw())
}

/// The bytes of a confidence beside a map, more is surer.
pub fn confidence(path: &Path, beside: &FloatMap) -> Result<Vec<u8>, EvalError> {
    mask(path, beside)
}

/// Refuses a file of another size.
fn same_size(path: &Path, given: (usize, usize), wanted: (usize, usize)) -> Result<(), EvalError> {
    let ((w, h), (columns, rows)) = (given, wanted);
    if given == wanted {
        return Ok(());
    }
    Err(EvalError::new(
        path,
        format!("is {w} x {h} px; {columns} x {rows} px are needed, the size of the truth"),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{ImageBuffer, Luma};
    use std::fs;
    use std::io::Cursor;

    fn read(file: DisparityFile, name: &str, bytes: &[u8]) -> Result<FloatMap, EvalError> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join(name);
        fs::write(&path, bytes).expect("a file");
        file.read(&path)
    }

    fn png16(samples: Vec<u16>) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let image = ImageBuffer::<Luma<u16>, _>::from_raw(samples.len() as u32, 1, samples).expect("a row");
        image.write_to(&mut bytes, image::ImageFormat::Png).expect("memory");
        bytes.into_inner()
    }

    #[test]
    fn steps_and_floats_are_pixels() {
        let map = read(DisparityFile::KITTI, "d.png", &png16(vec![0, 256, 640])).expect("a map");
        assert_eq!(map.values, [f32::INFINITY, 1.0, 2.5]);
        let mut pfm = Vec::new();
        pfm::write(&mut pfm, 4, &[0.0, f32::NAN, 7.5, -1.0]).expect("memory");
        let map = read(DisparityFile::KITTI, "d.pfm", &pfm).expect("a map");
        assert_eq!(map.values, [0.0, f32::INFINITY, 7.5, f32::INFINITY]);
    }

    #[test]
    fn depths_become_disparities() {
        // 100 px x 0.2 m, doffs 1 px: 2 m is 9 px.
        let rig = RectifiedRig::with_offset(100.0, 0.2, 10.0, 5.0, 11.0).expect("a rig");
        let file = DisparityFile { scale: 1000.0, depths_of: Some(rig) };
        assert_eq!(read(file, "z.png", &png16(vec![0, 2000])).expect("a map").values, [f32::INFINITY, 9.0]);
    }

    #[test]
    fn a_byte_has_too_few_steps_of_a_256th() {
        let mut png = Cursor::new(Vec::new());
        let image = ImageBuffer::<Luma<u8>, _>::from_raw(2, 1, vec![0, 40]).expect("a row");
        image.write_to(&mut png, image::ImageFormat::Png).expect("memory");
        let png = png.into_inner();
        let said = read(DisparityFile::KITTI, "d.png", &png).expect_err("no map").to_string();
        assert!(said.contains("d.png: has 8 bits") && said.contains("--truth-scale"), "{said}");
        let map = read(DisparityFile { scale: 4.0, depths_of: None }, "d.png", &png).expect("a map");
        assert_eq!(map.values, [f32::INFINITY, 10.0]);
    }

    #[test]
    fn a_truth_without_a_disparity_over_0_is_refused() {
        // 100 px x 0.2 m, doffs 1 px: 40 m is -0.5 px.
        let rig = RectifiedRig::with_offset(100.0, 0.2, 10.0, 5.0, 11.0).expect("a rig");
        let file = DisparityFile { scale: 1000.0, depths_of: Some(rig) };
        let folder = tempfile::tempdir().expect("a temporary folder");
        let truth = |samples: Vec<u16>| {
            let path = folder.path().join("z.png");
            fs::write(&path, png16(samples)).expect("a file");
            Truth::read(&path, &file, None, 0)
        };
        let said = truth(vec![0, 40_000]).expect_err("nothing to score").to_string();
        assert!(said.ends_with("no pixel of it is known and seen by both cameras"), "{said}");
        assert_eq!(truth(vec![2000, 40_000]).expect("a truth").scored.values, [9.0, -0.5]);
    }

    #[test]
    fn what_is_no_map_is_named() {
        let said = |name: &str, bytes: &[u8]| {
            read(DisparityFile::KITTI, name, bytes).expect_err("no map").to_string()
        };
        assert!(said("text.png", b"text").contains("text.png: is neither PFM nor a picture"));
        assert!(said("cut.pfm", b"Pf\n9 9\n-1\n").contains("cut.pfm: "));
        assert!(said("colour.pfm", b"PF\n1 1\n-1\n            ").contains("starts with the lines 'Pf'"));
    }
}
