//! Obstacles, ground and free space from rows of disparity, and what to do about them.
//!
//! In: rows of [`Disparity`](crate::units::Disparity) with their flags and, if there are any, confidences, as
//! they leave the matcher. Out, at the end of a frame: [`Ground`], a [`Stixel`] for each column of cells, the
//! nearest [`Sector`] by bearing, a [`LaserScan`], and a [`Decision`].
//!
//! ```text
//! for every row of pixels, `push` in `rows`:
//!   grid         pixels -> cells of 4 x 5 px, each the nearer of its two largest groups of disparities
//!   watchdog     rows lost or damaged, cells with an answer
//! for every frame, `finish` in `finder`:
//!   ransac       cells -> the line of the ground: the one of many pairs of cells that most cells are near to
//!   least_squares  a line, cells near to it -> the plane of the ground
//!   ground       the line over frames; height and pitch of the camera, heights above the ground
//!   stixel       a column of cells -> ground, obstacle or drop, beyond: the labels of the least cost
//!   surfaces     columns side by side -> connected surfaces of enough pixels
//! as often as asked:
//!   sector scan  columns -> sectors by bearing -> a laser scan
//!   held         sectors over frames, with hysteresis
//!   beside       what left the picture at its sides
//!   drive        the corridor ahead -> clear, slow, stop or blind
//! ```
//!
//! What is not seen is never free: a sector, a corridor or a frame with too few answers is blind.
//!
//! ```
//! use stereopsis::depth::DepthScale;
//! use stereopsis::geometry::camera::RectifiedRig;
//! use stereopsis::obstacles::{Decision, DriveConfig, DriveRule, ObstacleConfig, Obstacles};
//! use stereopsis::units::{Disparity, PixelFlags};
//!
//! let rig = RectifiedRig::new(130.0, 0.1, 79.5, 59.5)?;
//! let mut obstacles = Obstacles::<40, 24>::new();
//! let config = ObstacleConfig::default();
//! obstacles.start(&config, &DepthScale::new(&rig)?, [160, 120], Disparity::from_pixels(32))?;
//! let mut rule = DriveRule::new(DriveConfig::default());
//! // For each frame, with rows from a pipeline; these are of a floor 0.3 m below, and end in a wall.
//! obstacles.begin();
//! for y in 0..120_u16 {
//!     let floor = 32 * y.saturating_sub(59) / 3;
//!     let row = [Disparity::from_raw(floor.max(160)); 160];
//!     obstacles.push(y.into(), &row, &[PixelFlags::CLEAR; 160], &[]);
//! }
//! let trusted = obstacles.finish();
//! assert_eq!(trusted, Ok(()));
//! // The wall has 5 px of parallax: 130 * 0.1 / 5 = 2.6 m, of which 2 sigma are taken away.
//! let verdict = rule.decide(&obstacles.as_mut_view(), 1300);
//! assert!(matches!(verdict.decision, Decision::Slow(2400..2600)), "{verdict:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod config;
mod column;
mod cells;
mod grid;
mod ground;
mod least_squares;
mod ransac;
mod setup;
mod interval;
mod stixel;
mod surfaces;
mod watchdog;
mod state;
mod finder;
mod rows;
mod sector;
mod scan;
mod held;
mod beside;
mod hides;
mod drive;

pub use column::{Column, StixelKind};
pub use config::{GroundSource, ObstacleConfig, ObstacleError};
pub use drive::{Decision, DriveConfig, DriveRule, Verdict, speed_mm_s};
pub use finder::{Obstacles, ObstaclesView};
pub use grid::Filling;
pub use ground::Ground;
pub use held::{FreeSpace, Hysteresis};
pub use interval::Interval;
pub use scan::LaserScan;
pub use sector::{Sector, SectorState, Stixel};
pub use state::ObstaclesState;
pub use watchdog::BlindReason;
