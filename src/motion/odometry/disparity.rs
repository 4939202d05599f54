//! Disparity of one point, by aligning its template with the right picture.

use super::frame::Moment;
use crate::features::Template;
use crate::geometry::Real;

/// The correlation that a place found by its pixels must have.
pub(super) const CORRELATED: f32 = 0.8;
/// How far from the expected place pixels are aligned, px.
pub(super) const ALIGN_PX: f32 = 4.0;
/// How far rows of a pair may be off each other, beyond what is known of them, px.
const ROWS_PX: f32 = 1.5;

/// The disparity `f (x - x')` of a place near the expected one, and how much lower the right picture shows it
/// than the left one, px.
pub(super) fn disparity<T: Real>(now: &Moment<'_, T>, [x, y]: [f32; 2], expected: f32) -> Option<[f32; 2]> {
    let ((_, right_cx), right) = (now.rig.right?, now.frame.right?);
    // Columns of both pictures differ by the principal points, too.
    let offset = (right_cx - now.rig.camera.principal_point().0).to_f64() as f32;
    let template = Template::cut(&now.frame.left, x, y).ok()?;
    let start = x - expected + offset;
    let [correction, lower] = now.rig.correction_px([start, y]);
    let found = template.align(&right, &Template::UPRIGHT, [start + correction, y + lower], ALIGN_PX).ok()?;
    let [correction, lower] = now.rig.correction_px([found.x_px, y]);
    let good = found.correlation > CORRELATED && (found.y_px - y - lower).abs() < ROWS_PX;
    good.then_some([x - found.x_px + offset + correction, found.y_px - y])
}
