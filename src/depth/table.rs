//! Look-up table of depths, for cores without a divider: a Cortex-M0+ takes some 60 instructions per
//! division.

use super::DepthScale;
use super::range::largest;
use crate::matching::Config;
use crate::units::{Disparity, Millimetres};
use heapless::Vec;

/// Depth of every disparity of a search range, [`DepthScale::millimetres`] without a division.
///
/// The capacity `N` is at least `32 disparities + 1`, one entry per step: `2 N` bytes.
///
/// ```
/// use stereopsis::depth::{DepthScale, DepthTable};
/// use stereopsis::{geometry::camera::RectifiedRig, matching::{Block, Config}, units::Disparity};
/// let scale = DepthScale::new(&RectifiedRig::new(100.0, 0.05, 48.0, 32.0)?)?;
/// let table = DepthTable::<513>::new(&scale, &Config::for_method::<Block>(96, 64, 16))?;
/// let d = Disparity::from_raw(100);
/// assert_eq!(table.millimetres(d), scale.millimetres(d));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct DepthTable<const N: usize> {
    first: u16,
    depths: Vec<Millimetres, N>,
}

/// The table is too small for the search range.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TableError {
    /// Number of entries that would have been enough.
    pub needed: usize,
}

error_text!(TableError {
    Self { needed } => "the table must hold {needed} depths",
});

impl<const N: usize> DepthTable<N> {
    /// Tabulates the depths of all disparities that a search can return.
    pub fn new(scale: &DepthScale, config: &Config) -> Result<Self, TableError> {
        let first = Disparity::from_pixels(config.min_disparity).raw();
        let last = largest(config).raw();
        let mut depths = Vec::new();
        for raw in first..=last {
            let depth = scale.millimetres(Disparity::from_raw(raw));
            depths.push(depth).map_err(|_| TableError { needed: usize::from(last - first) + 1 })?;
        }
        Ok(Self { first, depths })
    }

    /// Returns the depth of an answer; [`Millimetres::NONE`] for no answer and for disparities outside the
    /// search.
    pub fn millimetres(&self, disparity: Disparity) -> Millimetres {
        let place = usize::from(disparity.raw().wrapping_sub(self.first));
        self.depths.get(place).copied().unwrap_or(Millimetres::NONE)
    }
}
