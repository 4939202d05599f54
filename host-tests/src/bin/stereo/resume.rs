//! What obstacles need of a pair that is matched already: its map from its files, so that what is carried
//! from frame to frame is what it would be had all been matched in one run.

use crate::failure::Failure;
use crate::match_args::MatchArgs;
use crate::rectified;
use crate::scale::scale;
use crate::solve::RECTIFIED;
use crate::sources::Input;
use crate::watch::{self, OBSTACLES, Watch};
use image::RgbImage;
use serde_json::Value;
use std::fmt::Display;
use std::fs;
use std::path::Path;
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::ImageSize;
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::map::DisparityMap;
use stereopsis_host::output::Staging;
use stereopsis_host::pfm;

/// Looks at a finished pair again, and writes what is found unless it is there already.
pub fn look_again(args: &MatchArgs, input: &Input, label: &str, watch: &mut Watch) -> Result<(), Failure> {
    let pair = input.open()?;
    let (left, right, scale) = if args.rectify {
        let size = ImageSize { width: pair.width, height: pair.height };
        let (calibration, rectification) = rectified::open(&args.calib, &args.options, size)?;
        let named = |e: &dyn Display| Failure::new(format!("{}: {e}", calibration.path.display()));
        let rig = rectification.rig().map_err(|e| named(&e))?;
        let scale = DepthScale::new(&rig).map_err(|e| named(&e))?;
        let [left, right] = [0, 1].map(|side| picture(&args.out.join(RECTIFIED[side])));
        (left?, right?, Some(scale))
    } else {
        let scale = scale(args, &pair)?;
        (pair.left, pair.right, scale)
    };
    let Some(scale) = scale else { return Ok(()) };
    let map = map(&args.out)?;
    let found = watch.look(label, &scale, (&map, map.height), largest(&args.out)?, &left, Some(&right))?;
    if watch::is_written(&args.out, &found) {
        return Ok(());
    }
    let mut staging = Staging::new(&args.out)?;
    watch::write(&mut staging, OBSTACLES, &found)?;
    Ok(staging.commit(&[])?)
}

/// Takes away what an earlier run found in a finished pair.
pub fn forget(folder: &Path) -> Result<(), Failure> {
    if OBSTACLES.iter().any(|name| folder.join(name).exists()) {
        Staging::new(folder)?.commit(&OBSTACLES)?;
    }
    Ok(())
}

fn failed(path: &Path, e: &dyn Display) -> Failure {
    Failure::new(format!("{}: {e}; remove the folder, and the pair is matched again", path.display()))
}

fn picture(path: &Path) -> Result<RgbImage, Failure> {
    Ok(image::open(path).map_err(|e| failed(path, &e))?.into_rgb8())
}

/// The map that a folder's files hold, to the bit, without deviations.
fn map(folder: &Path) -> Result<DisparityMap, Failure> {
    let disparity = folder.join("disparity.pfm");
    let bytes = fs::read(&disparity).map_err(|e| failed(&disparity, &e))?;
    let pixels = pfm::read(&mut bytes.as_slice()).map_err(|e| failed(&disparity, &e))?;
    let bytes = |name: &str| {
        let path = folder.join(name);
        let bytes = image::open(&path).map_err(|e| failed(&path, &e))?.into_luma8().into_raw();
        if bytes.len() != pixels.values.len() {
            return Err(failed(&path, &"is not of the size of disparity.pfm"));
        }
        Ok(bytes)
    };
    let steps = |&px: &f32| {
        // Disparities are whole steps.
        if px.is_finite() {
            Disparity::from_raw((px * f32::from(Disparity::ONE)).round() as u16)
        } else {
            Disparity::NONE
        }
    };
    let mut map = DisparityMap::new(pixels.width, pixels.height);
    map.disparity = pixels.values.iter().map(steps).collect();
    map.flags = bytes("flags.png")?.into_iter().map(PixelFlags::from_bits).collect();
    map.confidence = bytes("confidence.png")?;
    Ok(map)
}

/// The largest disparity of the search that a folder's summary tells.
fn largest(folder: &Path) -> Result<Disparity, Failure> {
    let path = folder.join("summary.json");
    let bytes = fs::read(&path).map_err(|e| failed(&path, &e))?;
    let summary: Value = serde_json::from_slice(&bytes).map_err(|e| failed(&path, &e))?;
    let number = |name: &str| summary[name].as_u64().and_then(|n| u16::try_from(n).ok());
    let ends = number("min_disparity").zip(number("disparities"));
    let (first, count) = ends.ok_or_else(|| failed(&path, &"says no search"))?;
    Ok(watch::end_of(first, count))
}
