//! `stereo rectify --matches`: a raw pair whose cameras nobody knows, its rows aligned by matches alone.

use crate::failure::Failure;
use crate::fundamental::why;
use crate::input::Pair;
use crate::place::{json, png};
use crate::shared::{print, remark, rows};
use image::{GrayImage, Luma, imageops};
use nalgebra::Point2;
use serde::Serialize;
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;
use stereopsis::geometry::{
    camera::ImageSize,
    rectify::UncalibratedRectification,
    robust::{RobustConfig, robust_fundamental},
    two_view::{Correspondence, Homography},
};
use stereopsis_host::calibration;
use stereopsis_host::command_line::one_line;
use stereopsis_host::matches::read_matches;
use stereopsis_host::mock::luma;
use stereopsis_host::output::Staging;
use stereopsis_host::pair::{agree_around, are_negative};

/// How far a match may be from what the others say, px.
const THRESHOLD_PX: f64 = 1.0;
/// Fewer right matches than this say too little.
const FEWEST: usize = 16;

/// The share of a rectified image that is seen of the raw one, at least, where nothing is said.
const LEAST_SEEN: f64 = 0.6;

/// What `rectified.json` holds. Names are a contract with programs that read it.
#[derive(Serialize)]
struct Summary {
    /// Always absent: lengths are in px alone.
    calibration: Option<&'static str>,
    axis: &'static str,
    width: u16,
    height: u16,
    /// `p1^T F p2 = 0` of the raw images.
    fundamental: [[f64; 3]; 3],
    /// From a raw pixel of the left and of the right image to the rectified one, `p' ~ H p`.
    homographies: [[[f64; 3]; 3]; 2],
    matches: usize,
    inliers: usize,
    /// The root mean square of how far the rows of right matches are apart.
    row_error_px: f64,
    /// The least and the largest disparity of right matches: what a search has to cover.
    disparity_px: [f64; 2],
    /// The shares of the rectified images that are seen.
    seen: [f64; 2],
}

pub fn run(pair: &Pair, matches: &Path, out: &Path) -> Result<(), Failure> {
    let size = ImageSize { width: pair.width, height: pair.height };
    let failed = |why: &dyn std::fmt::Display| Failure::new(format!("{}: {why}", matches.display()));
    let seen = read_matches(matches)?;
    let is_inside = |p: &Point2<f64>| {
        (-0.5..f64::from(size.width)).contains(&p.x) && (-0.5..f64::from(size.height)).contains(&p.y)
    };
    if let Some(at) = seen.iter().position(|s| !(is_inside(&s.first) && is_inside(&s.second))) {
        let (number, w, h) = (at + 1, size.width, size.height);
        return Err(failed(&format!(
            "match {number} is outside of the images of {w} x {h} px; name their matches"
        )));
    }
    let mut inliers = vec![false; seen.len()];
    let found = robust_fundamental(&seen, &RobustConfig::new(THRESHOLD_PX), &mut inliers)
        .map_err(|e| failed(&why(&seen, &e)))?;
    let right: Vec<_> =
        seen.iter().zip(&inliers).filter(|(_, is_right)| **is_right).map(|(s, _)| *s).collect();
    if right.len() < FEWEST {
        let count = right.len();
        return Err(failed(&format!(
            "{count} of {} matches agree with each other; {FEWEST} are needed",
            seen.len()
        )));
    }
    let rectify = |seen: &[_]| UncalibratedRectification::new(&found.fundamental, seen, size);
    let rough = rectify(&right).map_err(|e| failed(&e))?;
    let right = of_surfaces(&rough, right, size.width);
    let both = rectify(&right).map_err(|e| failed(&e))?;
    Staging::probe(out)?;

    let grey = [&pair.left, &pair.right].map(luma);
    let pictures: Vec<_> = grey.iter().zip(both.to_raw()).map(|(raw, to_raw)| warped(raw, to_raw)).collect();
    let share = |valid: &GrayImage| {
        valid.iter().filter(|&&seen| seen != 0).count() as f64
            / f64::from(size.width)
            / f64::from(size.height)
    };
    let (row_error_px, disparity_px) = figures(&both, &right);
    let summary = Summary {
        calibration: None,
        axis: "horizontal",
        width: size.width,
        height: size.height,
        fundamental: rows(found.fundamental.matrix()),
        homographies: both.to_raw().each_ref().map(|to_raw| rows(to_raw.inverse().matrix())),
        matches: seen.len(),
        inliers: right.len(),
        row_error_px,
        disparity_px,
        seen: [share(&pictures[0].1), share(&pictures[1].1)],
    };
    let mut staging = Staging::new(out)?;
    for (side, (picture, valid)) in ["left", "right"].into_iter().zip(&pictures) {
        staging.write(&format!("{side}.png"), |out| png(out, picture))?;
        staging.write(&format!("valid_{side}.png"), |out| png(out, valid))?;
    }
    staging.write("rectified.json", |out| json(out, &summary))?;
    staging.commit(&[])?;

    for note in &pair.notes {
        remark(&format!("note: {note}"));
    }
    let raw_px: Vec<_> = right.iter().map(|s| s.first.x - s.second.x).collect();
    if are_negative(&raw_px) {
        remark(
            "warning: nearly everything lies farther to the right in the right image: unless the cameras \
             are turned towards each other they are swapped, and what is near is matched as far; exchange \
             left and right",
        );
    }
    if let Some((side, share)) =
        ["left", "right"].into_iter().zip(summary.seen).find(|&(_, seen)| seen < LEAST_SEEN)
    {
        remark(&format!(
            "warning: the rectified {side} image shows {:.0} % of the raw one: its matches are wrong, or the \
             cameras stand far from side by side",
            100.0 * share
        ));
    }
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{} x {} px, horizontal, without a calibration: nothing is in metres",
        size.width, size.height
    );
    let _ = writeln!(text, "matches      {} of {} agree within {THRESHOLD_PX} px", right.len(), seen.len());
    let _ = writeln!(text, "rows         {row_error_px:.2} px apart");
    let _ =
        writeln!(text, "disparity    {:.1} to {:.1} px of these matches", disparity_px[0], disparity_px[1]);
    let _ = writeln!(text, "results are in {}", one_line(&out.display().to_string()));
    print(&text)
}

/// Whether a file is the `rectified.json` of a pair that matches alone have aligned.
pub fn is_uncalibrated(path: &Path) -> bool {
    let text = calibration::bytes(path).unwrap_or_default();
    serde_json::from_slice::<Value>(&text)
        .is_ok_and(|found| found["calibration"].is_null() && found["homographies"].is_array())
}

/// The matches that others around them agree with in disparity; all of them where these are too few. What is
/// wrong and on its line by chance moves the columns of all others.
fn of_surfaces(
    both: &UncalibratedRectification<f64>,
    seen: Vec<Correspondence<f64>>,
    width: u16,
) -> Vec<Correspondence<f64>> {
    let rectified = |s: &Correspondence<f64>| {
        let (first, second) = (both.first(&s.first)?, both.second(&s.second)?);
        Some((*s, Correspondence { first, second }))
    };
    let (raw, rectified): (Vec<_>, Vec<_>) = seen.iter().filter_map(rectified).unzip();
    let agreeing = agree_around(&rectified, width.into());
    let agreed: Vec<_> =
        raw.into_iter().zip(agreeing).filter_map(|(s, agrees)| agrees.then_some(s)).collect();
    if agreed.len() < FEWEST { seen } else { agreed }
}

/// How far rows of matches are apart, the root mean square, and their least and largest disparity; px.
fn figures(both: &UncalibratedRectification<f64>, seen: &[Correspondence<f64>]) -> (f64, [f64; 2]) {
    let places = seen.iter().filter_map(|s| Some((both.first(&s.first)?, both.second(&s.second)?)));
    let (mut squares, mut count, mut least, mut most) = (0.0, 0.0_f64, f64::INFINITY, f64::NEG_INFINITY);
    for (first, second) in places {
        let disparity = first.x - second.x;
        squares += (first.y - second.y).powi(2);
        count += 1.0;
        (least, most) = (disparity.min(least), disparity.max(most));
    }
    ((squares / count.max(1.0)).sqrt(), [least, most])
}

/// A picture by the map of its rectified pixels to raw ones, and 255 where the raw picture was seen.
fn warped(raw: &GrayImage, to_raw: &Homography<f64>) -> (GrayImage, GrayImage) {
    let (width, height) = raw.dimensions();
    let mut valid = GrayImage::new(width, height);
    let picture = GrayImage::from_fn(width, height, |x, y| {
        let place = to_raw.to_first(&Point2::new(x.into(), y.into()));
        let pixel = place.and_then(|p| imageops::interpolate_bilinear(raw, p.x as f32, p.y as f32));
        if pixel.is_some() {
            valid.put_pixel(x, y, Luma([255]));
        }
        pixel.unwrap_or(Luma([0]))
    });
    (picture, valid)
}
