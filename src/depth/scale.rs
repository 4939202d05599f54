//! Depth of a disparity by triangulation of a rectified pair, `Z = f b / (d + doffs)`.

use crate::geometry::camera::RectifiedRig;
use crate::math::round;
use crate::units::{Disparity, Metres, Millimetres};
use nalgebra::Point3;

/// Conversion of disparities to depths for one rig, `Z = f b / (d + doffs)`.
///
/// ```
/// use stereopsis::units::{Disparity, Metres, Millimetres};
/// use stereopsis::{depth::DepthScale, geometry::camera::RectifiedRig};
/// let rig = RectifiedRig::new(500.0, 0.1, 160.0, 120.0)?;
/// let scale = DepthScale::new(&rig)?;
/// let d = Disparity::from_pixels(25);
/// assert_eq!(scale.millimetres(d), Millimetres(2000));
/// assert_eq!(scale.metres(d), Some(Metres(2.0)));
/// // A quarter of a pixel at 2 m: 4 / (500 * 0.1) * 0.25
/// assert_eq!(scale.sigma(d, 0.25), Some(Metres(0.02)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DepthScale {
    rig: RectifiedRig,
    /// `f b` in millimetres times steps of disparity.
    millimetre_steps: u32,
    /// `doffs` in steps of disparity.
    offset_steps: i32,
}

/// Why a rig's depths do not fit integers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum DepthError {
    /// Focal length times baseline is over 134 000 px m.
    TooLarge,
    /// Focal length times baseline is under 0.0000156 px m: every depth would round to nothing.
    TooSmall,
    /// The offset between the principal points is over 30 000 px.
    Offset,
}

error_text!(DepthError {
    Self::TooLarge => "focal length times baseline must be under 134000 px m",
    Self::TooSmall => "focal length times baseline must be over 0.0000156 px m",
    Self::Offset => "the principal points must be under 30000 px apart",
});

impl DepthScale {
    /// Creates the scale of a rig.
    pub fn new(rig: &RectifiedRig) -> Result<Self, DepthError> {
        let steps = f32::from(Disparity::ONE);
        let millimetre_steps = round(rig.focal_px() * rig.baseline_m() * 1000.0 * steps);
        let offset_steps = round(rig.disparity_offset_px() * steps);
        if millimetre_steps < 1.0 {
            return Err(DepthError::TooSmall);
        }
        // The largest f32 under 2^32.
        if millimetre_steps > 4_294_967_040.0 {
            return Err(DepthError::TooLarge);
        }
        if !(-960_000.0..=960_000.0).contains(&offset_steps) {
            return Err(DepthError::Offset);
        }
        Ok(Self { rig: *rig, millimetre_steps: millimetre_steps as u32, offset_steps: offset_steps as i32 })
    }

    /// Returns the rig.
    pub fn rig(&self) -> &RectifiedRig {
        &self.rig
    }

    /// `f b` in millimetres times steps of disparity.
    pub(crate) fn millimetre_steps(&self) -> u32 {
        self.millimetre_steps
    }

    /// Offset between the principal points, `doffs`, in steps of disparity.
    pub(crate) fn offset_steps(&self) -> i32 {
        self.offset_steps
    }

    /// Returns the depth to the nearest millimetre, by one integer division; [`Millimetres::NONE`] for no
    /// answer, at or behind infinity, nearer than half a millimetre or beyond 65.535 m.
    ///
    /// The offset `doffs` is rounded to 1/32 px, which moves the depth by at most `Z^2 / (f b) / 64`.
    pub fn millimetres(&self, disparity: Disparity) -> Millimetres {
        let shift = i32::from(disparity.raw()) + self.offset_steps;
        if disparity.is_none() || shift <= 0 {
            return Millimetres::NONE;
        }
        let shift = shift as u32;
        let whole = self.millimetre_steps / shift;
        let rest = self.millimetre_steps % shift;
        let rounded = whole + u32::from(rest >= shift - rest);
        u16::try_from(rounded).map_or(Millimetres::NONE, Millimetres)
    }

    /// Returns the depth in metres; `None` for no answer and at or behind infinity.
    pub fn metres(&self, disparity: Disparity) -> Option<Metres> {
        self.rig.depth_m(disparity.to_f32()?).map(Metres)
    }

    /// Returns the depth's standard deviation for a disparity with standard deviation `sigma_px`, by
    /// first-order propagation: `sigma_Z = Z^2 / (f b) sigma_d`.
    pub fn sigma(&self, disparity: Disparity, sigma_px: f32) -> Option<Metres> {
        self.metres_and_sigma(disparity.to_f32()?, sigma_px).map(|(_, sigma)| sigma)
    }

    /// Returns the depth of a disparity in px, and its standard deviation.
    // In flash once.
    #[inline(never)]
    pub(super) fn metres_and_sigma(&self, disparity_px: f32, sigma_px: f32) -> Option<(Metres, Metres)> {
        let z = self.rig.depth_m(disparity_px)?;
        let per_px = z * z / (self.rig.focal_px() * self.rig.baseline_m());
        Some((Metres(z), Metres(per_px * sigma_px)))
    }

    /// Returns the point that column `u` and row `v` show, in the left camera's frame, m.
    pub fn point(&self, u: u16, v: u16, disparity: Disparity) -> Option<Point3<f32>> {
        self.rig.reproject(f32::from(u), f32::from(v), disparity.to_f32()?)
    }
}
