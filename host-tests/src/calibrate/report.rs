//! The residuals of a calibration, drawn.

use super::coverage::{CELLS, Coverage};
use super::{Calibrated, View, ViewFigures};
use crate::live::STYLE;
use crate::matches_picture::{line, side_by_side, square};
use image::{Rgb, RgbImage};
use std::fmt::Write;

/// How many times longer than they are residuals are drawn.
pub const LONGER: f64 = 50.0;

const CORNER: Rgb<u8> = Rgb([80, 200, 255]);
const RESIDUAL: Rgb<u8> = Rgb([255, 160, 40]);

/// Both pictures of a view, half as bright: a square at every corner, and from it a line to where the corner
/// would be were its residual [`LONGER`] times as long.
pub fn picture(left: &RgbImage, right: &RgbImage, view: &View, figures: &ViewFigures) -> RgbImage {
    let (mut picture, beside) = side_by_side(left, right);
    for (camera, begin) in [(0, 0), (1, beside)] {
        for (corner, residual) in view.corners[camera].iter().zip(&figures.residuals[camera]) {
            let end = corner + LONGER * residual;
            let [from, to] = [corner, &end].map(|p| [(p.x + f64::from(begin)) as f32, p.y as f32]);
            line(&mut picture, from, to, RESIDUAL);
            square(&mut picture, from, CORNER);
        }
    }
    picture
}

/// What the colours of [`map`] mean.
const SHADES: &str = "The stronger the colour of a part, the more corners it holds, up to 20; a part without \
                      colour holds none.";
/// A part with so many corners has the strongest colour.
const MANY: u32 = 20;

/// The cells of a picture as a drawing with a name: the stronger coloured the more corners they hold, and not
/// at all without any.
fn map(name: &str, coverage: &Coverage) -> String {
    let (across, down) = (CELLS[0] * 30, CELLS[1] * 30);
    let mut svg = format!(
        "<svg viewBox=\"0 0 {across} {down}\" width=\"{across}\" role=\"img\" aria-label=\"{name}\">"
    );
    for (y, row) in coverage.corners.iter().enumerate() {
        for (x, &count) in row.iter().enumerate() {
            let share = f64::from(count.min(MANY)) / f64::from(MANY);
            let fill = if count == 0 { 0.0 } else { 0.25 + 0.75 * share };
            let _ = write!(
                svg,
                "<rect x=\"{}\" y=\"{}\" width=\"30\" height=\"30\" class=\"column\" \
                 fill-opacity=\"{fill:.2}\" stroke=\"var(--line)\"><title>{count} corners</title></rect>",
                30 * x,
                30 * y
            );
        }
    }
    svg + "</svg>"
}

/// One page over all views: `reached` is where boards were, `advice` what would make it better, `names` are
/// the left and the right picture's, `files` those of the drawings.
pub fn page(
    found: &Calibrated,
    reached: &[Coverage; 2],
    advice: &[String],
    names: &[[String; 2]],
    files: &[String],
) -> String {
    let escape = |text: &str| {
        text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
    };
    let mut text = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\"><title>Calibration</title><style>\n{STYLE}{}</style>\
         </head><body>\n<h1>Calibration from {} views</h1>\n<p class=\"quiet\">Residuals are drawn {LONGER} \
         times as long as they are.</p>\n<ul class=\"headline\"><li><b>{:.3} px</b>re-projection error of \
         all corners (root mean square)</li><li><b>{:.3} px</b>of the left camera by itself</li>\
         <li><b>{:.3} px</b>of the right one</li></ul>\n",
        include_str!("../report/style.css"),
        found.views.len(),
        found.rms_px,
        found.alone_px[0],
        found.alone_px[1],
    );
    let _ = writeln!(text, "<h2>Parameters</h2>\n<pre>{}</pre>", escape(&found.words()));
    if !advice.is_empty() {
        let items: String = advice.iter().map(|advice| format!("<li>{}</li>\n", escape(advice))).collect();
        let _ = writeln!(text, "<h2>What would make it better</h2>\n<ul>\n{items}</ul>");
    }
    text += "<h2>Where boards were</h2>\n<div class=\"figures\">";
    for (name, coverage) in ["left", "right"].iter().zip(reached) {
        let _ = writeln!(
            text,
            "<figure>{}<figcaption>The {name} picture: corners in {:.0} % of its parts.</figcaption>\
             </figure>",
            map(&format!("How many corners each part of the {name} picture holds"), coverage),
            100.0 * coverage.share()
        );
    }
    let [across, up] = found.tilts_deg();
    let _ = writeln!(
        text,
        "</div><p>{SHADES}</p><p>Boards are tilted by {across:.0} degrees to the left and right, and by \
         {up:.0} up and down (root mean square).</p>\n<h2>Views</h2>"
    );
    text += "<figure class=\"scroll views\" tabindex=\"0\" role=\"region\" aria-label=\"The views\"><table>\
             <tr><th scope=\"col\">left</th><th scope=\"col\">right</th><th scope=\"col\">left, px</th><th \
             scope=\"col\">right, px</th><th scope=\"col\">distance, m</th><th></th></tr>\n";
    let outliers = found.outliers();
    for (i, (view, [left, right])) in found.views.iter().zip(names).enumerate() {
        let remark = if outliers.contains(&i) { "fits badly" } else { "" };
        let _ = writeln!(
            text,
            "<tr><td>{}</td><td>{}</td><td>{:.3}</td><td>{:.3}</td><td>{:.3}</td><td>{remark}</td></tr>",
            escape(left),
            escape(right),
            view.rms_px[0],
            view.rms_px[1],
            view.distance_m
        );
    }
    text += "</table></figure>\n<div class=\"figures\">\n";
    for (file, [left, right]) in files.iter().zip(names) {
        let (file, left, right) = (escape(file), escape(left), escape(right));
        let _ = writeln!(
            text,
            "<figure><img src=\"{file}\" alt=\"residuals of {left} and {right}\"><figcaption>{left}, \
             {right}</figcaption></figure>"
        );
    }
    text + "</div></body></html>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drawing_has_a_name_and_shades_by_corners() {
        let mut coverage = Coverage { corners: [[0; CELLS[0]]; CELLS[1]] };
        coverage.corners[0][..3].copy_from_slice(&[1, MANY, 2 * MANY]);
        let drawn = map("a name", &coverage);
        assert!(drawn.contains(" role=\"img\" aria-label=\"a name\">"), "{drawn}");
        let shades: Vec<_> = drawn.split("fill-opacity=\"").skip(1).map(|rest| &rest[..4]).collect();
        assert_eq!(shades[..4], ["0.29", "1.00", "1.00", "0.00"]);
        assert!(SHADES.contains(&format!("up to {MANY};")));
    }
}
