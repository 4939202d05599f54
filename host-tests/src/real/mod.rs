//! Real rectified pairs with a known truth, and how right answers are on them.
//!
//! A scene is a folder with `left.png`, `right.png`, `gt.png` (16 bit, disparity x 256, 0 = unknown),
//! `nonocc.png` (255 = both cameras see it) and `meta.json` (`disparities`, the search range). Scored are
//! pixels with a known truth that both cameras see, from column `disparities` on: left of it the range does
//! not fit the right image.
//!
//! * [`RealScene`]: one of them. [`Score`]: shares of right and wrong answers.
//! * [`Alteration`]: the same pair, taken by worse cameras.

mod altered;
mod score;

pub use altered::Alteration;
pub use score::{Score, mean};

use crate::limits;
use crate::mock::{MockCamera, MockError};
use crate::run::MOST_WIDTH;
use image::GrayImage;
use std::path::{Path, PathBuf};
use std::{fs, io};
use stereopsis::camera::{CameraError, CameraPair, StereoSource};
use stereopsis::imaging::GreyLines;

/// Bytes of a line in the widest format of a file.
const RAW_BYTES: usize = MOST_WIDTH * 6;

/// A pair with its truth.
#[derive(Clone, Debug)]
pub struct RealScene {
    /// The folder's name.
    pub name: String,
    /// How many whole disparities from 0 hold the scene.
    pub disparities: u16,
    /// The left image in grey, as the program `stereo` sees it.
    pub left: GrayImage,
    /// The right image likewise.
    pub right: GrayImage,
    /// Disparity in px for each pixel of the left image, row by row; 0 where the pixel is not scored.
    pub truth: Vec<f32>,
}

/// Why a folder holds no scenes: one line that names the file and what would be right.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RealError {
    /// A folder or a file cannot be read.
    #[error("{}: cannot be read ({source})", path.display())]
    Read {
        /// The folder or file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// No folder in it has a `meta.json`.
    #[error("{}: holds no scene; a scene is a folder with meta.json, left.png, right.png, gt.png and \
        nonocc.png", path.display())]
    NoScene {
        /// The folder.
        path: PathBuf,
    },
    /// `meta.json` has no range.
    #[error("{}: states no disparities from 16 to 256", path.display())]
    Disparities {
        /// The file.
        path: PathBuf,
    },
    /// One of the images of the pair is none.
    #[error("{0}")]
    Image(#[from] MockError),
    /// The pair gives no lines.
    #[error("{}: {what}", path.display())]
    Pair {
        /// The folder.
        path: PathBuf,
        /// What the camera says.
        what: String,
    },
    /// The truth is no image.
    #[error("{}: is no image ({source})", path.display())]
    Truth {
        /// The file.
        path: PathBuf,
        /// What the decoder says.
        source: image::ImageError,
    },
    /// The truth is of another size than the pair.
    #[error("{}: is {given:?} pixels large, left.png {wanted:?}", path.display())]
    Size {
        /// The file.
        path: PathBuf,
        /// Columns and rows.
        given: (u32, u32),
        /// Those of the pair.
        wanted: (u32, u32),
    },
}

impl RealScene {
    /// The scenes whose folders are in `data`, in order of their names.
    pub fn all(data: &Path) -> Result<Vec<Self>, RealError> {
        let failed = |source| RealError::Read { path: data.into(), source };
        let mut folders = Vec::new();
        for entry in fs::read_dir(data).map_err(failed)? {
            let folder = entry.map_err(failed)?.path();
            if folder.join("meta.json").is_file() {
                folders.push(folder);
            }
        }
        folders.sort();
        if folders.is_empty() {
            return Err(RealError::NoScene { path: data.into() });
        }
        folders.iter().map(|folder| Self::read(folder)).collect()
    }

    /// The scene in a folder.
    pub fn read(folder: &Path) -> Result<Self, RealError> {
        let disparities = disparities(&folder.join("meta.json"))?;
        let (left, right) = grey_pair(folder)?;
        let truth_file = |name: &str| {
            let path = folder.join(name);
            let image =
                image::open(&path).map_err(|source| RealError::Truth { path: path.clone(), source })?;
            let (given, wanted) = ((image.width(), image.height()), left.dimensions());
            if given == wanted { Ok(image) } else { Err(RealError::Size { path, given, wanted }) }
        };
        let (truth, seen) = (truth_file("gt.png")?.into_luma16(), truth_file("nonocc.png")?.into_luma8());
        let truth = truth.enumerate_pixels().zip(seen.pixels()).map(|((x, _, truth), seen)| {
            let scored = seen.0[0] > 0 && x >= u32::from(disparities);
            if scored { f32::from(truth.0[0]) / 256.0 } else { 0.0 }
        });
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Self { name, disparities, truth: truth.collect(), left, right })
    }
}

/// What `meta.json` says of the range.
pub(crate) fn disparities(path: &Path) -> Result<u16, RealError> {
    let text = limits::read(path, limits::CALIBRATION_BYTES);
    let text = text.map_err(|source| RealError::Read { path: path.into(), source })?;
    let meta: Option<serde_json::Value> = serde_json::from_slice(&text).ok();
    let stated = meta.and_then(|meta| meta.get("disparities")?.as_u64());
    let range = stated.and_then(|n| u16::try_from(n).ok()).filter(|n| (16..=256).contains(n));
    range.ok_or_else(|| RealError::Disparities { path: path.into() })
}

/// The pair through the same chain as in the program `stereo`.
fn grey_pair(folder: &Path) -> Result<(GrayImage, GrayImage), RealError> {
    let failed = |what: String| RealError::Pair { path: folder.into(), what };
    let (left, right) = MockCamera::open_pair(folder.join("left.png"), folder.join("right.png"))?;
    let left = GreyLines::<_, RAW_BYTES>::new(left).map_err(|e| failed(e.to_string()))?;
    let right = GreyLines::<_, RAW_BYTES>::new(right).map_err(|e| failed(e.to_string()))?;
    let mut camera = CameraPair::new(left, right, 0).map_err(|e| failed(e.to_string()))?;
    let [left, right] = frame(&mut camera).map_err(|e| failed(e.to_string()))?;
    Ok((left, right))
}

/// The next frame of a source of grey lines, whole: what a matcher is given.
pub fn frame<C: StereoSource>(camera: &mut C) -> Result<[GrayImage; 2], CameraError<C::Error>> {
    let format = camera.format();
    let (width, height) = (u32::from(format.width), u32::from(format.height));
    let (mut left, mut right) = (GrayImage::new(width, height), GrayImage::new(width, height));
    camera.start_frame()?;
    let line = usize::from(format.width).max(1);
    for (left, right) in left.chunks_mut(line).zip(right.chunks_mut(line)) {
        camera.next_lines(left, right)?;
    }
    Ok([left, right])
}
