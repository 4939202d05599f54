//! What is wrong with a pair of pictures, by the features that both show: cameras that are swapped, pictures
//! that are turned, mirrored, the same or of two scenes, and a search that is too short.

mod agreement;
mod beyond;
mod changes;
mod contrast;
mod fault;
mod few;
mod lacks;
mod matches;
mod search;

pub use agreement::{RowFit, agree_around};
pub use fault::{PairFault, fault, is_blank};
pub use matches::{PairMatches, are_negative};
pub use search::search;

use agreement::FEWEST;
use beyond::Beyond;
use contrast::Contrast;
use image::GrayImage;
use lacks::Lacks;
use serde::Serialize;
use stereopsis::matching::Config;

/// What features say of a pair and of its search. Names are those of `summary.json`.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct PairCheck {
    /// Features that both pictures show.
    pub matches: usize,
    /// Those of them that are in about the same rows.
    pub matches_in_rows: usize,
    /// The range of their disparities, 2nd to 98th percentile, px, of those that agree with others where
    /// these are enough; absent when there are too few.
    pub disparity_px: Option<[f64; 2]>,
    /// What is wrong; absent when nothing seems to be.
    pub fault: Option<PairFault>,
    /// The share of the matches that agree with others and lie beyond the search.
    pub beyond_search: f64,
    /// A search that would hold nearly all of them: `--min-disparity` and `--disparities`.
    pub search: Option<[u16; 2]>,
    /// The share of the left picture without texture: within 9 x 9 pixels no grey level changes by 4 along
    /// the row, or all change by no more than noise does.
    pub untextured: f64,
    /// That of the right one.
    pub untextured_right: f64,
    /// The share of both pictures that is white: 254 and more.
    pub over_exposed: f64,
    /// The share of both pictures that is black: 1 and less.
    pub under_exposed: f64,
    /// How many grey levels all but the darkest and the brightest hundredth of the left and of the right
    /// picture are within.
    pub grey_levels: [u8; 2],
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
    /// The shares of the left and of the right picture that are white, and that are black.
    #[serde(skip)]
    exposed: [[f64; 2]; 2],
}

/// The share of a picture that may be white or black without texture around before that is said.
const BADLY_EXPOSED: f64 = 0.25;

/// How many times as bright as the other a picture is whose partner is called dark.
const DARKER: f64 = 4.0;

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
        let (all, surfaces) = (matches.disparities_px(), matches.surfaces_px());
        let found = if surfaces.len() >= FEWEST { &surfaces } else { &all };
        let at =
            |share: f64| found.get((share * found.len().saturating_sub(1) as f64).round() as usize).copied();
        let range = (found.len() >= FEWEST).then(|| Some([at(0.02)?, at(0.98)?])).flatten();
        let search = if fault.is_none() { search(pictures, matches) } else { None };
        let beyond = Beyond::of(matches, config, search);
        let lacks = [0, 1].map(|side| Lacks::of(pictures[side], valid.map(|valid| valid[side])));
        let of_both = |of: fn(&Lacks) -> f64| lacks.iter().map(of).sum::<f64>() / 2.0;
        let mut check = Self {
            matches: matches.all.len(),
            matches_in_rows: matches.in_rows.len(),
            disparity_px: range,
            fault,
            beyond_search: range.map_or(0.0, |_| beyond.share()),
            search,
            untextured: lacks[0].untextured,
            untextured_right: lacks[1].untextured,
            over_exposed: of_both(|lacks| lacks.over_exposed),
            under_exposed: of_both(|lacks| lacks.under_exposed),
            grey_levels: matches.contrast.map(Contrast::levels),
            lost_texture: lacks[0].lost(&lacks[1]),
            lost_texture_right: lacks[1].lost(&lacks[0]),
            masked: lacks[0].masked,
            out_of_view: range.and(at(0.5)).map(|d| (d / f64::from(pictures[0].width())).clamp(0.0, 1.0)),
            warnings: Vec::new(),
            exposed: lacks.each_ref().map(|lacks| [lacks.over_exposed, lacks.under_exposed]),
        };
        let fault = check.fault.map(|fault| fault.to_string());
        // What is black or white lacks texture, too, and what is seen the wrong way round may seem to.
        let light = exposure_warning(&lacks);
        let texture =
            if light.is_none() && fault.is_none() { texture_warning(&lacks, matches) } else { None };
        let faint =
            if light.is_none() && texture.is_none() { Contrast::warning(matches.contrast) } else { None };
        let masks = mask_warning(&lacks);
        let nothing = (fault.is_none() && light.is_none() && texture.is_none() && masks.is_none())
            .then(|| unmatched_warning(matches))
            .flatten();
        let is_known = range.is_some() && search.is_some();
        let beyond = if is_known { beyond.warnings() } else { [None, None] };
        let found = [fault].into_iter().chain(beyond).chain([masks, light, texture, faint, nothing]);
        check.warnings = found.flatten().collect();
        check
    }

    /// The same with what else is wrong, if it is.
    pub fn with_warning(mut self, warning: Option<String>) -> Self {
        self.warnings.extend(warning);
        self
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

/// What is to be known about a mask that leaves nothing of its image.
fn mask_warning(lacks: &[Lacks; 2]) -> Option<String> {
    let black = lacks.iter().position(|lacks| lacks.masked >= 1.0)?;
    let side = ["left", "right"][black];
    Some(format!(
        "the mask of the {side} image is black, and nothing of that image is matched; make it 255 where \
         the image shows something"
    ))
}

/// What is to be known about features of both pictures of which next to none are the same.
fn unmatched_warning(matches: &PairMatches) -> Option<String> {
    let [left, right] = matches.features;
    (left.min(right) >= 8 * FEWEST && matches.all.len() < FEWEST).then(|| {
        format!(
            "of {left} features in the left image and {right} in the right one {} are the same: the images \
             show different things, one is out of focus, or all of it repeats; whether this is a pair, and \
             what has to be searched, is not known",
            matches.all.len()
        )
    })
}

/// What is to be known about a camera that sees less than the other one.
fn texture_warning(lacks: &[Lacks; 2], matches: &PairMatches) -> Option<String> {
    let side = Lacks::less_textured(lacks)?;
    let (of, other) = (&lacks[side], &lacks[1 - side]);
    let names = ["left", "right"];
    let (side, other_side) = (names[side], names[1 - side]);
    let cause = if DARKER * of.mean < other.mean {
        format!(
            "is dark: its mean grey level is {:.0}, that of the other one {:.0}; expose it longer, or see \
             what covers it",
            of.mean, other.mean
        )
    } else if matches.in_rows.len() < FEWEST {
        "is covered, dirty or out of focus, or shows another scene".to_owned()
    } else {
        "is covered, dirty or out of focus".to_owned()
    };
    Some(format!(
        "{:.0} % of the {side} image lacks the texture that the {other_side} one has in the same rows, and \
         what is answered there is a guess; see whether the {side} camera {cause}",
        100.0 * of.lost(other)
    ))
}

/// What is to be known about the light: of both pictures, or of the one that lacks it.
fn exposure_warning(lacks: &[Lacks; 2]) -> Option<String> {
    // Where there is texture around, as of dots on black, there is something to be matched.
    let said = |of: fn(&Lacks) -> f64, blank: fn(&Lacks) -> f64, what: &str, cure: &str| {
        let [left, right] = lacks.each_ref().map(of);
        let (share, images) = match lacks.each_ref().map(|lacks| blank(lacks) > BADLY_EXPOSED) {
            [true, true] => ((left + right) / 2.0, "images are"),
            [true, false] => (left, "left image is"),
            [false, true] => (right, "right image is"),
            [false, false] => return None,
        };
        let percent = 100.0 * share;
        Some(format!("{percent:.0} % of the {images} {what}, where nothing can be matched; {cure}"))
    };
    said(|lacks| lacks.over_exposed, |lacks| lacks.white, "over-exposed", "expose them shorter").or_else(
        || {
            let cure = "expose them longer, or mask what is a border (--valid-left, --valid-right)";
            said(|lacks| lacks.under_exposed, |lacks| lacks.black, "black", cure)
        },
    )
}
