//! Depth from focus: the lens that images a point sharply tells how far it is.
//!
//! In: frames of one scene with the lens in different positions, line by line. Out: for each pixel or tile
//! the position in which it is sharpest, and its depth.
//!
//! * [`ThinLens`], [`MicroLens`]: `1/z + 1/Z = 1/f` in floats and in whole micrometres, with
//!   [`DepthOfField`].
//! * [`SharpnessRows`]: classic measures of sharpness over windows. In them and below, in running order:
//!   [`binomial`], [`modified_laplacian`], [`tenengrad`], [`laplacian`].
//! * [`FocusMap`]: frames to a [`FocusPeak`] for each cell, with [`Breathing`]; among windows of
//!   several sizes [`narrowest_steady`] chooses; then [`median_row`] and [`plane_row`], and beside
//!   edges in depth, by [`FocusOrder`], [`uncover_row`], [`partly_hidden_row`] and [`extend_row`].
//! * [`FocusScale`]: peaks to [`Depth`](crate::depth::Depth).
//! * [`LensActuator`], [`Dw9714`]: what moves a lens. [`FocusCalibration`]: its positions to distances.
//! * [`RegionSharpness`], [`Autofocus`] with its [`FocusSearch`]: a region brought into focus in few frames.
//!
//! A stack of five frames, of which the third is the sharpest:
//!
//! ```
//! use stereopsis::focus::{Breathing, FocusConfig, FocusMap};
//! let mut map = FocusMap::<16, 2, 4>::new();
//! map.start(&FocusConfig::tiles(16, 16))?;
//! for contrast in [2, 10, 40, 10, 2] {
//!     map.begin_frame(Breathing::NONE)?;
//!     for y in 0..16 {
//!         let brighter = |x| if (x / 2 + y / 2) % 2 == 0 { contrast } else { 0 };
//!         let line = core::array::from_fn::<u8, 16, _>(|x| 100 + brighter(x));
//!         map.push(&line, |_| {})?;
//!     }
//! }
//! map.finish()?;
//! let peak = map.peak(0, 0)?;
//! assert_eq!((peak.position(), peak.confidence > 100), (2.0, true));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod actuator;
mod all_in_focus;
mod box_filter;
mod config;
mod breathing;
mod dw9714;
mod error;
mod focus_measures;
mod lens;
mod calibration;
mod depth_of_field;
mod logarithm;
mod micro_lens;
mod peak;
mod cells;
mod map_state;
mod map_view;
mod map;
mod median;
mod moving_least_squares;
mod occlusion;
mod peak_search;
mod autofocus;
mod scale;
mod sharpness;
mod region;
mod window_choice;

pub use actuator::{ActuatorErrorType, ActuatorLimits, LensActuator};
pub use all_in_focus::AllInFocusRow;
pub use autofocus::{Autofocus, AutofocusError, Focused, LensCommand, LensEvent};
pub use breathing::Breathing;
pub use calibration::{FocusCalibration, FocusCalibrationError};
pub use config::{FocusConfig, FocusConfigError, FocusLineError};
pub use depth_of_field::{DepthOfField, FarLimit};
pub use dw9714::{Dw9714, Slew};
pub use error::LensError;
pub use focus_measures::{binomial, laplacian, modified_laplacian, tenengrad};
pub use lens::ThinLens;
pub use map::FocusMap;
pub use map_state::FocusMapState;
pub use map_view::FocusMapView;
pub use median::median_row;
pub use micro_lens::MicroLens;
pub use moving_least_squares::plane_row;
pub use occlusion::{FocusOrder, extend_row, partly_hidden_row, uncover_row};
pub use peak::{FocusCell, FocusPeak, NoFocus};
pub use peak_search::{FocusSearch, FocusSearchStep};
pub use region::{Region, RegionSharpness};
pub use scale::{FocusScale, FocusScaleError};
pub use sharpness::{Measure, SharpnessRows};
pub use window_choice::narrowest_steady;
