//! What is wrong with a pair, as far as features tell.

use super::matches::{FEWEST, PairMatches, ROWS_APART, STILL};
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

/// How a right picture is brought back to the left one's orientation.
type Cure = fn(&GrayImage) -> GrayImage;
const CURES: [(PairFault, Cure); 5] = [
    (PairFault::RightUpsideDown, |right| imageops::rotate180(right)),
    (PairFault::RightOnItsSide, |right| imageops::rotate90(right)),
    (PairFault::RightOnItsSide, |right| imageops::rotate270(right)),
    (PairFault::RightMirrored, |right| imageops::flip_horizontal(right)),
    (PairFault::RightMirrored, |right| imageops::flip_vertical(right)),
];

/// The share of matches that stay where they are in pictures of one camera: noise and compression move some.
const STILL_SHARE: f64 = 0.85;
/// The share of a small copy's pixels that pictures of different scenes have answers in, at most: by chance.
const CHANCE: f64 = 0.25;

/// What is wrong with the pictures, as far as features tell.
pub fn fault(pictures: [&GrayImage; 2], matches: &PairMatches) -> Option<PairFault> {
    let [left, right] = pictures;
    if left.as_raw() == right.as_raw() {
        return Some(PairFault::Same);
    }
    if matches.moves_along_columns() && both_turned(pictures) {
        return Some(PairFault::BothOnTheirSides);
    }
    if matches.is_aligned(left.width()) {
        if matches.share_within(STILL) >= STILL_SHARE {
            return Some(PairFault::Still);
        }
        let moved: Vec<_> = matches.disparities_px().into_iter().filter(|d| d.abs() > STILL).collect();
        let negative = moved.iter().filter(|&&d| d < 0.0).count();
        let is_swapped = moved.len() >= FEWEST && 20 * negative > 17 * moved.len();
        // A mirrored picture of something symmetric has matches too, and fewer than one that is put right.
        return is_swapped.then(|| cured(pictures, matches.in_rows.len()).unwrap_or(PairFault::Swapped));
    }
    if let Some(fault) = cured(pictures, matches.in_rows.len()) {
        return Some(fault);
    }
    let in_columns = matches.all.iter().filter(|s| (s.first.x - s.second.x).abs() < ROWS_APART).count();
    if in_columns >= FEWEST && 2 * in_columns > matches.all.len() && both_turned(pictures) {
        return Some(PairFault::BothOnTheirSides);
    }
    if matches.are_rows_apart(left.height()) {
        return Some(PairFault::RowsApart);
    }
    // Pictures with texture that have nothing in common; without any, nothing is said. A pattern that repeats
    // has no matches that are sure, and answers everywhere.
    let own = [left, right]
        .map(|picture| PairMatches::find([picture, picture], None).map_or(0, |found| found.in_rows.len()));
    let has_texture = own[0].min(own[1]) >= 8 * FEWEST;
    let has_answers = || small_map(pictures).is_some_and(|(map, _)| map.density() > CHANCE);
    (has_texture && 16 * matches.in_rows.len() < own[0].min(own[1]) && !has_answers())
        .then_some(PairFault::TwoScenes)
}

/// How the right picture stands, where it has more matches when it is turned or mirrored: what has the most.
fn cured([left, right]: [&GrayImage; 2], fewest: usize) -> Option<PairFault> {
    let in_rows = |(fault, cure): (PairFault, Cure)| {
        let cured = cure(right);
        let found = (cured.dimensions() == left.dimensions())
            .then(|| PairMatches::find([left, &cured], None).ok())
            .flatten()
            .filter(|found| found.is_aligned(cured.width()))?;
        Some((found.in_rows.len(), fault))
    };
    let best = CURES.into_iter().filter_map(in_rows).max_by_key(|(count, _)| *count)?;
    (best.0 > fewest).then_some(best.1)
}

/// Whether both pictures are a pair when they are turned by 90 degrees.
fn both_turned(pictures: [&GrayImage; 2]) -> bool {
    let [left, right] = pictures.map(imageops::rotate90);
    PairMatches::find([&left, &right], None).is_ok_and(|found| found.is_aligned(left.width()))
}
