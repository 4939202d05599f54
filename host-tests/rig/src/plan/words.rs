//! A plan as text.

use super::advice::percent;
use super::{Plan, Work};
use crate::calibration::Reach;
use std::fmt::Write;
use stereopsis::matching::Config;

impl Plan {
    /// Lines of text: the rig, the search, depths, the common field, memory, speed, limits and what would
    /// help.
    pub fn describe(&self) -> String {
        let rig = &self.rig;
        let [across, down] = self.field_of_view_deg;
        let mut text = format!(
            "rig          baseline {:.2} mm, f {:.1} px, images of {} x {} px: {across:.1} x {down:.1} \
             degrees\n",
            1000.0 * rig.baseline_m,
            rig.focal_px,
            rig.width,
            rig.height
        );
        self.describe_depths(&mut text);
        self.takes(&mut text);
        self.describe_limits(&mut text);
        text
    }

    /// Lines of text: the search, and the depths that it tells.
    pub fn describe_depths(&self, text: &mut String) {
        let (rig, search) = (&self.rig, &self.search);
        let _ = writeln!(
            text,
            "search       --disparities {} --min-disparity {}",
            search.disparities, search.min_disparity
        );
        let distances: Vec<_> = self.depths.iter().map(|depth| depth.depth_m).collect();
        search.reach(rig).describe(&distances, text);
        accuracy(self.wanted.accuracy, self.reach_m.min(search.reach(rig).farthest_m()), text);
        for depth in
            self.depths.first().into_iter().chain(self.depths.last().filter(|_| self.depths.len() > 1))
        {
            let (z, share, wide) = (depth.depth_m, 100.0 * depth.overlap, depth.overlap_m);
            let _ =
                writeln!(text, "both see     at {z:5.2} m  {share:.0} % of the columns, {wide:.2} m across");
        }
    }

    /// Lines of text: what limits the rig, and what would help.
    pub fn describe_limits(&self, text: &mut String) {
        if self.limits.is_empty() {
            *text += "limit        none: all that is wanted is had\n";
        }
        for limit in &self.limits {
            let _ = writeln!(text, "limit        {limit}");
        }
        for change in &self.changes {
            let _ = writeln!(text, "change       {change}");
        }
    }

    /// What the methods take: memory, then frames in a second on each core.
    fn takes(&self, text: &mut String) {
        let bytes: [(&str, Bytes); 3] = [
            ("  RAM, bytes", |work| work.ram_bytes),
            ("  stack, bytes", |work| work.stack_bytes as usize),
            ("  flash, bytes", |work| work.flash_bytes as usize),
        ];
        line(text, "estimates", self.wanted.methods.iter().map(|name| (*name).to_owned()));
        for (name, of) in bytes {
            // The most of all cores.
            let of_method =
                |method: &str| self.work.iter().filter(|work| work.method == method).map(of).max();
            let cells = self.wanted.methods.iter().map(|name| of_method(name).unwrap_or(0).to_string());
            line(text, name, cells);
        }
        for &(core, clock_mhz) in &self.wanted.cores {
            let of_core = || self.work.iter().filter(|work| work.core == core);
            let millions = of_core().map(|work| format!("{:.1}", work.instructions / 1e6));
            line(text, &format!("  {core}, million instr."), millions);
            // Of a frame that takes seconds the tenths say nothing.
            let frames = of_core().map(|Work { frames_per_s, .. }| {
                if *frames_per_s < 1.0 { format!("{frames_per_s:.2}") } else { format!("{frames_per_s:.1}") }
            });
            line(text, &format!("    frames/s, {clock_mhz} MHz"), frames);
        }
        let memory = if self.work.iter().all(|work| work.ram_is_measured) {
            "RAM as measured, of the core that takes most"
        } else {
            "RAM at most, on any core"
        };
        let _ = writeln!(
            text,
            "{:13}frames/s at one instruction a clock, without camera and memory waits; {memory};\n{:13}the \
             rest is scaled from what was measured in an emulator (docs/performance.md)",
            "", ""
        );
    }
}

/// Lines of text of a rig whose search is given: how well its depths are told, what limits it at either end,
/// and what would help.
pub fn describe_search(reach: &Reach, baseline_m: f64, share: f64, text: &mut String) {
    let (within_m, farthest_m) = (reach.within_m(share), reach.farthest_m());
    let (aim, mm) = (percent(share), 1000.0 * baseline_m);
    let more = reach.disparities.saturating_mul(2).min(Config::MOST_DISPARITIES);
    let wider = Reach { disparities: more, ..*reach };
    let begins = |reach: &Reach| reach.nearest_m().map(|near| format!("would begin at {near:.3} m"));
    if let Some(nearest_m) = reach.nearest_m() {
        accuracy(share, within_m.min(farthest_m), text);
        let _ = writeln!(text, "limit        the search: depths are told from {nearest_m:.3} m on");
    }
    let shorter = Reach { fb_px_m: reach.fb_px_m / 2.0, ..*reach };
    let help = if more > reach.disparities {
        begins(&wider).map(|begins| format!("--disparities {more} {begins}"))
    } else {
        begins(&shorter).map(|begins| format!("a baseline of {:.0} mm {begins}", mm / 2.0))
    };
    if let Some(help) = help {
        let _ = writeln!(text, "change       {help}");
    }
    if farthest_m < within_m {
        let least = reach.min_disparity;
        let _ =
            writeln!(text, "limit        the search: nothing lies beyond {farthest_m:.3} m, at {least} px");
        return;
    }
    let _ = writeln!(text, "limit        the accuracy: beyond {within_m:.2} m the deviation is over {aim} %");
    let (longer, farther) = (2.0 * mm, 2.0 * within_m);
    let _ =
        writeln!(text, "change       a baseline of {longer:.0} mm would reach {farther:.2} m within {aim} %");
}

/// How far depths are told how well.
fn accuracy(share: f64, within_m: f64, text: &mut String) {
    let aim = percent(share);
    let _ = writeln!(text, "accuracy     within {aim} % up to {within_m:.2} m: one standard deviation");
}

/// A number of bytes that is told.
type Bytes = fn(&Work) -> usize;

/// A line of a table.
fn line(text: &mut String, name: &str, cells: impl Iterator<Item = String>) {
    let cells: String = cells.map(|cell| format!("{cell:>10}")).collect();
    let _ = writeln!(text, "{name:<22}{cells}");
}
