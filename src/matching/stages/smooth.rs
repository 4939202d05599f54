//! Answers of one surface along the row: how many there are, and their average.
//!
//! Two neighbours are of one surface when both are answers within
//! [`surface_step`](crate::matching::Checks::surface_step) of each other. The error of a sub-pixel answer
//! changes from pixel to pixel faster than a surface does, so an answer becomes the average of those around
//! it: as many to the left as to the right, so that a slanted surface keeps its own value, and none beyond
//! the surface's ends, so that depth edges stay where they are.
//!
//! The work is the same for every row.

use crate::matching::backend::{Isa, SmoothWork};
use crate::matching::method::Frame;

/// Averages the answers of `newest` within their surfaces.
pub(super) fn smooth_along_row(frame: &mut Frame<'_>, newest: usize) {
    let checks = &frame.config.checks;
    let (lengths, workspace) = frame.workspace.for_smoothing();
    let answers = frame.band.row_mut(newest);
    let (step, radius) = (checks.surface_step, checks.smoothing_radius);
    frame.backend.smooth(SmoothWork { answers, lengths, workspace, step, radius });
}
