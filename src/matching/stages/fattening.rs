//! Answers refused that spread from a near surface over a place without edges (foreground fattening).
//!
//! Where depth jumps, brightness mostly does as well. Costs along paths carry the disparity of a near surface
//! on over a wall or a sky that has little to say, up to where the wall's own disparity takes over: a jump
//! without an edge. Along a part of a row without edges an answer is therefore refused that is nearer than
//! another one by more than [`FatteningWork::TOLERANCE`] and
//! [`fattening_slope`](crate::matching::Checks::fattening_slope) for each pixel between the two: so a slanted
//! surface stays, and an answer far away refuses nothing.
//!
//! An edge is a pixel where Sobel's gradient along the row is large: it looks at three rows, so that noise
//! makes few of them. The work is the same for every picture.

use crate::imaging::Noise;
use crate::matching::backend::{FatteningWork, Isa, MethodParameters};
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::part;
use crate::matching::method::Frame;

/// The least Sobel gradient of an edge, eighths of a grey level per pixel: about three deviations of what
/// noise makes.
pub(super) const fn least_gradient(noise: Noise) -> u16 {
    match noise {
        Noise::None => 16,
        Noise::Low => 24,
        Noise::High => 48,
    }
}

/// Forgets the frame before.
pub(super) fn begin(frame: &mut Frame<'_>) {
    frame.edges.fill(0);
}

/// Takes the edges of the row that comes in; below the image there are none.
pub(super) fn take_edges(frame: &mut Frame<'_>, lines: Option<[&Rows5<'_>; 2]>) {
    if !frame.config.checks.look_for_edges() {
        return;
    }
    match lines {
        Some([left, _]) => {
            let [above, line, below] = [left[1], left[2], left[3]].map(|line| part(line, ..frame.width));
            let least = least_gradient(frame.config.noise);
            frame.backend.push_edges(frame.edges, [above, line, below], least);
        }
        None => frame.edges.iter_mut().for_each(|edges| *edges = *edges << 1 & !FatteningWork::REFUSED),
    }
}

/// Refuses the answers of `newest` that spread.
pub(super) fn refuse_fattening<S: MethodParameters>(frame: &mut Frame<'_>, newest: usize) {
    let slope = frame.config.checks.fattening_slope;
    if slope.is_some() {
        let (answers, flags) = (frame.band.row_mut(newest), frame.flags.row_mut(newest));
        let edges = &mut *frame.edges;
        frame.backend.refuse_fattening(FatteningWork { answers, flags, edges, row: 1 << S::RADIUS_Y, slope });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::backend::Backend;
    use crate::units::{Disparity, PixelFlags};

    const NONE: u16 = Disparity::NONE.raw();

    fn refuse(answers: &mut [Disparity], flags: &mut [PixelFlags], edges: &mut [u8]) {
        let slope = Disparity::from_raw(24);
        Backend::detect().refuse_fattening(FatteningWork { answers, flags, edges, row: 1, slope });
    }

    #[test]
    fn a_near_surface_ends_at_its_edge() {
        // Near up to the fourth pixel, where the edge is; the wall's own disparity from the seventh on.
        let row = [640, 640, 640, 640, 640, 640, 320, 320, 320, NONE];
        let mut answers = row.map(Disparity::from_raw);
        let mut flags = [PixelFlags::CLEAR; 10];
        let mut edges = [0, 0, 0, 1, 0, 0, 0, 0, 0, 0];
        refuse(&mut answers, &mut flags, &mut edges);
        let refused = [640, 640, 640, NONE, NONE, NONE, 320, 320, 320, NONE];
        assert_eq!(answers.map(Disparity::raw), refused);
        for (x, flags) in flags.into_iter().enumerate() {
            assert_eq!(flags, PixelFlags::UNTEXTURED.when((3..6).contains(&x)), "{x}");
        }
    }

    #[test]
    fn a_slope_stays() {
        let row: [u16; 8] = core::array::from_fn(|x| 320 + 24 * x as u16);
        let mut answers = row.map(Disparity::from_raw);
        refuse(&mut answers, &mut [PixelFlags::CLEAR; 8], &mut [0; 8]);
        assert_eq!(answers.map(Disparity::raw), row);
    }

    #[test]
    fn a_step_of_brightness_is_an_edge_on_both_sides() {
        let line = [100, 100, 100, 104, 104, 104];
        let mut edges = [0b1; 6];
        Backend::detect().push_edges(&mut edges, [&line; 3], least_gradient(Noise::None));
        assert_eq!(edges, [0b10, 0b10, 0b11, 0b11, 0b10, 0b10]);
        Backend::detect().push_edges(&mut edges, [&line; 3], least_gradient(Noise::Low));
        assert_eq!(edges, [0b100, 0b100, 0b110, 0b110, 0b100, 0b100]);
    }
}
