//! Lines of pixels: held in windows, brought to grey, turned into census codes.
//!
//! In: lines from a camera. Out: census rows.
//!
//! 1. [`GreyLines`]: any pixel format as 8-bit grey lines; [`BayerLines`]: a mosaic of colours as well.
//! 2. [`LineBand`]: the last lines, as the rows around a centre; [`LineWindow`] holds five.
//! 3. [`census_plus4`], [`census_ring8`], [`census_wide8`]: the codes of one row.
//!    [`gradients`]: how its brightness changes along the line and across it.
//! 4. [`RectifiedPair`]: raw lines as rectified ones, by a [`Remap`] for each camera with its [`RemapTable`].
//! 5. [`PairMonitor`]: what the pictures tell of the cameras' health, with a [`Histogram`] of each;
//!    [`AutoExposure`]: one exposure for both.
//! 6. [`BalancedPair`]: the right camera's lines as the left one would have exposed them.
//! 7. [`NoiseMeter`]: how noisy the lines are, in levels of [`Noise`]; [`smooth()`]: a row of a window with
//!    less of it.
//!
//! Borders, but of remapped lines: a row or column outside the image is the nearest one inside it, everywhere
//! in this module.

mod balance;
mod bayer;
mod census;
mod exposure;
mod gradient;
mod grey;
mod health;
mod histogram;
mod noise;
mod picture;
mod remap;
mod smooth;
mod window;

pub use balance::{Balance, BalancedPair};
pub use bayer::BayerLines;
pub use census::{census_plus4, census_ring8, census_wide8};
pub use exposure::{AutoExposure, ExposureCommand, ExposureLimits};
pub use gradient::gradients;
pub use grey::GreyLines;
pub use health::{CameraHealth, PairMonitor};
pub use histogram::Histogram;
pub use noise::{Noise, NoiseMeter};
pub use picture::{Picture, PictureError};
pub use remap::{
    RectifiedPair, RectifiedPairError, Remap, RemapError, RemapPair, RemapTable, RemapTableError,
};
pub use smooth::smooth;
pub use window::{LineBand, LineWindow};
