//! What is wrong with a pair, as far as features tell.

use super::agreement::FEWEST;
use super::lacks::Lacks;
use super::matches::{PairMatches, STILL};
use super::search::small_map;
use image::{GrayImage, imageops};
use serde::Serialize;
use std::fmt;

/// What is wrong with a pair.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PairFault {
    /// Nearly all disparities are negative.
    Swapped,
    /// Both pictures are the same.
    Same,
    /// Both pictures show the same in the same places.
    Still,
    /// Both pictures stand on their sides.
    BothOnTheirSides,
    /// The right picture stands on its head.
    RightUpsideDown,
    /// The right picture stands on its side.
    RightOnItsSide,
    /// The right picture is mirrored.
    RightMirrored,
    /// The left picture stands on its head.
    LeftUpsideDown,
    /// The left picture stands on its side.
    LeftOnItsSide,
    /// The left picture is mirrored.
    LeftMirrored,
    /// The right picture stands much higher or lower than the left one.
    RowsApart,
    /// The pictures have next to nothing in common.
    TwoScenes,
}

impl fmt::Display for PairFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Swapped => {
                "nearly everything lies farther to the right in the right image: the cameras are swapped, \
                 or both images are upside down or mirrored; exchange left and right"
            }
            Self::Same => "the left and the right image are the same picture; give one of each camera",
            Self::Still => {
                "both images show everything in the same place: they are of one camera, or all is too far \
                 for these two; give an image of each camera"
            }
            Self::BothOnTheirSides => {
                "what moves from image to image moves along columns: both images are turned by 90 degrees; \
                 turn them upright"
            }
            Self::RightUpsideDown => "the right image is turned by 180 degrees; turn it as the left one is",
            Self::RightOnItsSide => "the right image is turned by 90 degrees; turn it as the left one is",
            Self::RightMirrored => "the right image is mirrored; mirror it back",
            Self::LeftUpsideDown => "the left image is turned by 180 degrees; turn it as the right one is",
            Self::LeftOnItsSide => "the left image is turned by 90 degrees; turn it as the right one is",
            Self::LeftMirrored => "the left image is mirrored; mirror it back",
            Self::RowsApart => {
                "the right image stands over 12 px higher or lower than the left one: the pair is not \
                 rectified, or not by the calibration of these cameras; give --rectify with that, or align \
                 it by rectify --matches"
            }
            Self::TwoScenes => {
                "the images have next to nothing in common: they show different scenes, or are far from \
                 rectified; give a rectified pair, or --rectify with the calibration of these cameras"
            }
        })
    }
}

/// How a picture is brought back to the other one's orientation; what is wrong where that is the right one,
/// and where it is the left one.
struct Cure {
    turned: fn(&GrayImage) -> GrayImage,
    right: PairFault,
    left: PairFault,
    /// Whether the pair that this makes of the wrong picture is one with left and right exchanged.
    exchanges: bool,
}

const CURES: [Cure; 5] = [
    Cure {
        turned: |picture| imageops::rotate180(picture),
        right: PairFault::RightUpsideDown,
        left: PairFault::LeftUpsideDown,
        exchanges: true,
    },
    Cure {
        turned: |picture| imageops::rotate90(picture),
        right: PairFault::RightOnItsSide,
        left: PairFault::LeftOnItsSide,
        exchanges: false,
    },
    Cure {
        turned: |picture| imageops::rotate270(picture),
        right: PairFault::RightOnItsSide,
        left: PairFault::LeftOnItsSide,
        exchanges: false,
    },
    Cure {
        turned: |picture| imageops::flip_horizontal(picture),
        right: PairFault::RightMirrored,
        left: PairFault::LeftMirrored,
        exchanges: true,
    },
    Cure {
        turned: |picture| imageops::flip_vertical(picture),
        right: PairFault::RightMirrored,
        // With either mirrored it is a pair, and nothing tells which one should be.
        left: PairFault::RightMirrored,
        exchanges: false,
    },
];

/// The share of matches that stay where they are in pictures of one camera: noise and compression move some.
const STILL_SHARE: f64 = 0.85;
/// The share of a small copy's pixels that pictures of different scenes have answers in, at most: by chance.
const CHANCE: f64 = 0.25;

/// What is wrong with the pictures, as far as features tell.
pub fn fault(pictures: [&GrayImage; 2], matches: &PairMatches) -> Option<PairFault> {
    let [left, right] = pictures;
    if left.as_raw() == right.as_raw() {
        // What sees nothing is not known to be one camera.
        return (!is_blank(left)).then_some(PairFault::Same);
    }
    if matches.moves_along_columns() && both_turned(pictures) {
        return Some(PairFault::BothOnTheirSides);
    }
    if matches.is_aligned() {
        if matches.share_within(STILL) >= STILL_SHARE && !matches.has_another_surface() {
            return Some(PairFault::Still);
        }
        // A mirrored picture of something symmetric has matches too, and fewer than one that is put right.
        if matches.are_negative() {
            return Some(cured(pictures, matches.in_rows.len()).unwrap_or(PairFault::Swapped));
        }
        return if matches.is_sure() { None } else { cured(pictures, 2 * matches.in_rows.len()) };
    }
    if let Some(fault) = cured(pictures, matches.most_in_rows()) {
        return Some(fault);
    }
    if matches.are_in_columns() && both_turned(pictures) {
        return Some(PairFault::BothOnTheirSides);
    }
    if matches.are_rows_apart() {
        // What the rows are is said once the cameras are exchanged.
        let is_swapped = matches.are_negative_in_moved_rows();
        return Some(if is_swapped { PairFault::Swapped } else { PairFault::RowsApart });
    }
    // Pictures with texture that have nothing in common; without any, nothing is said. A pattern that repeats
    // has no matches that are sure, and answers everywhere.
    let own = [left, right]
        .map(|picture| PairMatches::find([picture, picture], None).map_or(0, |found| found.in_rows.len()));
    let has_texture = own[0].min(own[1]) >= 8 * FEWEST;
    let has_answers = || small_map(pictures).is_some_and(|(map, _)| map.density() > CHANCE);
    // Of a camera that is covered noise is what has features.
    let is_covered = || Lacks::hardly_textured(&pictures.map(|picture| Lacks::of(picture, None)));
    (has_texture && 16 * matches.in_rows.len() < own[0].min(own[1]) && !has_answers() && !is_covered())
        .then_some(PairFault::TwoScenes)
}

/// Whether a picture has one grey level.
pub fn is_blank(picture: &GrayImage) -> bool {
    let first = picture.as_raw().first();
    picture.iter().all(|grey| Some(grey) == first)
}

/// How one of the pictures stands, where there are more matches when it is turned or mirrored: what has the
/// most.
fn cured([left, right]: [&GrayImage; 2], fewest: usize) -> Option<PairFault> {
    let aligned = |left: &GrayImage, right: &GrayImage| {
        let is_one_size = left.dimensions() == right.dimensions();
        let found = is_one_size.then(|| PairMatches::find([left, right], None).ok()).flatten()?;
        found.is_aligned().then_some(found)
    };
    let by = |cure: &Cure| {
        let of_right = aligned(left, &(cure.turned)(right)).map(|found| {
            let is_left = cure.exchanges && found.are_negative();
            (found.in_rows.len(), if is_left { cure.left } else { cure.right })
        });
        // What exchanges the two is the same pair with either turned; what does not is none with the other.
        let of_left = (!cure.exchanges).then(|| aligned(&(cure.turned)(left), right)).flatten();
        let of_left = of_left.map(|found| (found.in_rows.len(), cure.left));
        of_left.into_iter().chain(of_right).max_by_key(|(count, _)| *count)
    };
    let best = CURES.iter().filter_map(by).max_by_key(|(count, _)| *count)?;
    (best.0 > fewest).then_some(best.1)
}

/// Whether both pictures are a pair when they are turned by 90 degrees.
fn both_turned(pictures: [&GrayImage; 2]) -> bool {
    let [left, right] = pictures.map(imageops::rotate90);
    PairMatches::find([&left, &right], None).is_ok_and(|found| found.is_aligned())
}
