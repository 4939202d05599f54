//! Frames from moving cameras.
//!
//! * `bundle`: bundle adjustment and structure of many views.
//! * `drives`, `states`, `degenerate`, `few`, `refine`, `templates`, `trajectories`: visual odometry, on
//!   scenes that are driven through, where nothing moves or nothing can be told, and what its errors are.

mod bundle;
mod degenerate;
mod drives;
mod few;
mod refine;
mod self_calibration;
mod states;
mod support;
mod templates;
mod trajectories;
