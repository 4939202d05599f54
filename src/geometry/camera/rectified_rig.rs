//! A rectified stereo rig: depth from disparity, and the re-projection matrix Q.

use crate::math::atan;
use nalgebra::{Matrix4, Point3, Vector4};

/// Two cameras after rectification, in pixels and metres.
///
/// Conventions: X right, Y down, Z forward from the left camera; pixel centres at integers. A point at depth
/// Z (metres) with left column u and right column u' has
///
/// `d = u - u'`, `doffs = cx' - cx`, `Z = f b / (d + doffs)`
///
/// (Siegwart, Nourbakhsh & Scaramuzza 2011, 4.2.5; the offset as in Scharstein et al. 2014, whose rectified
/// cameras have different principal points).
///
/// ```
/// use stereopsis::geometry::camera::RectifiedRig;
/// let rig = RectifiedRig::new(500.0, 0.1, 160.0, 120.0)?;
/// let point = rig.reproject(260.0, 120.0, 25.0).expect("in front of the camera");
/// assert_eq!((point.x, point.y, point.z), (0.4, 0.0, 2.0));
/// # Ok::<(), stereopsis::geometry::camera::RigError>(())
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RectifiedRig {
    focal_px: f32,
    baseline_m: f32,
    cx: f32,
    cy: f32,
    cx_right: f32,
}

deserialize_checked! {
    RectifiedRig { focal_px: f32, baseline_m: f32, cx: f32, cy: f32, cx_right: f32 }
    by |rig| Self::with_offset(rig.focal_px, rig.baseline_m, rig.cx, rig.cy, rig.cx_right)
}

/// Why a set of numbers is no rectified rig.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RigError {
    /// A number is infinite or not a number, or focal length times baseline or the disparity's offset is.
    NotFinite,
    /// The focal length is zero or negative.
    FocalLength,
    /// The baseline is zero or negative: the right camera has to be on the right.
    Baseline,
}

error_text!(RigError {
    Self::NotFinite => "a number of the calibration is not finite",
    Self::FocalLength => "the focal length must be greater than zero",
    Self::Baseline => "the baseline must be greater than zero",
});

impl RectifiedRig {
    /// A rig whose two cameras share one principal point `(cx, cy)`, px.
    pub fn new(focal_px: f32, baseline_m: f32, cx: f32, cy: f32) -> Result<Self, RigError> {
        Self::with_offset(focal_px, baseline_m, cx, cy, cx)
    }

    /// A rig whose right camera has its principal point at column `cx_right`.
    pub fn with_offset(
        focal_px: f32,
        baseline_m: f32,
        cx: f32,
        cy: f32,
        cx_right: f32,
    ) -> Result<Self, RigError> {
        let products = [focal_px * baseline_m, cx_right - cx];
        if ![focal_px, baseline_m, cx, cy, cx_right].iter().chain(&products).all(|v| v.is_finite()) {
            return Err(RigError::NotFinite);
        }
        if focal_px <= 0.0 {
            return Err(RigError::FocalLength);
        }
        if baseline_m <= 0.0 {
            return Err(RigError::Baseline);
        }
        Ok(Self { focal_px, baseline_m, cx, cy, cx_right })
    }

    /// Focal length, px.
    pub fn focal_px(&self) -> f32 {
        self.focal_px
    }

    /// Distance between the two optical centres, m.
    pub fn baseline_m(&self) -> f32 {
        self.baseline_m
    }

    /// Principal point of the left camera (column, row), px.
    pub fn principal_point(&self) -> (f32, f32) {
        (self.cx, self.cy)
    }

    /// `cx' - cx`, px: what is added to a disparity before it divides.
    pub fn disparity_offset_px(&self) -> f32 {
        self.cx_right - self.cx
    }

    /// Depth in metres of a disparity in px: `f b / (d + doffs)`, or `None` at and behind infinity, which
    /// begins where numbers end.
    pub fn depth_m(&self, disparity_px: f32) -> Option<f32> {
        let shift = disparity_px + self.disparity_offset_px();
        let depth_m = self.focal_px * self.baseline_m / shift;
        (shift > 0.0 && depth_m.is_finite()).then_some(depth_m)
    }

    /// Disparity in px of a depth in metres: `f b / Z - doffs`. It is negative where the rig cannot see that
    /// far.
    pub fn disparity_px(&self, depth_m: f32) -> f32 {
        self.focal_px * self.baseline_m / depth_m - self.disparity_offset_px()
    }

    /// The re-projection matrix Q: `(X Y Z W)^T = Q (u v d 1)^T`, and the point is `(X Y Z) / W`, in metres.
    ///
    /// `Q = [1 0 0 -cx; 0 1 0 -cy; 0 0 0 f; 0 0 1/b doffs/b]`: OpenCV's, with its `T_x = -b` written out.
    pub fn q(&self) -> Matrix4<f32> {
        let per_baseline = 1.0 / self.baseline_m;
        Matrix4::new(
            1.0,
            0.0,
            0.0,
            -self.cx, //
            0.0,
            1.0,
            0.0,
            -self.cy, //
            0.0,
            0.0,
            0.0,
            self.focal_px, //
            0.0,
            0.0,
            per_baseline,
            self.disparity_offset_px() * per_baseline,
        )
    }

    /// The point in the left camera's frame, metres, that is seen at column `u`, row `v` with disparity `d`
    /// (px); `None` at and behind infinity.
    pub fn reproject(&self, u: f32, v: f32, d: f32) -> Option<Point3<f32>> {
        let h = self.q() * Vector4::new(u, v, d, 1.0);
        let point = Point3::new(h.x / h.w, h.y / h.w, h.z / h.w);
        (h.w > 0.0 && point.iter().all(|x| x.is_finite())).then_some(point)
    }

    /// Horizontal field of view in radians of an image `width` px wide: from the left edge to the right edge.
    pub fn field_of_view_rad(&self, width: u16) -> f32 {
        let left = self.cx + 0.5;
        atan(left / self.focal_px) + atan((f32::from(width) - left) / self.focal_px)
    }
}
