//! The pipeline for C: functions with a C ABI over memory that the caller owns.
//!
//! A program in C gives memory, a configuration and lines, and gets rows. A small Rust package, a
//! `staticlib`, says once for which method and sizes, and so makes the functions of `stereopsis.h`:
//!
//! ```
//! stereopsis::instantiate_c_api!(Block, width = 320, disparities = 64);
//! # fn main() { assert!(stereopsis_c::stereopsis_size() > 40_000); }
//! ```
//!
//! `examples/c-firmware` is such a package with a program in C. In running order:
//!
//! * [`CConfig`], [`CRow`], [`CCameras`], [`CRig`], [`CPoint`], [`CCounters`], [`CNoiseMeter`] and the
//!   constants: what crosses the border, laid out as C has it.
//! * [`Status`]: the result of every call.
//! * [`Rectifier`]: raw lines and a calibration record to rectified lines; C holds a [`RectifierHandle`].
//! * [`Instance`]: rectified lines to rows, for one method and one capacity; C holds a [`Handle`].
//! * [`two_view_fundamental`] and those beside it: matches of two views to F, pose and points.
//! * [`instantiate_c_api`]: their names in C, from which `cargo xtask header` makes
//!   `stereopsis.h` beside this file.
//!
//! The contract:
//!
//! * Memory is the caller's. Nothing is allocated, nothing is kept of a caller's pointer but the memory that
//!   was given to `stereopsis_init`. Lines are copied.
//! * Every call checks its pointers for null and alignment; the memory carries a mark with its own address,
//!   method and capacity, so that memory that was not initialised, was moved, was given up or belongs to
//!   another library is noticed. What is wrong is answered by a status, and nothing has changed then.
//! * Numbers that choose something come as integers and are checked: no number is taken for an enum.
//! * A call does not panic. On a bare-metal target the program that links the library proves it: see the
//!   example's panic handler.
//! * One call at a time for one handle. Handles share nothing: two of them may be used by two threads.
//! * What cannot be checked is up to the caller: a pointer that is neither null nor misaligned points to as
//!   many bytes as its function says.

mod config;
mod faults;
mod instance;
mod names;
mod names_plain;
mod names_rectifier;
mod names_two_view;
mod noise;
mod points;
mod record;
mod rectifier;
mod rectifying;
mod rig;
mod row;
mod state;
mod status;
mod two_view;

pub use config::{
    CConfig, STEREOPSIS_NOISE_HIGH, STEREOPSIS_NOISE_LOW, STEREOPSIS_NOISE_NONE, STEREOPSIS_NOT_CHECKED,
    STEREOPSIS_PRESET_DEFAULT, STEREOPSIS_PRESET_DENSE, STEREOPSIS_PRESET_STRICT, config_default,
    config_noise,
};
pub use faults::{
    CCounters, STEREOPSIS_LOST_DROPPED, STEREOPSIS_LOST_LATE, STEREOPSIS_LOST_STALE, STEREOPSIS_LOST_TORN,
};
pub use instance::Instance;
#[doc(hidden)]
pub use names::{first_of, instantiate_c_api};
#[doc(hidden)]
pub use names_plain::c_api_without_state;
#[doc(hidden)]
pub use names_rectifier::c_api_of_rectification;
#[doc(hidden)]
pub use names_two_view::c_api_of_two_views;
pub use noise::{CNoiseMeter, noise_clear, noise_level, noise_line};
pub use points::{CPoint, metres, points};
pub use record::{CCameras, STEREOPSIS_ALPHA_NATURAL, STEREOPSIS_RECORD_BYTES, record_read};
pub use rectifier::Rectifier;
pub use rectifying::{RectifierHandle, rectifier_bytes, rectifier_slots, rectifier_width};
pub use rig::{CRig, millimetres};
pub use row::{
    CRow, STEREOPSIS_FLAG_AMBIGUOUS, STEREOPSIS_FLAG_CEILING, STEREOPSIS_FLAG_DAMAGED,
    STEREOPSIS_FLAG_FILLED, STEREOPSIS_FLAG_MISMATCH, STEREOPSIS_FLAG_OUTSIDE, STEREOPSIS_FLAG_SPECKLE,
    STEREOPSIS_FLAG_UNTEXTURED, STEREOPSIS_NONE, STEREOPSIS_STEPS_PER_PX,
};
pub use state::{Handle, STEREOPSIS_ALIGN, memory_bytes};
pub use status::{STEREOPSIS_ABI, Status, status_text, version_text};
pub use two_view::{
    CAgreement, CMatch, CPinhole, CPose, two_view_eight_point, two_view_fundamental, two_view_pose,
    two_view_triangulate,
};
