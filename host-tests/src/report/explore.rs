//! The run itself in its page: pictures of its numbers, which the scripts of the live page look at.

use super::page::{Kind, fitted, png_url};
use super::{Accuracy, Report};
use crate::live::{SHARED, cameras, in_script, looks};
use image::{Rgb, RgbImage};
use serde_json::{Map, Value, json};
use std::io;
use stereopsis::units::Disparity;

/// The views, the sliders, and what they say.
const BODY: &str = include_str!("../../live/page/report.html");
/// What comes after the scripts that both pages have.
const SCRIPT: &str = include_str!("../../live/page/report.js");
/// Deviations are told in so many parts of a pixel.
const SIGMA_PARTS: f32 = 1024.0;

/// The part of the page that is explored; HTML.
pub(super) fn body() -> &'static str {
    BODY
}

/// The scripts with the run's data; HTML.
pub(super) fn script(report: &Report<'_>) -> io::Result<String> {
    Ok(with_data(data(report)?, SCRIPT))
}

/// The scripts that both pages have, between data and the script that comes after them; HTML.
pub(super) fn with_data(data: Map<String, Value>, script: &str) -> String {
    let (data, shared) = (in_script(data), SHARED.join("\n"));
    format!("<script>\n\"use strict\";\nconst DATA = {data};\n{shared}\n{script}</script>\n")
}

fn data(report: &Report<'_>) -> io::Result<Map<String, Value>> {
    let map = report.map;
    let answers = map.disparity.iter().zip(&map.confidence).map(|(d, &confidence)| (d.raw(), confidence));
    let sigmas = map.sigma_px.iter().map(|sigma| (sigma * SIGMA_PARTS).round() as u16);
    let notes = sigmas.zip(&map.flags).map(|(sigma, flags)| (sigma, flags.bits()));
    let truth = report.truth.map(|truth| {
        let errors_px = Accuracy::errors_px(map, truth);
        // Steps are too coarse to tell again which answers are bad.
        let is_bad = errors_px.into_iter().map(|px| u8::from(px.is_finite() && px.abs() > Accuracy::BAD_PX));
        let pixels = Accuracy::true_disparity_px(truth).into_iter().zip(&truth.occluded);
        let steps =
            pixels.map(|(px, is_hidden)| if *is_hidden { Disparity::NONE.raw() } else { in_steps(px) });
        steps.zip(is_bad).collect()
    });
    let mut data = looks();
    data.insert("names".into(), json!([report.left_name, report.right_name]));
    data.insert("columns".into(), json!(map.width));
    data.insert("rows".into(), json!(map.height));
    data.insert("rig".into(), json!(report.rig.map(cameras)));
    data.insert("answers".into(), json!(url_of(map.width, answers.collect())?));
    data.insert("notes".into(), json!(url_of(map.width, notes.collect())?));
    data.insert("truth".into(), json!(truth.map(|truth| url_of(map.width, truth)).transpose()?));
    Ok(data)
}

/// A disparity of px in the steps of the core; no answer for what is not finite.
fn in_steps(px: f32) -> u16 {
    if px.is_finite() { (px * f32::from(Disparity::ONE)).round() as u16 } else { Disparity::NONE.raw() }
}

/// Numbers of two bytes and of one as a picture, `width` in a row: the high byte is red, the low one green,
/// and the other number blue.
pub(super) fn url_of(width: usize, numbers: Vec<(u16, u8)>) -> io::Result<String> {
    let rows = numbers.len() / width.max(1);
    let mut picture = RgbImage::new(width as u32, rows as u32);
    for (pixel, (number, other)) in picture.pixels_mut().zip(numbers) {
        let [high, low] = number.to_be_bytes();
        *pixel = Rgb([high, low, other]);
    }
    png_url(&fitted(Kind::Map, &picture))
}
