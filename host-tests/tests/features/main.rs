//! Features and matches: the core against its naive twins, and against what a rendered scene is known to be.
//!
//! * `twins`: every stage, to the bit. `refused`: capacities and errors. `scenes`: matches that follow a
//!   known motion.

mod refused;
mod scenes;
mod twins;

use image::GrayImage;
use nalgebra::Matrix3;
use stereopsis::features::{
    Feature, FeatureConfig, FeatureCounts, FeatureDetector, FeatureMatcher, Match, MatchConfig,
};
use stereopsis::geometry::two_view::Fundamental;

/// The capacity of the detectors here: lines, and corners in a row of cells.
const W: usize = 330;
const C: usize = 110;

/// The features of a picture by the core.
fn detect(config: &FeatureConfig, image: &GrayImage) -> (Vec<Feature>, FeatureCounts) {
    let mut detector = Box::new(FeatureDetector::<W, C>::new());
    let mut list = Box::new(heapless::Vec::<Feature, 4096>::new());
    detector.start(config).expect("a configuration within the capacity");
    for line in image.as_raw().chunks_exact(image.width() as usize) {
        detector.push(line, list.as_mut_view()).expect("a line that is due");
    }
    (list.to_vec(), detector.counts())
}

/// Their matches by the core.
fn matched(left: &[Feature], right: &[Feature], search: &MatchConfig) -> Vec<Match> {
    let mut list = Box::new(heapless::Vec::<Match, 4096>::new());
    let mut matcher = Box::new(FeatureMatcher::<4096>::new());
    let dropped = matcher.run(left, right, search, list.as_mut_view());
    assert_eq!(dropped, Ok(0));
    list.to_vec()
}

/// F of two pictures with aligned rows: the line of a point is its row.
fn rows_aligned() -> Fundamental<f32> {
    let shift = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
    Fundamental::from_matrix(&shift).expect("a matrix of rank two")
}

/// The configuration for a picture.
fn config(image: &GrayImage) -> FeatureConfig {
    FeatureConfig::new(image.width() as u16, image.height() as u16)
}
