//! One run on one page: `report.html` holds its pictures and asks for nothing from anywhere.
//!
//! In: the pictures, the map and the [`Summary`] of a run, for a rendered scene its truth and the
//! [`Accuracy`]. Out: HTML that reads on a phone and on paper, in light and dark, in the style of the live
//! page and with its views, cursor and points.

mod accuracy;
mod explore;
mod figures;
mod focus;
mod page;
mod summary;
mod svg;

pub use accuracy::Accuracy;
pub use focus::FocusReport;
pub use summary::{Depth, Exposure, Spread, Summary};

use crate::colour::{
    ColourScale, FLAG_COLOURS, NO_ANSWER, confidence_picture, error_picture, first_reason, flags_picture,
};
use crate::live::STYLE;
use crate::map::DisparityMap;
use crate::obstacles::{self, ObstacleRecord};
use crate::scene::Truth;
use image::{Rgb, RgbImage};
use page::{Kind, caption, escape, figure, table};
use std::io::{self, Write};
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::units::PixelFlags;

/// What the page shows.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// What the left image is called.
    pub left_name: &'a str,
    /// What the right image is called.
    pub right_name: &'a str,
    /// The left image.
    pub left: &'a RgbImage,
    /// The right image.
    pub right: &'a RgbImage,
    /// The results.
    pub map: &'a DisparityMap,
    /// The figures.
    pub summary: &'a Summary,
    /// The rig, when there is a calibration: disparities are given in metres too.
    pub rig: Option<&'a RectifiedRig>,
    /// The truth, when it is known.
    pub truth: Option<&'a Truth>,
    /// What stands in the way and how it is drawn, where it was looked for.
    pub obstacles: Option<(&'a ObstacleRecord, &'a RgbImage)>,
    /// The disparities of the darkest and the brightest colour, where they were asked for; else the answers'
    /// 2nd and 98th percentile.
    pub colours: Option<ColourScale>,
}

/// Errors are shown from minus to plus this, px.
pub const ERROR_LIMIT_PX: f32 = 3.0;

/// What the page's scripts may do: nothing but look at the page.
const POLICY: &str = "default-src 'none'; img-src data: blob:; script-src 'unsafe-inline'; style-src \
                      'unsafe-inline'";

/// What each flag says, in the order of [`PixelFlags::NAMES`].
const MEANINGS: [&str; 8] = [
    "no candidate lies inside the right image",
    "the largest disparity searched won, or the edge of the right picture: the surface may be nearer",
    "its neighbours cost the same, or too little texture in the window",
    "another disparity matches nearly as well",
    "the right image disagrees: occluded or mismatched",
    "too few answers around it are of its surface",
    "answered with the farther one of the answers on both sides of a small gap",
    "a line that it rests on was lost",
];

impl Report<'_> {
    /// Writes the page.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let s = self.summary;
        let title = format!("{} and {}", self.left_name, self.right_name);
        writeln!(
            out,
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
             content=\"width=device-width, initial-scale=1\"><meta http-equiv=\"Content-Security-Policy\" \
             content=\"{POLICY}\"><title>Stereo: {0}</title><style>\n{STYLE}{1}</style></head><body>\n\
             <h1>Stereo: {0}</h1>\n<p class=\"quiet\">{2} \
             &#215; {3} px, disparities {4} to {5}, method {6}, filter {7}, kernel {8}</p>",
            escape(&title),
            include_str!("style.css"),
            s.width,
            s.height,
            s.min_disparity,
            s.min_disparity + s.disparities - 1,
            s.method,
            s.filter,
            s.kernel,
        )?;
        writeln!(out, "<ul class=\"headline\">{}</ul>", self.headline())?;
        for warning in self.summary.warnings() {
            writeln!(out, "<p class=\"warning\">{}</p>", escape(warning))?;
        }
        writeln!(out, "{}<div class=\"figures\">", explore::body())?;
        self.pictures(out)?;
        writeln!(out, "</div>\n<h2>Disparities</h2><figure>")?;
        out.write_all(svg::histogram(self.map, s.min_disparity, s.disparities).as_bytes())?;
        writeln!(out, "</figure>")?;
        if let Some(truth) = self.truth {
            let note = "Of the answers more than 2 px off, while the least sure ones are taken away: what \
                        is left. Below: taken away in the order of their error, the best there is.";
            let curves = svg::sparsification(&Accuracy::judged(self.map, truth));
            writeln!(out, "<h2>Confidence</h2><figure>{curves}{}</figure>", caption(note))?;
        }
        writeln!(out, "<h2>Figures</h2><figure>{}</figure>", table(&self.figures()))?;
        writeln!(out, "{}</body></html>", explore::script(self)?)
    }

    /// The few figures that come first; HTML.
    fn headline(&self) -> String {
        let s = self.summary;
        let threads = match s.threads {
            1 => "for the frame, one thread".to_owned(),
            threads => format!("for the frame, {threads} threads"),
        };
        let mut items = vec![
            (percent(s.density), "of the pixels answered"),
            (format!("{:.1} ms", s.time_ms), threads.as_str()),
            (format!("{:.1} KB", s.state_bytes as f64 / 1000.0), "of matcher state"),
            (s.latency_lines.to_string(), "lines of delay"),
        ];
        if let Some(a) = s.accuracy {
            items.insert(1, (percent(a.bad2), "of the answers over 2 px off"));
            items.insert(2, (format!("{:.3} px", a.rms_good_px), "RMS error of the others"));
        }
        items.iter().map(|(value, what)| format!("<li><b>{value}</b>{what}</li>")).collect()
    }

    fn pictures(&self, out: &mut dyn Write) -> io::Result<()> {
        let colours = self.colours.unwrap_or_else(|| ColourScale::of(self.map));
        let mut show = |title: &str, kind, picture: &RgbImage, below: &str| {
            out.write_all(figure(title, kind, picture, below)?.as_bytes())
        };
        show("Left image", Kind::Photograph, self.left, &caption(self.left_name))?;
        show("Right image", Kind::Photograph, self.right, &caption(self.right_name))?;
        let note = if self.colours.is_some() {
            "Near is bright; black: no answer."
        } else {
            "Near is bright; black: no answer. The colours run from the 2nd to the 98th percentile of the \
             answers."
        };
        let disparity = colours.picture(self.map.width, &self.map.pixels());
        let bar = svg::disparity_bar("disparity", &colours, self.rig);
        show("Disparity", Kind::Map, &disparity, &(bar + &caption(note)))?;
        if let Some(truth) = self.truth {
            let picture = colours.picture(truth.width, &Accuracy::true_disparity_px(truth));
            let bar = svg::disparity_bar("truth", &colours, self.rig);
            show(
                "True disparity",
                Kind::Map,
                &picture,
                &(bar + &caption("The same colours as the answers.")),
            )?;
            let errors = Accuracy::errors_px(self.map, truth);
            let picture = error_picture(truth.width, &errors, ERROR_LIMIT_PX);
            let note =
                "Answer minus truth: blue is too far, orange too near, white is right; black: no answer.";
            show("Error", Kind::Map, &picture, &(svg::error_bar("error", ERROR_LIMIT_PX) + &caption(note)))?;
        }
        let note = "Sure is bright: the second best candidate costs much more, and the answers around \
                    agree; black: no answer.";
        show("Confidence", Kind::Map, &confidence_picture(self.map), &caption(note))?;
        if let Some((record, picture)) = self.obstacles {
            let rows: String = obstacles::COLOURS
                .iter()
                .map(|(colour, meaning)| format!("<tr><th>{}{meaning}</th></tr>\n", swatch(*colour)))
                .collect();
            let decision = caption(&format!("Decision: {}", record.line()));
            let below = format!("{decision}<table>{rows}</table>");
            show("Obstacles", Kind::Photograph, picture, &below)?;
        }
        // The tallest one last: what stands beside another one is as tall as that.
        show("Why pixels have no answer", Kind::Map, &flags_picture(self.map, self.left), &self.legend())?;
        Ok(())
    }

    /// What the colours of the flags mean, with the share of the pixels that each one has; HTML.
    fn legend(&self) -> String {
        let mut counts = [0usize; PixelFlags::NAMES.len()];
        let (mut answered, mut unnamed) = (0usize, 0usize);
        for pixel in 0..self.map.disparity.len() {
            match first_reason(self.map, pixel) {
                Some(reason) => counts[reason] += 1,
                None if self.map.disparity[pixel].is_some() => answered += 1,
                None => unnamed += 1,
            }
        }
        let share = |count: usize| percent(count as f64 / self.map.disparity.len().max(1) as f64);
        let row = |colour, text: String, count| {
            format!("<tr><th>{}{text}</th><td>{}</td></tr>\n", swatch(colour), share(count))
        };
        let mut rows = row(Rgb([0xb0; 3]), "answered: the left image, pale".into(), answered);
        for (i, (_, name)) in PixelFlags::NAMES.iter().enumerate() {
            rows += &row(FLAG_COLOURS[i], format!("{name}: {}", MEANINGS[i]), counts[i]);
        }
        if unnamed > 0 {
            rows += &row(NO_ANSWER, "no reason given".into(), unnamed);
        }
        format!(
            "<table>{rows}</table>{}",
            caption("A pixel with several reasons has the colour of the first.")
        )
    }
}

/// A colour before what it means; HTML.
fn swatch(Rgb([r, g, b]): Rgb<u8>) -> String {
    format!("<span class=\"swatch\" style=\"background:#{r:02x}{g:02x}{b:02x}\"></span>")
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}
