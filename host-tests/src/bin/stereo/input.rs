//! The images and the search, checked against each other before any work.

use crate::failure::Failure;
use crate::shared::{MethodArgs, RangeArgs};
use image::RgbImage;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use stereopsis::camera::{CameraPair, LineSource, StereoSource};
use stereopsis::geometry::camera::ImageSize;
use stereopsis::imaging::{GreyLines, NoiseMeter};
use stereopsis::matching::Config;
use stereopsis_host::calibration::off_middle;
use stereopsis_host::limits::IMAGE_SIDE;
use stereopsis_host::mock::MockCamera;

/// Bytes of the longest raw line: RGB with 16 bits.
pub const RAW: usize = IMAGE_SIDE as usize * 6;

/// A camera on a file, as 8-bit grey.
type Grey = GreyLines<MockCamera, RAW>;

/// Two files as a stereo source, with their pictures for display.
pub struct Pair {
    pub camera: CameraPair<Grey, Grey>,
    pub left: RgbImage,
    pub right: RgbImage,
    pub width: u16,
    pub height: u16,
    /// What is to be known about the files.
    pub notes: Vec<String>,
    /// The files.
    pub inputs: Vec<PathBuf>,
    /// The names of both images.
    pub names: [String; 2],
}

impl Pair {
    /// Of two files.
    pub fn open(left: &Path, right: &Path) -> Result<Self, Failure> {
        let (a, b) = MockCamera::open_pair(left, right)?;
        Self::new([a, b], [left, right], vec![left.to_owned(), right.to_owned()])
    }

    /// Of two cameras, and the files that each is of.
    pub fn new(cameras: [MockCamera; 2], of: [&Path; 2], inputs: Vec<PathBuf>) -> Result<Self, Failure> {
        let name = |path: &Path| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        let alpha = |(camera, path): (&MockCamera, &&Path)| {
            camera.had_alpha().then(|| format!("{}: the alpha channel is dropped", path.display()))
        };
        let notes: Vec<_> = cameras.iter().zip(&of).filter_map(alpha).collect();
        let (width, height) = (cameras[0].format().width, cameras[0].format().height);
        let [left, right] = cameras.each_ref().map(MockCamera::picture);
        let [a, b] = cameras;
        let camera = CameraPair::new(GreyLines::new(a)?, GreyLines::new(b)?, 0)?;
        Ok(Self { camera, left, right, width, height, notes, inputs, names: of.map(name) })
    }
}

/// The search in images of that size, as the method and its filter have it, or which option does not fit
/// them. The noise is still to be told: [`with_noise`].
pub fn config(range: &RangeArgs, options: &MethodArgs, width: u16, height: u16) -> Result<Config, Failure> {
    let RangeArgs { disparities, min_disparity } = *range;
    if width < Config::FEWEST_DISPARITIES {
        let least = Config::FEWEST_DISPARITIES;
        return Err(Failure::new(format!(
            "--left: the images are {width} px wide; at least {least} are needed"
        )));
    }
    if disparities > width {
        return Err(Failure::new(format!(
            "--disparities {disparities}: the images are {width} px wide; give {} to {width}",
            Config::FEWEST_DISPARITIES
        )));
    }
    let most = width.min(Config::END) - disparities;
    if min_disparity > most {
        return Err(Failure::new(format!(
            "--min-disparity {min_disparity}: with --disparities {disparities} in images {width} pixels \
             wide, at most {most} is possible"
        )));
    }
    let min_confidence = options.min_confidence;
    let search =
        Config { min_disparity, min_confidence, ..options.method.config(width, height, disparities) };
    Ok(options.method.with_filter(options.filter, search))
}

/// The search with the noise that is told or measured in the source's next frame, and what was measured.
pub fn with_noise<C: StereoSource<Error: Display>>(
    options: &MethodArgs,
    config: Config,
    source: &mut C,
) -> Result<(Config, Option<NoiseMeter>), Failure> {
    let (noise, meter) = options.noise.level(source).map_err(|e| Failure::new(e.to_string()))?;
    Ok((options.method.with_filter(options.filter, Config { noise, ..config }), meter))
}

/// Refuses a calibration whose principal point says that it is of images of another size.
pub fn fits(path: &Path, centre: (f64, f64), size: ImageSize) -> Result<(), Failure> {
    let refused = |why| Failure::new(format!("{}: {why}; give the calibration of this size", path.display()));
    off_middle(centre, size).map_or(Ok(()), |why| Err(refused(why)))
}
