//! Disparity of one point, by aligning its template with the right picture.

use super::frame::Moment;
use crate::features::Template;
use crate::geometry::Real;

/// The correlation that a place found by its pixels must have.
pub(super) const CORRELATED: f32 = 0.8;
/// How far from the expected place pixels are aligned, px.
pub(super) const ALIGN_PX: f32 = 4.0;
/// How far rows of a pair may be off each other, px.
const ROWS_PX: f32 = 1.5;

/// The disparity `f (x - x')` of a place, px, near the expected one.
pub(super) fn disparity<T: Real>(now: &Moment<'_, T>, [x, y]: [f32; 2], expected: f32) -> Option<f32> {
    let ((_, right_cx), right) = (now.rig.right?, now.frame.right?);
    // Columns of both pictures differ by the principal points, too.
    let offset = (right_cx - now.rig.camera.principal_point().0).to_f64() as f32;
    let template = Template::cut(&now.frame.left, x, y).ok()?;
    let start = x - expected + offset;
    let start = start + now.rig.correction_px(start);
    let found = template.align(&right, &Template::UPRIGHT, [start, y], ALIGN_PX).ok()?;
    let good = found.correlation > CORRELATED && (found.y_px - y).abs() < ROWS_PX;
    good.then(|| x - found.x_px + offset + now.rig.correction_px(found.x_px))
}
