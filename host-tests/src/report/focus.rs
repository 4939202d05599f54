//! What a focus stack tells, on one page in the style of the others.

use super::page::{Kind, caption, escape, figure, table};
use super::{percent, svg};
use crate::colour::{ColourScale, viridis};
use crate::live::STYLE;
use crate::map::quantile;
use image::RgbImage;
use std::io::{self, Write};

/// What the page of a focus stack shows. Maps are row by row, as wide as the picture.
#[derive(Clone, Copy, Debug)]
pub struct FocusReport<'a> {
    /// What the stack is called.
    pub name: &'a str,
    /// How many frames it has.
    pub frames: usize,
    /// Each pixel as in the frame in which it is sharpest.
    pub picture: &'a RgbImage,
    /// Those frames, from 1; infinite where there is no answer.
    pub index: &'a [f32],
    /// How sure that is, 0 to 1.
    pub confidence: &'a [f32],
    /// Depths, m, infinite where there is none; of a lens whose positions are known.
    pub depth_m: Option<&'a [f32]>,
}

impl FocusReport<'_> {
    /// The frames in colours, the first one dark.
    pub fn index_colour(&self) -> RgbImage {
        self.index_scale().picture(self.width(), self.index)
    }

    /// Writes the page.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let (width, height) = self.picture.dimensions();
        writeln!(
            out,
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
             content=\"width=device-width, initial-scale=1\"><title>Focus: {0}</title><style>\n{STYLE}{1}\
             </style></head><body>\n<h1>Focus: {0}</h1>\n\
             <p class=\"quiet\">{2} frames of {width} &#215; {height} px</p>\n\
             <div class=\"figures\">",
            escape(self.name),
            include_str!("style.css"),
            self.frames,
        )?;
        let mut show = |title: &str, kind, picture: &RgbImage, below: &str| {
            out.write_all(figure(title, kind, picture, below)?.as_bytes())
        };
        let note = "Each pixel as in the frame in which it is sharpest.";
        show("All in focus", Kind::Photograph, self.picture, &caption(note))?;
        let last = self.frames as f32;
        let bar = svg::bar(
            "frames",
            viridis,
            |t| format!("{:.1}", 1.0 + t * (last - 1.0)),
            None::<fn(f32) -> String>,
        );
        let note = "The first frame is dark; black: no answer.";
        show("Sharpest frame", Kind::Map, &self.index_colour(), &(bar + &caption(note)))?;
        let sure: Vec<_> = self.confidence.iter().map(|&c| if c > 0.0 { c } else { f32::INFINITY }).collect();
        let whole = ColourScale { far_px: 0.0, near_px: 1.0 };
        let note = "Sure is bright; black: no answer.";
        show("Confidence", Kind::Map, &whole.picture(self.width(), &sure), &caption(note))?;
        if let Some(depth_m) = self.depth_m {
            let near: Vec<_> = depth_m.iter().map(|&z| nearness(z)).collect();
            let scale = ends(&near);
            let at = |t: f32| 1.0 / (scale.far_px + t * (scale.near_px - scale.far_px));
            let metres = |t| format!("{} m", svg::three_digits(at(t)));
            let bar = svg::bar("depth", viridis, metres, None::<fn(f32) -> String>);
            let note = "Near is bright; black: no answer.";
            show("Depth", Kind::Map, &scale.picture(self.width(), &near), &(bar + &caption(note)))?;
        }
        writeln!(out, "</div><h2>Figures</h2><figure>{}</figure>", table(&self.figures()))?;
        writeln!(out, "</body></html>")
    }

    fn width(&self) -> usize {
        self.picture.width() as usize
    }

    fn index_scale(&self) -> ColourScale {
        ColourScale { far_px: 1.0, near_px: (self.frames as f32).max(2.0) }
    }

    fn figures(&self) -> Vec<(String, String)> {
        let answered = self.index.iter().filter(|index| index.is_finite()).count();
        let share = answered as f64 / self.index.len().max(1) as f64;
        let mut rows = vec![("In focus in one of the frames".to_owned(), percent(share))];
        let mut spread = |what: &str, values: &[f32], unit: &str| {
            let mut sorted: Vec<f32> = values.iter().copied().filter(|value| value.is_finite()).collect();
            sorted.sort_by(f32::total_cmp);
            let all =
                [0.02, 0.5, 0.98].map(|share| quantile(&sorted, share).map_or("-".into(), svg::three_digits));
            rows.push((
                format!("{what}, of 100 the 2nd / median / 98th"),
                format!("{}{unit}", all.join(" / ")),
            ));
        };
        spread("Sharpest frame", self.index, "");
        if let Some(depth_m) = self.depth_m {
            spread("Depth", depth_m, " m");
        }
        rows
    }
}

/// One over a depth, 1/m; infinite where there is none.
fn nearness(depth_m: f32) -> f32 {
    if depth_m.is_finite() && depth_m > 0.0 { 1.0 / depth_m } else { f32::INFINITY }
}

/// The 2nd and the 98th of a hundred of the values that are finite.
fn ends(values: &[f32]) -> ColourScale {
    let mut sorted: Vec<f32> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_by(f32::total_cmp);
    let far_px = quantile(&sorted, 0.02).unwrap_or(0.0);
    let near_px = quantile(&sorted, 0.98).unwrap_or(1.0);
    ColourScale { far_px, near_px: near_px.max(far_px * 1.001 + 1e-6) }
}
