//! What each stage of the dense path gives, in running order: the vectors that a block of gates is held to.

use super::cost::{self, Volume};
use super::open::Open;
use super::repeats::Repeats;
use super::smooth::Seen;
use super::{Answers, Cost, Method, Picture, census, confidence, fattening, filter, paths, rims, select};
use image::GrayImage;
use stereopsis::matching::{Config, WinnerRecord};
use stereopsis::units::{Disparity, PixelFlags};

/// The rows of all stages of a pair, one after the other.
#[derive(Clone, Debug)]
pub struct Stages {
    /// The census codes of the left and of the right picture.
    pub census: [Vec<u32>; 2],
    /// What each candidate of each pixel costs by itself.
    pub costs: Volume,
    /// Window sums, or sums along paths.
    pub aggregated: Volume,
    /// The winners.
    pub winners: Vec<WinnerRecord>,
    /// The flags after the left-right check and what else refuses a winner.
    pub flags: Vec<PixelFlags>,
    /// The answers that stay, to a fraction of a pixel.
    pub subpixel: Vec<Disparity>,
    /// Those averaged along the row, without those that fattening refuses.
    pub smoothed: Vec<Disparity>,
    /// Those after the median, the speckle filter and the filter down the columns, and their flags.
    pub checked: (Vec<Disparity>, Vec<PixelFlags>),
    /// What comes out.
    pub answers: Answers,
}

impl Stages {
    /// Matches a pair of pictures.
    ///
    /// # Panics
    ///
    /// When the pictures are not of the configuration's size.
    pub fn of(scheme: &Method, config: &Config, left: &GrayImage, right: &GrayImage) -> Self {
        let size = (u32::from(config.width), u32::from(config.height));
        assert_eq!(
            (left.dimensions(), right.dimensions()),
            (size, size),
            "the pictures have the configuration's size"
        );
        let (left, right) = (Picture::new(left), Picture::new(right));
        let seen = [&left, &right].map(|picture| Seen::new(*picture, config.noise));
        let (census, costs, aggregated) = candidates(scheme, config, &seen);
        let (width, height) = (left.width, left.height);
        let (disparity, flags, sigma_px, confidence) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut map = Answers { width, height, disparity, flags, sigma_px, confidence };
        let (mut winners, mut lengths, mut margins) = (Vec::new(), Vec::new(), Vec::new());
        let (mut flags, mut subpixel) = (Vec::new(), Vec::new());
        let open = Open::of(config, &left, scheme.radius_y);
        let repeats = Repeats::of(scheme, config, &left);
        for y in 0..height {
            let pair = [&left, &right];
            winners.extend(select::records(scheme, config, pair, &aggregated, y));
            let (answers, row_flags, row_margins) = select::select_row(scheme, config, pair, &aggregated, y);
            flags.extend_from_slice(&row_flags);
            subpixel.extend_from_slice(&answers);
            let (answers, row_flags) = open.refuse(config, y, &row_margins, answers, row_flags);
            let (answers, row_flags) = repeats.refuse(y, answers, row_flags);
            let (answers, row_flags) = fattening::refuse(config, &left, y, answers, row_flags);
            let (answers, row_flags) = rims::refuse(scheme, config, &left, &open, y, answers, row_flags);
            let (smooth, row_lengths) = filter::smooth_row(&config.checks, &answers);
            map.disparity.extend(smooth);
            lengths.extend(row_lengths);
            map.flags.extend(row_flags);
            margins.extend(row_margins);
        }
        let smoothed = map.disparity.clone();
        if config.checks.median {
            map.disparity = filter::medians(map.width, &smoothed);
        }
        let answers = map.disparity.clone();
        let mut map = filter::drop_speckles(&config.checks, &smoothed, &lengths, &open, map);
        if scheme.smooth_down && config.checks.smoothing_radius > 0 {
            filter::smooth_down(&smoothed, &mut map);
        }
        let checked = (map.disparity.clone(), map.flags.clone());
        let after = &checked.0;
        let mut map = filter::fill_gaps(&config.checks, &repeats, map);
        map.sigma_px = filter::sigmas(scheme, config, &smoothed, after, &map);
        if config.confidence || config.min_confidence > 0 {
            map.confidence = confidence::confidences(config, &margins, &smoothed, [&answers, after], &map);
        }
        confidence::refuse_unsure(config, &mut map);
        Self { census, costs, aggregated, winners, flags, subpixel, smoothed, checked, answers: map }
    }
}

/// The codes of both pictures, and what the candidates of each pixel cost: by themselves and aggregated.
fn candidates(scheme: &Method, config: &Config, seen: &[Seen<'_>; 2]) -> ([Vec<u32>; 2], Volume, Volume) {
    let [left, right] = seen;
    match scheme.cost {
        Cost::Window { neighbours, unit } => {
            let costs = cost::costs(neighbours, config, left, right);
            let sums = cost::window_sums(scheme, unit, &costs);
            (seen.each_ref().map(|seen| census::census(seen, neighbours)), costs, sums)
        }
        Cost::Paths { between_pixels, within_edges } => {
            let costs = paths::costs(between_pixels, config, left, right);
            let guide = left.rows();
            let guide = Picture::new(&guide);
            let averaged = if within_edges {
                paths::averaged_within_edges(config, &costs, &guide)
            } else {
                paths::averaged_down(&costs)
            };
            let sums = paths::path_sums(config, &averaged, &guide);
            (seen.each_ref().map(|seen| census::census(seen, &census::WIDE8)), costs, sums)
        }
    }
}
