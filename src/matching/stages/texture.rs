//! How many pixels of a window have texture.
//!
//! A pixel has texture when its left and right neighbour differ by a few grey levels: along the line, because
//! only there does texture tell disparities apart. One bit a pixel is kept, 16 rows of them in a word a
//! column.

use crate::matching::backend::MethodParameters;
use crate::matching::backend::loops::{fill_bytes, keep_loop, keep_scalar_loop, once_without_vectors};
use crate::matching::config::Checks;
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::part;
use crate::matching::method::{Frame, Method};
use crate::units::PixelFlags;

/// Forgets the frame before.
pub(super) fn begin(frame: &mut Frame<'_>) {
    fill_bytes(frame.texture, 0);
    fill_bytes(frame.textured, 0);
}

/// Takes the texture of the row that comes in.
pub(super) fn take_texture<S: Method>(frame: &mut Frame<'_>, lines: Option<[&Rows5<'_>; 2]>) {
    let checks = &frame.config.checks;
    if checks.texture_pixels > 0 {
        let line = lines.map(|[left, _]| part(left[2], ..frame.width));
        Texture { history: frame.texture, counts: frame.textured }.push::<S>(line, checks);
    }
}

/// Flags the answers of `newest` whose window has too little texture.
pub(super) fn flag_untextured<S: Method>(frame: &mut Frame<'_>, newest: usize) {
    let pixels = frame.config.checks.texture_pixels;
    if pixels > 0 {
        let texture = Texture { history: frame.texture, counts: frame.textured };
        texture.mark::<S>(u16::from(pixels), frame.flags.row_mut(newest));
    }
}

/// Rows of texture bits: bit `k` of a column's word is the row `k` before the newest.
struct Texture<'a> {
    /// One word for each column.
    pub history: &'a mut [u16],
    /// Textured pixels of each column in the window's rows.
    pub counts: &'a mut [u8],
}

impl Texture<'_> {
    /// Moves one row on; `line` is the new row, or `None` below the image.
    fn push<S: MethodParameters>(&mut self, line: Option<&[u8]>, checks: &Checks) {
        let Some(line) = line else {
            for x in 0..self.counts.len() {
                keep_loop();
                push_at::<S>(self, x, false);
            }
            return;
        };
        let gradient = checks.texture_gradient;
        let beside = line.windows(3).map(|beside| (beside[0], beside[2]));
        let inner = self.history.iter_mut().zip(self.counts.iter_mut()).skip(1);
        for ((word, count), (left, right)) in inner.zip(beside) {
            keep_scalar_loop();
            go_on::<S>(word, count, left.abs_diff(right) >= gradient);
        }
        // At the two ends the pixel itself stands for the neighbour outside.
        let last = line.len().saturating_sub(1);
        // A line of one pixel has one end.
        for x in [0, last].into_iter().take(line.len()) {
            keep_loop();
            let beside = [x.saturating_sub(1), last.min(x + 1)];
            let [left, right] = beside.map(|x| line.get(x).copied().unwrap_or(0));
            push_at::<S>(self, x, left.abs_diff(right) >= gradient);
        }
    }

    /// Flags the pixels of the window's centre row whose window has fewer than `pixels` textured ones.
    fn mark<S: MethodParameters>(&self, pixels: u16, flags: &mut [PixelFlags]) {
        // Columns outside the image have no texture; left of it the place wraps.
        let column = |x: usize| self.counts.get(x).map_or(0, |&count| u16::from(count));
        let mut count = 0;
        for &first in part(self.counts, ..S::RADIUS_X.min(self.counts.len())) {
            keep_loop();
            count += u16::from(first);
        }
        for (x, flags) in flags.iter_mut().enumerate() {
            keep_loop();
            count += column(x + S::RADIUS_X);
            count -= column(x.wrapping_sub(S::RADIUS_X + 1));
            *flags = flags.union(PixelFlags::UNTEXTURED.when(count < pixels));
        }
    }
}

once_without_vectors! {
    /// Moves column `x` on.
    fn push_at<S: MethodParameters>(texture: &mut Texture<'_>, x: usize, textured: bool) {
        if let (Some(word), Some(count)) = (texture.history.get_mut(x), texture.counts.get_mut(x)) {
            go_on::<S>(word, count, textured);
        }
    }
}

/// Moves a column on by a pixel that is textured or not.
#[inline(always)]
fn go_on<S: MethodParameters>(word: &mut u16, count: &mut u8, textured: bool) {
    *count = *count - ((*word >> (2 * S::RADIUS_Y)) as u8 & 1) + u8::from(textured);
    *word = *word << 1 | u16::from(textured);
}
