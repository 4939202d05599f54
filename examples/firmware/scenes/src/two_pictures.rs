//! Two cameras' lines to features of both pictures, and their matches.
//!
//! It knows no hardware: the same runs on the host, which compares.

use heapless::Vec;
use stereopsis::features::{
    Feature, FeatureConfig, FeatureConfigError, FeatureDetector, FeatureLineError, FeatureMatcher, Match,
    MatchConfig, MatchConfigError,
};

/// Pixels in a line.
pub const WIDTH: usize = 160;
/// Lines in a picture.
pub const HEIGHT: usize = 120;
/// Features of a picture, at most.
pub const MOST: usize = 128;
/// What is looked for.
const CONFIG: FeatureConfig = FeatureConfig::new(WIDTH as u16, HEIGHT as u16);

/// One camera's features: lines in, a list out.
pub struct Eye {
    detector: FeatureDetector<WIDTH, { CONFIG.slots() }>,
    /// What was found so far.
    pub features: Vec<Feature, MOST>,
}

/// Both cameras' features and their matches.
pub struct TwoPictures {
    /// The left camera.
    pub left: Eye,
    /// The right camera.
    pub right: Eye,
    matcher: FeatureMatcher<MOST>,
    /// Which feature is which.
    pub matches: Vec<Match, MOST>,
}

impl Eye {
    const fn new() -> Self {
        Self { detector: FeatureDetector::new(), features: Vec::new() }
    }

    fn start(&mut self) -> Result<(), FeatureConfigError> {
        self.features.clear();
        self.detector.start(&CONFIG)
    }

    fn push(&mut self, line: &[u8]) -> Result<(), FeatureLineError> {
        self.detector.push(line, self.features.as_mut_view())
    }
}

impl TwoPictures {
    /// Nothing came yet.
    pub const fn new() -> Self {
        Self { left: Eye::new(), right: Eye::new(), matcher: FeatureMatcher::new(), matches: Vec::new() }
    }

    /// Begins a frame.
    ///
    /// # Errors
    /// When the detectors are too small for it; which they are not.
    pub fn start(&mut self) -> Result<(), FeatureConfigError> {
        self.left.start()?;
        self.right.start()
    }

    /// The next line of both cameras.
    ///
    /// # Errors
    /// When it has not [`WIDTH`] pixels, or when [`HEIGHT`] lines have come.
    pub fn push(&mut self, left: &[u8], right: &[u8]) -> Result<(), FeatureLineError> {
        self.left.push(left)?;
        self.right.push(right)
    }

    /// Matches what was found, all features of the one picture with all of the other.
    ///
    /// # Errors
    /// When the search is wrong or there are too many features; which it is not and there are not.
    pub fn pair(&mut self) -> Result<(), MatchConfigError> {
        self.matches.clear();
        let matches = self.matches.as_mut_view();
        self.matcher.run(&self.left.features, &self.right.features, &MatchConfig::new(), matches)?;
        Ok(())
    }
}

impl Default for TwoPictures {
    fn default() -> Self {
        Self::new()
    }
}
