//! Visual odometry: on scenes that are driven through, where nothing moves or nothing can be told, and what
//! its errors are.

#[path = "motion/degenerate.rs"]
mod degenerate;
#[path = "motion/drives.rs"]
mod drives;
#[path = "motion/refine.rs"]
mod refine;
#[path = "motion/support.rs"]
mod support;
#[path = "motion/templates.rs"]
mod templates;
#[path = "motion/trajectories.rs"]
mod trajectories;
