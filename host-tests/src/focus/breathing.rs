//! Whether the frames of a stack grow as the thin lens says: a lens that keeps its angle of view, and a stack
//! that was aligned, do not.
//!
//! Neighbouring frames of a fine sweep differ by less than a pixel: those are compared that differ by two in
//! a corner.

use image::GrayImage;
use stereopsis::focus::Breathing;

/// How far neighbouring frames are from each other, as they are and each seen at its scale, in grey levels
/// summed up.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Agreement {
    plain: f64,
    scaled: f64,
}

impl Agreement {
    /// Whether frames of that size differ enough to be told apart: by two pixels in a corner.
    pub fn is_telling((width, height): (u32, u32), ratio: f32) -> bool {
        (ratio - 1.0).abs() * (width as f32).hypot(height as f32) >= 4.0
    }

    /// Adds a pair of frames, of which `after` is `ratio` times as large as `before` by the lens's model.
    pub fn add(&mut self, before: &GrayImage, after: &GrayImage, ratio: f32) {
        let Ok(scale) = Breathing::new(ratio) else { return };
        let (width, height) = (before.width() as usize, before.height() as usize);
        let at = |image: &GrayImage, x: usize, y: usize| f64::from(image.get_pixel(x as u32, y as u32).0[0]);
        for y in 0..height {
            for x in 0..width {
                let here = at(before, x, y);
                let moved = at(after, scale.source(x, width), scale.source(y, height));
                self.plain += (here - at(after, x, y)).abs();
                self.scaled += (here - moved).abs();
            }
        }
    }

    /// Whether frames agree better at their scales.
    pub fn is_breathing(&self) -> bool {
        self.scaled < self.plain
    }
}
