//! What `odometry` says of how a pair differs from its calibration.

use crate::shared::remark;
use std::path::Path;
use stereopsis::motion::odometry::RigEstimate;
use stereopsis_host::rows::BORNE_PX;

/// What the points' motion shows of a pair.
pub fn rig_line(rig: &RigEstimate<f64>) -> String {
    if rig.pairs == 0 {
        return "rig          not known: no two views had points enough in common".to_owned();
    }
    let [off, sigma, principal] = [rig.disparity_px, rig.sigma_px, rig.principal_px].map(Signed);
    let [yaw, roll] = [rig.yaw_rad, rig.roll_rad].map(|rad| Signed(1e3 * rad));
    let (lower, larger) = (Signed(rig.lower_px), Signed(100.0 * (rig.scale - 1.0)));
    let what = match (rig.is_applied, rig.is_sure) {
        (true, _) => "corrected",
        (_, true) => "as calibrated",
        _ => "not sure",
    };
    format!(
        "rig          disparities {off} px (deviation {:.3}) by {} pairs of views; right principal point \
         {principal} px, right camera turned by {yaw} mrad and rolled by {roll}, right image {lower} px \
         lower and {larger} % larger: {what}",
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
/// images that are not of one moment it never is. Rows are told of with the size of the images, where nothing
/// is said of them yet.
pub fn warn_of(rig: Option<&RigEstimate<f64>>, calib: &Path, size: Option<(u32, u32)>) {
    let Some(rig) = rig.filter(|rig| rig.pairs >= FEWEST_PAIRS) else { return };
    let rows_px = size.map_or(0.0, |size| rows_px(rig, size));
    let what = if (RigEstimate { is_sure: true, ..*rig }).is_off() {
        format!("disparities lack {:+.2} px (deviation {:.2})", rig.disparity_px, rig.sigma_px)
    } else if rows_px > BORNE_PX {
        format!("rows are {rows_px:.2} px off")
    } else {
        return;
    };
    let done = if rig.is_applied { "the poses are corrected for it" } else { "distances are wrong by it" };
    remark(&format!(
        "warning: {}: {what}: the right camera is turned, or its principal point is another, or the two \
         images of a pair are not of one moment; {done}; calibrate the pair again, or let both cameras \
         expose together",
        calib.display()
    ));
}

/// The root mean square over the image of how far rows are off, px.
fn rows_px(rig: &RigEstimate<f64>, (width, height): (u32, u32)) -> f64 {
    // The mean square of a column is a twelfth of the width's square.
    let by_roll = rig.roll_rad * f64::from(width);
    let by_scale = (rig.scale - 1.0) * f64::from(height);
    (rig.lower_px.powi(2) + (by_roll.powi(2) + by_scale.powi(2)) / 12.0).sqrt()
}
