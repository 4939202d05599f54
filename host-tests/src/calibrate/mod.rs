//! A stereo rig from pictures of a chessboard.
//!
//! In: pairs of pictures, or of their corners. Out: [`Calibrated`]: the rig in metres, where the boards
//! stood, and what is left of every corner. In running order:
//!
//! * [`board`]: the board's corners in a picture.
//! * `start`: focal lengths and poses from each view's homography (Zhang 2000).
//! * `bundle`: the least sum of squares of all residuals, by Levenberg and Marquardt's method; first of each
//!   camera by itself, lens coefficient by lens coefficient, then of both with one pose between them.
//!   `normal`: its equations. `deviations`: how far off what is found may be.
//! * `lens`: the models of lenses. `solve`: these in order. `calibrated`: what they find, and its worth.
//! * [`coverage`]: how much of the pictures the boards reached. [`report`](mod@report): the residuals, drawn.
//!
//! [`scene`] makes pictures of boards for tests.

pub mod board;
mod bundle;
mod calibrated;
pub mod coverage;
mod deviations;
mod lens;
mod normal;
mod paired;
pub mod report;
pub mod scene;
mod solve;
mod start;

pub use calibrated::{Calibrated, SolveError, View, ViewFigures};
pub use lens::LensModel;
pub use paired::solve_paired;
pub use solve::solve;
