//! How right answers are.

use serde::Serialize;

/// Shares of the scored pixels of a scene, 0 to 1.
#[derive(Clone, Copy, Default, PartialEq, Debug, Serialize)]
pub struct Score {
    /// Answers among the scored pixels.
    pub density: f64,
    /// Those among the answers that are over [`Score::BAD_PX`] off.
    pub bad2: f64,
    /// Scored pixels with such an answer, or none.
    pub missed: f64,
}

impl Score {
    /// An answer off by more than this is bad, px.
    pub const BAD_PX: f32 = 2.0;

    /// Compares answers in px, `None` or infinite where there is none, with a truth that is 0 where a pixel
    /// is not scored. `None` when no pixel is scored.
    pub fn of(answers: impl IntoIterator<Item = Option<f32>>, truth: &[f32]) -> Option<Self> {
        let (mut scored, mut answered, mut good) = (0u32, 0u32, 0u32);
        for (answer, &truth) in answers.into_iter().zip(truth).filter(|(_, truth)| **truth > 0.0) {
            scored += 1;
            if let Some(px) = answer.filter(|px| px.is_finite()) {
                answered += 1;
                good += u32::from((px - truth).abs() <= Self::BAD_PX);
            }
        }
        let share = |part: u32, whole: u32| f64::from(part) / f64::from(whole.max(1));
        let (density, bad2) = (share(answered, scored), share(answered - good, answered));
        (scored > 0).then(|| Self { density, bad2, missed: share(scored - good, scored) })
    }

    /// The mean of several scenes, which count alike; all zero of none. That of the share of wrong answers is
    /// of the scenes that have answers.
    pub fn mean(of: &[Self]) -> Self {
        Self {
            density: mean(of.iter().map(|s| s.density)),
            bad2: mean(of.iter().filter(|s| s.has_answers()).map(|s| s.bad2)),
            missed: mean(of.iter().map(|s| s.missed)),
        }
    }

    /// Whether a scored pixel has an answer.
    pub fn has_answers(&self) -> bool {
        self.density > 0.0
    }
}

/// The mean of some numbers; zero of none.
pub fn mean(of: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = of.fold((0.0, 0), |(sum, count), number| (sum + number, count + 1));
    sum / f64::from(count.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_of_the_scored_pixels() {
        let truth = [10.0, 10.0, 10.0, 10.0, 0.0];
        let score = Score::of([Some(12.0), Some(12.1), None, Some(f32::INFINITY), Some(10.0)], &truth);
        assert_eq!(score, Some(Score { density: 0.5, bad2: 0.5, missed: 0.75 }));
        assert_eq!(Score::of([None; 5], &truth), Some(Score { density: 0.0, bad2: 0.0, missed: 1.0 }));
        assert_eq!(Score::of([Some(1.0)], &[0.0]), None);
    }

    #[test]
    fn scenes_count_alike() {
        let scores =
            [Score { density: 1.0, bad2: 0.2, missed: 0.2 }, Score { density: 0.5, bad2: 0.0, missed: 0.5 }];
        assert_eq!(Score::mean(&scores), Score { density: 0.75, bad2: 0.1, missed: 0.35 });
        let none = Score { density: 0.0, bad2: 0.0, missed: 1.0 };
        let mean = Score::mean(&[scores[0], none]);
        assert_eq!(mean, Score { density: 0.5, bad2: 0.2, missed: 0.6 }, "what is not answered is not right");
        assert_eq!(Score::mean(&[]), Score::default());
    }
}
