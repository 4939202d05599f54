//! How much is read of a calibration, at most.

/// The longest calibration file.
pub const CALIBRATION_BYTES: u64 = 1 << 20;
/// How deep a calibration file's elements may be nested.
pub const DEPTH: usize = 64;
