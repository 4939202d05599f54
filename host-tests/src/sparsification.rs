//! What a confidence is worth: the area under the sparsification curve.
//!
//! The least sure answers are taken away one after the other; the curve is the mean loss of those that are
//! left, over the share that was taken. A confidence is good when the loss falls fast. Two others tell how
//! good it could be: the oracle's, which takes away the worst answers first, and that of a random order,
//! which stays where it is.

use serde::Serialize;

/// An answer whose truth is known.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Judged {
    /// How sure the core is.
    pub confidence: u8,
    /// What it costs to believe it: 1 for a wrong answer and 0 for a right one, or its error.
    pub loss: f32,
}

/// Areas under three sparsification curves, each the mean over all shares of answers that are left.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Sparsification {
    /// In the order of confidence; of equal ones any might go first, which counts as their mean.
    pub area: f64,
    /// In the order of the loss itself: no order is better.
    pub oracle: f64,
    /// In a random order: the mean loss.
    pub random: f64,
}

impl Sparsification {
    /// Of answers; `None` where there is none.
    pub fn of(answers: &[Judged]) -> Option<Self> {
        let mut losses: Vec<f64> = answers.iter().map(|a| f64::from(a.loss)).collect();
        losses.sort_by(f64::total_cmp);
        let area = |curve: &[f64]| curve.iter().sum::<f64>() / curve.len() as f64;
        let (curve, best) = (means(in_order(answers)), means(losses));
        Some(Self { area: area(&curve), oracle: area(&best), random: *best.last()? })
    }

    /// How far from the oracle, of the way to a random order: 0 is the oracle itself, 1 a confidence that
    /// says nothing; 0 where all answers are as good.
    pub fn from_oracle(&self) -> f64 {
        let way = self.random - self.oracle;
        if way > 0.0 { (self.area - self.oracle) / way } else { 0.0 }
    }
}

/// Mean losses of the answers that are left, by the share of them that was taken away, from 0: of confidence
/// and of the oracle; `steps` of each.
pub fn curves(answers: &[Judged], steps: usize) -> [Vec<f64>; 2] {
    let mut losses: Vec<f64> = answers.iter().map(|a| f64::from(a.loss)).collect();
    losses.sort_by(f64::total_cmp);
    [in_order(answers), losses].map(|losses| {
        let curve = means(losses);
        let left = |step: usize| curve.len().saturating_sub(step * curve.len() / steps).checked_sub(1);
        (0..steps).filter_map(|step| curve.get(left(step)?).copied()).collect()
    })
}

/// The losses, those of the surest answers first; each of those that are as sure has their mean.
fn in_order(answers: &[Judged]) -> Vec<f64> {
    let (mut counts, mut sums) = ([0usize; 256], [0f64; 256]);
    for answer in answers {
        counts[usize::from(answer.confidence)] += 1;
        sums[usize::from(answer.confidence)] += f64::from(answer.loss);
    }
    let groups = counts.iter().zip(&sums).rev();
    groups.flat_map(|(&count, &sum)| std::iter::repeat_n(sum / count.max(1) as f64, count)).collect()
}

/// The mean of the first one, of the first two, and so on.
fn means(values: Vec<f64>) -> Vec<f64> {
    let mut sum = 0.0;
    let mean = |(i, value): (usize, f64)| {
        sum += value;
        sum / (i + 1) as f64
    };
    values.into_iter().enumerate().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(answers: &[(u8, f32)]) -> Sparsification {
        let answers: Vec<_> = answers.iter().map(|&(confidence, loss)| Judged { confidence, loss }).collect();
        Sparsification::of(&answers).expect("there are answers")
    }

    #[test]
    fn worked_by_hand() {
        // Left are the surest one, two, three, four.
        let s = of(&[(9, 0.0), (1, 0.0), (5, 1.0), (3, 0.0)]);
        assert!((s.area - (0.0 + 1.0 / 2.0 + 1.0 / 3.0 + 1.0 / 4.0) / 4.0).abs() < 1e-12);
        assert_eq!((s.oracle, s.random), (0.25 / 4.0, 0.25));
        assert!(s.from_oracle() > 0.0 && s.from_oracle() > 1.0, "the wrong one is among the surest");
    }

    #[test]
    fn the_oracle_is_0_and_no_order_is_1() {
        assert_eq!(of(&[(1, 1.0), (7, 0.0), (7, 0.0)]).from_oracle(), 0.0);
        assert_eq!(of(&[(4, 1.0), (4, 0.0), (4, 0.0)]).from_oracle(), 1.0);
        assert_eq!(of(&[(1, 0.0), (2, 0.0)]).from_oracle(), 0.0);
        assert_eq!(Sparsification::of(&[]), None);
    }

    #[test]
    fn curves_begin_with_all_answers() {
        let answers =
            [(1, 1.0), (7, 0.0), (8, 1.0), (9, 0.0)].map(|(confidence, loss)| Judged { confidence, loss });
        let [found, oracle] = curves(&answers, 2);
        assert_eq!((found, oracle), (vec![0.5, 0.5], vec![0.5, 0.0]));
    }
}
