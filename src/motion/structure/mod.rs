//! Structure from motion: where m calibrated cameras stand and where n points are, from what the cameras see
//! of them.
//!
//! In: [`Observation`](super::bundle::Observation)s of points that somebody matched over the views, some of
//! them wrong. Out: the views' poses and the points, in an unknown unit of length ([`Structure`]) until one
//! is known ([`MetricStructure`]).
//!
//! In running order:
//!
//! * `initial_pair`: two views and what they have in common, by the fundamental matrix or a plane's
//!   homography. What cannot give a pose is named ([`InitialPairError`]): no motion, a turn alone (or nothing
//!   but what is far away, which looks the same), a plane that two motions explain.
//! * `incremental`: of all pairs the best one, then view after view by resection
//!   ([`robust_resection`](crate::geometry::robust::robust_resection)), its new points by `triangulation`,
//!   and a bundle adjustment of what there is.
//! * `triangulation`: a point from all that see it, some of them wrongly.
//! * [`Structure`]: the result, without a scale. [`StructureWorkspaceView`]: what it is made in;
//!   [`StructureWorkspace`]: that in one `static`.

mod config;
mod metric;
mod triangulation;
mod initial_pair;
mod workspace;
mod incremental;

pub use config::{InitialPairError, PointState, StructureConfig, StructureError, ViewState};
pub use incremental::{StructureReport, structure};
pub use metric::{MetricStructure, Structure};
pub use workspace::{StructureWorkspace, StructureWorkspaceView};
