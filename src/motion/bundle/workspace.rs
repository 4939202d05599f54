//! The memory that an adjustment works in.

use super::envelope::Block;
use super::view::View;
use crate::geometry::Real;
use nalgebra::Point3;

/// What is kept for each view during a step.
#[derive(Clone, Copy, Debug)]
pub struct ViewSlot<V, T, const N: usize> {
    /// The view after the step.
    pub(super) trial: V,
    /// The first view that its row of the reduced matrix reaches, and where the row begins.
    pub(super) first: usize,
    pub(super) offset: usize,
    /// The gradient by the view, and the diagonal of its block of `J^T J`.
    pub(super) gradient: [T; N],
    pub(super) diagonal: [T; N],
    /// The right side of the reduced equations, then their solution.
    pub(super) step: [T; N],
}

/// What is kept for each view that sees the point in hand: `J_view^T J_point`, transposed.
#[derive(Clone, Copy, Debug)]
pub struct CrossBlock<T, const N: usize> {
    pub(super) view: usize,
    pub(super) cross: [[T; N]; 3],
}

impl<V: View<T, N>, T: Real, const N: usize> ViewSlot<V, T, N> {
    /// Not in use.
    pub const EMPTY: Self = Self {
        trial: V::EMPTY,
        first: 0,
        offset: 0,
        gradient: [T::ZERO; N],
        diagonal: [T::ZERO; N],
        step: [T::ZERO; N],
    };
}

impl<T: Real, const N: usize> CrossBlock<T, N> {
    /// Not in use.
    pub const EMPTY: Self = Self { view: 0, cross: [[T::ZERO; N]; 3] };
}

/// Memory for problems up to a size: [`Need`](super::WorkspaceSize) says how much.
#[derive(Debug)]
pub struct Workspace<'a, V, T: Real, const N: usize> {
    /// One for each view.
    pub slots: &'a mut [ViewSlot<V, T, N>],
    /// As many as the largest number of views that see a point.
    pub terms: &'a mut [CrossBlock<T, N>],
    /// The points after a step.
    pub trial_points: &'a mut [Point3<T>],
    /// The lower triangle of the reduced matrix.
    pub blocks: &'a mut [Block<T, N>],
}
