//! The rectifying warp: the raw pixel of a rectified one.

use crate::geometry::Real;
use crate::geometry::camera::{Camera, ImageSize, ProjectionError};
use nalgebra::{Matrix3, Point2, Point3, Vector3};

/// One camera's map from rectified pixels to raw ones: the ray of the rectified pixel, rotated into the
/// camera, through its lens: `p_raw = K distort(R^T K_new^-1 p)`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Warp<T: Real> {
    camera: Camera<T>,
    raw: ImageSize,
    rotation: Matrix3<T>,
    new: Camera<T>,
    size: ImageSize,
    reach_r2: T,
}

/// A place in the raw image.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WarpSource<T: Real> {
    /// Raw px; it may be outside the image.
    pub pixel: Point2<T>,
    /// Whether the lens model describes the ray: beyond where its radius stops growing it gives places
    /// that other rays have too.
    pub is_described: bool,
}

impl<T: Real> Warp<T> {
    /// The warp of a camera with raw images of `raw` px, by the rotation of its frame into that of the camera
    /// `new`, which has no lens and images of `size` px.
    pub(super) fn new(
        camera: Camera<T>,
        raw: ImageSize,
        rotation: Matrix3<T>,
        new: Camera<T>,
        size: ImageSize,
    ) -> Self {
        // A hundredth less than the fold itself, where the map stands still.
        let reach_r2 = camera.lens().reach_r2() * T::of(0.98);
        Self { camera, raw, rotation, new, size, reach_r2 }
    }

    /// The camera behind its lens.
    pub fn camera(&self) -> &Camera<T> {
        &self.camera
    }

    /// From the camera's frame into that of the rectified camera.
    pub fn rotation(&self) -> &Matrix3<T> {
        &self.rotation
    }

    /// The size of the raw image.
    pub fn raw_size(&self) -> ImageSize {
        self.raw
    }

    /// The size of the rectified image.
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// Where a rectified pixel is in the raw image; [`ProjectionError::Behind`] when its ray is behind the
    /// camera.
    pub fn source(&self, rectified: &Point2<T>) -> Result<WarpSource<T>, ProjectionError> {
        let (fx, fy) = self.new.focal_px();
        let (cx, cy) = self.new.principal_point();
        let ray = Vector3::new((rectified.x - cx) / fx, (rectified.y - cy) / fy, T::ONE);
        let there = Point3::from(self.rotation.tr_mul(&ray));
        let pixel = self.camera.project(&there)?;
        let r2 = (there.x * there.x + there.y * there.y) / (there.z * there.z);
        Ok(WarpSource { pixel, is_described: r2 <= self.reach_r2 })
    }

    /// Where a raw pixel is in the rectified image.
    pub fn rectify(&self, raw: &Point2<T>) -> Result<Point2<T>, ProjectionError> {
        self.new.project(&Point3::from(self.rotation * self.camera.unproject(raw)?))
    }

    /// Whether a place is in the raw image, on or between its pixels' centres.
    pub fn is_in_raw(&self, place: &Point2<T>) -> bool {
        let most = |side: u16| T::count(usize::from(side).saturating_sub(1));
        (T::ZERO..=most(self.raw.width)).contains(&place.x)
            && (T::ZERO..=most(self.raw.height)).contains(&place.y)
    }
}
