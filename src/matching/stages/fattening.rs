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
use crate::matching::backend::loops::{fill_bytes, keep_loop};
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
    fill_bytes(frame.edges, 0);
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
        None => {
            for edges in &mut *frame.edges {
                keep_loop();
                *edges = *edges << 1 & !FatteningWork::REFUSED;
            }
        }
    }
}

/// Refuses the answers of `newest` that spread.
pub(super) fn refuse_fattening<S: MethodParameters>(frame: &mut Frame<'_>, newest: usize) {
    let slope = frame.config.checks.fattening_slope;
    if slope.is_some() {
        let (answers, flags) = (frame.band.row_mut(newest), frame.flags.row_mut(newest));
        let edges = &mut *frame.edges;
        let row = 1 << S::RADIUS_Y;
        frame.backend.refuse_fattening(FatteningWork { answers, flags, edges, row, slope });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::backend::Backend;
    use crate::matching::kernel::Kernel;
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

    /// Whether another answer refuses the one at `x`: pair by pair.
    fn is_refused(answers: &[Disparity], edges: &[u8], slope: u32, x: usize) -> bool {
        (0..answers.len()).filter(|&y| y != x).any(|y| {
            // An edge belongs to what is on its right.
            let has_edge = edges[x.min(y) + 1..=x.max(y)].contains(&1);
            let farthest = u32::from(FatteningWork::TOLERANCE) + slope * (x.abs_diff(y) as u32 - 1);
            !has_edge && u32::from(answers[x].raw()) > u32::from(answers[y].raw()) + farthest
        })
    }

    #[test]
    fn rows_of_any_length_lose_what_another_answer_refuses() {
        let mut state = 1u32;
        let mut next = |below: u32| {
            state = state.wrapping_mul(0x9e37_79b1).wrapping_add(0x7f4a_7c15);
            (state >> 12) % below
        };
        let kernels = [Kernel::Planes, Kernel::Lanes, Kernel::Avx2, Kernel::Avx512];
        let widths = [1, 2, 3, 31, 63, 64, 65, 127, 128, 129, 191, 200];
        // All pairs of a long row take an interpreter an hour.
        for width in widths.into_iter().filter(|&width| !cfg!(miri) || width < 64) {
            // Surfaces with an edge, a hole or another depth here and there.
            let (mut answers, mut edges) = ([Disparity::NONE; 200], [0u8; 200]);
            let mut depth = 1000;
            for (answer, edges) in answers.iter_mut().zip(&mut edges) {
                depth = if next(16) == 0 { next(3000) as u16 } else { depth };
                *answer = if next(9) == 0 { Disparity::NONE } else { Disparity::from_raw(depth) };
                *edges = u8::from(next(20) == 0);
            }
            let (row, edges_of_row) = (&answers[..width], &edges[..width]);
            let gone: [bool; 200] = core::array::from_fn(|x| {
                x < width && row[x].is_some() && is_refused(row, edges_of_row, 24, x)
            });
            assert!(width < 100 || gone.contains(&true), "{width}: nothing is refused");
            for backend in kernels.into_iter().filter_map(Backend::of).chain([Backend::detect()]) {
                let (mut found, mut flags) = (answers, [PixelFlags::CLEAR; 200]);
                let (found, flags) = (&mut found[..width], &mut flags[..width]);
                let mut edges = edges;
                let (row, slope) = (1, Disparity::from_raw(24));
                backend.refuse_fattening(FatteningWork {
                    answers: found,
                    flags,
                    edges: &mut edges[..width],
                    row,
                    slope,
                });
                for x in 0..width {
                    let left = if gone[x] { Disparity::NONE } else { answers[x] };
                    assert_eq!(found[x], left, "{:?} {width} {x}", backend.kernel());
                    assert_eq!(flags[x], PixelFlags::UNTEXTURED.when(gone[x]), "{width} {x}");
                }
            }
        }
    }
}
