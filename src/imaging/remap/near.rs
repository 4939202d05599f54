//! Whether a table's positions are those of its warp.

use super::RemapTable;
use super::segment::{BITS, HALF, Part, Segment};
use super::table::FINEST;
use crate::geometry::{Real, camera::ImageSize, rectify::Warp};
use nalgebra::Point2;

impl<const SLOTS: usize> RemapTable<SLOTS> {
    /// Whether the positions inside the raw image, by the table or by the warp, are those of the warp, within
    /// the tolerance: at every second pixel of every fourth row, at every fourth of the others, and where the
    /// valid pixels begin and end.
    pub(super) fn is_near<T: Real>(&self, warp: &Warp<T>) -> bool {
        let last = self.size().height.saturating_sub(1);
        (0..=last).all(|y| {
            let is_strict = y.is_multiple_of(4) || y == last;
            let (px, step) = if is_strict { (Self::TOLERANCE_PX, 2) } else { (Self::LARGEST_ERROR_PX, 4) };
            let looks = Looks { y, step, most: T::of(px) };
            let cells = self.segments(y, false).zip((0..self.size().width).step_by(1 << self.shift()));
            cells.into_iter().all(|(segment, x)| self.is_segment_near(&segment, x, warp, &looks))
        })
    }

    /// Whether the positions of a segment that begins at column `x` are near.
    fn is_segment_near<T: Real>(&self, segment: &Segment, x: u16, warp: &Warp<T>, looks: &Looks<T>) -> bool {
        let Looks { y, step, most } = *looks;
        let length = (1 << self.shift()).min(usize::from(self.size().width - x));
        let is_described = segment.part != Part::None;
        let raw = self.raw_size();
        let is_found = |place: &(i32, i32)| is_described && is_in(raw, *place);
        let places = segment.column.places(self.piece()).zip(segment.row.places(self.piece()));
        let mut places = places.take(length).enumerate().peekable();
        let mut was_found = false;
        while let Some((k, place)) = places.next() {
            let here = is_found(&place);
            // Pieces are straight: between two that are near lies what is near.
            let is_between = was_found && places.peek().is_some_and(|(_, next)| is_found(next));
            was_found = here;
            if !k.is_multiple_of(step) && (!here || is_between) {
                continue;
            }
            let Ok(source) = warp.source(&Point2::new(T::count(usize::from(x) + k), T::count(y.into())))
            else {
                if here {
                    return false;
                }
                continue;
            };
            let is_asked = source.is_described && warp.is_in_raw(&source.pixel);
            // A place that is not described takes its cell with it: small ones only.
            if is_asked && !is_described {
                if self.shift() > FINEST {
                    return false;
                }
                continue;
            }
            // Half a 256th was added, for the pixels' weights.
            let px = |place: i32| (T::of(f64::from(place)) - T::of(f64::from(HALF))) * T::of(1.0 / 65536.0);
            let is_near = (Point2::new(px(place.0), px(place.1)) - source.pixel).norm() <= most;
            if (is_asked || here) && !is_near {
                return false;
            }
        }
        true
    }
}

/// Where a row is looked at: at every so many pixels, within a distance, px.
struct Looks<T> {
    y: u16,
    step: usize,
    most: T,
}

/// Whether a position is in the raw image, as the mask has it: from 0 to the last pixel, within a 256th.
fn is_in(raw: ImageSize, (column, row): (i32, i32)) -> bool {
    let end = |side: u16| ((u32::from(side) - 1) << BITS) + 2 * HALF as u32;
    column.cast_unsigned() < end(raw.width) && row.cast_unsigned() < end(raw.height)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_is_inside_to_the_last_pixel() {
        let raw = ImageSize { width: 5, height: 3 };
        let (right, bottom) = (4 << BITS, 2 << BITS);
        // Half a 256th is added to all of them, and half a 256th more is still the last pixel.
        for (place, is_inside) in [(-1, false), (0, true), (HALF, true), (2 * HALF - 1, true)] {
            let at_end = |end: i32| if is_inside { end + place } else { place };
            assert_eq!(is_in(raw, (at_end(right), 9)), is_inside, "{place}");
            assert_eq!(is_in(raw, (9, at_end(bottom))), is_inside, "{place}");
        }
        assert!(!is_in(raw, (right + 2 * HALF, 9)) && !is_in(raw, (9, bottom + 2 * HALF)));
    }
}
