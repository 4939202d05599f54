//! Two views: the epipolar geometry, the homography, the pose in them and the points that they show.
//!
//! In: [`Correspondence`]s, or the [`Pose`](super::camera::Pose) of two cameras. Out:
//!
//! * [`Fundamental`], in px, and [`Essential`], in the cameras' frames, with lines, epipoles and distances.
//! * [`eight_point()`]: F from eight correspondences or more. [`Homography`]: from four or more. [`choose`]
//!   says which of the two the correspondences call for (GRIC).
//! * [`Essential::recover_pose`] and [`Homography::recover_motions`]: the pose without its scale
//!   ([`RelativePose`]).
//! * [`TwoViews`]: points from two rays, with their residual, angle and covariance.

mod correspondence;
mod weighted;
mod normalise;
mod line;
mod essential;
mod fundamental;
mod distance;
mod degenerate;
mod eight_point;
mod seven_point;
mod five_point;
mod homography;
mod model_choice;
mod relative;
mod recover;
mod plane_motion;
mod triangulate;

pub use correspondence::Correspondence;
pub use degenerate::EightPointError;
pub use eight_point::{eight_point, eight_point_weighted};
pub use essential::{Essential, EssentialError};
pub(crate) use five_point::{EssentialCandidates, five_point};
pub use fundamental::{Fundamental, FundamentalError};
pub(crate) use homography::least_squares;
pub use homography::{Homography, HomographyError};
pub use line::{Epipole, Line};
pub use model_choice::{ModelChoice, TwoViewModel, choose, gric};
pub use plane_motion::{PlaneMotion, PlaneMotionError};
pub use recover::{RecoverError, RecoveredPose};
pub(crate) use relative::scaled;
pub use relative::{RelativePose, ScaleError};
pub(crate) use seven_point::{Candidates, seven_point};
pub use triangulate::{Triangulated, TriangulationError, TwoViews};
