//! Pictures of few grey levels: too dark, or behind a veil.

use image::GrayImage;
use std::borrow::Cow;

/// So many grey levels between a picture's darkest and brightest hundredth are few. At a fifth of the light,
/// where these are 36 to 51, the real pairs that the tests know miss three times as many answers.
const FEW: u8 = 40;

/// The grey levels that all but a hundredth of a picture's pixels at either end are within.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Contrast {
    pub least: u8,
    pub most: u8,
}

impl Contrast {
    /// Of a picture, which shows nothing where `valid` is 0.
    pub fn of(picture: &GrayImage, valid: Option<&GrayImage>) -> Self {
        let mut counts = [0_usize; 256];
        for (at, &grey) in picture.as_raw().iter().enumerate() {
            let is_shown = valid.is_none_or(|valid| valid.as_raw().get(at).is_some_and(|&shown| shown != 0));
            counts[usize::from(grey)] += usize::from(is_shown);
        }
        let all_but = counts.iter().sum::<usize>() / 100;
        let least = beyond(all_but, &counts, 0..=255);
        Self { least, most: beyond(all_but, &counts, (0..=255).rev()).max(least) }
    }

    /// How many grey levels that are.
    pub fn levels(self) -> u8 {
        self.most - self.least
    }

    /// What is to be known about pictures of few grey levels, or about the one that is.
    pub fn warning(of: [Self; 2]) -> Option<String> {
        let few = of.map(|contrast| contrast.levels() < FEW);
        let (images, contrast) = match few {
            [true, true] => ("images have", of[usize::from(of[0].levels() < of[1].levels())]),
            [true, false] => ("left image has", of[0]),
            [false, true] => ("right image has", of[1]),
            [false, false] => return None,
        };
        let Self { least, most } = contrast;
        let cure = if most < 2 * FEW {
            "expose longer, or light the scene"
        } else {
            "see whether a lens is fogged or its camera looks into the light"
        };
        Some(format!(
            "the {images} little contrast: grey levels from {least} to {most}, of which one is as much as \
             what is to be matched; {cure}"
        ))
    }

    /// The picture with these grey levels spread over all that there are, where they are few.
    pub fn spread(self, picture: &GrayImage) -> Cow<'_, GrayImage> {
        let levels = u32::from(self.levels());
        if levels == 0 || levels >= FEW.into() {
            return Cow::Borrowed(picture);
        }
        let mut spread = picture.clone();
        for pixel in spread.iter_mut() {
            let above = u32::from(pixel.saturating_sub(self.least)).min(levels);
            *pixel = (255 * above / levels) as u8;
        }
        Cow::Owned(spread)
    }
}

/// The first of some grey levels that, with those before it, more than so many pixels have.
fn beyond(few: usize, counts: &[usize; 256], mut levels: impl Iterator<Item = u8>) -> u8 {
    let mut seen = 0;
    let is_beyond = |&level: &u8| {
        seen += counts[usize::from(level)];
        seen > few
    };
    levels.find(is_beyond).unwrap_or(0)
}
