//! What a matcher is asked to do, checked once before the first line.

use super::penalties::{Penalties, PenaltiesError};
use crate::imaging::Noise;
use crate::units::Disparity;

/// Frame size, search range and checks of a matcher.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Config {
    /// Pixels in a line: 1 up to the matcher's capacity.
    pub width: u16,
    /// Lines in a frame, at least 1.
    pub height: u16,
    /// How many whole disparities are searched: [`Config::FEWEST_DISPARITIES`] up to the matcher's capacity.
    pub disparities: u16,
    /// The smallest disparity searched, px. The search covers `min_disparity .. min_disparity +
    /// disparities`.
    pub min_disparity: u16,
    /// The checks that refuse answers.
    pub checks: Checks,
    /// P1, P2 and truncations of semi-global matching; the methods over windows ignore them.
    pub penalties: Penalties,
    /// Whether rows say how sure each answer is ([`Row::confidences`](super::Row::confidences)): a search
    /// more for each pixel.
    pub confidence: bool,
    /// The least confidence that an answer keeps: one that is less sure is refused, as
    /// [`AMBIGUOUS`](crate::units::PixelFlags::AMBIGUOUS), and so is every answer that was filled in, from 2
    /// on. The rows below are as they would be with it. 0: none is refused; more, up to
    /// [`Config::MOST_CONFIDENCE`], asks for `confidence`, too.
    pub min_confidence: u8,
    /// How noisy both cameras are: what is compared is smoothed accordingly. The next frame's is what a
    /// [`NoiseMeter`](crate::imaging::NoiseMeter) says of this one. It takes work, but no memory. Checks and
    /// penalties that suit it are those of [`Config::with_filter`] after it is set. Between frames a
    /// guarded pipeline takes it by `restart`.
    pub noise: Noise,
}

impl Config {
    /// The shortest search range.
    pub const FEWEST_DISPARITIES: u16 = 16;
    /// The longest search range of any matcher.
    pub const MOST_DISPARITIES: u16 = 256;

    /// The highest confidence that an answer can have.
    pub const MOST_CONFIDENCE: u8 = 207;

    /// Where every search ends, px: its largest disparity lies below, so that no answer is near
    /// [`Disparity::NONE`].
    pub const END: u16 = Disparity::MAX_PIXELS;

    /// All zero: a matcher that was not started, which so takes no place in flash when it is a static.
    pub(crate) const UNSET: Self = Self {
        width: 0,
        height: 0,
        disparities: 0,
        min_disparity: 0,
        checks: Checks {
            smoothing_radius: 0,
            surface_step: Disparity::ZERO,
            fill_step: Disparity::ZERO,
            fattening_slope: Disparity::ZERO,
            ..Checks::DENSE
        },
        penalties: Penalties::UNSET,
        confidence: false,
        min_confidence: 0,
        noise: Noise::None,
    };

    /// Whether the kernel has to find how much more the second best costs.
    pub(crate) const fn needs_margins(&self) -> bool {
        self.confidence || self.checks.open_margin > 0
    }

    /// Whether a matcher for lines up to `width` and ranges up to `disparities` can do this.
    pub(crate) fn check(&self, width: usize, disparities: usize) -> Result<(), ConfigError> {
        if self.width == 0 || usize::from(self.width) > width {
            return Err(ConfigError::Width { given: self.width, most: width });
        }
        if self.height == 0 {
            return Err(ConfigError::Height);
        }
        if self.disparities < Self::FEWEST_DISPARITIES || usize::from(self.disparities) > disparities {
            return Err(ConfigError::Disparities { given: self.disparities, most: disparities });
        }
        if u32::from(self.min_disparity) + u32::from(self.disparities) > u32::from(Self::END) {
            return Err(ConfigError::MinDisparity { most: Self::END - self.disparities });
        }
        if self.checks.uniqueness_percent.is_some_and(|p| p > 99) {
            return Err(ConfigError::Uniqueness);
        }
        if self.checks.smoothing_radius > Checks::MOST_SMOOTHING {
            return Err(ConfigError::Smoothing);
        }
        if self.checks.surface_step.raw() > Disparity::ONE {
            return Err(ConfigError::SurfaceStep);
        }
        if self.checks.open_margin > Checks::MOST_OPEN_MARGIN {
            return Err(ConfigError::OpenMargin);
        }
        if self.min_confidence > Self::MOST_CONFIDENCE {
            return Err(ConfigError::MinConfidence);
        }
        self.penalties.check().map_err(|error| match error {
            PenaltiesError::Gradient => ConfigError::Gradient,
            PenaltiesError::Order => ConfigError::Penalties,
        })
    }
}

/// Checks that refuse answers, and how strict they are.
///
/// Three operating points are ready made, those of the block methods here: [`Checks::DENSE`] answers wherever
/// there is a candidate, [`Checks::DEFAULT`] drops what the other image or the neighbourhood contradicts,
/// [`Checks::STRICT`] keeps what is well supported. [`Filter::checks`](super::Filter::checks) has them for
/// every method.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Checks {
    /// Left-right check: largest difference, px, between a winner and the disparity kept by its partner in
    /// the right image, that of the cheapest left pixel that chose it. `None`: not checked.
    pub left_right_px: Option<u8>,
    /// Uniqueness: an answer stays when every other disparity costs more than the winner by over this share
    /// of its own cost, percent, 0 to 99; 0 refuses exact ties only. Those up to two px beside the
    /// winner do not count. `None`: not checked, and the kernel saves the pass.
    pub uniqueness_percent: Option<u8>,
    /// Flat: refuses a winner that costs the same as both neighbouring disparities.
    pub refuse_flat: bool,
    /// Texture: a pixel counts as textured when its left and right neighbour differ by this many grey
    /// levels.
    pub texture_gradient: u8,
    /// Texture: an answer stays when its window holds this many textured pixels. 0: not checked, and the
    /// pass is saved.
    pub texture_pixels: u8,
    /// Whether a winner at the largest disparity searched is refused, for the surface may be nearer, and one
    /// whose partner is the first column of the right image, for that camera may not see it.
    pub refuse_ceiling: bool,
    /// Two neighbours are of one surface when they differ by at most this; up to 1 px.
    pub surface_step: Disparity,
    /// Answers are averaged along the line with up to this many pairs of neighbours, left and right alike,
    /// of their surface; 0 to [`Checks::MOST_SMOOTHING`], 0 for none. With the methods along paths they
    /// are then smoothed down the columns as well
    /// ([`Method::VERTICAL_FILTER`](super::Method::VERTICAL_FILTER)).
    pub smoothing_radius: u8,
    /// Speckle: answers are dropped that have fewer of their surface, themselves included, on a cross: in
    /// their column, down to four rows below, and along the rows of these. 0: none is.
    pub speckle_pixels: u8,
    /// Median: every answer becomes the middle one of those in 3 x 3 pixels around it.
    pub median: bool,
    /// Fill: gaps along the row of at most this many pixels, between two answers, get the farther of the
    /// two, and [`PixelFlags::FILLED`](crate::units::PixelFlags::FILLED). 0: none is.
    pub fill_pixels: u8,
    /// Fill: by how much the two answers beside a gap may differ: [`Disparity::NONE`] for any two.
    pub fill_step: Disparity,
    /// Speckle: a row of a surface counts as at most this many answers, so that a streak of few rows is none
    /// however long it is. 0: it counts as all it has.
    pub speckle_run: u8,
    /// Fattening: along a part of a row without edges an answer may be nearer than the others by 2 px, and by
    /// this much for each pixel between. The methods along paths also ask images without noise for an edge
    /// where a nearer surface begins. [`Disparity::NONE`]: neither is checked, and the passes are saved.
    pub fattening_slope: Disparity,
    /// Open: in and beside a place without edges that reaches up to the image's first row, as a sky does, a
    /// row of a surface counts as at most this many answers for its speckle. 0: as anywhere.
    pub open_run: u8,
    /// Open: there an answer stays when every other disparity, but for those up to two px beside it, costs
    /// more by at least this, up to [`Checks::MOST_OPEN_MARGIN`]. Where the fattening of methods along paths
    /// is checked too, a near surface there must also end at an edge. 0: neither is checked, and the kernel
    /// saves the pass.
    pub open_margin: u8,
    /// Repeats, with the methods along paths: whether answers are refused on patterns that repeat along the
    /// row within the search, such as a chessboard's.
    pub refuse_repeats: bool,
}

impl Checks {
    /// Whether open places are looked for.
    pub(crate) const fn look_for_open(&self) -> bool {
        self.open_run > 0 || self.open_margin > 0
    }

    /// Whether edges of the left image are looked for.
    pub(crate) const fn look_for_edges(&self) -> bool {
        self.fattening_slope.is_some() || self.look_for_open()
    }

    /// The widest smoothing along the line.
    pub const MOST_SMOOTHING: u8 = 8;

    /// The largest margin of answers in open places: what costs are compared up to.
    pub const MOST_OPEN_MARGIN: u8 = 127;

    /// Every pixel with a candidate gets an answer.
    pub const DENSE: Self = Self {
        left_right_px: None,
        uniqueness_percent: None,
        refuse_flat: false,
        texture_gradient: 0,
        texture_pixels: 0,
        refuse_ceiling: false,
        smoothing_radius: 4,
        speckle_pixels: 0,
        surface_step: Disparity::ONE_PIXEL,
        median: false,
        fill_pixels: 0,
        fill_step: Disparity::ONE_PIXEL,
        speckle_run: 0,
        fattening_slope: Disparity::NONE,
        open_run: 0,
        open_margin: 0,
        refuse_repeats: false,
    };

    /// Most answers, few of them wrong.
    pub const DEFAULT: Self = Self {
        left_right_px: Some(1),
        refuse_flat: true,
        refuse_ceiling: true,
        speckle_pixels: 24,
        ..Self::DENSE
    };

    /// Sure answers: fewer, and wrong only rarely.
    pub const STRICT: Self = Self {
        uniqueness_percent: Some(5),
        texture_gradient: 2,
        texture_pixels: 4,
        speckle_pixels: 60,
        ..Self::DEFAULT
    };
}

impl Default for Checks {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Why a matcher cannot do what it is asked.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ConfigError {
    /// The width is 0 or over the capacity.
    Width {
        /// What was asked.
        given: u16,
        /// The capacity.
        most: usize,
    },
    /// The height is 0.
    Height,
    /// The number of disparities is under [`Config::FEWEST_DISPARITIES`] or over the capacity.
    Disparities {
        /// What was asked.
        given: u16,
        /// The capacity.
        most: usize,
    },
    /// The search range ends beyond what [`Disparity`] can say.
    MinDisparity {
        /// The largest `min_disparity` for this number of disparities.
        most: u16,
    },
    /// The uniqueness is over 99 percent.
    Uniqueness,
    /// The smoothing radius is over [`Checks::MOST_SMOOTHING`].
    Smoothing,
    /// The step of a surface is over 1 px.
    SurfaceStep,
    /// The margin of open places is over [`Checks::MOST_OPEN_MARGIN`].
    OpenMargin,
    /// The least confidence is over [`Config::MOST_CONFIDENCE`].
    MinConfidence,
    /// The range of gradients is 0 or over [`Penalties::MOST_GRADIENT`].
    Gradient,
    /// The penalties are not in order, or a sum of them is over its byte.
    Penalties,
}

error_text!(ConfigError {
    Self::Width { given, most } => "width {given}: 1 to {most} pixels",
    Self::Height => "height 0: at least 1 line",
    Self::Disparities { given, most } => "disparities {given}: {} to {most}" (Config::FEWEST_DISPARITIES),
    Self::MinDisparity { most } => "min_disparity: at most {most} with these disparities",
    Self::Uniqueness => "uniqueness: 0 to 99 percent",
    Self::SurfaceStep => "surface step: at most 1 px",
    Self::OpenMargin => "open margin: at most {}" (Checks::MOST_OPEN_MARGIN),
    Self::MinConfidence => "min_confidence: at most {}" (Config::MOST_CONFIDENCE),
    Self::Gradient => "gradient: 1 to {}" (Penalties::MOST_GRADIENT),
    Self::Penalties =>
        "penalties: cost >= 1, steps falling, jumps above them, edges rising, \
         cost + step + jump < 128, 3 cost + 2 jump < 255",
    Self::Smoothing => "smoothing radius: at most {}" (Checks::MOST_SMOOTHING),
});

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::method::{Fast, Sgm};

    #[test]
    fn each_number_is_taken_up_to_its_limit() {
        let plain = Config::for_method::<Fast>(40, 30, 32);
        let with = |checks: Checks| Config { checks, ..plain };
        let (width, disparities) = (64, 48);
        for config in [
            plain,
            Config { width: 1, ..plain },
            Config { width: 64, height: 1, ..plain },
            Config { height: u16::MAX, disparities: 16, ..plain },
            Config { disparities: 48, ..plain },
            Config { min_disparity: Config::END - 32, ..plain },
            with(Checks { uniqueness_percent: None, ..plain.checks }),
            with(Checks { uniqueness_percent: Some(99), ..plain.checks }),
            with(Checks { smoothing_radius: Checks::MOST_SMOOTHING, ..plain.checks }),
            with(Checks { surface_step: Disparity::ONE_PIXEL, ..plain.checks }),
            with(Checks { open_margin: Checks::MOST_OPEN_MARGIN, ..plain.checks }),
            Config { min_confidence: Config::MOST_CONFIDENCE, ..plain },
        ] {
            assert_eq!(config.check(width, disparities), Ok(()), "{config:?}");
        }
        let beyond = Disparity::from_raw(Disparity::ONE + 1);
        let steps_rise = Penalties { step: [3, 4], ..Penalties::DEFAULT };
        for (config, error) in [
            (Config { width: 0, ..plain }, ConfigError::Width { given: 0, most: 64 }),
            (Config { width: 65, ..plain }, ConfigError::Width { given: 65, most: 64 }),
            (Config { width: 900, ..plain }, ConfigError::Width { given: 900, most: 64 }),
            (Config { height: 0, ..plain }, ConfigError::Height),
            (Config { disparities: 0, ..plain }, ConfigError::Disparities { given: 0, most: 48 }),
            (Config { disparities: 15, ..plain }, ConfigError::Disparities { given: 15, most: 48 }),
            (Config { disparities: 49, ..plain }, ConfigError::Disparities { given: 49, most: 48 }),
            (Config { disparities: 256, ..plain }, ConfigError::Disparities { given: 256, most: 48 }),
            (
                Config { min_disparity: Config::END - 31, ..plain },
                ConfigError::MinDisparity { most: Config::END - 32 },
            ),
            (
                Config { min_disparity: u16::MAX, ..plain },
                ConfigError::MinDisparity { most: Config::END - 32 },
            ),
            (with(Checks { uniqueness_percent: Some(100), ..plain.checks }), ConfigError::Uniqueness),
            (with(Checks { uniqueness_percent: Some(255), ..plain.checks }), ConfigError::Uniqueness),
            (
                with(Checks { smoothing_radius: Checks::MOST_SMOOTHING + 1, ..plain.checks }),
                ConfigError::Smoothing,
            ),
            (with(Checks { smoothing_radius: 255, ..plain.checks }), ConfigError::Smoothing),
            (with(Checks { surface_step: beyond, ..plain.checks }), ConfigError::SurfaceStep),
            (with(Checks { surface_step: Disparity::NONE, ..plain.checks }), ConfigError::SurfaceStep),
            (with(Checks { open_margin: 128, ..plain.checks }), ConfigError::OpenMargin),
            (Config { min_confidence: 208, ..plain }, ConfigError::MinConfidence),
            (
                Config { penalties: Penalties { gradient: 0, ..Penalties::DEFAULT }, ..plain },
                ConfigError::Gradient,
            ),
            (Config { penalties: steps_rise, ..plain }, ConfigError::Penalties),
        ] {
            assert_eq!(config.check(width, disparities), Err(error), "{config:?}");
        }
    }

    #[test]
    fn what_is_asked_for_is_looked_for() {
        for (confidence, open_margin) in [(false, 0), (false, 1), (true, 0), (true, 52)] {
            let checks = Checks { open_margin, ..Checks::DENSE };
            let config = Config { confidence, checks, ..Config::for_method::<Sgm>(40, 30, 32) };
            assert_eq!(config.needs_margins(), (confidence, open_margin) != (false, 0));
        }
        for (open_run, open_margin) in [(0, 0), (0, 1), (1, 0), (5, 52)] {
            for fattening_slope in [Disparity::ZERO, Disparity::NONE] {
                let checks = Checks { open_run, open_margin, fattening_slope, ..Checks::DENSE };
                let is_open = (open_run, open_margin) != (0, 0);
                assert_eq!(checks.look_for_open(), is_open);
                assert_eq!(checks.look_for_edges(), is_open || fattening_slope == Disparity::ZERO);
            }
        }
    }
}
