//! Every stage of the dense path again, in its plainest form, over whole pictures: what the core is held to,
//! bit by bit.
//!
//! In: two pictures, a configuration. Out: [`Answers`]. In running order:
//!
//! * [`smooth`]: pictures with less noise, if asked for. [`census`](mod@census): darker neighbours as bits.
//! * [`cost`]: bits that differ, per disparity, and their sum over the window. [`paths`]: differences of
//!   pixels, and their sum along paths.
//! * `select`: the cheapest disparity, its fraction, the checks. `fattening`: what spreads where no edge is,
//!   `rims` the last of it. `open`: where no edge is up to the first row. `repeats`: where the left picture
//!   repeats itself.
//! * `filter`: smoothing along the row, the median, the speckle filter, smoothing down the columns, filling,
//!   the deviation.
//! * `confidence`: how sure an answer is.
//! * [`Stages`]: what each of them gives, for those who build one of them elsewhere.
//!
//! Apart from them: [`mod@balance`], one exposure for both pictures; [`bundle`], the step of a bundle
//! adjustment; [`features`], corners, descriptors and matches; [`focus`], [`focus_smoothing`] and
//! [`focus_edges`], sharpness, its peaks and their map; [`obstacles`], ground and stixels;
//! [`remap`](mod@remap), raw pictures as rectified ones.
//!
//! Nothing here is shared with the core but its words: [`Config`], [`Disparity`], [`PixelFlags`].

pub mod balance;
pub mod bundle;
pub mod census;
pub mod cost;
pub mod features;
pub mod focus;
pub mod focus_edges;
pub mod focus_smoothing;
pub mod obstacles;
pub mod paths;
pub mod remap;
pub mod smooth;
pub mod stages;

mod confidence;
mod fattening;
mod filter;
mod open;
mod repeats;
mod rims;
mod select;

use image::GrayImage;
use stages::Stages;
use stereopsis::matching::Config;
use stereopsis::units::{Disparity, PixelFlags};

/// What tells one matching method from another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// Where its costs come from.
    pub cost: Cost,
    /// An answer rests on this many columns to each side, which texture is counted in.
    pub radius_x: usize,
    /// And on this many rows up and down.
    pub radius_y: usize,
    /// How much a disparity beside the winner costs for that alone.
    pub step: i32,
    /// Whether answers that are averaged along the row are smoothed down the columns too.
    pub smooth_down: bool,
    /// The least deviation of an answer, px.
    pub sigma_px: f32,
}

/// Where costs come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cost {
    /// Census bits that differ, summed over the columns and rows that the scheme reaches.
    Window {
        /// The census: (dy, dx) of each bit.
        neighbours: &'static [(isize, isize)],
        /// The unit of a window's sum, in bits that differ: a column has as many as go into its own sum.
        unit: u16,
    },
    /// Differences of pixels, summed along paths.
    Paths {
        /// Whether a gradient is compared with all between a candidate and halfway to those beside it.
        between_pixels: bool,
        /// Whether costs are averaged down the columns within edges, or wherever they are.
        within_edges: bool,
    },
}

impl Method {
    /// The twin of [`stereopsis::matching::Fast`]: 4-bit census, 9 x 7 window.
    pub const FAST: Self = Self {
        cost: Cost::Window { neighbours: &census::PLUS4, unit: 1 },
        radius_x: 4,
        radius_y: 3,
        step: 0,
        smooth_down: false,
        sigma_px: 0.15,
    };
    /// The twin of [`stereopsis::matching::Block`]: 8-bit census, 9 x 9 window, in
    /// quarters.
    pub const BLOCK: Self = Self {
        cost: Cost::Window { neighbours: &census::RING8, unit: 4 },
        radius_x: 4,
        radius_y: 4,
        step: 0,
        smooth_down: false,
        sigma_px: 0.15,
    };
    /// The twin of [`stereopsis::matching::Sgm`].
    pub const SGM: Self = Self {
        cost: Cost::Paths { between_pixels: true, within_edges: false },
        radius_x: 4,
        radius_y: 1,
        step: 12,
        smooth_down: true,
        sigma_px: 0.15,
    };
    /// The twin of [`stereopsis::matching::SgmLean`].
    pub const SGM_LEAN: Self =
        Self { cost: Cost::Paths { between_pixels: false, within_edges: false }, ..Self::SGM };
    /// The twin of [`stereopsis::matching::SgmEdge`].
    pub const SGM_EDGE: Self =
        Self { cost: Cost::Paths { between_pixels: true, within_edges: true }, radius_y: 2, ..Self::SGM };
}

/// An 8-bit picture whose edge goes on for ever outside of it.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    width: usize,
    height: usize,
    pixels: &'a [u8],
}

impl<'a> Picture<'a> {
    /// The picture as the twin sees it.
    ///
    /// # Panics
    ///
    /// When it has no pixel.
    pub fn new(image: &'a GrayImage) -> Self {
        assert!(image.width() > 0 && image.height() > 0, "a picture has at least one pixel");
        Self { width: image.width() as usize, height: image.height() as usize, pixels: image.as_raw() }
    }

    /// The pixel (x, y), or the nearest one inside.
    #[inline]
    pub fn at(&self, x: isize, y: isize) -> u8 {
        let x = x.clamp(0, self.width as isize - 1) as usize;
        let y = y.clamp(0, self.height as isize - 1) as usize;
        self.pixels[y * self.width + x]
    }
}

/// What the matcher says about every pixel, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Answers {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The disparities.
    pub disparity: Vec<Disparity>,
    /// The flags.
    pub flags: Vec<PixelFlags>,
    /// The deviation of every answer, px.
    pub sigma_px: Vec<Option<f32>>,
    /// How sure every answer is; 0 where there is none. Empty where the configuration does not ask.
    pub confidence: Vec<u8>,
}

/// Matches a pair of pictures.
///
/// # Panics
///
/// When the pictures are not of the configuration's size.
pub fn match_pair(scheme: &Method, config: &Config, left: &GrayImage, right: &GrayImage) -> Answers {
    Stages::of(scheme, config, left, right).answers
}
