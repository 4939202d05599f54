//! The workspace of bundle adjustment: owned, and the view of it that the algorithms take.

use super::view::View;
use crate::geometry::Real;
use nalgebra::Point3;

/// One block. Of row i and column j it holds the transpose, so that every loop inside runs along memory.
pub(super) type Block<T, const N: usize> = [[T; N]; N];

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

/// The memory that adjusting a problem of up to `VIEWS` views and `POINTS` points takes, for a `static`: all
/// zeros.
#[derive(Debug)]
pub struct BundleWorkspace<V, T: Real, const N: usize, const VIEWS: usize, const POINTS: usize> {
    slots: [ViewSlot<V, T, N>; VIEWS],
    terms: [CrossBlock<T, N>; VIEWS],
    trial_points: [Point3<T>; POINTS],
    blocks: [[Block<T, N>; VIEWS]; VIEWS],
}

/// A borrowed [`BundleWorkspace`] of any size, or slices of the caller's own; [`WorkspaceSize`] says how long
/// they have to be.
///
/// [`WorkspaceSize`]: super::WorkspaceSize
#[derive(Debug)]
pub struct BundleWorkspaceView<'a, V, T: Real, const N: usize> {
    /// One slot for each view.
    pub slots: &'a mut [ViewSlot<V, T, N>],
    /// Blocks of one point's equations: as many as the largest number of views that see a point.
    pub terms: &'a mut [CrossBlock<T, N>],
    /// The points after a step.
    pub trial_points: &'a mut [Point3<T>],
    /// The lower triangle of the reduced camera matrix (the Schur complement).
    pub blocks: &'a mut [Block<T, N>],
}

impl<V: View<T, N>, T: Real, const N: usize, const VIEWS: usize, const POINTS: usize>
    BundleWorkspace<V, T, N, VIEWS, POINTS>
{
    /// A workspace that is not in use.
    pub const EMPTY: Self = Self {
        slots: [ViewSlot::EMPTY; VIEWS],
        terms: [CrossBlock::EMPTY; VIEWS],
        trial_points: [Point3::new(T::ZERO, T::ZERO, T::ZERO); POINTS],
        blocks: [[[[T::ZERO; N]; N]; VIEWS]; VIEWS],
    };

    /// The view that the algorithms take, so that they are compiled once for all sizes.
    pub fn as_mut_view(&mut self) -> BundleWorkspaceView<'_, V, T, N> {
        BundleWorkspaceView {
            slots: &mut self.slots,
            terms: &mut self.terms,
            trial_points: &mut self.trial_points,
            blocks: self.blocks.as_flattened_mut(),
        }
    }
}
