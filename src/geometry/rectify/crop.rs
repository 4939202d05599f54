//! The camera of the rectified images: the shared focal length and principal point.

use super::config::{Axis, Crop, RectifyError};
use crate::geometry::Real;
use crate::geometry::camera::{Camera, ImageSize};
use nalgebra::{Matrix3, Point2, Vector2};

/// Points of an image's outline on each side, its corners with them.
const PER_SIDE: usize = 33;
/// How often a point of the outline without a ray goes to the image's middle, each time a 32nd of the way.
const STEPS_IN: usize = 32;

/// One camera and its rotation into the rectified frame.
pub(super) struct Rotated<'a, T: Real> {
    pub camera: &'a Camera<T>,
    pub size: ImageSize,
    pub rotation: &'a Matrix3<T>,
}

/// A rectangle of the plane Z = 1 of the rectified frame.
#[derive(Clone, Copy)]
struct Rectangle<T> {
    left: T,
    right: T,
    top: T,
    bottom: T,
}

/// The camera that both rectified images are of.
///
/// The focal length is the mean of both across the baseline; the principal point puts the middle of the four
/// corners in the middle of the image, on average. Then the focal length is scaled as [`Crop`] has it,
/// between the largest at which all of both images is seen and the least at which nothing else is (OpenCV's
/// alpha).
pub(super) fn shared_camera<T: Real>(
    rotated: &[Rotated<'_, T>; 2],
    axis: Axis,
    crop: Crop<T>,
    size: ImageSize,
) -> Result<Camera<T>, RectifyError> {
    let half = T::of(0.5);
    let share = |new: u16, raw: u16| T::count(new.into()) / T::count(raw.into());
    let focal = |t: &Rotated<'_, T>| match axis {
        Axis::Horizontal => t.camera.focal_px().1 * share(size.height, t.size.height),
        Axis::Vertical => t.camera.focal_px().0 * share(size.width, t.size.width),
    };
    let [first, second] = rotated;
    let f = (focal(first) + focal(second)) * half;
    let middles = [middle_of_corners(first)?, middle_of_corners(second)?];
    let middle = (middles[0] + middles[1]) * half;
    let [w, h] = [size.width, size.height].map(|side| T::count(usize::from(side).saturating_sub(1)));
    let (cx, cy) = (w * half - f * middle.x, h * half - f * middle.y);
    let scale = match crop {
        Crop::Natural => T::ONE,
        Crop::Alpha(alpha) => {
            if !(alpha >= T::ZERO && alpha <= T::ONE) {
                return Err(RectifyError::Alpha);
            }
            let (mut all_valid, mut all_seen) = (T::ZERO, T::of(1e9));
            for t in rotated {
                let (inner, outer) = outline(t)?;
                for (rectangle, is_inner) in [(inner, true), (outer, false)] {
                    for (pixels, reach) in rectangle.extents(cx, cy, w, h) {
                        if !(pixels > T::ZERO && reach > T::ZERO) {
                            return Err(RectifyError::NothingShared);
                        }
                        let scale = pixels / (reach * f);
                        if is_inner {
                            all_valid = all_valid.max(scale);
                        } else {
                            all_seen = all_seen.min(scale);
                        }
                    }
                }
            }
            all_valid * (T::ONE - alpha) + all_seen * alpha
        }
    };
    Camera::new(f * scale, f * scale, cx, cy).map_err(RectifyError::Camera)
}

impl<T: Real> Rectangle<T> {
    /// For each side: the pixels between the principal point and the image's side, and how far the rectangle
    /// reaches from the axis on the plane Z = 1.
    fn extents(&self, cx: T, cy: T, w: T, h: T) -> [(T, T); 4] {
        [(cx, -self.left), (w - cx, self.right), (cy, -self.top), (h - cy, self.bottom)]
    }
}

/// Where the rectified frame sees a place of the raw outline, on the plane Z = 1. Where the lens has no ray
/// for it, the nearest on the way to the principal point that has one.
fn seen<T: Real>(t: &Rotated<'_, T>, place: Point2<T>) -> Result<Vector2<T>, RectifyError> {
    let (cx, cy) = t.camera.principal_point();
    let to_middle = Vector2::new(cx - place.x, cy - place.y) / T::count(STEPS_IN);
    for step in 0..STEPS_IN {
        let place = place + to_middle * T::count(step);
        let Ok(ray) = t.camera.unproject(&place) else { continue };
        let there = t.rotation * ray;
        // Within 84 degrees of the axis.
        if there.z > T::of(0.1) * there.xy().norm() {
            return Ok(there.xy() / there.z);
        }
    }
    Err(RectifyError::NothingShared)
}

fn middle_of_corners<T: Real>(t: &Rotated<'_, T>) -> Result<Vector2<T>, RectifyError> {
    let [w, h] = [t.size.width, t.size.height].map(|side| T::count(usize::from(side).saturating_sub(1)));
    let mut sum = Vector2::zeros();
    for (x, y) in [(T::ZERO, T::ZERO), (w, T::ZERO), (T::ZERO, h), (w, h)] {
        sum += seen(t, Point2::new(x, y))?;
    }
    Ok(sum * T::of(0.25))
}

/// The largest rectangle, about, within the raw image's outline, and the smallest around it.
fn outline<T: Real>(t: &Rotated<'_, T>) -> Result<(Rectangle<T>, Rectangle<T>), RectifyError> {
    let [w, h] = [t.size.width, t.size.height].map(|side| T::count(usize::from(side).saturating_sub(1)));
    let (low, high) = (-T::of(1e9), T::of(1e9));
    let mut inner = Rectangle { left: low, right: high, top: low, bottom: high };
    let mut outer = Rectangle { left: high, right: low, top: high, bottom: low };
    for i in 0..PER_SIDE {
        let part = T::count(i) / T::count(PER_SIDE - 1);
        let left = seen(t, Point2::new(T::ZERO, part * h))?;
        let right = seen(t, Point2::new(w, part * h))?;
        let top = seen(t, Point2::new(part * w, T::ZERO))?;
        let bottom = seen(t, Point2::new(part * w, h))?;
        inner.left = inner.left.max(left.x);
        inner.right = inner.right.min(right.x);
        inner.top = inner.top.max(top.y);
        inner.bottom = inner.bottom.min(bottom.y);
        for p in [left, right, top, bottom] {
            outer.left = outer.left.min(p.x);
            outer.right = outer.right.max(p.x);
            outer.top = outer.top.min(p.y);
            outer.bottom = outer.bottom.max(p.y);
        }
    }
    Ok((inner, outer))
}
