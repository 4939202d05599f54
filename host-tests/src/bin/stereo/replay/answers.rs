//! The answers of all frames of which every line came.

use std::collections::BTreeMap;
use stereopsis::units::PixelFlags;
use stereopsis_host::pair::PairCheck;
use stereopsis_host::run::GuardedFrame;

/// What the pixels of whole frames say, counted.
#[derive(Default)]
pub struct Answers {
    answers: usize,
    pixels: usize,
    flags: BTreeMap<&'static str, usize>,
}

impl Answers {
    /// Counts a frame, if all of it came: what did not says nothing of the pictures.
    pub fn add(&mut self, frame: &GuardedFrame) {
        let map = &frame.map;
        if frame.error.is_some() || frame.lost_lines > 0 || frame.damaged_rows > 0 {
            return;
        }
        self.answers += map.answers();
        self.pixels += map.pixels().len();
        for (flag, name) in PixelFlags::NAMES {
            *self.flags.entry(name).or_default() += map.flagged(flag);
        }
    }

    /// Why there are few of them, where there are, by the pair that was looked at.
    pub fn few(&self, check: &PairCheck) -> Option<String> {
        let flags = self.flags.iter().map(|(&name, &count)| (name, count));
        check.few_answers(self.answers, self.pixels, flags, 0)
    }
}
