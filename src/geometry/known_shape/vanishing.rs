//! Vanishing points of parallel lines (Hartley & Zisserman 2004, 8.6).

use super::pencil::{LineSegment, VanishingPointError, vanishing_point};
use crate::geometry::Real;
use crate::geometry::camera::Camera;
use nalgebra::{Point2, Unit, Vector3};

/// The vanishing point of parallel lines of the world.
///
/// Lines parallel to the image have it at infinity, as a direction without a pixel.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct VanishingPoint<T: Real> {
    homogeneous: Vector3<T>,
    rms_px: T,
}

impl<T: Real> VanishingPoint<T> {
    /// The point for which the segments' ends are least away, root mean square, from the lines through it and
    /// their middles.
    pub fn of(segments: &[LineSegment<T>]) -> Result<Self, VanishingPointError> {
        if !segments.iter().all(LineSegment::is_finite) {
            return Err(VanishingPointError::NotFinite);
        }
        let (centre, scale) = extent(segments.iter());
        if !(scale > T::ZERO) {
            return Err(if segments.len() < 2 {
                VanishingPointError::TooFew
            } else {
                VanishingPointError::Line
            });
        }
        let (v, squares) = vanishing_point(segments.iter().map(|segment| segment.scaled(&centre, scale)))?;
        let v = Vector3::new(v.x * scale + centre.x * v.z, v.y * scale + centre.y * v.z, v.z);
        let rms_px = (squares / T::count(segments.len())).sqrt() * scale;
        let homogeneous = v / v.norm();
        if !((homogeneous.norm() - T::ONE).abs() < T::of(1e-4) && rms_px.is_finite()) {
            return Err(VanishingPointError::NotFinite);
        }
        Ok(Self { homogeneous, rms_px })
    }

    /// The homogeneous point (x, y, w) of length one: the point is at (x / w, y / w) px; where w = 0, in the
    /// direction (x, y).
    pub fn homogeneous(&self) -> &Vector3<T> {
        &self.homogeneous
    }

    /// Column and row, px; `None` at infinity, as
    /// [`Epipole::pixel`](crate::geometry::two_view::Epipole::pixel).
    pub fn pixel(&self) -> Option<Point2<T>> {
        let v = &self.homogeneous;
        (v.z.abs() > T::EPSILON * T::of(8.0)).then(|| Point2::new(v.x / v.z, v.y / v.z))
    }

    /// How far the segments' ends are from the lines through the point, root mean square, px.
    pub fn rms_px(&self) -> T {
        self.rms_px
    }

    /// The direction of the lines in the camera's frame, forward; of lines parallel to the image either of
    /// the two.
    pub fn direction(&self, camera: &Camera<T>) -> Unit<Vector3<T>> {
        let direction = camera.inverse_matrix() * self.homogeneous;
        Unit::new_normalize(if direction.z < T::ZERO { -direction } else { direction })
    }
}

/// The middle of the segments' box, and half of its longer side.
pub(super) fn extent<'a, T: Real>(segments: impl Iterator<Item = &'a LineSegment<T>>) -> (Point2<T>, T) {
    let mut corners: Option<(Point2<T>, Point2<T>)> = None;
    for end in segments.flat_map(|segment| [segment.from, segment.to]) {
        corners = Some(corners.map_or((end, end), |(low, high)| {
            (Point2::from(low.coords.inf(&end.coords)), Point2::from(high.coords.sup(&end.coords)))
        }));
    }
    let (low, high) = corners.unwrap_or((Point2::origin(), Point2::origin()));
    (nalgebra::center(&low, &high), (high - low).amax() * T::of(0.5))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rails_converge() {
        let rails = [
            LineSegment::new((0.0, 480.0), (200.0, 180.0)),
            LineSegment::new((640.0, 480.0), (440.0, 180.0)),
        ];
        let point = VanishingPoint::of(&rails).expect("a point");
        // Left: u = 2 / 3 (480 - v), right: its mirror; both at u = 320 where v = 0.
        assert!((point.pixel().expect("finite") - Point2::new(320.0, 0.0)).norm() < 1e-9, "{point:?}");
        assert!(point.rms_px() < 1e-10);
        let camera = Camera::new(480.0, 480.0, 320.0, 240.0).expect("a camera");
        assert!(
            (point.direction(&camera).into_inner() - Vector3::new(0.0, -0.5, 1.0).normalize()).norm() < 1e-12
        );
    }

    #[test]
    fn parallels_have_it_at_infinity() {
        let lines =
            [LineSegment::new((0.0, 0.0), (30.0, 40.0)), LineSegment::new((100.0, 0.0), (130.0, 40.0))];
        let point = VanishingPoint::of(&lines).expect("a point");
        assert_eq!(point.pixel(), None);
        assert!((point.homogeneous().x / point.homogeneous().y - 0.75_f64).abs() < 1e-12);
    }

    #[test]
    fn what_has_none_is_refused() {
        let line = LineSegment::new((0.0, 0.0), (30.0, 40.0));
        assert_eq!(VanishingPoint::of(&[line]), Err(VanishingPointError::TooFew));
        let more = LineSegment::new((60.0, 80.0), (90.0, 120.0));
        assert_eq!(VanishingPoint::of(&[line, more]), Err(VanishingPointError::Line));
        assert_eq!(
            VanishingPoint::of(&[line, LineSegment::new((f64::NAN, 0.0), (1.0, 1.0))]),
            Err(VanishingPointError::NotFinite)
        );
    }
}
