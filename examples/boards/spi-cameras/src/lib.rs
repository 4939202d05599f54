//! Two cameras with an SPI bus, and the matcher that works while their next line is on its way: what the
//! boards without a camera port share.
//!
//! * [`mega`]: the camera, an Arducam Mega, which keeps its picture until it is read.
//! * [`frames`]: a frame of both, line by line through the pipeline.
//! * [`text`]: what the boards say of frames and faults.
//! * `simulated`, with the feature of that name: a camera without hardware, as the other end of the bus.
#![no_std]

pub mod frames;
pub mod mega;
#[cfg(feature = "simulated")]
pub mod simulated;
pub mod text;
