//! What is followed, and by which cameras.

use stereopsis::geometry::camera::{Camera, RectifiedRig};

/// Points that are followed at most.
pub const POINTS: usize = 2048;

/// The cameras.
#[derive(Clone, Copy, Debug)]
pub enum Rig {
    /// A pair with aligned rows.
    Stereo(RectifiedRig),
    /// One camera.
    Mono(Camera<f64>),
}
