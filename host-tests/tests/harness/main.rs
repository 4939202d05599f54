//! The harness itself: mock cameras, rendered scenes, altered pairs, files of calibration, and calibration
//! from pictures of boards.

mod altered;
mod calibrate;
mod calibration;
mod chance;
mod contrast;
mod copied;
mod deep;
mod faults;
mod mock_camera;
mod orientation;
mod output;
mod pair;
mod pair_moved;
mod raw_calibration;
mod rows;
mod scene;
mod sequences;
