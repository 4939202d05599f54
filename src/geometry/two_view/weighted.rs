//! Correspondences with weights.

use super::correspondence::Correspondence;
use crate::geometry::Real;
use nalgebra::Point2;

/// One of the two images.
#[derive(Clone, Copy)]
pub(crate) enum Image {
    First,
    Second,
}

impl Image {
    /// Where this image shows a correspondence.
    #[inline(always)]
    pub(crate) fn point<T: Real>(self, seen: &Correspondence<T>) -> Point2<T> {
        match self {
            Self::First => seen.first,
            Self::Second => seen.second,
        }
    }
}

/// Correspondences with their weights; all alike without.
///
/// Slices, so that what takes them is compiled once for any caller.
#[derive(Clone, Copy)]
pub(crate) struct Weighted<'a, T: Real> {
    seen: &'a [Correspondence<T>],
    weights: Option<&'a [T]>,
}

impl<'a, T: Real> Weighted<'a, T> {
    /// All with a weight of one.
    pub(crate) const fn alike(seen: &'a [Correspondence<T>]) -> Self {
        Self { seen, weights: None }
    }

    /// The correspondences whose weight is greater than zero, or is not a number.
    pub(crate) const fn new(seen: &'a [Correspondence<T>], weights: &'a [T]) -> Self {
        Self { seen, weights: Some(weights) }
    }

    /// Each with its weight.
    #[inline(always)]
    pub(crate) fn iter(self) -> impl Iterator<Item = (&'a Correspondence<T>, T)> + Clone {
        self.seen.iter().enumerate().filter_map(move |(at, seen)| {
            let weight = match self.weights {
                None => T::ONE,
                Some(weights) => *weights.get(at)?,
            };
            // What is not a number stays in, and is refused.
            (!(weight <= T::ZERO)).then_some((seen, weight))
        })
    }
}
