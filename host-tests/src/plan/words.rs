//! A plan as text.

use super::advice::percent;
use super::{Plan, Work};
use std::fmt::Write;

impl Plan {
    /// Lines of text: the rig, the search, depths, the common field, memory, speed, limits and what would
    /// help.
    pub fn describe(&self) -> String {
        let (rig, search) = (&self.rig, &self.search);
        let [across, down] = self.field_of_view_deg;
        let mut text = format!(
            "rig          baseline {:.2} mm, f {:.1} px, images of {} x {} px: {across:.1} x {down:.1} \
             degrees\n",
            1000.0 * rig.baseline_m,
            rig.focal_px,
            rig.width,
            rig.height
        );
        let _ = writeln!(
            text,
            "search       --disparities {} --min-disparity {}",
            search.disparities, search.min_disparity
        );
        let distances: Vec<_> = self.depths.iter().map(|depth| depth.depth_m).collect();
        search.reach(rig).describe(&distances, &mut text);
        if let Some(end_m) = self.end_m {
            let _ = writeln!(text, "             what is beyond {end_m:.2} m is not told");
        }
        let _ = writeln!(
            text,
            "accuracy     within {} % up to {:.2} m: one standard deviation",
            percent(self.wanted.accuracy),
            self.reach_m
        );
        for depth in
            self.depths.first().into_iter().chain(self.depths.last().filter(|_| self.depths.len() > 1))
        {
            let (z, share, wide) = (depth.depth_m, 100.0 * depth.overlap, depth.overlap_m);
            let _ =
                writeln!(text, "both see     at {z:5.2} m  {share:.0} % of the columns, {wide:.2} m across");
        }
        self.takes(&mut text);
        if self.limits.is_empty() {
            text += "limit        none: all that is wanted is had\n";
        }
        for limit in &self.limits {
            let _ = writeln!(text, "limit        {limit}");
        }
        for change in &self.changes {
            let _ = writeln!(text, "change       {change}");
        }
        text
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
            let frames = of_core().map(|work| format!("{:.1}", work.frames_per_s));
            line(text, &format!("    frames/s, {clock_mhz} MHz"), frames);
        }
        *text += "             frames/s at one instruction a clock, without camera and memory waits; RAM is \
                  exact, the rest is scaled\n             from what was measured in an emulator \
                  (docs/performance.md)\n";
    }
}

/// A number of bytes that is told.
type Bytes = fn(&Work) -> usize;

/// A line of a table.
fn line(text: &mut String, name: &str, cells: impl Iterator<Item = String>) {
    let cells: String = cells.map(|cell| format!("{cell:>10}")).collect();
    let _ = writeln!(text, "{name:<22}{cells}");
}
