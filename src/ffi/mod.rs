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
//! * [`CWinner`]: rows of winners that something else computed, by the functions of [`Instance`] that begin
//!   with `winners`; C holds a [`WinnersHandle`].
//! * [`line_queue_init`] and those beside it: lines from an interrupt to the program; C holds a
//!   [`LineQueueHandle`].
//! * [`balance_between`], [`decimate`], [`temporal_row`] and those beside them: what is done with lines
//!   before the matcher and with rows after it.
//! * [`detector_push`], [`match_features`] and those beside them: lines to features, and to matches of two
//!   views; C holds a [`DetectorHandle`].
//! * [`two_view_fundamental`] and those beside it: matches of two views to F, pose and points.
//! * [`odometry_step`]: the motion of a pair; C holds an [`OdometryHandle`].
//! * [`focus_push`]: depth from focus; C holds a [`FocusHandle`].
//! * [`obstacles_push`], [`drive_decide`] and those beside them: rows to obstacles, ground, free space and
//!   decisions; C holds an [`ObstaclesHandle`], a [`DriveHandle`], a [`FreeSpaceHandle`] and, for the
//!   cameras' health, a [`PairMonitorHandle`].
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
//! * One call at a time for one handle, or for each side of a line queue's. Handles share nothing: two of
//!   them may be used by two threads.
//! * What cannot be checked is up to the caller: a pointer that is neither null nor misaligned points to as
//!   many bytes as its function says.

mod after;
mod balance;
mod config;
mod detection;
mod drive;
mod drive_types;
mod faults;
mod feature_matches;
mod features;
mod focus;
mod focus_types;
mod instance;
mod line_queue;
mod names;
mod names_after;
mod names_drive;
mod names_features;
mod names_focus;
mod names_line_queue;
mod names_obstacles;
mod names_plain;
mod names_rectifier;
mod names_two_view;
mod names_winners;
mod noise;
mod obstacles;
mod obstacles_config;
mod obstacles_found;
mod obstacles_rows;
mod obstacles_types;
mod odometry;
mod odometry_types;
mod pair_monitor;
mod points;
mod record;
mod rectifier;
mod rectifying;
mod rig;
mod row;
mod state;
mod status;
mod status_texts;
mod two_view;
mod winner;
mod winners;

pub use after::{
    CTemporal, STEREOPSIS_ORIGIN_AVERAGED, STEREOPSIS_ORIGIN_HELD, STEREOPSIS_ORIGIN_NEW,
    STEREOPSIS_ORIGIN_NOTHING, decimate, temporal_default, temporal_forget, temporal_row,
};
pub use balance::{CBalance, CHistogram, balance_between, balance_line, histogram_clear, histogram_line};
pub use config::{
    CConfig, STEREOPSIS_NOISE_HIGH, STEREOPSIS_NOISE_LOW, STEREOPSIS_NOISE_NONE, STEREOPSIS_NOT_CHECKED,
    STEREOPSIS_PRESET_DEFAULT, STEREOPSIS_PRESET_DENSE, STEREOPSIS_PRESET_STRICT, config_default,
    config_noise,
};
pub use detection::{CDetection, CDetectionCounts, detection_default};
pub use drive::{
    DriveHandle, FreeSpaceHandle, STEREOPSIS_DRIVE_BYTES, STEREOPSIS_FREE_SPACE_BYTES, drive_decide,
    drive_deinit, drive_init, drive_start, drive_stopping_mm, free_space_deinit, free_space_init,
    free_space_sectors, free_space_update,
};
pub use drive_types::{
    CDriveConfig, CVerdict, STEREOPSIS_DECISION_BLIND, STEREOPSIS_DECISION_CLEAR, STEREOPSIS_DECISION_SLOW,
    STEREOPSIS_DECISION_STOP, STEREOPSIS_NO_CONTACT, drive_default, drive_speed_mm_s,
};
pub use faults::{
    CCounters, STEREOPSIS_LOST_DROPPED, STEREOPSIS_LOST_LATE, STEREOPSIS_LOST_STALE, STEREOPSIS_LOST_TORN,
};
pub use feature_matches::{CSearch, match_features, search_default};
pub use features::{
    CFeature, DetectorHandle, detector_bytes, detector_counts, detector_deinit, detector_init, detector_push,
    detector_start,
};
pub use focus::{
    FocusHandle, focus_begin_frame, focus_bytes, focus_deinit, focus_finish, focus_init, focus_push,
    focus_row, focus_start,
};
pub use focus_types::{
    CFocusConfig, CFocusPeak, STEREOPSIS_FOCUS_BROAD, STEREOPSIS_FOCUS_FEW, STEREOPSIS_FOCUS_FOUND,
    STEREOPSIS_FOCUS_UNTEXTURED, focus_default,
};
pub use instance::Instance;
pub use line_queue::{
    CLine, LineQueueHandle, line_queue_begin, line_queue_bytes, line_queue_deinit, line_queue_done,
    line_queue_finish, line_queue_init, line_queue_next, line_queue_overruns,
};
#[doc(hidden)]
pub use names::{first_of, instantiate_c_api};
#[doc(hidden)]
pub use names_after::c_api_before_and_after;
#[doc(hidden)]
pub use names_drive::c_api_of_driving;
#[doc(hidden)]
pub use names_features::c_api_of_features;
#[doc(hidden)]
pub use names_focus::c_api_of_focus_and_motion;
#[doc(hidden)]
pub use names_line_queue::c_api_of_line_queues;
#[doc(hidden)]
pub use names_obstacles::c_api_of_obstacles;
#[doc(hidden)]
pub use names_plain::c_api_without_state;
#[doc(hidden)]
pub use names_rectifier::c_api_of_rectification;
#[doc(hidden)]
pub use names_two_view::c_api_of_two_views;
#[doc(hidden)]
pub use names_winners::c_api_of_winners;
pub use noise::{CNoiseMeter, noise_clear, noise_level, noise_line};
pub use obstacles::{ObstaclesHandle, obstacles_bytes, obstacles_deinit, obstacles_init, obstacles_start};
pub use obstacles_config::{
    CObstacleConfig, STEREOPSIS_GROUND_ABSENT, STEREOPSIS_GROUND_GIVEN, STEREOPSIS_GROUND_SEARCHED,
    obstacles_default,
};
pub use obstacles_found::{
    obstacles_cells, obstacles_ground, obstacles_scan, obstacles_sectors, obstacles_stixels,
};
pub use obstacles_rows::{
    obstacles_begin_frame, obstacles_cameras, obstacles_finish, obstacles_push, obstacles_set_pose,
};
pub use obstacles_types::{
    CGround, CScan, CSector, CStixel, STEREOPSIS_BLIND_CAMERA, STEREOPSIS_BLIND_FEW_ANSWERS,
    STEREOPSIS_BLIND_NO_FRAME, STEREOPSIS_BLIND_NO_GROUND, STEREOPSIS_BLIND_NOT, STEREOPSIS_BLIND_ROWS_LOST,
    STEREOPSIS_BLIND_SWAPPED, STEREOPSIS_BLIND_UNSEEN, STEREOPSIS_SECTOR_BLIND, STEREOPSIS_SECTOR_DROP,
    STEREOPSIS_SECTOR_FREE, STEREOPSIS_SECTOR_OBSTACLE, STEREOPSIS_STIXEL_DROP, STEREOPSIS_STIXEL_NOTHING,
    STEREOPSIS_STIXEL_OBSTACLE,
};
pub use odometry::{
    OdometryHandle, odometry_bytes, odometry_deinit, odometry_init, odometry_start, odometry_step,
};
pub use odometry_types::{
    COdometryConfig, CPicture, CStep, STEREOPSIS_MOTION_FIRST, STEREOPSIS_MOTION_FOUND,
    STEREOPSIS_MOTION_LEFT_ONLY, STEREOPSIS_MOTION_LOST, STEREOPSIS_MOTION_RESTARTED,
    STEREOPSIS_MOTION_ROTATION_ONLY, STEREOPSIS_MOTION_STATIONARY, STEREOPSIS_MOTION_STEP_UNKNOWN,
    STEREOPSIS_MOTION_TRACKED, STEREOPSIS_MOTION_UNCERTAIN, odometry_default,
};
pub use pair_monitor::{
    PairMonitorHandle, STEREOPSIS_CAMERA_BLACK, STEREOPSIS_CAMERA_FLAT, STEREOPSIS_CAMERA_GOOD,
    STEREOPSIS_CAMERA_REPEATING, STEREOPSIS_CAMERA_SATURATED, STEREOPSIS_PAIR_MONITOR_BYTES,
    pair_monitor_begin_frame, pair_monitor_deinit, pair_monitor_health, pair_monitor_init, pair_monitor_push,
};
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
pub use status::{STEREOPSIS_ABI, Status};
pub use status_texts::{status_text, version_text};
pub use two_view::{
    CAgreement, CMatch, CPinhole, CPose, two_view_eight_point, two_view_fundamental, two_view_pose,
    two_view_triangulate,
};
pub use winner::{CWinner, winners_seal};
pub use winners::{WinnersHandle, winners_bytes};
