//! What is wrong with a pair of pictures, by the features that both show: cameras that are swapped, pictures
//! that are turned, mirrored, the same or of two scenes, and a search that is too short.

mod fault;
mod lacks;
mod matches;
mod search;

pub use fault::{PairFault, fault};
pub use matches::PairMatches;
pub use search::search;

use image::GrayImage;
use lacks::Lacks;
use matches::{FEWEST, STILL};
use serde::Serialize;
use stereopsis::matching::Config;

/// What features say of a pair and of its search. Names are those of `summary.json`.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct PairCheck {
    /// Features that both pictures show.
    pub matches: usize,
    /// Those of them that are in about the same rows.
    pub matches_in_rows: usize,
    /// The range of their disparities, 2nd to 98th percentile, px; absent when there are too few.
    pub disparity_px: Option<[f64; 2]>,
    /// What is wrong; absent when nothing seems to be.
    pub fault: Option<PairFault>,
    /// The share of the matches that lie beyond the search.
    pub beyond_search: f64,
    /// A search that would hold nearly all of them: `--min-disparity` and `--disparities`.
    pub search: Option<[u16; 2]>,
    /// The share of the left picture without texture: no grey level changes by 4 within 9 x 9 pixels.
    pub untextured: f64,
    /// That of the right one.
    pub untextured_right: f64,
    /// The share of both pictures that is white: 254 and more.
    pub over_exposed: f64,
    /// The share of both pictures that is black: 1 and less.
    pub under_exposed: f64,
    /// The share of the left picture that lacks the texture that the right one has in the same rows.
    pub lost_texture: f64,
    /// That of the right one, beside the left one.
    pub lost_texture_right: f64,
    /// The share of the left picture that shows nothing, as its mask says.
    pub masked: f64,
    /// About the share of the left picture that the right camera does not see; absent with few matches.
    pub out_of_view: Option<f64>,
    /// What is wrong with the pair and its search, and what would help: a line each.
    pub warnings: Vec<String>,
    /// The share of the matches that lie before the search.
    #[serde(skip)]
    before_search: f64,
}

/// The share of the features that a search may miss, and of a picture that may be white or black, before that
/// is said.
const MISSED: f64 = 0.05;
const BADLY_EXPOSED: f64 = 0.25;

/// The share of a picture that may lack the other one's texture before that is said. It is under .04 in the
/// real pairs that the tests know, and up to .26 where one of their images is blurred or darkened.
const LOST_TEXTURE: f64 = 0.3;

impl PairCheck {
    /// Looks at a pair that is to be matched, whose pictures show nothing where `valid` is 0 and have this
    /// [`fault`].
    pub fn new(
        pictures: [&GrayImage; 2],
        valid: Option<[&GrayImage; 2]>,
        matches: &PairMatches,
        fault: Option<PairFault>,
        config: &Config,
    ) -> Self {
        let found = matches.disparities_px();
        let at =
            |share: f64| found.get((share * found.len().saturating_sub(1) as f64).round() as usize).copied();
        let range = (found.len() >= FEWEST).then(|| Some([at(0.02)?, at(0.98)?])).flatten();
        let first = f64::from(config.min_disparity);
        let last = first + f64::from(config.disparities) - 1.0;
        let share = |is_so: &dyn Fn(f64) -> bool| {
            range.map_or(0.0, |_| found.iter().filter(|&&d| is_so(d)).count() as f64 / found.len() as f64)
        };
        let before_search = share(&|d| d < first - STILL);
        let lacks = [0, 1].map(|side| Lacks::of(pictures[side], valid.map(|valid| valid[side])));
        let of_both = |of: fn(&Lacks) -> f64| lacks.iter().map(of).sum::<f64>() / 2.0;
        let mut check = Self {
            matches: matches.all.len(),
            matches_in_rows: matches.in_rows.len(),
            disparity_px: range,
            fault,
            beyond_search: before_search + share(&|d| d > last),
            search: if fault.is_none() { search(pictures, matches) } else { None },
            untextured: lacks[0].untextured,
            untextured_right: lacks[1].untextured,
            over_exposed: of_both(|lacks| lacks.over_exposed),
            under_exposed: of_both(|lacks| lacks.under_exposed),
            lost_texture: lacks[0].lost(&lacks[1]),
            lost_texture_right: lacks[1].lost(&lacks[0]),
            masked: lacks[0].masked,
            out_of_view: range.and(at(0.5)).map(|d| (d / f64::from(pictures[0].width())).clamp(0.0, 1.0)),
            warnings: Vec::new(),
            before_search,
        };
        let fault = check.fault.map(|fault| fault.to_string());
        // What is black or white lacks texture, too, and what is seen the wrong way round may seem to.
        let light = exposure_warning(&lacks);
        let texture = if light.is_none() && fault.is_none() { check.texture_warning() } else { None };
        let found = [fault, check.search_warning(config), light, texture];
        check.warnings = found.into_iter().flatten().collect();
        check
    }

    /// The same with what else is wrong, if it is.
    pub fn with_warning(mut self, warning: Option<String>) -> Self {
        self.warnings.extend(warning);
        self
    }

    /// What is to be known about the search, with a cure, where it misses what features show.
    fn search_warning(&self, config: &Config) -> Option<String> {
        let ([first, last], [min_disparity, disparities]) = (self.disparity_px?, self.search?);
        if self.beyond_search <= MISSED {
            return None;
        }
        if config.min_disparity == 0 && self.before_search > MISSED {
            return Some(format!(
                "{:.0} % of the features have disparities below 0, down to {first:.0} px, where nothing is \
                 searched; shift the right image to the left by as much, or rectify the pair anew",
                100.0 * self.before_search
            ));
        }
        let searched = [config.min_disparity, config.disparities];
        let cure = if searched == [min_disparity, disparities] {
            format!("at most {disparities} can be searched: make the images smaller")
        } else {
            format!("give --min-disparity {min_disparity} --disparities {disparities}")
        };
        Some(format!(
            "{:.0} % of the features lie beyond disparities {} to {}, where they are from {first:.0} to \
             {last:.0} px; {cure}",
            100.0 * self.beyond_search,
            searched[0],
            searched[0] + searched[1] - 1
        ))
    }

    /// What is to be known about a camera that sees less than the other one.
    fn texture_warning(&self) -> Option<String> {
        let shares = [(self.lost_texture, "left", "right"), (self.lost_texture_right, "right", "left")];
        let &(share, side, other) = shares.iter().find(|(share, ..)| *share > LOST_TEXTURE)?;
        Some(format!(
            "{:.0} % of the {side} image lacks the texture that the {other} one has in the same rows, and \
             what is answered there is a guess; see whether the {side} camera is covered, dirty or out of \
             focus",
            100.0 * share
        ))
    }

    /// What the pictures lack, in a line.
    pub fn lacks(&self) -> String {
        let percent = |share: f64| format!("{:.0} %", 100.0 * share);
        let out_of_view = self.out_of_view.map(|share| format!(", {} out of view", percent(share)));
        format!(
            "{} without texture, {} over-exposed, {} under-exposed{}",
            percent(self.untextured),
            percent(self.over_exposed),
            percent(self.under_exposed),
            out_of_view.unwrap_or_default()
        )
    }
}

/// What is to be known about the light: of both pictures, or of the one that lacks it.
fn exposure_warning(lacks: &[Lacks; 2]) -> Option<String> {
    let said = |of: fn(&Lacks) -> f64, what: &str, cure: &str| {
        let [left, right] = lacks.each_ref().map(of);
        let (share, images) = match [left, right].map(|share| share > BADLY_EXPOSED) {
            [true, true] => ((left + right) / 2.0, "images are"),
            [true, false] => (left, "left image is"),
            [false, true] => (right, "right image is"),
            [false, false] => return None,
        };
        let percent = 100.0 * share;
        Some(format!("{percent:.0} % of the {images} {what}, where nothing can be matched; {cure}"))
    };
    said(|lacks| lacks.over_exposed, "over-exposed", "expose them shorter").or_else(|| {
        let cure = "expose them longer, or mask what is a border (--valid-left, --valid-right)";
        said(|lacks| lacks.under_exposed, "black", cure)
    })
}
