//! Image lines: grey conversion, line windows, census, gradients, rectification, exposure, noise.
//!
//! In: lines from a camera. Out: census and gradient rows, rectified lines.
//!
//! 1. [`GreyLines`]: any pixel format as 8-bit grey; [`BayerLines`]: a Bayer mosaic as grey.
//! 2. [`LineWindow`]: the last five lines, as the rows around a centre.
//! 3. [`census_plus4`], [`census_ring8`], [`census_wide8`]: the codes of one row. [`gradients`]: Sobel
//!    gradients of a row.
//! 4. [`RectifiedPair`]: rectified lines of raw ones, by a [`Remap`] for each camera with its [`RemapTable`].
//! 5. [`PairMonitor`]: health of the cameras, by a [`Histogram`] of each; [`AutoExposure`]: one exposure for
//!    both.
//! 6. [`BalancedPair`]: the right camera's lines with the brightness of the left one's.
//! 7. [`NoiseMeter`]: noise of the lines as a level of [`Noise`]; [`smooth()`]: a binomial filter against it.
//!
//! Everywhere in this module but in remapped lines, borders repeat the nearest row or column inside the
//! image.

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
mod rows;
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
    RectifiedPair, RectifiedPairError, Remap, RemapError, RemapPair, RemapPairError, RemapTable,
    RemapTableError,
};
pub(crate) use rows::{RowRing, chunks, chunks_mut, part};
pub use smooth::smooth;
pub use window::LineWindow;
