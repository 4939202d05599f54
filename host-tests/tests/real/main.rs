//! Real pictures of the folder in `STEREO_DATA`, one file a kind.

mod bundle;
mod calibration;
mod dense;
mod features;
mod focus;
mod obstacles;
mod odometry;
mod two_view;
