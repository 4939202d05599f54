//! How right answers are, in the measures of the public benchmarks.

use super::Truth;
use crate::real::{self, Score};
use crate::sparsification::{Judged, Sparsification};
use serde::Serialize;

/// Measures of the scored pixels of a scene. Shares are 0 to 1; those of wrong answers are of the answers,
/// `missed` is of the scored pixels. Names are those of `stereo eval --json`.
#[derive(Clone, Copy, Default, PartialEq, Debug, Serialize)]
pub struct Measures {
    /// Pixels that are scored; of a mean, those of all scenes.
    pub scored: usize,
    /// Density, answers over 2 px off, and scored pixels with such an answer or none.
    #[serde(flatten)]
    pub score: Score,
    /// Answers over half a pixel off.
    pub bad05: f64,
    /// Answers over 1 px off.
    pub bad1: f64,
    /// Answers over 4 px off.
    pub bad4: f64,
    /// Answers over 3 px off that are over 5 % off, too: KITTI's D1, of the answers.
    pub d1: f64,
    /// The mean absolute error of the answers, px: the end-point error. 0 where there is none.
    pub epe_px: f64,
    /// How far the confidence's order of the answers is from the best one, of the way to a random one;
    /// absent without a confidence.
    pub confidence_from_oracle: Option<f64>,
    /// The same of the pixels that only the left camera sees, where a mask tells them apart: none of them
    /// needs an answer.
    pub occluded: Option<Score>,
}

impl Measures {
    /// KITTI's limits of a wrong answer, px and a share of the truth.
    const D1: (f32, f32) = (3.0, 0.05);

    /// Compares answers in px, infinite where there is none, with a truth, both row by row. `None` when no
    /// pixel is scored.
    pub fn of(answers: &[f32], truth: &Truth, confidence: Option<&[u8]>) -> Option<Self> {
        let score = |truth: &[f32]| Score::of(answers.iter().map(|&px| Some(px)), truth);
        let occluded = truth.occluded.as_deref().and_then(score);
        let truth = truth.scored.values.as_slice();
        let score = score(truth)?;
        let scored = truth.iter().filter(|px| **px > 0.0).count();
        let both = answers.iter().zip(truth).enumerate();
        let errors: Vec<(usize, f32, f32)> = both
            .filter(|(_, (px, truth))| **truth > 0.0 && px.is_finite())
            .map(|(at, (px, truth))| (at, (px - truth).abs(), *truth))
            .collect();
        let share = |is_bad: &dyn Fn(f32, f32) -> bool| {
            let bad = errors.iter().filter(|(_, error, truth)| is_bad(*error, *truth)).count();
            bad as f64 / errors.len().max(1) as f64
        };
        // The sum of nothing is minus zero.
        let sum = errors.iter().map(|(_, error, _)| f64::from(*error)).sum::<f64>() + 0.0;
        let judged = confidence.map(|confidence| {
            let judge = |&(at, error, _): &(usize, f32, f32)| Judged {
                confidence: confidence.get(at).copied().unwrap_or(0),
                loss: f32::from(u8::from(error > Score::BAD_PX)),
            };
            errors.iter().map(judge).collect::<Vec<_>>()
        });
        Some(Self {
            scored,
            score,
            bad05: share(&|error, _| error > 0.5),
            bad1: share(&|error, _| error > 1.0),
            bad4: share(&|error, _| error > 4.0),
            d1: share(&|error, truth| error > Self::D1.0 && error > Self::D1.1 * truth),
            epe_px: sum / errors.len().max(1) as f64,
            confidence_from_oracle: judged
                .and_then(|judged| Sparsification::of(&judged))
                .map(|sparsification| sparsification.from_oracle()),
            occluded,
        })
    }

    /// The mean of several scenes, which count alike; that of the confidence where every scene has one, that
    /// of occluded pixels of the scenes that have some, and those of errors of the scenes that have answers.
    pub fn mean(of: &[Self]) -> Self {
        let answered = || of.iter().filter(|m| m.score.has_answers());
        let mean = |part: fn(&Self) -> f64| real::mean(answered().map(part));
        let occluded: Vec<_> = of.iter().filter_map(|m| m.occluded).collect();
        let sure: Option<Vec<f64>> = of.iter().map(|m| m.confidence_from_oracle).collect();
        Self {
            scored: of.iter().map(|m| m.scored).sum(),
            score: Score::mean(&of.iter().map(|m| m.score).collect::<Vec<_>>()),
            bad05: mean(|m| m.bad05),
            bad1: mean(|m| m.bad1),
            bad4: mean(|m| m.bad4),
            d1: mean(|m| m.d1),
            epe_px: mean(|m| m.epe_px),
            confidence_from_oracle: sure
                .filter(|sure| !sure.is_empty())
                .map(|sure| sure.iter().sum::<f64>() / sure.len() as f64),
            occluded: (!occluded.is_empty()).then(|| Score::mean(&occluded)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pfm::FloatMap;

    const NONE: f32 = f32::INFINITY;

    /// A row of a truth.
    fn truth(scored: &[f32], occluded: Option<&[f32]>) -> Truth {
        let row = FloatMap { width: scored.len(), height: 1, values: scored.to_vec() };
        Truth { scored: row, occluded: occluded.map(<[_]>::to_vec) }
    }

    #[test]
    fn worked_by_hand() {
        // Errors 0, 0.75, 1.5, 3.5 (of 100: under 5 %), 4.5 (of 50: over); one without an answer, one not
        // scored.
        let known = truth(&[10.0, 10.0, 10.0, 100.0, 50.0, 10.0, 0.0], None);
        let answers = [10.0, 10.75, 11.5, 103.5, 54.5, NONE, 1.0];
        let m = Measures::of(&answers, &known, Some(&[9, 8, 7, 2, 1, 0, 0])).expect("six are scored");
        assert_eq!((m.scored, m.score.density), (6, 5.0 / 6.0));
        assert_eq!([m.bad05, m.bad1, m.score.bad2, m.bad4], [0.8, 0.6, 0.4, 0.2]);
        assert_eq!((m.d1, m.score.missed), (0.2, 0.5));
        assert!((m.epe_px - (0.75 + 1.5 + 3.5 + 4.5) / 5.0).abs() < 1e-6);
        assert_eq!(m.confidence_from_oracle, Some(0.0), "the wrong ones are the least sure");
        assert_eq!((m.occluded, Measures::of(&answers, &truth(&[0.0; 7], None), None)), (None, None));
    }

    #[test]
    fn occluded_pixels_are_counted_apart() {
        // Three of four have answers, one of which is wrong.
        let known = truth(&[5.0, 0.0, 0.0, 0.0, 0.0], Some(&[0.0, 1.0, 2.0, 3.0, 4.0]));
        let m = Measures::of(&[5.0, 1.5, 9.0, NONE, 4.0], &known, None).expect("one is scored");
        assert_eq!((m.scored, m.score.missed), (1, 0.0));
        let expected = Score { density: 0.75, bad2: 1.0 / 3.0, missed: 0.5 };
        assert_eq!(m.occluded, Some(expected));
        // Of scenes without occluded pixels nothing is known of them.
        let none = Measures::of(&[5.0], &truth(&[5.0], Some(&[0.0])), None).expect("one is scored");
        assert_eq!((none.occluded, Measures::mean(&[m, none]).occluded), (None, Some(expected)));
    }

    #[test]
    fn a_map_without_answers_has_no_error_and_misses_all() {
        let m = Measures::of(&[NONE; 2], &truth(&[1.0; 2], None), None).expect("two are scored");
        assert_eq!((m.score.missed, m.epe_px, m.bad1, m.confidence_from_oracle), (1.0, 0.0, 0.0, None));
        let none = Measures::mean(&[]);
        assert!(
            [m.epe_px, Measures::mean(&[m]).epe_px, none.epe_px, none.score.bad2]
                .iter()
                .all(|x| x.is_sign_positive())
        );
    }

    #[test]
    fn scenes_count_alike() {
        let score = Score { density: 0.5, bad2: 0.1, missed: 0.55 };
        let one = Measures {
            scored: 1,
            score,
            epe_px: 1.0,
            confidence_from_oracle: Some(0.5),
            ..Measures::default()
        };
        let two = Measures { scored: 9, score, epe_px: 2.0, ..Measures::default() };
        let mean = Measures::mean(&[one, two]);
        assert_eq!((mean.scored, mean.epe_px, mean.confidence_from_oracle), (10, 1.5, None));
        // What is not answered has no error.
        let mean = Measures::mean(&[one, two, Measures { scored: 5, ..Measures::default() }]);
        assert_eq!((mean.scored, mean.epe_px), (15, 1.5));
    }
}
