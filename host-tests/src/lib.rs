//! The host harness of `stereopsis`: the same `no_std` core behind mock cameras.
//!
//! The harness, the program `stereo` and the tests are one package: cargo hands a program's path to the tests
//! of its own package only, and the tests of the commands run the program. Below it stands
//! `stereopsis_model`, the twins and scenes, which is built for the emulated processors too, and
//! `stereopsis_rig`, calibrations and plans, which is in the live page too; `xtask` is a package beside it.
//!
//! In running order:
//!
//! * [`mock`]: a camera that reads image files.
//! * [`fault`]: faults before any source, seeded and recorded.
//! * [`scene`]: a ray-traced scene as a camera, with its true depth, disparity and occlusion.
//! * [`calibration`]: rigs from and to the files of other programs.
//! * [`plan`]: what a rig of two cameras can tell, and what it takes, before it is built.
//! * [`calibrate`]: a rig from pictures of a chessboard.
//! * [`mod@matches`]: correspondences from files.
//! * [`masked`]: masks beside any source.
//! * [`real`]: real pairs with a known truth, also altered, and scores on them.
//! * [`eval`]: results of any program beside a truth, in the measures of public benchmarks.
//! * [`recording`]: lines as they came, in a file, and played again.
//! * [`run`]: a stereo source through the core's pipeline into whole maps.
//! * [`correspond`]: two pictures through the core's features and matcher. [`correspond_refine`]: to a small
//!   part of a pixel. [`two_view`]: correspondences of a
//!   known scene, with noise and wrong ones. [`chance`]: whether matches agree by chance. [`degenerate`]:
//!   what is special about those that nothing explains. [`turned`]: whether they show a camera that has only
//!   turned.
//! * [`focus`]: focus stacks, a simulated lens, and stacks through the core's map.
//! * [`obstacles`]: ground, stixels and sectors of a whole map, as a record and a picture.
//! * [`odometry`]: sequences of pictures through the core's odometry, trajectories and their errors.
//! * [`rectify`]: raw pictures through the core's remap. [`pair`], [`rows`]: what is wrong with a pair.
//! * [`views`]: pictures of one camera from several places through the core's structure from motion.
//! * [`bal`]: problems of bundle adjustment through the core.
//! * [`interpolate`]: poses between two known ones.
//! * [`twin`]: each stage again, naively, to hold the core to. [`dump`]: its rows as files.
//! * [`winners`]: a model of the block of gates, with faults.
//! * [`map`], [`samples`], [`pfm`], [`ply`], [`colour`], [`matches_picture`], [`epipolar_picture`],
//!   [`output`], [`report`]: results as files. [`unfinished`]: what an interruption takes away. [`live`]: the
//!   live page. [`command_line`]: errors in one line.

pub mod bal;
pub mod calibrate;
pub mod calibration;
pub mod chance;
pub mod colour;
pub mod command_line;
pub mod correspond;
pub mod correspond_refine;
pub mod degenerate;
pub mod dump;
pub mod epipolar_picture;
pub mod eval;
pub mod fault;
pub mod focus;
pub mod limits;
pub mod live;
pub mod map;
pub mod masked;
pub mod matches;
pub mod matches_picture;
pub mod mock;
pub mod obstacles;
pub mod odometry;
pub mod output;
pub mod pair;
pub mod partners;
pub mod pfm;
pub mod ply;
pub mod real;
pub mod recording;
pub mod rectify;
pub mod report;
pub mod rows;
pub mod run;
pub mod samples;
pub mod sparsification;
pub mod turned;
pub mod two_view;
pub mod unfinished;
pub mod views;
pub mod winners;

pub use stereopsis_model::{interpolate, scene, twin};
pub use stereopsis_rig::plan;
