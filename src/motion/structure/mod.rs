//! Structure from motion: where m calibrated cameras stand and where n points are, from what the cameras see
//! of them.
//!
//! In: [`Sight`](super::bundle::Sight)s of points that somebody matched over the views, some of them wrong.
//! Out: the views' poses and the points, in an unknown unit of length ([`Structure`]) until one is known
//! ([`MetricStructure`]).
//!
//! In running order:
//!
//! * `start`: two views and what they have in common, by the fundamental matrix or a plane's homography. What
//!   cannot give a pose is named ([`PairFault`]): no motion, a turn alone (or nothing but what is far away,
//!   which looks the same), a plane that two motions explain.
//! * `grow`: of all pairs the best one, then view after view by resection
//!   ([`robust_resection`](crate::geometry::robust::robust_resection)), its new points by `many`, and a
//!   bundle adjustment of what there is.
//! * `many`: a point from all that see it, some of them wrongly.
//! * [`Structure`]: the result, without a scale. [`SceneMemory`]: what it is made in; [`StructureRoom`]: that
//!   in one `static`.

mod config;
mod grow;
mod many;
mod memory;
mod room;
mod scaled;
mod start;

pub use config::{PairFault, Placement, PointState, StructureConfig, StructureError};
pub use grow::{StructureReport, structure};
pub use memory::SceneMemory;
pub use room::StructureRoom;
pub use scaled::{MetricStructure, Structure};
