//! What of a frame does not depend on those before it.

use crate::correspond::{CorrespondError, Plan, features};
use image::GrayImage;
use stereopsis::features::{Feature, Orientation};

/// How corners are found: as many as are followed, on the full picture.
fn plan() -> Plan {
    Plan { corners: 1500, threshold: 8, levels: 1, ..Plan::default() }
}

/// A frame with its features.
pub(super) struct Prepared {
    pub left: GrayImage,
    pub right: Option<GrayImage>,
    pub corners: Vec<Feature>,
}

impl Prepared {
    /// Finds the features of a frame.
    pub fn new((left, right): (GrayImage, Option<GrayImage>)) -> Result<Self, CorrespondError> {
        let corners = features(&plan(), Orientation::Upright, &left)?;
        Ok(Self { left, right, corners })
    }
}
