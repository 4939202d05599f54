//! A track: a point with its template, followed from frame to frame.

use super::inverse_depth::InversePoint;
use crate::features::{Descriptor, Template};
use crate::geometry::Real;
use nalgebra::Vector3;

/// A point with what it looks like.
#[derive(Clone, Copy, Debug)]
pub struct Track<T: Real> {
    pub(super) point: InversePoint<T>,
    /// The pixels, as they were when the template was cut.
    pub(super) template: Template,
    /// Affine warp of offsets from the point: from the template's picture into the last picture.
    pub(super) warp: [[f32; 2]; 2],
    pub(super) descriptor: Descriptor,
    /// Where it was seen last, px.
    pub(super) pixel: [f32; 2],
    /// Where this frame sees it, px; `None` where it does not. Set anew by each frame.
    pub(super) now: Option<[f32; 2]>,
    /// How alike its pixels were.
    pub(super) correlation: f32,
    /// The descriptor of the feature that it was recognised by in this frame.
    pub(super) fresh: Descriptor,
    /// Frames in which it was found.
    pub(super) seen: u16,
    /// Frames since it was found.
    pub(super) missed: u8,
    /// Frames in which it disagreed with the others.
    pub(super) wrong: u8,
    pub(super) used: bool,
    /// How many points had this place before.
    pub(super) lives: u16,
    /// What both cameras saw of it in the view that self-calibration compares with.
    pub(super) anchor: Option<Vector3<T>>,
}

/// The product of two warps.
pub(super) fn product(a: &[[f32; 2]; 2], b: &[[f32; 2]; 2]) -> [[f32; 2]; 2] {
    let row = |[x, y]: [f32; 2]| [x * b[0][0] + y * b[1][0], x * b[0][1] + y * b[1][1]];
    [row(a[0]), row(a[1])]
}

impl<T: Real> Track<T> {
    /// Not in use. All zeros: an odometry in a `static` takes RAM and no flash.
    pub const EMPTY: Self = Self {
        point: InversePoint::ZERO,
        template: Template::NONE,
        warp: [[0.0; 2]; 2],
        descriptor: Descriptor::NONE,
        pixel: [0.0; 2],
        now: None,
        correlation: 0.0,
        fresh: Descriptor::NONE,
        seen: 0,
        missed: 0,
        wrong: 0,
        used: false,
        lives: 0,
        anchor: None,
    };

    /// Whether the last frame sees it where it is expected.
    pub(super) fn is_followed(&self) -> bool {
        self.used && self.missed == 0
    }

    /// Whether the depth is known to a share of itself.
    pub(super) fn is_deep(&self, share: f64) -> bool {
        let r = self.point.at.z;
        let variance = self.point.covariance.m33;
        r > T::ZERO && variance < r * r * T::of(share * share)
    }
}
