//! What the programs of this firmware share. A program stands in `src/bin`: `depth` is the pipeline, `pose`
//! two views, `bundle` their adjustment, `features` corners and their matches, `focus` depth by a lens that
//! moves, `gates` the pipeline behind a block of gates, `interrupt` lines that an interrupt brings,
//! `odometry` where a pair of cameras goes, `rectify` raw lines, `any_frames` frames of any size with all
//! that can be asked of them, `soak` frames of a camera with every fault, `dump` the rows of the matcher's
//! stages.
//!
//! * [`choice`]: the method, the sizes and the board, chosen when it is built; [`board`] is the list of
//!   boards, a package of its own.
//! * [`camera`]: where lines come from: the built-in scene, or two files on the host.
//! * [`rows`]: rows of disparity to a file on the host, with their checksum; `stage_files`: rows of the
//!   matcher's stages, `first_half` and `candidates`: those of the stages that it keeps none of.
//!   [`console`]: figures as text.
//! * [`host`]: files on the host. [`block`]: a simulated block of gates behind two of them.
//! * [`clock`]: instructions counted; [`ticker`]: the same timer, for interrupts. [`stack`]: the stack
//!   measured.
//! * [`firmware_scenes`], a package of its own: what the programs see, and their work on it.
//! * [`log`]: defmt through semihosting. [`runtime`]: start and end of a program, and no panic.
//!
//! Files, text and log go to the host by semihosting, which works under QEMU and with a debugger. In a
//! product these modules are the drivers, and what is left is the pipeline in a static and a loop over its
//! rows.
#![no_std]

pub mod block;
pub mod camera;
#[cfg(feature = "trace")]
mod candidates;
pub mod clock;
pub mod console;
#[cfg(feature = "trace")]
pub mod first_half;
pub mod host;
pub mod log;
pub mod rows;
pub mod runtime;
pub mod stack;
#[cfg(feature = "trace")]
pub mod stage_files;
pub mod ticker;

pub use firmware_boards as board;
pub use firmware_scenes::{
    any_frames, drive, raw_pair, scene, soak, sweep, two_pictures, two_views, walk, window,
};

/// The method, the sizes and the board: `build.rs` writes this from the environment.
pub mod choice {
    include!(concat!(env!("OUT_DIR"), "/choice.rs"));
}
