//! What is seen of a pair before it is matched: the search, swapped cameras, rows that are off.

use crate::failure::Failure;
use crate::input;
use crate::rectified::{CAMERAS, MASKS};
use crate::shared::{self, MethodArgs, RangeArgs, min_disparity};
use clap::Args;
use image::{GrayImage, imageops};
use std::path::PathBuf;
use stereopsis::geometry::camera::{Camera, ImageSize};
use stereopsis::matching::Config;
use stereopsis_host::mock::MockCamera;
use stereopsis_host::pair::{self, PairCheck, PairFault, PairMatches};
use stereopsis_host::rectify::RectifiedPictures;
use stereopsis_host::rows::Rows;

#[derive(Clone, Debug, Args)]
pub struct SearchArgs {
    /// How many whole disparities are searched: 16 to 256, at most the images' width; or auto, as many as
    /// the images show
    #[arg(long, value_name = "N|auto", value_parser = disparities, allow_negative_numbers = true)]
    pub disparities: Disparities,
    /// The smallest disparity searched, px; 0 where none is given, or what auto finds
    #[arg(long, value_name = "M", value_parser = min_disparity, allow_negative_numbers = true)]
    pub min_disparity: Option<u16>,
    /// Match the images even if the cameras seem to be swapped
    #[arg(long)]
    pub force: bool,
}

impl SearchArgs {
    /// Refuses what cannot be searched in images of that size, before any work.
    pub fn check(&self, method: &MethodArgs, width: u16, height: u16) -> Result<(), Failure> {
        if let Disparities::Count(disparities) = self.disparities {
            let range = RangeArgs { disparities, min_disparity: self.min_disparity.unwrap_or(0) };
            input::config(&range, method, width, height)?;
        }
        Ok(())
    }
}

/// What the images show.
#[derive(Clone, Debug, Args)]
pub struct MaskArgs {
    /// Mask of the left image, 0 where it shows nothing, as rectify writes it; without one, that beside
    /// rectified.json where --calib is that file, else all is valid
    #[arg(long, value_name = "FILE", requires = "valid_right", conflicts_with = "rectify")]
    pub valid_left: Option<PathBuf>,
    /// Mask of the right image
    #[arg(long, value_name = "FILE", requires = "valid_left")]
    pub valid_right: Option<PathBuf>,
}

impl MaskArgs {
    /// The files of the masks: those that are given, or those that `rectify` wrote beside the calibration.
    pub fn files(&self, calib: &[PathBuf]) -> Option<[PathBuf; 2]> {
        if let Some((left, right)) = self.valid_left.as_ref().zip(self.valid_right.as_ref()) {
            return Some([left.clone(), right.clone()]);
        }
        let [calib] = calib else { return None };
        let beside = MASKS.map(|name| calib.with_file_name(name));
        let is_of_rectify = calib.file_name().is_some_and(|name| name == CAMERAS);
        (is_of_rectify && beside.iter().all(|mask| mask.is_file())).then_some(beside)
    }

    /// The masks of both images, which must have their size.
    pub fn read(&self, calib: &[PathBuf], size: (u32, u32)) -> Result<Option<[GrayImage; 2]>, Failure> {
        let Some(files) = self.files(calib) else { return Ok(None) };
        let [left, right] = files.each_ref().map(|path| {
            let mask = imageops::grayscale(&MockCamera::open(path)?.picture());
            if mask.dimensions() == size {
                return Ok(mask);
            }
            let ((w, h), (columns, rows)) = (mask.dimensions(), size);
            let path = path.display();
            Err(Failure::new(format!("{path}: is {w} x {h} px; a mask of {columns} x {rows} px is needed")))
        });
        Ok(Some([left?, right?]))
    }
}

/// How many disparities are searched.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Disparities {
    /// As many as the images show.
    Auto,
    /// That many.
    Count(u16),
}

pub fn disparities(text: &str) -> Result<Disparities, String> {
    if text == "auto" {
        return Ok(Disparities::Auto);
    }
    shared::disparities(text).map(Disparities::Count).map_err(|needed| format!("{needed}, or auto"))
}

/// A pair before it is matched.
pub struct Looked<'a> {
    /// What is matched.
    pub pictures: [&'a GrayImage; 2],
    /// 0 where a picture shows nothing.
    pub valid: Option<[&'a GrayImage; 2]>,
    /// The camera that both pictures are of, where a calibration tells it.
    pub camera: Option<&'a Camera<f64>>,
    /// What is added to a disparity before it divides, px: by so much what is in front may be negative.
    pub offset_px: f64,
    /// Whether one raw picture was given for both, which a calibration rectified in two ways.
    pub is_given_twice: bool,
}

impl<'a> Looked<'a> {
    /// Pictures of which no more is known.
    pub fn of(pictures: [&'a GrayImage; 2]) -> Self {
        Self { pictures, valid: None, camera: None, offset_px: 0.0, is_given_twice: false }
    }

    fn fault(&self, matches: &PairMatches) -> Option<PairFault> {
        if self.is_given_twice {
            return Some(PairFault::Same);
        }
        let fault = pair::fault(self.pictures, matches);
        fault.filter(|&fault| fault != PairFault::Swapped || !matches.are_in_front(self.offset_px))
    }

    /// How the rows lie; rows of images that are turned or mirrored say nothing of the cameras.
    fn rows(&self, matches: &PairMatches, fault: Option<PairFault>) -> Option<Rows> {
        // Pictures have at most 4096 columns and rows.
        let (width, height) = (self.pictures[0].width() as u16, self.pictures[0].height() as u16);
        let has_rows = matches!(fault, None | Some(PairFault::Swapped));
        has_rows.then(|| Rows::measure(matches, ImageSize { width, height }, self.camera)).flatten()
    }
}

/// Whether two raw pictures are one that shows something.
pub fn are_same(left: &GrayImage, right: &GrayImage) -> bool {
    left.as_raw() == right.as_raw() && !pair::is_blank(left)
}

/// How the rows of a pair lie, where it shows enough. A pair of swapped cameras, or the picture of one twice,
/// is refused unless that is forced; `exchanged` is what the pictures would be if the cameras were exchanged
/// before they are rectified.
pub fn rows_of_pair(
    looked: &Looked<'_>,
    is_forced: bool,
    exchanged: impl FnOnce() -> Option<RectifiedPictures>,
) -> Result<Option<Rows>, Failure> {
    // Where nothing is found nothing is said.
    let Ok(matches) = PairMatches::find(looked.pictures, None) else { return Ok(None) };
    let fault = looked.fault(&matches);
    if !is_forced && fault == Some(PairFault::Same) {
        return Err(Failure::new(format!("{}, or give --force", PairFault::Same)));
    }
    if !is_forced && is_swapped(fault, &matches, exchanged) {
        return Err(swapped());
    }
    Ok(looked.rows(&matches, fault))
}

fn swapped() -> Failure {
    Failure::new(format!("{}, or give --force", PairFault::Swapped))
}

/// Whether the cameras are swapped: pictures that a calibration rectified may be a pair only then.
fn is_swapped(
    fault: Option<PairFault>,
    matches: &PairMatches,
    exchanged: impl FnOnce() -> Option<RectifiedPictures>,
) -> bool {
    let is_pair = |RectifiedPictures { pictures, valid, .. }: RectifiedPictures| {
        let pictures = pictures.each_ref();
        PairMatches::find(pictures, Some(valid.each_ref())).is_ok_and(|found| {
            // A calibration that is a little off leaves rows that do not agree, and what is in front in
            // front.
            (found.is_aligned() || found.are_positive() && !matches.are_positive())
                && found.in_rows.len() > matches.in_rows.len()
                && pair::fault(pictures, &found).is_none()
        })
    };
    match fault {
        Some(PairFault::Swapped) => true,
        Some(PairFault::Same | PairFault::Still) => false,
        _ if matches.is_sure() => false,
        _ => exchanged().is_some_and(is_pair),
    }
}

/// What is seen of a pair before it is matched.
pub struct Look {
    pub config: Config,
    pub check: Option<PairCheck>,
    pub rows: Option<Rows>,
}

/// Looks at a pair before it is matched: the search, and what is wrong. Swapped cameras are an error.
pub fn look(
    args: &SearchArgs,
    method: &MethodArgs,
    looked: &Looked<'_>,
    exchanged: impl FnOnce() -> Option<RectifiedPictures>,
) -> Result<Look, Failure> {
    let &Looked { pictures, valid, .. } = looked;
    // Pictures have at most 4096 columns and rows.
    let (width, height) = (pictures[0].width() as u16, pictures[0].height() as u16);
    // Pictures without features are matched as well as they can be.
    let matches = PairMatches::find(pictures, valid).ok();
    let fault = matches.as_ref().and_then(|matches| looked.fault(matches));
    if let Some(matches) = matches.as_ref().filter(|_| !args.force)
        && is_swapped(fault, matches, exchanged)
    {
        return Err(swapped());
    }
    let [first, count] = match args.disparities {
        Disparities::Count(count) => [args.min_disparity.unwrap_or(0), count],
        Disparities::Auto if args.force && fault == Some(PairFault::Swapped) => {
            return Err(Failure::new(
                "--disparities auto: the cameras seem to be swapped, and what they search is not known; give \
                 a number with --force",
            ));
        }
        Disparities::Auto => searched(pictures, matches.as_ref(), fault, args.min_disparity)?,
    };
    let range = RangeArgs { disparities: count, min_disparity: first };
    let config = input::config(&range, method, width, height)?;
    let config = Config { confidence: true, ..config };
    let Some(matches) = matches else { return Ok(Look { config, check: None, rows: None }) };
    let check = PairCheck::new(pictures, valid, &matches, fault, &config);
    let rows = looked.rows(&matches, check.fault);
    Ok(Look { config, check: Some(check), rows })
}

/// The search that a pair shows, from the first disparity on that is given.
fn searched(
    pictures: [&GrayImage; 2],
    matches: Option<&PairMatches>,
    fault: Option<PairFault>,
    first: Option<u16>,
) -> Result<[u16; 2], Failure> {
    let refused = |why: &dyn std::fmt::Display| Failure::new(format!("--disparities auto: {why}"));
    let too_little = "the images show too little to find a range; give a number";
    let matches = matches.ok_or_else(|| refused(&too_little))?;
    if let Some(fault) = fault {
        return Err(refused(&fault));
    }
    let [found, count] = pair::search(pictures, matches).ok_or_else(|| refused(&too_little))?;
    let (first, last) = (first.unwrap_or(found), found + count);
    // From another first disparity on to the same last one.
    let count = last.saturating_sub(first).max(1).next_multiple_of(16);
    Ok([first, count.min(Config::MOST_DISPARITIES)])
}
