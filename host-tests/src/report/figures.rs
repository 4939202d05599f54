//! The figures of a run as rows of a table.

use super::{Exposure, Report, percent, svg};
use stereopsis::units::PixelFlags;

impl Report<'_> {
    /// All figures, with names.
    pub(super) fn figures(&self) -> Vec<(String, String)> {
        let s = self.summary;
        let mut rows: Vec<(String, String)> = Vec::new();
        let mut add = |name: &str, value: String| rows.push((name.into(), value));
        let metres =
            |value: Option<f32>| value.map_or("-".to_owned(), |z| format!("{} m", svg::three_digits(z)));
        add("Answers", format!("{} of {} ({})", s.answers, self.map.disparity.len(), percent(s.density)));
        if let Some(c) = s.confidence {
            add("Confidence, least / median / largest", format!("{} / {} / {}", c.min, c.median, c.max));
        }
        if let Some(d) = s.disparity_px {
            add(
                "Disparity, least / median / largest",
                format!("{:.2} / {:.2} / {:.2} px", d.min, d.median, d.max),
            );
        }
        for (flag, name) in PixelFlags::NAMES {
            add(&format!("Pixels with the flag '{name}'"), self.map.flagged(flag).to_string());
        }
        let measured = s
            .noise_sigma
            .map_or("told, or not to be measured".into(), |sigma| format!("{sigma:.1} grey levels"));
        add("Noise", format!("{}, {measured}", s.noise));
        let balanced =
            s.balance.map(|Exposure { gain, offset }| format!("x {gain:.2} {offset:+.1} grey levels"));
        add("Right image, to be exposed as the left one", balanced.unwrap_or("as it came".into()));
        if let Some(rows) = &s.rows {
            add("Rows of the images", rows.summary());
        }
        if let Some(pair) = &s.pair {
            add(
                "Features that both images show",
                format!("{}, {} in rows", pair.matches, pair.matches_in_rows),
            );
            add("Features beyond the search", percent(pair.beyond_search));
            add("The images", pair.lacks());
        }
        if let Some(fault) = s.pair.as_ref().and_then(|pair| pair.fault) {
            add("The pair", fault.to_string());
        }
        if let Some([first, last]) = s.pair.as_ref().and_then(|pair| pair.disparity_px) {
            add("Disparities of matched features", format!("{first:.0} to {last:.0} px"));
        }
        add("Matcher state", format!("{} bytes", s.state_bytes));
        add("Delay", format!("{} lines", s.latency_lines));
        add("Time", format!("{:.2} ms", s.time_ms));
        if let Some(d) = &s.depth {
            add("Focal length", format!("{:.2} px", d.focal_px));
            add("Baseline", format!("{:.1} mm", d.baseline_m * 1000.0));
            add("Offset of the principal points", format!("{:.2} px", d.doffs_px));
            add("Nearest depth that the range can tell", metres(d.nearest_m));
            add("Its standard deviation", metres(d.sigma_nearest_m));
            add("Farthest depth that the range can tell", metres(d.farthest_m));
            add("Its standard deviation", metres(d.sigma_farthest_m));
            if let Some(found) = d.found_m {
                let [least, middle, most] = [found.min, found.median, found.max].map(|z| metres(Some(z)));
                add("Depth found, least / median / largest", format!("{least} / {middle} / {most}"));
            }
        }
        if let Some(a) = s.accuracy {
            add("Pixels that both cameras see", a.seen_by_both.to_string());
            add("Of these answered", percent(a.density));
            add("Of these answers over 2 px off", percent(a.bad2));
            add("RMS error of the others", format!("{:.3} px", a.rms_good_px));
            add("True depth within 3 sigma", percent(a.within_3_sigma));
            if let Some(s) = a.sparsification {
                add("Confidence, from the best order (0 %) to none (100 %)", percent(s.from_oracle()));
            }
            let (m, share) = (a.median_depth_error_m * 1000.0, percent(a.median_depth_error_relative));
            add("Median depth error", format!("{m:.1} mm ({share})"));
            add("Answers at pixels that only the left camera sees", a.answers_where_occluded.to_string());
        }
        rows
    }
}
