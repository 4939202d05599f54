//! Why a pair has few answers.

use super::PairCheck;

/// The flag of what was filled in, which is an answer.
const FILLED: &str = "filled";
/// Shares under this are left out.
const LITTLE: f64 = 0.05;

impl PairCheck {
    /// Why fewer than half of some pixels have an answer, where that is so: what the pictures lack, the flags
    /// of the pixels, by name, and the confidence that was asked for.
    pub fn few_answers<'a>(
        &self,
        answers: usize,
        pixels: usize,
        flags: impl Iterator<Item = (&'a str, usize)>,
        min_confidence: u8,
    ) -> Option<String> {
        if 2 * answers >= pixels {
            return None;
        }
        let of_pixels = |count: usize| count as f64 / pixels as f64;
        let flags = flags.filter(|&(name, _)| name != FILLED).map(|(name, count)| (name, of_pixels(count)));
        let (lacks, flags) = (list(self.lacking()), list(flags));
        let lacks = if lacks.is_empty() { "textured, exposed and in view".to_owned() } else { lacks };
        let asked = match min_confidence {
            0 => String::new(),
            least => format!("; --min-confidence {least} refuses what is less sure"),
        };
        Some(format!(
            "only {:.1} % of the pixels have an answer; the picture is {lacks}; flags: {flags}{asked}",
            100.0 * of_pixels(answers)
        ))
    }

    /// What the pictures lack, by name.
    fn lacking(&self) -> impl Iterator<Item = (&'static str, f64)> {
        // Both pictures have about the same: what the right one alone lacks its camera did not see.
        let right_alone = self.untextured_right > self.untextured + LITTLE;
        let [left, right] = self.exposed;
        let exposed = |i: usize, names: [&'static str; 3]| {
            let is_alike = (left[i] - right[i]).abs() <= LITTLE;
            let shares =
                if is_alike { [(left[i] + right[i]) / 2.0, 0.0, 0.0] } else { [0.0, left[i], right[i]] };
            names.into_iter().zip(shares)
        };
        let texture = [
            ("without texture", self.untextured),
            ("without texture in the right image", if right_alone { self.untextured_right } else { 0.0 }),
        ];
        let over = ["over-exposed", "over-exposed in the left image", "over-exposed in the right image"];
        let under = ["under-exposed", "under-exposed in the left image", "under-exposed in the right image"];
        let shown = [
            ("out of the right camera's view", self.out_of_view.unwrap_or(0.0)),
            ("outside of the masks", self.masked),
        ];
        texture.into_iter().chain(exposed(0, over)).chain(exposed(1, under)).chain(shown)
    }
}

/// Shares that are not too little, in a line.
fn list<'a>(shares: impl Iterator<Item = (&'a str, f64)>) -> String {
    let shares = shares.filter(|(_, share)| *share >= LITTLE);
    shares.map(|(name, share)| format!("{:.0} % {name}", 100.0 * share)).collect::<Vec<_>>().join(", ")
}
