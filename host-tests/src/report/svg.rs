//! Drawings of the report that are lines and text: they scale with the page and follow its colours.

use crate::colour::{ColourScale, diverging, viridis};
use crate::map::DisparityMap;
use crate::sparsification::{Judged, curves};
use image::Rgb;
use std::fmt::Write;
use stereopsis::geometry::camera::RectifiedRig;

/// Width and height of a chart, which is stretched to the page.
const CHART: [f32; 2] = [1000.0, 150.0];

/// The colours of disparities with numbers: px above, metres below where there is a rig. `id` names the
/// drawing in the page.
pub(super) fn disparity_bar(id: &str, scale: &ColourScale, rig: Option<&RectifiedRig>) -> String {
    let at = |t: f32| scale.far_px + t * (scale.near_px - scale.far_px);
    let metres = |rig: &RectifiedRig, px| {
        rig.depth_m(px).map_or("\u{221e}".to_owned(), |z| format!("{} m", three_digits(z)))
    };
    bar(id, viridis, |t| format!("{:.1} px", at(t)), rig.map(|rig| move |t| metres(rig, at(t))))
}

/// The colours of errors from `-limit` to `+limit`, px.
pub(super) fn error_bar(id: &str, limit: f32) -> String {
    let above = |t: f32| format!("{:.1} px", (2.0 * t - 1.0) * limit);
    bar(id, |t| diverging(2.0 * t - 1.0), above, None::<fn(f32) -> String>)
}

/// Colours with numbers above and below them.
pub(super) fn bar(
    id: &str,
    colour: impl Fn(f32) -> Rgb<u8>,
    above: impl Fn(f32) -> String,
    below: Option<impl Fn(f32) -> String>,
) -> String {
    let height = if below.is_some() { 66 } else { 46 };
    let mut svg = format!(
        "<svg viewBox=\"0 0 460 {height}\" role=\"img\" aria-label=\"Colours and their \
         values\"><defs><linearGradient id=\"colours-{id}\">"
    );
    for step in 0..=16 {
        let t = step as f32 / 16.0;
        let [r, g, b] = colour(t).0;
        let _ = write!(svg, "<stop offset=\"{t}\" stop-color=\"#{r:02x}{g:02x}{b:02x}\"/>");
    }
    let _ = write!(
        svg,
        "</linearGradient></defs><rect x=\"30\" y=\"20\" width=\"400\" height=\"20\" \
         fill=\"url(#colours-{id})\" rx=\"2\"/>"
    );
    for step in 0..=4 {
        let t = step as f32 / 4.0;
        let x = 30.0 + 400.0 * t;
        text(&mut svg, x, 14.0, &above(t));
        if let Some(below) = &below {
            text(&mut svg, x, 58.0, &below(t));
        }
    }
    svg.push_str("</svg>");
    svg
}

/// How many answers have which disparity, over the whole search range.
pub(super) fn histogram(map: &DisparityMap, min_disparity: u16, disparities: u16) -> String {
    const BINS: usize = 64;
    let bins = BINS.min(usize::from(disparities));
    let (first, range) = (f32::from(min_disparity), f32::from(disparities));
    let mut counts = vec![0usize; bins];
    for px in map.disparity.iter().filter_map(|d| d.to_f32()) {
        let at = ((px - first) / range * bins as f32).max(0.0) as usize;
        counts[at.min(bins - 1)] += 1;
    }
    let highest = counts.iter().copied().max().unwrap_or(0);
    let step = CHART[0] / bins as f32;
    let mut columns = String::new();
    for (i, &count) in counts.iter().enumerate() {
        let height = CHART[1] * count as f32 / highest.max(1) as f32;
        let _ = write!(
            columns,
            "<rect class=\"column\" x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" \
             height=\"{height:.1}\"><title>{:.1} px: {count} pixels</title></rect>",
            step * i as f32,
            CHART[1] - height,
            step * 0.9,
            first + range * (i as f32 + 0.5) / bins as f32,
        );
    }
    let note = match map.answers() {
        0 => "no pixel has an answer".to_owned(),
        answers => {
            format!("highest column: {:.1} % of the answers", 100.0 * highest as f64 / answers as f64)
        }
    };
    chart("Histogram of the disparities", &note, &columns, |t| format!("{:.0} px", first + t * range))
}

/// A drawing as wide as the page, of [`CHART`] units, with a note above and five numbers below it that keep
/// their size.
fn chart(label: &str, note: &str, drawing: &str, below: impl Fn(f32) -> String) -> String {
    let numbers: String = (0..=4).map(|tick| format!("<span>{}</span>", below(tick as f32 / 4.0))).collect();
    let [width, height] = CHART;
    format!(
        "<figcaption>{note}</figcaption><svg class=\"chart\" viewBox=\"0 0 {width} {height}\" \
         preserveAspectRatio=\"none\" role=\"img\" aria-label=\"{label}\">{drawing}</svg><p \
         class=\"numbers\">{numbers}</p>"
    )
}

/// The share of bad answers among those that are left, over the share that was taken away: in the order of
/// confidence, and in that of the error.
pub(super) fn sparsification(answers: &[Judged]) -> String {
    const STEPS: usize = 100;
    let [found, oracle] = curves(answers, STEPS);
    let highest = found.iter().copied().fold(1e-4, f64::max);
    let points = |curve: &[f64]| -> String {
        let point = |(step, &share): (usize, &f64)| {
            format!(
                "{:.1},{:.1} ",
                CHART[0] * step as f32 / STEPS as f32,
                CHART[1] * (1.0 - share / highest) as f32
            )
        };
        curve.iter().enumerate().map(point).collect()
    };
    let mut lines = String::new();
    for (curve, style) in [(&found, ""), (&oracle, " stroke-dasharray=\"4 3\"")] {
        let points = points(curve);
        let _ = write!(lines, "<polyline class=\"curve\"{style} points=\"{}\"/>", points.trim_end());
    }
    let note = format!("at most {:.2} %", 100.0 * highest);
    chart("Bad answers that are left", &note, &lines, |t| format!("{:.0} %", 100.0 * t))
}

fn text(svg: &mut String, x: f32, y: f32, content: &str) {
    let _ = write!(svg, "<text x=\"{x:.0}\" y=\"{y:.0}\" text-anchor=\"middle\">{content}</text>");
}

/// A length with three digits that count.
pub(super) fn three_digits(value: f32) -> String {
    let before_point = value.abs().max(1e-3).log10().floor() as i32 + 1;
    format!("{value:.*}", (3 - before_point).clamp(0, 5) as usize)
}

#[cfg(test)]
mod tests {
    use super::{histogram, three_digits};
    use crate::map::DisparityMap;
    use stereopsis::units::Disparity;

    #[test]
    fn a_histogram_of_nothing_has_no_share() {
        let mut map = DisparityMap::new(4, 1);
        let drawn = histogram(&map, 0, 16);
        assert!(drawn.contains("<figcaption>no pixel has an answer</figcaption>"), "{drawn}");
        map.disparity[..3].copy_from_slice(&[1, 1, 9].map(Disparity::from_pixels));
        let drawn = histogram(&map, 0, 16);
        assert!(drawn.contains("<figcaption>highest column: 66.7 % of the answers</figcaption>"), "{drawn}");
        assert_eq!(drawn.matches("height=\"75.0\"").count(), 1, "{drawn}");
    }

    #[test]
    fn lengths_have_three_digits() {
        assert_eq!(
            [0.01234, 0.5, 1.0, 12.34, 1234.5].map(three_digits),
            ["0.0123", "0.500", "1.00", "12.3", "1234"]
        );
    }
}
