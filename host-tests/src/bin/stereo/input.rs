//! The images and the search, checked against each other before any work.

use crate::failure::Failure;
use crate::shared::{MethodArgs, PairArgs, RangeArgs};
use image::RgbImage;
use std::fmt::Display;
use std::path::Path;
use stereopsis::camera::{CameraPair, LineSource, StereoSource};
use stereopsis::geometry::camera::ImageSize;
use stereopsis::imaging::{GreyLines, NoiseMeter};
use stereopsis::matching::Config;
use stereopsis_host::mock::MockCamera;

/// Bytes of the longest raw line: RGB with 16 bits.
pub const RAW: usize = MockCamera::MOST_PIXELS as usize * 6;

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
}

impl Pair {
    pub fn open(args: &PairArgs) -> Result<Self, Failure> {
        let (left, right) = MockCamera::open_pair(&args.left, &args.right)?;
        let alpha = |camera: &MockCamera, path: &std::path::Path| {
            camera.had_alpha().then(|| format!("{}: the alpha channel is dropped", path.display()))
        };
        let notes = [alpha(&left, &args.left), alpha(&right, &args.right)].into_iter().flatten().collect();
        let (width, height) = (left.format().width, left.format().height);
        let pictures = (left.picture(), right.picture());
        let camera = CameraPair::new(GreyLines::new(left)?, GreyLines::new(right)?, 0)?;
        Ok(Self { camera, left: pictures.0, right: pictures.1, width, height, notes })
    }
}

/// The search in images of that size, as the method and its filter have it, or which option does not fit
/// them. The noise is still to be told: [`with_noise`].
pub fn config(range: &RangeArgs, options: &MethodArgs, width: u16, height: u16) -> Result<Config, Failure> {
    let RangeArgs { disparities, min_disparity } = *range;
    if width < Config::FEWEST_DISPARITIES {
        let least = Config::FEWEST_DISPARITIES;
        return Err(Failure::new(format!(
            "--left: the images are {width} pixels wide; at least {least} are needed"
        )));
    }
    if disparities > width {
        return Err(Failure::new(format!(
            "--disparities {disparities}: the images are {width} pixels wide; give {} to {width}",
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

/// Files of KITTI do not say for which size they are: a principal point in the outer tenth of the pictures is
/// of another one.
pub fn fits(path: &Path, (cx, cy): (f64, f64), size: ImageSize) -> Result<(), Failure> {
    let (width, height) = (f64::from(size.width), f64::from(size.height));
    let inside = |c: f64, length: f64| (0.1 * length..=0.9 * length).contains(&c);
    if inside(cx, width) && inside(cy, height) {
        return Ok(());
    }
    Err(Failure::new(format!(
        "{}: its principal point ({cx:.1}, {cy:.1}) is not near the middle of the frames, which are {width} \
         x {height} px; give the calibration of frames of this size",
        path.display()
    )))
}
