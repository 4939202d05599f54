//! The ground plane as a line of the v-disparity (Labayrade, Aubert & Tarel 2002) that leans with the camera.

use super::config::GroundSource;
use crate::depth::DepthScale;
use crate::math::{atan, round};
use crate::units::Disparity;

/// Most of what a slope or an inclination may be, steps of disparity per row in 65536ths.
const STEEPEST: i64 = 1 << 30;

/// Steps in which a plane is given a height: its pitch changes with it.
const BOUNDING_STEPS: usize = 4;

/// Numbers of a rig, rounded to integers.
#[derive(Clone, Copy, Debug)]
pub(super) struct RigNumbers {
    /// Focal length, sixteenths of a px.
    pub(super) focal_16ths: i32,
    /// Column of the principal point, sixteenths of a px.
    pub(super) cx_16ths: i32,
    /// Row of the principal point, halves of a px.
    pub(super) cy_halves: i32,
    /// Baseline, sixteenths of a mm.
    baseline_16ths: i32,
}

impl RigNumbers {
    pub(super) const ZERO: Self = Self { focal_16ths: 0, cx_16ths: 0, cy_halves: 0, baseline_16ths: 0 };

    pub(super) fn new(scale: &DepthScale) -> Self {
        let rig = scale.rig();
        let whole = |x: f32| round(x.clamp(-1e9, 1e9)) as i32;
        Self {
            focal_16ths: whole(16.0 * rig.focal_px()).max(1),
            cx_16ths: whole(16.0 * rig.principal_point().0),
            cy_halves: whole(2.0 * rig.principal_point().1),
            baseline_16ths: whole(16_000.0 * rig.baseline_m()).max(1),
        }
    }

    /// Bearing of a column of pixels, thousandths of a radian to the right.
    pub(super) fn bearing_mrad(&self, u: f32) -> i16 {
        let tangent = (u - self.cx_16ths as f32 / 16.0) * 16.0 / self.focal_16ths as f32;
        round(1000.0 * atan(tangent)) as i16
    }

    /// Deviation of the pitch's tangent, 65536ths, where the parallax of a plane with this slope has a
    /// variance at the horizon, 256ths of squared steps: that of the horizon's row beside the focal length.
    pub(super) fn pitch_sigma(&self, slope: i64, variance_256ths: u64) -> Option<u16> {
        // A slope is below 2^30, the root below 2^31: no wrap.
        let per_row = (slope * i64::from(self.focal_16ths)) as u64;
        let sigma = (variance_256ths.isqrt() << 32).checked_div(per_row)?;
        Some(sigma.min(u16::MAX.into()) as u16)
    }
}

/// A ground plane: its parallax `d + doffs` grows by a constant from row to row, and by another one from
/// column to column.
///
/// With the camera at height `H`, pitched down by `theta`, rolled to the right by `rho`, at column `u` and
/// row `v`:
///
/// `d + doffs = b / H (sin rho cos theta (u - cx) + cos rho cos theta (v - cy) + f sin theta)`
///
/// so the growths give the height and the roll, and the parallax at the principal point gives the pitch.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ground {
    /// Parallax at row 0 in the column of the principal point, steps of disparity in 65536ths.
    pub level: i64,
    /// Growth of the parallax from a row to the next, steps of disparity in 65536ths.
    pub slope: i64,
    /// Growth of the parallax from a column to the next, steps of disparity in 65536ths.
    pub lean: i32,
    /// Variance of the parallax, squares of steps of disparity.
    pub variance: u32,
    /// Height of the camera above the ground, mm.
    pub height_mm: u16,
    /// Tangent of the downward pitch of the camera in 65536ths.
    pub pitch_tangent: i32,
    /// Standard deviation of that tangent in 65536ths, at most 65535: 0 where the pose is given.
    pub pitch_sigma: u16,
}

impl Ground {
    /// Largest deviation of a pitch that is sure, its tangent in 65536ths: a third of half a degree.
    const SURE: u16 = 190;

    /// Whether the pitch is sure: three standard deviations of it are within half a degree.
    pub fn is_sure(&self) -> bool {
        self.pitch_sigma <= Self::SURE
    }

    /// Standard deviation of [`Self::pitch_rad`], radians.
    pub fn pitch_sigma_rad(&self) -> f32 {
        f32::from(self.pitch_sigma) / 65_536.0
    }

    /// Parallax of the ground at half-row `halves` (row `halves / 2`) in the column of the principal point,
    /// 256ths of a step of disparity.
    pub(super) fn parallax_256ths(&self, halves: i64) -> i32 {
        // The slope is below 2^30 and rows are below 2^16: no wrap.
        let exact = self.level.wrapping_add(self.slope.wrapping_mul(halves) / 2) >> 8;
        exact.clamp(-(1 << 28), 1 << 28) as i32
    }

    /// What the ground's parallax has more at a position to the right of the principal point, sixteenths of a
    /// px, than in its column, 256ths of a step.
    pub(super) fn beside_256ths(&self, right_16ths: i64) -> i32 {
        ((i64::from(self.lean) * right_16ths) >> 12).clamp(-(1 << 28), 1 << 28) as i32
    }

    /// Parallax of the ground at a half-row and a position to the right, whole steps of disparity.
    pub(super) fn parallax(&self, halves: i64, right_16ths: i64) -> i32 {
        (self.parallax_256ths(halves) + self.beside_256ths(right_16ths)) >> 8
    }

    /// Number of rows in which the ground is not seen at any of these positions to the right of the principal
    /// point, sixteenths of a px.
    pub(super) fn rows_above(&self, right_16ths: [i64; 2]) -> u16 {
        let beside = right_16ths.map(|right| (i64::from(self.lean) * right) >> 4);
        let below = -self.level.saturating_add(beside[0].max(beside[1]));
        let rows = below.max(0).saturating_add(self.slope - 1).checked_div(self.slope);
        rows.map_or(0, |rows| rows.min(u16::MAX.into()) as u16)
    }

    /// Downward pitch of the camera, radians.
    pub fn pitch_rad(&self) -> f32 {
        atan(self.pitch_tangent as f32 / 65_536.0)
    }

    /// Roll of the camera, radians: positive where its right side is the lower one.
    pub fn roll_rad(&self) -> f32 {
        atan(self.lean as f32 / self.slope.max(1) as f32)
    }

    /// A plane with this parallax; `None` where no camera in front of a plane sees such a one.
    pub(super) fn from_line(
        level: i64,
        slope: i64,
        lean: i64,
        variance: u32,
        rig: &RigNumbers,
    ) -> Option<Self> {
        let at_centre = level.wrapping_add(slope.wrapping_mul(rig.cy_halves.into()) / 2);
        let inclination = at_centre.wrapping_mul(16).checked_div(rig.focal_16ths.into())?;
        if !(1..STEEPEST).contains(&slope) || inclination.abs() >= STEEPEST || lean.abs() > slope {
            return None;
        }
        let down = (slope * slope + lean * lean) as u64;
        let norm = (down + (inclination * inclination) as u64).isqrt();
        let scaled = (i64::from(rig.baseline_16ths) * 131_072) as u64;
        let height_mm = u16::try_from(scaled.checked_div(norm)?).ok()?;
        let pitch_tangent = i32::try_from((inclination * 65_536).checked_div(down.isqrt() as i64)?).ok()?;
        let (lean, pitch_sigma) = (lean as i32, 0);
        Some(Self { level, slope, lean, variance, height_mm, pitch_tangent, pitch_sigma })
    }

    /// The plane below a camera of known pose, thousandths of a radian, with no uncertainty but that of 1
    /// step.
    pub(super) fn given(pitch_mrad: i16, roll_mrad: i16, height_mm: u16, rig: &RigNumbers) -> Option<Self> {
        // The series of the tangent: 0.00005 off at half a radian.
        let tangent = |mrad: i16| {
            let angle = f32::from(mrad) / 1000.0;
            let square = angle * angle;
            angle * (1.0 + square * (1.0 / 3.0 + square * (2.0 / 15.0 + square * (17.0 / 315.0))))
        };
        let cosine = |tangent: f32| 1.0 / nalgebra::ComplexField::sqrt(1.0 + tangent * tangent);
        let (pitch, roll) = (tangent(pitch_mrad), tangent(roll_mrad));
        let per_px = rig.baseline_16ths as f32 / 16.0 / f32::from(height_mm.max(1)) * cosine(pitch);
        let down = per_px * f32::from(Disparity::ONE) * 65_536.0;
        if down >= STEEPEST as f32 {
            return None;
        }
        let slope = round(down * cosine(roll));
        let at_centre = down * pitch * rig.focal_16ths as f32 / 16.0;
        let level = at_centre - slope * rig.cy_halves as f32 / 2.0;
        let lean = round(slope * roll);
        let ground = Self::from_line(round(level) as i64, slope as i64, lean as i64, 1, rig)?;
        Some(Self { height_mm, ..ground })
    }

    /// The plane with the nearest height that a search allows, and the same parallax at half-row `halves`;
    /// `None` if its own height is more than an eighth off.
    pub(super) fn bounded(&self, source: &GroundSource, halves: i64, rig: &RigNumbers) -> Option<Self> {
        let GroundSource::Searched { least_height_mm, most_height_mm, .. } = *source else {
            return Some(*self);
        };
        let height_mm = self.height_mm.clamp(least_height_mm, most_height_mm.max(least_height_mm));
        if 8 * u32::from(self.height_mm.abs_diff(height_mm)) > u32::from(height_mm) {
            return None;
        }
        let mut plane = *self;
        for _ in 0..BOUNDING_STEPS {
            if plane.height_mm == height_mm {
                break;
            }
            // The higher the camera, the less the parallax grows.
            let slope = (plane.slope * i64::from(plane.height_mm)).checked_div(height_mm.into())?;
            let level = plane.level + (plane.slope - slope) * halves / 2;
            plane = Self::from_line(level, slope, plane.lean.into(), plane.variance, rig)?;
        }
        Some(Self { height_mm, ..plane })
    }

    /// Whether the plane is within what a search allows.
    pub(super) fn is_within(&self, source: &GroundSource) -> bool {
        match *source {
            GroundSource::Searched { least_height_mm, most_height_mm, most_pitch, most_roll } => {
                (least_height_mm..=most_height_mm).contains(&self.height_mm)
                    && i64::from(self.pitch_tangent).abs() * 1000 <= i64::from(most_pitch) * 65_536
                    && i64::from(self.lean).abs() * 1000 <= i64::from(most_roll) * self.slope
            }
            _ => true,
        }
    }

    /// Height above the ground of what has this parallax where the ground has `ground`, mm.
    pub(super) fn height_above(&self, parallax: i32, ground: i32) -> i16 {
        let above = i64::from(self.height_mm) * i64::from(parallax - ground);
        let height = above.checked_div(i64::from(parallax)).unwrap_or(0);
        height.clamp(i16::MIN.into(), i16::MAX.into()) as i16
    }
}

/// The ground over frames: a Kalman filter of the line with one variance.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct CarriedGround {
    pub(super) ground: Option<Ground>,
    /// Frames since a ground was last measured.
    age: u8,
}

impl CarriedGround {
    pub(super) const NONE: Self = Self { ground: None, age: 0 };
    /// Variance that a frame adds: a quarter of a px by which a moving camera nods.
    const PER_FRAME: u32 = 64;
    /// Frames for which a ground is carried without being measured.
    const MOST_HELD: u8 = 8;

    /// The carried ground in the next frame, before it is measured there.
    fn predicted(&self, rig: &RigNumbers) -> Option<Ground> {
        let ground = self.ground?;
        let nod = rig.pitch_sigma(ground.slope, u64::from(Self::PER_FRAME) << 8).unwrap_or(u16::MAX);
        let [before, nod] = [ground.pitch_sigma, nod].map(u32::from);
        // Each is below 2^16; both squares may not fit in 32 bits.
        let pitch_sigma = (u64::from(before * before) + u64::from(nod * nod)).isqrt().min(u16::MAX.into());
        let (variance, pitch_sigma) = (ground.variance + Self::PER_FRAME, pitch_sigma as u16);
        Some(Ground { variance, pitch_sigma, ..ground })
    }

    /// Takes what a frame measured. A measurement within three deviations at all of `at`, half-rows and
    /// positions to the right, is averaged with what was carried, by their variances; any other one replaces
    /// it.
    ///
    /// The deviations of pitches are averaged as well: what a texture does to a fit it does in all frames.
    pub(super) fn update(&mut self, measured: Option<Ground>, at: [(i64, i64); 4], rig: &RigNumbers) {
        let carried = self.predicted(rig);
        let (Some(old), Some(new)) = (carried, measured) else {
            self.age = if measured.is_some() { 0 } else { self.age.saturating_add(1) };
            self.ground = measured.or(carried.filter(|_| self.age <= Self::MOST_HELD));
            return;
        };
        self.age = 0;
        let both = i64::from(old.variance) + i64::from(new.variance);
        let agree = at.iter().all(|&(halves, right)| {
            let apart = i64::from(new.parallax(halves, right) - old.parallax(halves, right));
            apart * apart <= 9 * both
        });
        let gain = (256 * i64::from(old.variance)).checked_div(both).unwrap_or(256);
        let mix = |old: i64, new: i64| old + (((new - old) * gain) >> 8);
        let variance = (i64::from(old.variance) * (256 - gain) / 256).max(1) as u32;
        let (level, slope) = (mix(old.level, new.level), mix(old.slope, new.slope));
        let lean = mix(old.lean.into(), new.lean.into());
        let pitch_sigma = mix(old.pitch_sigma.into(), new.pitch_sigma.into()) as u16;
        let mixed = Ground::from_line(level, slope, lean, variance, rig);
        let mixed = mixed.map(|ground| Ground { pitch_sigma, ..ground });
        self.ground = if agree { mixed.or(measured) } else { measured };
    }
}
