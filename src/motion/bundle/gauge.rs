//! Gauge freedom: what is held still, as images tell neither the frame nor the scale.

use crate::geometry::{Real, camera::Pose};
use core::ops::Range;
use nalgebra::Vector3;

/// What fixes the frame and the scale of the result.
#[derive(Clone, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Gauge {
    /// Nothing: the damping keeps steps short, and the scene drifts. There is no covariance.
    Free,
    /// Views of this range are held where they are. One fixes the frame, and with rigs of two cameras all;
    /// two fix the scale as well.
    Views(Range<u16>),
    /// The view `held` is held, and `other`, which is in another place, keeps its distance from it: seven
    /// numbers, as many as the images leave open.
    Baseline {
        /// The view that is the frame.
        held: u16,
        /// The view whose distance is the scale.
        other: u16,
    },
}

/// What a gauge lets a view do.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Freedom<T> {
    All,
    /// Across this direction of length one, at this distance from this centre.
    Across(Vector3<T>, T, Vector3<T>),
    None,
}

impl Gauge {
    /// Whether every view that it names exists, and a baseline's two views are different.
    pub(super) fn is_sound(&self, views: usize) -> bool {
        match self {
            Self::Free => true,
            Self::Views(held) => held.start < held.end && usize::from(held.end) <= views,
            Self::Baseline { held, other } => held != other && usize::from(*held.max(other)) < views,
        }
    }

    /// The baseline from the first of these views to the one farthest from it; `None` where all are in one
    /// place, to the root of a rounding of the unit.
    pub(crate) fn longest_baseline<T: Real>(poses: &[Pose<T>]) -> Option<Self> {
        let first = poses.first()?;
        let (mut longest, mut found) = (T::EPSILON, None);
        for (other, pose) in (0..).zip(poses) {
            let squared = (pose.translation() - first.translation()).norm_squared();
            if squared >= longest {
                (longest, found) = (squared, Some(Self::Baseline { held: 0, other }));
            }
        }
        found
    }

    /// Whether the views of a baseline, which are at `place`, are in different places.
    pub(super) fn has_length<T: Real>(&self, place: impl Fn(u16) -> Option<Vector3<T>>) -> bool {
        let Self::Baseline { held, other } = self else { return true };
        let apart = place(*held).zip(place(*other)).map(|(held, other)| (held - other).norm());
        apart.is_some_and(|apart| apart > T::ZERO && apart.is_finite())
    }

    /// Whether it holds frame and scale; `lengths`: there are rigs, whose own baseline is a scale.
    pub(super) fn is_complete(&self, lengths: bool) -> bool {
        match self {
            Self::Free => false,
            Self::Views(held) => lengths || held.len() > 1,
            Self::Baseline { .. } => true,
        }
    }

    /// What view `at` may do, where `pose` is its own and `of` that of another.
    pub(super) fn freedom<T: Real>(
        &self,
        at: u16,
        pose: &Pose<T>,
        of: impl FnOnce(u16) -> Pose<T>,
    ) -> Freedom<T> {
        match self {
            Self::Views(held) if held.contains(&at) => Freedom::None,
            Self::Baseline { held, .. } if *held == at => Freedom::None,
            Self::Baseline { held, other } if *other == at => {
                let centre = *of(*held).translation();
                let apart = pose.translation() - centre;
                let distance = apart.norm();
                Freedom::Across(apart * (T::ONE / distance), distance, centre)
            }
            _ => Freedom::All,
        }
    }
}

impl<T: Real> Freedom<T> {
    /// Takes from a row of the derivative by the view what the gauge holds.
    pub(super) fn restrict<const N: usize>(&self, row: &mut [T; N]) {
        match self {
            Self::All => {}
            Self::None => *row = [T::ZERO; N],
            Self::Across(along, ..) => {
                if let [_, _, _, x, y, z, ..] = row.as_mut_slice() {
                    let off = *x * along.x + *y * along.y + *z * along.z;
                    *x -= along.x * off;
                    *y -= along.y * off;
                    *z -= along.z * off;
                }
            }
        }
    }

    /// Makes a view's block, empty in what is held, one that can be factored: the step there is zero. `size`
    /// is of the block.
    pub(super) fn fill<const N: usize>(&self, block: &mut [[T; N]; N], size: T) {
        match self {
            Self::All => {}
            Self::None => {
                for (k, row) in block.iter_mut().enumerate() {
                    if let Some(x) = row.get_mut(k) {
                        *x = T::ONE;
                    }
                }
            }
            Self::Across(along, ..) => {
                let along = [along.x, along.y, along.z];
                for (row, &a) in block.iter_mut().skip(3).zip(&along) {
                    for (x, &b) in row.iter_mut().skip(3).zip(&along) {
                        *x += a * b * size;
                    }
                }
            }
        }
    }

    /// The pose after a step, at the distance that is held.
    pub(super) fn settled(&self, pose: &Pose<T>) -> Pose<T> {
        match self {
            Self::Across(_, distance, centre) => {
                let apart = pose.translation() - centre;
                Pose::of_parts(*pose.rotation(), centre + apart * (*distance / apart.norm()))
            }
            _ => *pose,
        }
    }
}
