//! What is wrong with a pair of pictures, by the features that both show: cameras that are swapped, pictures
//! that are turned, mirrored, the same or of two scenes, and a search that is too short.

mod lacks;

use crate::correspond::{CorrespondError, Plan, correspond};
use crate::map::quantile;
use crate::run::{MemoryPair, MethodName, run};
use image::{GrayImage, imageops};
use lacks::{share, untextured};
use nalgebra::Point2;
use serde::Serialize;
use std::fmt;
use stereopsis::features::Orientation;
use stereopsis::geometry::two_view::Correspondence;
use stereopsis::matching::{Config, Filter};

/// Corners that are looked for: enough for a few hundredths of a pixel, in a few milliseconds.
const CORNERS: u16 = 600;
/// Partners in a pair to be matched are at most so many rows apart, px.
const ROWS_APART: f64 = 12.0;
/// Corners are so far from what a camera did not see, px: its border is none.
const MARGIN: i64 = 6;
/// With fewer matches nothing is said.
const FEWEST: usize = 16;
/// Width up to which pictures are made smaller to find their range, px.
const SMALL: u32 = 320;
/// A disparity that is none for sure, px.
const STILL: f64 = 1.5;

/// Features that two pictures have in common.
#[derive(Clone, Debug)]
pub struct PairMatches {
    /// All matches, wherever they are.
    all: Vec<Correspondence<f64>>,
    /// Those in about the same rows.
    pub in_rows: Vec<Correspondence<f64>>,
}

impl PairMatches {
    /// Matches two pictures; `valid` is 0 where a picture shows nothing.
    pub fn find(pictures: [&GrayImage; 2], valid: Option<[&GrayImage; 2]>) -> Result<Self, CorrespondError> {
        let plan =
            Plan { corners: CORNERS, levels: 1, orientation: Some(Orientation::Upright), ..Plan::default() };
        let found = correspond(&plan, pictures[0], pictures[1])?;
        let is_shown = |s: &Correspondence<f64>| {
            valid.is_none_or(|[left, right]| is_within(left, &s.first) && is_within(right, &s.second))
        };
        let all: Vec<_> = found
            .points()
            .map(|[x1, y1, x2, y2]| Correspondence {
                first: Point2::new(x1, y1).cast::<f64>(),
                second: Point2::new(x2, y2).cast(),
            })
            .filter(is_shown)
            .collect();
        let in_rows = all.iter().copied().filter(|s| (s.first.y - s.second.y).abs() < ROWS_APART).collect();
        Ok(Self { all, in_rows })
    }

    /// Whether most matches are in rows, there are enough of them, and their disparities are those of a pair:
    /// of a mirrored image they spread over all its width.
    fn is_aligned(&self, width: u32) -> bool {
        self.in_rows.len() >= FEWEST
            && 2 * self.in_rows.len() > self.all.len()
            && 3.0 * middle(self.disparities_px()).spread < f64::from(width)
    }

    /// Whether the matches move along columns, as far as is different, and not along rows.
    fn moves_along_columns(&self) -> bool {
        let along_rows = middle(self.all.iter().map(|s| s.first.x - s.second.x).collect());
        let along_columns = middle(self.all.iter().map(|s| s.first.y - s.second.y).collect());
        self.all.len() >= FEWEST
            && along_rows.median.abs() < STILL
            && along_columns.median.abs() > 2.0 * STILL
            && along_columns.spread > STILL.max(3.0 * along_rows.spread)
    }

    /// The disparities of the matches in rows, in ascending order, px.
    fn disparities_px(&self) -> Vec<f64> {
        let mut found: Vec<_> = self.in_rows.iter().map(|s| s.first.x - s.second.x).collect();
        found.sort_by(f64::total_cmp);
        found
    }
}

/// The middle of some numbers, and from their lowest fifth to their highest one.
struct Middle {
    median: f64,
    spread: f64,
}

/// The middle of some numbers; all zero of none.
fn middle(mut numbers: Vec<f64>) -> Middle {
    numbers.sort_by(f64::total_cmp);
    let at = |tenths: usize| numbers.get(numbers.len() * tenths / 10).copied().unwrap_or(0.0);
    Middle { median: at(5), spread: at(8) - at(2) }
}

/// What is wrong with a pair.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PairFault {
    /// Nearly all disparities are negative.
    Swapped,
    /// Both pictures are the same.
    Same,
    /// Both pictures stand on their sides.
    BothOnTheirSides,
    /// The right picture stands on its head.
    RightUpsideDown,
    /// The right picture stands on its side.
    RightOnItsSide,
    /// The right picture is mirrored.
    RightMirrored,
    /// The pictures have next to nothing in common.
    TwoScenes,
}

impl fmt::Display for PairFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Swapped => {
                "nearly everything lies farther to the right in the right image: the cameras are swapped; \
                 exchange left and right"
            }
            Self::Same => "the left and the right image are the same picture; give one of each camera",
            Self::BothOnTheirSides => {
                "what moves from image to image moves along columns: both images are turned by 90 degrees; \
                 turn them upright"
            }
            Self::RightUpsideDown => "the right image is turned by 180 degrees; turn it as the left one is",
            Self::RightOnItsSide => "the right image is turned by 90 degrees; turn it as the left one is",
            Self::RightMirrored => "the right image is mirrored; mirror it back",
            Self::TwoScenes => {
                "the images have next to nothing in common: they show different scenes, or are far from \
                 rectified; give a rectified pair, or --rectify with a calibration"
            }
        })
    }
}

/// What features say of a pair and of its search. Names are those of `summary.json`.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct PairCheck {
    /// Features that both pictures show.
    pub matches: usize,
    /// Those of them that are in about the same rows.
    pub matches_in_rows: usize,
    /// The range of their disparities, 2nd to 98th percentile, px; absent when there are too few.
    pub disparity_px: Option<[f64; 2]>,
    /// What is wrong; absent when nothing seems to be.
    pub fault: Option<PairFault>,
    /// The share of the matches that lie beyond the search.
    pub beyond_search: f64,
    /// A search that would hold nearly all of them: `--min-disparity` and `--disparities`.
    pub search: Option<[u16; 2]>,
    /// The share of the left picture without texture: no grey level changes by 4 within 9 x 9 pixels.
    pub untextured: f64,
    /// That of the right one.
    pub untextured_right: f64,
    /// The share of both pictures that is white: 254 and more.
    pub over_exposed: f64,
    /// The share of both pictures that is black: 1 and less.
    pub under_exposed: f64,
    /// About the share of the left picture that the right camera does not see; absent with few matches.
    pub out_of_view: Option<f64>,
}

impl PairCheck {
    /// Looks at a pair that is to be matched.
    pub fn new(pictures: [&GrayImage; 2], matches: &PairMatches, config: &Config) -> Self {
        let found = matches.disparities_px();
        let at =
            |share: f64| found.get((share * found.len().saturating_sub(1) as f64).round() as usize).copied();
        let range = (found.len() >= FEWEST).then(|| Some([at(0.02)?, at(0.98)?])).flatten();
        let fault = fault(pictures, matches);
        let first = f64::from(config.min_disparity);
        let last = first + f64::from(config.disparities) - 1.0;
        let beyond = found.iter().filter(|&&d| d > last || d < first - STILL).count();
        Self {
            matches: matches.all.len(),
            matches_in_rows: matches.in_rows.len(),
            disparity_px: range,
            fault,
            beyond_search: if range.is_some() { beyond as f64 / found.len() as f64 } else { 0.0 },
            search: if fault.is_none() { search(pictures, matches) } else { None },
            untextured: untextured(pictures[0]),
            untextured_right: untextured(pictures[1]),
            over_exposed: share(pictures, |pixel| pixel >= 254),
            under_exposed: share(pictures, |pixel| pixel <= 1),
            out_of_view: range.and(at(0.5)).map(|d| (d / f64::from(pictures[0].width())).clamp(0.0, 1.0)),
        }
    }

    /// What is to be known about the search, with a cure, where it misses what features show.
    pub fn search_warning(&self, config: &Config) -> Option<String> {
        let ([first, last], [min_disparity, disparities]) = (self.disparity_px?, self.search?);
        (self.beyond_search > 0.05).then(|| {
            format!(
                "{:.0} % of the features lie beyond disparities {} to {}, where they are from {first:.0} to \
                 {last:.0} px; give --min-disparity {min_disparity} --disparities {disparities}",
                100.0 * self.beyond_search,
                config.min_disparity,
                config.min_disparity + config.disparities - 1
            )
        })
    }
}

/// A search that holds what a pair shows: the smallest disparity and how many. It is that of the matches and
/// of a smaller copy of the pair, matched over its whole width, with a margin. `None` where neither has
/// answers.
pub fn search(pictures: [&GrayImage; 2], matches: &PairMatches) -> Option<[u16; 2]> {
    let width = u16::try_from(pictures[0].width()).ok()?;
    let of_matches = matches.disparities_px();
    let range = |sorted: &[f64], ends: [f64; 2]| {
        let at = |share: f64| sorted.get((share * (sorted.len() - 1) as f64).round() as usize).copied();
        if sorted.len() < FEWEST { None } else { Some([at(ends[0])?, at(ends[1])?]) }
    };
    let ranges = [range(&of_matches, [0.02, 0.98]), small_range(pictures)];
    let all = || ranges.iter().flatten();
    let first = all().map(|r| r[0]).min_by(f64::total_cmp)?;
    let last = all().map(|r| r[1]).max_by(f64::total_cmp)?;
    let more = 4.0 + (last - first) / 8.0;
    // From 0 on where that costs little: what is far has few features.
    let first = if first - more < 32.0 { 0.0 } else { (first - more).floor() };
    let count = ((last + more - first).max(1.0) as u16).next_multiple_of(16);
    let most = Config::MOST_DISPARITIES.min(width.saturating_sub(first as u16)) & !15;
    Some([first as u16, count.clamp(Config::FEWEST_DISPARITIES, most.max(Config::FEWEST_DISPARITIES))])
}

/// The range of the disparities in a smaller copy of a pair, in pixels of the pair.
fn small_range(pictures: [&GrayImage; 2]) -> Option<[f64; 2]> {
    let (width, height) = pictures[0].dimensions();
    let by = width.div_ceil(SMALL);
    let small = |picture: &GrayImage| imageops::thumbnail(picture, width / by, (height / by).max(1));
    let [left, right] = pictures.map(small);
    // Images have at most 4096 columns and rows.
    let (width, height) = (left.width() as u16, left.height() as u16);
    let disparities = Config::MOST_DISPARITIES.min(width) & !15;
    let config =
        MethodName::Block.with_filter(Filter::Strict, MethodName::Block.config(width, height, disparities));
    let mut pair = MemoryPair::new(width, left.into_raw(), right.into_raw())?;
    let found = run(MethodName::Block, &config, &mut pair, |_| ()).ok()?.map.sorted();
    let by = f64::from(by);
    (found.len() >= 16 * FEWEST).then(|| {
        Some([by * f64::from(quantile(&found, 0.001)?), by * (f64::from(quantile(&found, 0.999)?) + 1.0)])
    })?
}

/// What is wrong with the pictures, as far as features tell.
pub fn fault(pictures: [&GrayImage; 2], matches: &PairMatches) -> Option<PairFault> {
    let [left, right] = pictures;
    if left.as_raw() == right.as_raw() {
        return Some(PairFault::Same);
    }
    if matches.moves_along_columns() {
        return Some(PairFault::BothOnTheirSides);
    }
    if matches.is_aligned(left.width()) {
        let moved: Vec<_> = matches.disparities_px().into_iter().filter(|d| d.abs() > STILL).collect();
        let negative = moved.iter().filter(|&&d| d < 0.0).count();
        return (moved.len() >= FEWEST && 20 * negative > 17 * moved.len()).then_some(PairFault::Swapped);
    }
    let in_columns = matches.all.iter().filter(|s| (s.first.x - s.second.x).abs() < ROWS_APART).count();
    if in_columns >= FEWEST && 2 * in_columns > matches.all.len() {
        return Some(PairFault::BothOnTheirSides);
    }
    let is_cured = |cured: &GrayImage| {
        cured.dimensions() == left.dimensions()
            && PairMatches::find([left, cured], None).is_ok_and(|found| found.is_aligned(cured.width()))
    };
    if is_cured(&imageops::rotate180(right)) {
        return Some(PairFault::RightUpsideDown);
    }
    if is_cured(&imageops::rotate90(right)) || is_cured(&imageops::rotate270(right)) {
        return Some(PairFault::RightOnItsSide);
    }
    if is_cured(&imageops::flip_horizontal(right)) || is_cured(&imageops::flip_vertical(right)) {
        return Some(PairFault::RightMirrored);
    }
    // Pictures with texture that have nothing in common; without any, nothing is said.
    let own = [left, right]
        .map(|picture| PairMatches::find([picture, picture], None).map_or(0, |found| found.in_rows.len()));
    (own[0].min(own[1]) >= 8 * FEWEST && 16 * matches.in_rows.len() < own[0].min(own[1]))
        .then_some(PairFault::TwoScenes)
}

/// Whether a place and what is around it is shown.
fn is_within(valid: &GrayImage, place: &Point2<f64>) -> bool {
    let at = |dx: i64, dy: i64| {
        let (x, y) = (place.x.round() as i64 + dx, place.y.round() as i64 + dy);
        let pixel = u32::try_from(x).ok().zip(u32::try_from(y).ok());
        pixel.and_then(|(x, y)| valid.get_pixel_checked(x, y)).is_some_and(|pixel| pixel.0[0] != 0)
    };
    [(-MARGIN, -MARGIN), (MARGIN, -MARGIN), (-MARGIN, MARGIN), (MARGIN, MARGIN)]
        .into_iter()
        .all(|(x, y)| at(x, y))
}
