//! The rig of the views whose two pictures are of one moment.

use super::board::Pattern;
use super::calibrated::{Calibrated, SolveError, View, ViewFigures};
use super::lens::LensModel;
use super::solve::solve;
use stereopsis::geometry::camera::ImageSize;

/// Finds the rig as [`solve`] does, without the views whose two pictures do not belong together: where both
/// cameras fit much worse than each by itself the worst view is left out, and so on. The worst of a fit that
/// is spoilt may be a good one: those that fit what is found in the end come back. Returns the rig and the
/// places of the views that it is of, two thirds of them at least.
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
    let solved = |kept: &[usize]| {
        let of_kept: Vec<_> = kept.iter().map(|&i| views[i].clone()).collect();
        solve(model, pattern, square_m, size, &of_kept)
    };
    let mut kept: Vec<usize> = (0..views.len()).collect();
    let mut found = solved(&kept)?;
    let alone_px = found.alone_px[0].max(found.alone_px[1]);
    let not_paired = SolveError::NotPaired { alone_px, together_px: found.rms_px };
    while !is_paired(&found) {
        if kept.len() <= Calibrated::LEAST_VIEWS {
            return Err(not_paired);
        }
        let rms_px = |view: &ViewFigures| view.rms_px[0].max(view.rms_px[1]);
        let worst =
            (0..kept.len()).max_by(|&a, &b| rms_px(&found.views[a]).total_cmp(&rms_px(&found.views[b])));
        kept.remove(worst.unwrap_or_default());
        found = solved(&kept).map_err(|_| not_paired)?;
    }
    let (found, kept) = with_what_fits(found, kept, views.len(), solved);
    let fewest = Calibrated::LEAST_VIEWS.max(views.len() - views.len() / 3);
    if kept.len() < fewest { Err(not_paired) } else { Ok((found, kept)) }
}

/// Whether both cameras together fit about as well as each by itself.
fn is_paired(found: &Calibrated) -> bool {
    let alone_px = found.alone_px[0].max(found.alone_px[1]);
    found.rms_px < 3.0 * alone_px || found.rms_px < alone_px + 0.5
}

/// The rig with those of the other views that fit it as the kept ones do.
fn with_what_fits(
    mut found: Calibrated,
    mut kept: Vec<usize>,
    views: usize,
    solved: impl Fn(&[usize]) -> Result<Calibrated, SolveError>,
) -> (Calibrated, Vec<usize>) {
    let left_out: Vec<_> = (0..views).filter(|view| !kept.contains(view)).collect();
    for view in left_out {
        let mut more = kept.clone();
        let at = more.partition_point(|&other| other < view);
        more.insert(at, view);
        if let Ok(again) = solved(&more)
            && is_paired(&again)
            && !again.outliers().contains(&at)
        {
            (found, kept) = (again, more);
        }
    }
    (found, kept)
}
