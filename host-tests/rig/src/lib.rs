//! What is known of a rig of two cameras before it sees anything: the host's programs and the live page,
//! which has no files and no processes, share it.
//!
//! * [`limits`]: how much is read.
//! * [`method`]: the methods of this build, by name.
//! * [`calibration`]: rigs from and to the files of other programs.
//! * [`plan`]: what a rig can tell, and what it takes, before it is built.

pub mod limits;

pub mod method;

pub mod calibration;

pub mod plan;
