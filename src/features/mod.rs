//! Features of pictures and their matches: which point of one picture is which point of another.
//!
//! In: lines of grey pixels, from two cameras or of two moments. Out: pairs of features, with sub-pixel
//! positions.
//!
//! 1. [`Downsample`]: ever smaller pictures, for scenes that come nearer.
//! 2. [`FeatureDetector`]: lines to features, in a band of lines. In it, in running order: [`binomial5_row`];
//!    [`fast_scores`], the segment test; its `maxima` as [`Corner`]s; `grid`, the strongest in every cell;
//!    [`Patch`], what is around them; [`refine()`], where they are; [`Descriptor`], what they look like,
//!    turned by a [`PatchOrientation`]; [`PATTERN`].
//! 3. [`FeatureMatcher`]: all features of one picture with all of another, as a [`MatchConfig`] admits.
//! 4. [`drop_duplicates`]: a corner found on several levels is one match.
//! 5. [`Template`]: where pictures are held whole, a place found again to a small part of a pixel.
//!
//! Pixels to matches is integer arithmetic but for positions: [`Feature`] has them in px of the full picture,
//! and a search along epipolar lines compares them with lines.

mod circle;
#[cfg(any(stereopsis_dsp, stereopsis_vectors))]
mod armv7em;
mod binomial;
mod corner;
mod downsample;
mod fast;
mod maxima;
mod orientation;
mod pattern;
mod descriptor;
mod feature;
mod match_config;
mod config;
mod grid;
mod inner_product;
mod feature_matcher;
mod duplicates;
mod subpixel;
mod detector_state;
mod detector;
mod template;

pub use binomial::binomial5_row;
pub use config::{FeatureConfig, FeatureConfigError, Orientation};
pub use corner::Corner;
pub use descriptor::{Descriptor, Patch};
pub use detector::{FeatureDetector, FeatureDetectorView, FeatureLineError};
pub use detector_state::{FeatureCounts, FeatureDetectorState};
pub use downsample::{Downsample, DownsampleState, DownsampleView};
pub use duplicates::drop_duplicates;
pub use fast::fast_scores;
pub use feature::{Feature, Level};
pub use feature_matcher::{FeatureMatcher, FeatureMatcherView, Match, MatchSlot};
pub use grid::CornerSlot;
pub use match_config::{Epipolar, MatchConfig, MatchConfigError};
pub use orientation::PatchOrientation;
pub use pattern::{PAIRS, PATCH_RADIUS, PATTERN, PointPair};
pub use subpixel::refine;
pub use template::{RowMatch, Template, TemplateError, TemplateMatch};
