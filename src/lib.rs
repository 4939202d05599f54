//! Stereo depth on a microcontroller: `no_std`, no allocation, line by line.
//!
//! Lines of pixels of two cameras go in, rows of disparity and depth come out a few lines later. The modules
//! are in the order in which data moves; each uses only what stands above it.
//!
//! ```text
//! errors         what errors say
//! units math     types with units: Disparity, Millimetres, PixelFlags; the one file that names libm
//! dsp            instructions of Arm on four bytes, where the target has them
//! stored         values read back by serde, through their constructors' checks
//! geometry       camera models, two-view geometry, pose, robust estimation, rectification; no pixels
//! camera         traits of line sources, two cameras as a stereo source, sensor drivers, line hand-off
//! imaging        grey lines, line windows, census, gradients, rectifying remap, exposure, noise
//! matching       lines -> disparity rows: costs, aggregation, winner-take-all, checks, sub-pixel, filters
//! depth          disparity -> depth with its deviation, points; temporal filter, decimation, display
//! focus          thin lens, sharpness, depth from focus, lens motors
//! features       corners, descriptors, feature matches
//! motion         odometry, structure from motion, bundle adjustment, self-calibration
//! obstacles      disparity rows -> ground, stixels, nearest per sector, free space, a decision
//! pipeline       the live path, row by row: camera -> imaging -> matching
//! ffi            the pipeline for C, with the feature `ffi`
//!
//! camera -lines-> imaging -line windows-> matching -disparity row-> depth
//!        '------------------------ pipeline -----------------------' -> ffi
//! camera -lines-> imaging -lines-> features -matches-> motion, geometry -> poses, points
//!                         '-------> focus -> depth from one lens
//! ```
//!
//! Start here: firmware implements [`camera::StereoSource`], or pushes lines itself, keeps a
//! [`pipeline::Pipeline`] in a static, reads a [`matching::Row`] per line, and converts it to millimetres by
//! a [`depth::DepthScale`].
#![no_std]

/// The lists that features and matches are put into, in the version that they come from.
pub use heapless;
/// The matrices and vectors of the public interface, in the version that they come from.
pub use nalgebra;

#[macro_use]
mod errors;
pub mod units;
mod math;

#[cfg(any(stereopsis_dsp, stereopsis_vectors))]
#[allow(dead_code, reason = "on a Cortex-M55 vectors do the most of it")]
mod dsp;

#[macro_use]
mod stored;
pub mod geometry;
pub mod camera;
pub mod imaging;
pub mod matching;
pub mod depth;
pub mod focus;
pub mod features;
pub mod motion;
pub mod obstacles;
pub mod pipeline;

#[cfg(feature = "ffi")]
pub mod ffi;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(doctest)]
#[doc = include_str!("../docs/library.md")]
struct LibraryPage;

#[cfg(doctest)]
#[doc = include_str!("../docs/firmware.md")]
struct FirmwarePage;

#[cfg(doctest)]
#[doc = include_str!("../docs/calibration.md")]
struct CalibrationPage;
