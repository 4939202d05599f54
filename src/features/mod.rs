//! Features of pictures and their matches: which point of one picture is which point of another.
//!
//! In: lines of grey pixels, from two cameras or of two moments. Out: pairs of features, with sub-pixel
//! positions.
//!
//! 1. [`Shrink`]: ever smaller pictures, for scenes that come nearer.
//! 2. [`FeatureDetector`]: lines to features, in a band of lines. In it, in running order: [`smooth_row`];
//!    [`fast_scores`], the segment test; local maxima as [`Corner`]s; `cells`, the strongest in every cell;
//!    [`Patch`], what is around them; [`refine()`], where they are; [`Descriptor`], what they look like,
//!    turned by a [`Turn`]; [`PATTERN`].
//! 3. [`Matcher`]: all features of one picture with all of another, as a [`Search`] admits.
//! 4. [`drop_repeats`]: a corner found on several levels is one match.
//! 5. [`Template`]: where pictures are held whole, a place found again to a small part of a pixel.
//!
//! Pixels to matches is integer arithmetic but for positions: [`Feature`] has them in px of the full picture,
//! and a search along epipolar lines compares them with lines.

mod cells;
mod config;
mod corner;
mod descriptor;
mod detector;
mod error;
mod fast;
mod feature;
mod matcher;
mod pattern;
mod refine;
mod repeats;
mod search;
mod shrink;
mod smooth;
mod template;
mod turn;

pub use config::{FeatureConfig, Orientation};
pub use corner::Corner;
pub use descriptor::{Descriptor, Patch};
pub use detector::{FeatureCounts, FeatureDetector};
pub use error::{FeatureConfigError, FeatureLineError, SearchError};
pub use fast::fast_scores;
pub use feature::{Feature, Level};
pub use matcher::{Match, Matcher};
pub use pattern::{PAIRS, PATCH_RADIUS, PATTERN, Pair};
pub use refine::refine;
pub use repeats::drop_repeats;
pub use search::{Epipolar, Search};
pub use shrink::Shrink;
pub use smooth::smooth_row;
pub use template::{Aligned, AlongRow, Template};
pub use turn::Turn;
