//! What a focus stack tells, on one page in the style of the others.

use super::page::{Kind, caption, escape, figure, table};
use super::{POLICY, explore, percent, svg};
use crate::colour::{ColourScale, viridis};
use crate::live::{STYLE, looks};
use crate::map::quantile;
use image::RgbImage;
use serde_json::{Map, Value, json};
use std::io::{self, Write};
use stereopsis::units::Disparity;

/// What comes after the scripts that both pages have.
const SCRIPT: &str = include_str!("../../live/page/focus.js");
/// The largest number of a frame or a depth in the page's data: one more says that there is no answer.
const MOST_STEPS: u16 = Disparity::NONE.raw() - 1;

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
    /// The focal length, px, where points in space can be shown.
    pub focal_px: Option<f32>,
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
             content=\"width=device-width, initial-scale=1\"><meta http-equiv=\"Content-Security-Policy\" \
             content=\"{POLICY}\"><title>Focus: {0}</title><style>\n{STYLE}{1}\
             </style></head><body>\n<h1>Focus: {0}</h1>\n\
             <p class=\"quiet\">{2} frames of {width} &#215; {height} px</p>\n\
             {3}<div class=\"figures\">",
            escape(self.name),
            include_str!("style.css"),
            self.frames,
            explore::body(),
        )?;
        let mut show = |title: &str, kind, picture: &RgbImage, below: &str| {
            out.write_all(figure(title, kind, picture, below)?.as_bytes())
        };
        let note = "Each pixel as in the frame in which it is sharpest.";
        show("All in focus", Kind::Photograph, self.picture, &caption(note))?;
        let scale = ends(self.index);
        let frame = |t: f32| format!("{:.1}", scale.far_px + t * (scale.near_px - scale.far_px));
        let bar = svg::bar("frames", viridis, frame, NO_NUMBERS);
        let note = "Earlier frames are dark; black: no answer. The colours run from the 2nd to the 98th \
                    percentile of the answers; those of index_colour.png over all frames.";
        show("Sharpest frame", Kind::Map, &scale.picture(self.width(), self.index), &(bar + &caption(note)))?;
        let sure: Vec<_> = self.confidence.iter().map(|&c| if c > 0.0 { c } else { f32::INFINITY }).collect();
        let whole = ColourScale { far_px: 0.0, near_px: 1.0 };
        let bar = svg::bar("confidence", viridis, |t| format!("{t:.2}"), NO_NUMBERS);
        let note = "Sure is bright: the sharpness has one high peak; black: no answer.";
        show("Confidence", Kind::Map, &whole.picture(self.width(), &sure), &(bar + &caption(note)))?;
        if let Some(depth_m) = self.depth_m {
            let near: Vec<_> = depth_m.iter().map(|&z| nearness(z)).collect();
            let scale = ends(&near);
            let at = |t: f32| 1.0 / (scale.far_px + t * (scale.near_px - scale.far_px));
            let metres = |t| format!("{} m", svg::three_digits(at(t)));
            let bar = svg::bar("depth", viridis, metres, NO_NUMBERS);
            let note = "Near is bright; black: no answer.";
            show("Depth", Kind::Map, &scale.picture(self.width(), &near), &(bar + &caption(note)))?;
        }
        writeln!(out, "</div><h2>Figures</h2><figure>{}</figure>", table(&self.figures()))?;
        writeln!(out, "{}</body></html>", explore::with_data(self.data()?, SCRIPT))
    }

    /// What the page's script looks at.
    fn data(&self) -> io::Result<Map<String, Value>> {
        let steps = (MOST_STEPS / u16::try_from(self.frames.max(1)).unwrap_or(u16::MAX)).clamp(1, 256);
        let in_steps = |value: f32| (value.min(f32::from(MOST_STEPS))).round() as u16;
        let answers = self.index.iter().zip(self.confidence).map(|(&index, &confidence)| match index {
            index if index.is_finite() => {
                // The least sure answer is one.
                (in_steps(index * f32::from(steps)), (confidence * 255.0).round().clamp(1.0, 255.0) as u8)
            }
            _ => (Disparity::NONE.raw(), 0),
        });
        let mut data = looks();
        data.insert("name".into(), json!(self.name));
        data.insert("columns".into(), json!(self.width()));
        data.insert("rows".into(), json!(self.picture.height()));
        data.insert("frame_steps".into(), json!(steps));
        data.insert("answers".into(), json!(explore::url_of(self.width(), answers.collect())?));
        // The farthest ones may be at the end of the lens's range, beyond all that is seen.
        let far_m = self.depth_m.and_then(|depth_m| quantile(&sorted(depth_m), 0.98)).unwrap_or(1.0);
        let step_m = 4.0 * far_m / f32::from(MOST_STEPS);
        let depths = self.depth_m.map(|depth_m| {
            let steps = depth_m.iter().map(|&z| if z.is_finite() { in_steps(z / step_m) } else { 0 });
            explore::url_of(self.width(), steps.map(|steps| (steps, 0)).collect())
        });
        data.insert("depth_step_m".into(), json!(step_m));
        data.insert("depths".into(), json!(depths.transpose()?));
        data.insert("focal_px".into(), json!(self.depth_m.and(self.focal_px)));
        Ok(data)
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
            let sorted = sorted(values);
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

/// Colours with numbers on one side alone.
const NO_NUMBERS: Option<fn(f32) -> String> = None;

/// The values that are finite, in their order.
fn sorted(values: &[f32]) -> Vec<f32> {
    let mut sorted: Vec<f32> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_by(f32::total_cmp);
    sorted
}

/// One over a depth, 1/m; infinite where there is none.
fn nearness(depth_m: f32) -> f32 {
    if depth_m.is_finite() && depth_m > 0.0 { 1.0 / depth_m } else { f32::INFINITY }
}

/// The 2nd and the 98th of a hundred of the values that are finite.
fn ends(values: &[f32]) -> ColourScale {
    let sorted = sorted(values);
    let far_px = quantile(&sorted, 0.02).unwrap_or(0.0);
    let near_px = quantile(&sorted, 0.98).unwrap_or(1.0);
    ColourScale { far_px, near_px: near_px.max(far_px * 1.001 + 1e-6) }
}
