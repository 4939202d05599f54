//! Obstacles in the frames that are played.

use super::ReplayArgs;
use crate::failure::Failure;
use crate::scale::{of_files, of_numbers, off_middle_of};
use crate::shared::remark;
use crate::watch::{self, Watch};
use image::{DynamicImage, GrayImage, RgbImage};
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::ImageSize;
use stereopsis::matching::Config;
use stereopsis_host::recording::Header;
use stereopsis_host::run::GuardedFrame;

/// A watch and its scale, where obstacles are asked for.
pub fn watch(args: &ReplayArgs, header: Header) -> Result<Option<(Watch, DepthScale)>, Failure> {
    let Some(watch) = args.watch.watch() else {
        return if args.typed.is_given() {
            Err(Failure::new("--baseline-mm: is for --obstacles, which is missing"))
        } else {
            Ok(None)
        };
    };
    let size = ImageSize { width: header.width, height: header.height };
    let scale = match (args.typed.numbers(size), args.calib.len()) {
        (Some(rig), _) => of_numbers(rig, size)?,
        (None, 0) => {
            return Err(Failure::usage(
                "--obstacles: distances need a calibration; give --calib, or --focal-px and --baseline-mm",
            ));
        }
        (None, 1 | 2) => {
            let scale = of_files(&args.calib, args.unit, &args.from, size)?;
            if let Some(off) = off_middle_of(&args.calib, &scale, size) {
                remark(&format!("warning: {off}"));
            }
            scale
        }
        _ => {
            return Err(Failure::usage(
                "--calib: is given more than twice; a file of both cameras or one of each is needed",
            ));
        }
    };
    Ok(Some((watch, scale)))
}

/// What a watch sees in a frame that was played; a black image where it did not begin.
pub fn look(
    watch: &mut Watch,
    scale: &DepthScale,
    config: &Config,
    (number, frame): (usize, &GuardedFrame),
    pictures: Option<[GrayImage; 2]>,
) -> Result<watch::Seen, Failure> {
    let (label, size) = (format!("{number:06}"), [config.width, config.height].map(u32::from));
    let came = (&frame.map, usize::from(frame.rows));
    let pictures = pictures.map(|both| both.map(|picture| DynamicImage::ImageLuma8(picture).into_rgb8()));
    match &pictures {
        Some([left, right]) => watch.look(&label, scale, came, watch::largest(config), left, Some(right)),
        None => {
            let black = RgbImage::new(size[0], size[1]);
            watch.look(&label, scale, came, watch::largest(config), &black, None)
        }
    }
}
