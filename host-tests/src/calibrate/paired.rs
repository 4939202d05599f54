//! The rig of the views whose two pictures are of one moment.

use super::board::Pattern;
use super::calibrated::{Calibrated, SolveError, View, ViewFigures};
use super::lens::LensModel;
use super::solve::solve;
use stereopsis::geometry::camera::ImageSize;

/// Finds the rig as [`solve`] does, without the views whose two pictures do not belong together: where both
/// cameras fit much worse than each by itself the worst view is left out, and so on, up to a third of them.
/// Returns the rig and the places of the views that it is of.
///
/// # Panics
///
/// When a view has corners that the pattern has not.
pub fn solve_paired(
    model: LensModel,
    pattern: Pattern,
    square_m: f64,
    size: ImageSize,
    views: &[View],
) -> Result<(Calibrated, Vec<usize>), SolveError> {
    let fewest = Calibrated::LEAST_VIEWS.max(views.len() - views.len() / 3);
    let mut kept: Vec<usize> = (0..views.len()).collect();
    loop {
        let of_kept: Vec<_> = kept.iter().map(|&i| views[i].clone()).collect();
        let found = solve(model, pattern, square_m, size, &of_kept)?;
        let alone_px = found.alone_px[0].max(found.alone_px[1]);
        if found.rms_px < 3.0 * alone_px || found.rms_px < alone_px + 0.5 {
            return Ok((found, kept));
        }
        if kept.len() <= fewest {
            return Err(SolveError::NotPaired { alone_px, together_px: found.rms_px });
        }
        let rms_px = |view: &ViewFigures| view.rms_px[0].max(view.rms_px[1]);
        let worst =
            (0..kept.len()).max_by(|&a, &b| rms_px(&found.views[a]).total_cmp(&rms_px(&found.views[b])));
        kept.remove(worst.unwrap_or_default());
    }
}
