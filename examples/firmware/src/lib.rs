//! What the programs of this firmware share. A program stands in `src/bin`: `depth` is the pipeline, `pose`
//! two views, `bundle` their adjustment, `features` corners and their matches, `focus` depth by a lens that
//! moves, `interrupt` lines that an interrupt brings, `odometry` where a pair of cameras goes, `rectify` raw
//! lines.
//!
//! * [`choice`]: the method, the sizes and the board, chosen when it is built; [`board`] is the list of
//!   boards.
//! * [`camera`]: where lines come from: the built-in scene, or two files on the host.
//! * [`rows`]: rows of disparity to a file on the host, with their checksum. [`console`]: figures as text.
//! * [`host`]: files on the host.
//! * [`clock`]: instructions counted; [`ticker`]: the same timer, for interrupts. [`stack`]: the stack
//!   measured.
//! * [`two_views`]: matches of a known world, and the pose and points that they give.
//! * [`window`]: two views and their points, adjusted.
//! * [`two_pictures`]: features of two cameras' lines, and their matches.
//! * [`sweep`]: frames of a lens that moves, and where each tile is in focus.
//! * [`raw_pair`]: raw lines, rectified, and depth from them.
//! * [`walk`]: a view that moves, and the motion from frame to frame.
//! * [`log`]: defmt through semihosting. [`runtime`]: start and end of a program, and no panic.
//!
//! Files, text and log go to the host by semihosting, which works under QEMU and with a debugger. In a
//! product these modules are the drivers, and what is left is the pipeline in a static and a loop over its
//! rows.
#![no_std]

pub mod board;
pub mod camera;
pub mod clock;
pub mod console;
pub mod host;
pub mod log;
pub mod raw_pair;
pub mod rows;
pub mod runtime;
pub mod stack;
pub mod sweep;
pub mod ticker;
pub mod two_pictures;
pub mod two_views;
pub mod walk;
pub mod window;

use camera::scene;

/// The method, the sizes and the board: `build.rs` writes this from the environment.
pub mod choice {
    include!(concat!(env!("OUT_DIR"), "/choice.rs"));
}
