//! What a replay came to, counted.

use serde::Serialize;
use std::fmt::Write;
use std::path::Path;
use stereopsis::pipeline::FaultCounters;
use stereopsis::units::PixelFlags;
use stereopsis_host::command_line::one_line;
use stereopsis_host::pair::PairCheck;
use stereopsis_host::rows::Rows;

/// The replay in figures.
#[derive(Serialize)]
pub struct Summary {
    /// The program's version.
    pub version: &'static str,
    /// The command line, word by word.
    pub command: Vec<String>,
    /// What was read: the recording, then the calibration's files.
    pub inputs: Vec<String>,
    pub width: u16,
    pub height: u16,
    pub method: &'static str,
    pub disparities: u16,
    pub min_disparity: u16,
    pub frames: u32,
    pub whole_frames: u32,
    pub damaged_frames: u32,
    pub broken_frames: u32,
    pub failed_frames: u32,
    /// Frames that were smoothed against noise.
    pub noisy_frames: u32,
    /// Frames whose right image was brought to the left one's exposure.
    pub balanced_frames: u32,
    pub recording_was_cut: bool,
    /// The first frame, from 1, whose time stamp is of before that of the frame before.
    pub time_went_back_at: Option<u32>,
    pub counters: Counters,
    /// How well the images' rows agree; absent when too few features match.
    pub rows: Option<Rows>,
    /// What features say of the pair and of the search, by the frame of the first ones that has the most.
    pub pair: Option<PairCheck>,
}

/// [`FaultCounters`], by name.
#[derive(Serialize)]
pub struct Counters {
    frames_skipped: u32,
    frames_stale: u32,
    restarts: u32,
    rows: u32,
    rows_damaged: u32,
    lines: u32,
    lines_dropped: u32,
    lines_repeated: u32,
    lines_torn: u32,
    lines_late: u32,
    lines_stale: u32,
    lines_failed: u32,
    lines_timed_out: u32,
    lines_short: u32,
    syncs_lost: u32,
}

impl From<FaultCounters> for Counters {
    fn from(c: FaultCounters) -> Self {
        Self {
            frames_skipped: c.frames_skipped,
            frames_stale: c.frames_stale,
            restarts: c.restarts,
            rows: c.rows,
            rows_damaged: c.rows_damaged,
            lines: c.lines,
            lines_dropped: c.lines_dropped,
            lines_repeated: c.lines_repeated,
            lines_torn: c.lines_torn,
            lines_late: c.lines_late,
            lines_stale: c.lines_stale,
            lines_failed: c.lines_failed,
            lines_timed_out: c.lines_timed_out,
            lines_short: c.lines_short,
            syncs_lost: c.syncs_lost,
        }
    }
}

impl Summary {
    /// What is to be known about the pair and the recording, a line each.
    pub fn remarks(&self) -> impl Iterator<Item = String> {
        let warnings = self.pair.iter().flat_map(|pair| &pair.warnings);
        let cut = "note: the recording ends within a record; what is before it was played";
        let back = self.time_went_back_at.map(|frame| {
            format!("note: time stamps go back at frame {frame}; frames were played in the order of the file")
        });
        let notes = self.recording_was_cut.then(|| cut.to_owned()).into_iter().chain(back);
        warnings.map(|warning| format!("warning: {warning}")).chain(notes)
    }

    /// The figures in a few lines.
    pub fn figures(&self, out: &Path) -> String {
        let mut text = format!(
            "{} frames of {} x {} px, method {}\n",
            self.frames, self.width, self.height, self.method
        );
        let _ = writeln!(
            text,
            "{} whole, {} with rows flagged as {}, {} broken off, {} that did not begin",
            self.whole_frames,
            self.damaged_frames,
            PixelFlags::NAMES.last().map_or("", |(_, name)| name),
            self.broken_frames,
            self.failed_frames
        );
        if self.noisy_frames > 0 {
            let _ = writeln!(text, "{} smoothed against noise", self.noisy_frames);
        }
        if self.balanced_frames > 0 {
            let _ =
                writeln!(text, "{} with the right image in the left one's exposure", self.balanced_frames);
        }
        let _ = writeln!(text, "results are in {}", one_line(&out.display().to_string()));
        text
    }
}
