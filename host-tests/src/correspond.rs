//! Two pictures through the core's detector and matcher: corners on several levels, and which of them are the
//! same.

use image::GrayImage;
use stereopsis::features::{
    DownsampleState, DownsampleView, Feature, FeatureConfig, FeatureCounts, FeatureDetector, FeatureMatcher,
    Level, Match, MatchConfig, Orientation, drop_duplicates,
};

/// The longest line, px.
const WIDEST: usize = 4096;
/// Corners in a row of cells: the widest picture with the smallest cells.
const SLOTS: usize = WIDEST / FeatureConfig::LEAST_CELL as usize * PER_CELL;
/// Corners that are kept in a cell.
const PER_CELL: usize = 5;
/// Features that a picture may have.
const MOST: usize = 16384;
/// Three pixels of four: from level to level a scene looks a third farther away.
const SHRINK: usize = 4;
/// Matches that lie nearer to each other than this at both ends are of one corner, px.
const REPEATED_PX: f32 = 1.5;
/// With fewer matches than one for so many features, the pictures may be turned against each other.
const FEW: usize = 4;

/// How features are found and matched.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// For about how many features of each picture there is room, on all levels: [`Plan::FEWEST`] to
    /// [`Plan::MOST`].
    pub corners: u16,
    /// Grey levels by which a corner differs from its circle.
    pub threshold: u8,
    /// How many levels, the full picture included.
    pub levels: u8,
    /// How corners are described; `None` is upright and, where few match, turned as well: what has more
    /// matches.
    pub orientation: Option<Orientation>,
    /// What a match has to be.
    pub search: MatchConfig,
}

impl Plan {
    /// The fewest corners that can be asked for.
    pub const FEWEST: u16 = 50;
    /// The most: rows and columns of cells that are cut off make it up to a third more.
    pub const MOST: u16 = 12000;

    /// Side of the cells that spread the corners over a picture of so many pixels.
    fn cell_px(&self, pixels: u32) -> u16 {
        // Every level has nine sixteenths of the cells of the one before.
        let share = ((SHRINK - 1) as f64 / SHRINK as f64).powi(2);
        let shares: f64 = (0..i32::from(self.levels)).map(|level| share.powi(level)).sum();
        let side = f64::from(pixels) * shares * PER_CELL as f64 / f64::from(self.corners);
        (side.sqrt().round() as u16).clamp(FeatureConfig::LEAST_CELL, WIDEST as u16)
    }
}

impl Default for Plan {
    fn default() -> Self {
        // Partners may be on any two levels: the pictures may be taken from near and from far.
        let search = MatchConfig { levels_apart: u8::MAX, ..MatchConfig::new() };
        Self { corners: 4000, threshold: 8, levels: 4, orientation: None, search }
    }
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Correspondences {
    /// The left picture's features.
    pub left: Vec<Feature>,
    /// The right picture's.
    pub right: Vec<Feature>,
    /// Which are the same, in the order of the left ones.
    pub matches: Vec<Match>,
}

impl Correspondences {
    /// Where matches are: column and row in the left picture, column and row in the right one, px.
    pub fn points(&self) -> impl Iterator<Item = [f32; 4]> {
        self.matches.iter().map(|m| {
            let (left, right) = (&self.left[usize::from(m.left)], &self.right[usize::from(m.right)]);
            [left.x_px, left.y_px, right.x_px, right.y_px]
        })
    }
}

/// Why nothing was found: what the core says to a plan or a picture that is beyond its capacity.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CorrespondError {
    /// The detector does not take the picture.
    #[error(transparent)]
    Config(#[from] stereopsis::features::FeatureConfigError),
    /// The detector does not take a line.
    #[error(transparent)]
    Line(#[from] stereopsis::features::FeatureLineError),
    /// The matcher does not take the plan.
    #[error(transparent)]
    Search(#[from] stereopsis::features::MatchConfigError),
    /// A picture has more features than there is room for.
    #[error("{dropped} features have no room; ask for fewer corners")]
    Room {
        /// How many were left out.
        dropped: u32,
    },
}

/// The features of both pictures and their matches, a corner that was found on several levels once.
pub fn correspond(
    plan: &Plan,
    left: &GrayImage,
    right: &GrayImage,
) -> Result<Correspondences, CorrespondError> {
    if let Some(orientation) = plan.orientation {
        return described(plan, orientation, left, right);
    }
    let upright = described(plan, Orientation::Upright, left, right)?;
    if FEW * upright.matches.len() >= upright.left.len().min(upright.right.len()) {
        return Ok(upright);
    }
    let turned = described(plan, Orientation::Centroid, left, right)?;
    Ok(if turned.matches.len() > upright.matches.len() { turned } else { upright })
}

/// The same, with corners described in one way.
fn described(
    plan: &Plan,
    orientation: Orientation,
    left: &GrayImage,
    right: &GrayImage,
) -> Result<Correspondences, CorrespondError> {
    let (left, right) = (features(plan, orientation, left)?, features(plan, orientation, right)?);
    let matches = matches(plan, &left, &right)?;
    Ok(Correspondences { left, right, matches })
}

/// Which features of two pictures are the same, a corner that was found on several levels once.
pub fn matches(plan: &Plan, left: &[Feature], right: &[Feature]) -> Result<Vec<Match>, CorrespondError> {
    let mut matches = Box::new(heapless::Vec::<Match, MOST>::new());
    let mut matcher = Box::new(FeatureMatcher::<MOST>::new());
    let dropped = matcher.run(left, right, &plan.search, matches.as_mut_view())?;
    if dropped > 0 {
        return Err(CorrespondError::Room { dropped });
    }
    drop_duplicates(left, right, matches.as_mut_view(), REPEATED_PX);
    Ok(matches.to_vec())
}

/// The features of a picture, those of the full one first.
pub fn features(
    plan: &Plan,
    orientation: Orientation,
    picture: &GrayImage,
) -> Result<Vec<Feature>, CorrespondError> {
    let cell_px = plan.cell_px(picture.width() * picture.height());
    let mut detector = Box::new(FeatureDetector::<WIDEST, SLOTS>::new());
    let mut list = Box::new(heapless::Vec::<Feature, MOST>::new());
    let (mut picture, mut level, mut dropped) = (picture.clone(), Level::FULL, 0);
    for _ in 0..plan.levels {
        // Pictures have at most 4096 columns and rows.
        let (width, height) = (picture.width() as u16, picture.height() as u16);
        let config = FeatureConfig {
            threshold: plan.threshold,
            cell_px,
            per_cell: PER_CELL as u16,
            orientation,
            level,
            ..FeatureConfig::new(width, height)
        };
        detector.start(&config)?;
        for line in lines(&picture) {
            detector.push(line, list.as_mut_view())?;
        }
        let FeatureCounts { dropped: of_level, .. } = detector.counts();
        dropped += of_level;
        (picture, level) = (shrunk::<SHRINK>(&picture), level.downsampled::<SHRINK>());
    }
    if dropped > 0 { Err(CorrespondError::Room { dropped }) } else { Ok(list.to_vec()) }
}

/// The picture made smaller by the core, `N - 1` pixels of every `N`.
pub fn shrunk<const N: usize>(picture: &GrayImage) -> GrayImage {
    let width = picture.width() as usize;
    let (mut state, mut sums, mut out) = (DownsampleState::default(), vec![0; 2 * width], vec![0; width]);
    let mut shrink = DownsampleView::<N>::new(&mut state, &mut sums, &mut out);
    shrink.start(width);
    let mut pixels = Vec::new();
    for line in lines(picture) {
        pixels.extend_from_slice(shrink.push(line).unwrap_or_default());
    }
    let (width, height) = (shrink.width(), DownsampleView::<N>::height(picture.height() as usize));
    GrayImage::from_raw(width as u32, height as u32, pixels).unwrap_or_default()
}

fn lines(picture: &GrayImage) -> impl Iterator<Item = &[u8]> {
    picture.as_raw().chunks_exact((picture.width() as usize).max(1))
}
