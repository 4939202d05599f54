//! Features beside their twins.

use crate::case;
use arbitrary::{Result, Unstructured};
use stereopsis::features::{Feature, FeatureConfig, FeatureDetector, Level, Orientation};
use stereopsis_model::twin::features as twin;

const WIDTH: usize = 160;
/// Corners in a row of cells.
const CORNERS: usize = 96;

/// The features of any picture, by any configuration that is taken, are the twin's to the bit.
pub fn equal_their_twins(u: &mut Unstructured<'_>) -> Result<()> {
    let (width, height) = (u.int_in_range(1..=WIDTH as u16)?, u.int_in_range(1..=90_u16)?);
    let config = FeatureConfig {
        threshold: u.arbitrary()?,
        cell_px: u.int_in_range(0..=80)?,
        per_cell: u.int_in_range(0..=9)?,
        orientation: if u.arbitrary()? { Orientation::Centroid } else { Orientation::Upright },
        level: if u.arbitrary()? { Level::FULL } else { Level::FULL.downsampled::<3>() },
        ..FeatureConfig::new(width, height)
    };
    let image = case::pair(u, width.into(), height.into())?.0;
    let mut detector = Box::new(FeatureDetector::<WIDTH, CORNERS>::new());
    if detector.start(&config).is_err() {
        return Ok(());
    }
    let mut list = Box::new(heapless::Vec::<Feature, 4096>::new());
    for line in image.as_raw().chunks_exact(width.into()) {
        detector.push(line, list.as_mut_view()).expect("a line that is due");
    }
    let (expected, corners) = twin::features(&config, &image);
    let counts = detector.counts();
    assert_eq!((&list[..], counts.corners, counts.dropped), (&expected[..], corners, 0), "{config:?}");
    Ok(())
}
