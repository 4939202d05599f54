//! Depth from two cameras, on a microcontroller: `no_std`, no allocation, line by line.
//!
//! Lines of pixels go in, rows of disparity and depth come out a few lines later. The modules stand in the
//! order in which data moves; each uses only what stands above it.
//!
//! ```text
//! units math     words: Disparity, Millimetres, PixelFlags; the one file that names libm
//! geometry       pure maths on fixed-size nalgebra types, no pixels
//! camera         traits for where lines come from; two cameras as one stereo source; sensor drivers, line hand-off
//! imaging        lines, line windows, pixel formats, remap, census, gradients, noise
//! matching       lines -> disparity row: census, costs, winner, checks, sub-pixel, speckle
//! depth          disparity -> metres with its uncertainty, points; over frames, smaller, on a display
//! focus          thin lens, sharpness, depth from focus, lens motors
//! features       corners, descriptors, matches: which point of one picture is which of another
//! motion         where cameras go and what they see on the way: odometry, structure of many views, bundle adjustment
//! pipeline       the live path, row by row
//! ffi            the same for C, with the feature `ffi`
//!
//! camera -lines-> imaging -line windows-> matching -disparity row-> depth
//!        '------------------------ pipeline -----------------------' -> ffi
//! camera -lines-> imaging -line bands-> features -matches-> motion -poses
//!                         |                          '-sights-> geometry, motion
//!                         '-------------> focus -peaks-> depth by one lens
//! ```
//!
//! A way in: [`pipeline::Pipeline`] is what firmware holds, [`camera::StereoSource`] is what it implements,
//! [`matching::Row`] is what it gets, [`depth::DepthScale`] is what turns that into millimetres.
#![no_std]

pub mod units;

mod math;

pub mod geometry;

pub mod camera;

pub mod imaging;

pub mod matching;

pub mod depth;

pub mod focus;

pub mod features;

pub mod motion;

pub mod pipeline;

#[cfg(feature = "ffi")]
pub mod ffi;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
