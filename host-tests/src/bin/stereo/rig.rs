//! What `odometry` says of how a pair differs from its calibration.

use crate::shared::remark;
use std::path::Path;
use stereopsis::motion::odometry::RigEstimate;

/// What the points' motion shows of a pair.
pub fn rig_line(rig: &RigEstimate<f64>) -> String {
    if rig.pairs == 0 {
        return "rig          not known: no two views had points enough in common".to_owned();
    }
    let [off, sigma, principal] = [rig.disparity_px, rig.sigma_px, rig.principal_px].map(Signed);
    let yaw = Signed(1e3 * rig.yaw_rad);
    let what = match (rig.is_applied, rig.is_sure) {
        (true, _) => "corrected",
        (_, true) => "as calibrated",
        _ => "not sure",
    };
    format!(
        "rig          disparities {off} px (deviation {:.3}) by {} pairs of views; right principal point \
         {principal} px, right camera turned by {yaw} mrad: {what}",
        sigma.0, rig.pairs
    )
}

/// A number with its sign.
struct Signed(f64);

impl std::fmt::Display for Signed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // No minus before what rounds to zero.
        let rounded = (self.0 * 1e3).round() / 1e3 + 0.0;
        write!(f, "{rounded:+.3}")
    }
}

/// Pairs of views from which on an estimate that is not sure says something, too.
const FEWEST_PAIRS: u32 = 3;

/// Warns of a pair that is off, also where the estimate is not sure enough to correct the pair by it: of
/// images that are not of one moment it never is.
pub fn warn_of(rig: Option<&RigEstimate<f64>>, calib: &Path) {
    let told = rig.filter(|rig| rig.pairs >= FEWEST_PAIRS).map(|rig| RigEstimate { is_sure: true, ..*rig });
    let Some(rig) = told.filter(RigEstimate::is_off) else { return };
    let done = if rig.is_applied { "the poses are corrected for it" } else { "distances are wrong by it" };
    remark(&format!(
        "warning: {}: disparities lack {:+.2} px (deviation {:.2}): the right camera is turned, or its \
         principal point is another, or the two images of a pair are not of one moment; {done}; calibrate \
         the pair again, or let both cameras expose together",
        calib.display(),
        rig.disparity_px,
        rig.sigma_px
    ));
}
