//! The stages of a row, in running order.
//!
//! Each line that comes in makes the answers of one row, `newest`, and finishes another, the row that waits
//! [`LOOK_AHEAD`](super::memory::rings::LOOK_AHEAD) rows above it until its support is known. What lasts from
//! line to line is in a [`Frame`]: `band`, the answers of the rows from the one that waits to the newest;
//! `flags` beside them; `finished`, the answers of the last rows as they came out, the row that waits among
//! them. Of a row that came out, what was filled or refused as unsure is undone before the next one is
//! finished: later rows look at what was measured.
//!
//! ```text
//! when row y comes in (r: rows that the method looks down; BAND = 5, LOOK_AHEAD = 4, HISTORY = 5)
//!
//! stage                       reads                               writes
//! withhold::restore_unsure    withheld answers                    finished y - r - 5, as before the refusal
//! S::enter: denoise, if asked lines y - 2 .. y + 2                smoothed lines, for S::enter alone
//! S::enter: census            lines y - 2 .. y + 2                codes y; along paths both are in S::select
//! texture::take_texture       line y                              texture of y, counts of the window
//! fattening::take_edges       lines y - 1 .. y + 1                edges of y
//! open::take_open             lines y - 1, y + 1, edges of y      open blocks of every other y
//! repeats::take_repeats       line y, of every fifth row          blocks that repeat
//! fill::undo_fill             flags y - r - 5                     finished y - r - 5, as before the fill
//! median::take_medians        band y - r - 5 .. y - r - 3         finished y - r - 4
//! S::select: costs, paths     codes to y, or lines around y       costs of y - r
//! S::select: winner-take-all  costs                               winners, margins and flags y - r
//! texture::flag_untextured    counts                              flags y - r
//! left_right::make_answers    winners y - r                       band and flags y - r
//! open::refuse_unsure         open blocks, margins y - r          band and flags y - r
//! repeats::refuse_repeats     blocks that repeat                  band and flags y - r
//! fattening::refuse_fattening band and edges y - r                band and flags y - r
//! rims::refuse_rims           band, edges, open blocks y - r       band and flags y - r
//! confidence::note_margins    margins y - r                       notes y - r, in place of the flags
//! smooth::smooth_along_row    band y - r                          band y - r, surface lengths y - r
//! open::limit_lengths         open blocks                         surface lengths y - r
//! speckle::end_surfaces       support, below the last row         support
//! confidence::make_confidences notes y - r - 4, band, finished    confidences and flags y - r - 4
//! speckle::drop_speckle       band y - r, y - r - 1, y - r - 4    support; finished and flags y - r - 4
//! vertical::filter_vertically finished y - r - 5, band y - r      finished y - r - 4
//! fill::fill_gaps             finished y - r - 4                  finished and flags y - r - 4
//! repeats::empty_filled       blocks that repeat                  finished and flags y - r - 4
//! confidence::finish_confidences finished and flags y - r - 4     confidences y - r - 4
//! withhold::refuse_unsure     confidences of y - r - 4            finished, flags, withheld answers
//! mask, once the row is out   masks of both images                finished, flags, confidences y - r - 4
//! ```
//!
//! The row that comes out is `y - r - LOOK_AHEAD`. [`workspace`](super::memory::workspace) says what the
//! workspace holds at each stage.

mod texture;
mod median;
mod left_right;
mod fattening;
mod rims;
mod open;
mod repeats;
mod smooth;
pub(super) mod confidence;
mod speckle;
mod vertical;
mod fill;
mod withhold;
pub(super) mod mask;
#[cfg(feature = "trace")]
mod traced;

use super::backend::BY_CAPACITY;
use super::backend::loops::fill_bytes;
use super::memory::Rows5;
use super::method::{Block, External, Fast, Frame, Method, Sgm, SgmEdge, SgmLean, Step, Steps};
use core::hint::black_box;

/// The stages of a method, compiled with this crate, once for each capacity that has code of its own: a
/// program is linked without the code for numbers of candidates that its matchers have no room for, however
/// it is optimised.
macro_rules! steps {
    ($($method:ty),*) => {$(
        impl Steps for $method {
            #[inline(always)]
            fn step_for(most: usize) -> Step {
                steps!(of_any, $method, 0);
                steps!(of_16, $method, 16);
                steps!(of_32, $method, 32);
                steps!(of_64, $method, 64);
                match most {
                    16 if BY_CAPACITY => of_16,
                    32 if BY_CAPACITY => of_32,
                    64 if BY_CAPACITY => of_64,
                    _ => of_any,
                }
            }
        }
    )*};
    ($name:ident, $method:ty, $most:literal) => {
        // As a part of the matcher's own step it would look every field of the configuration up behind the
        // matcher's arrays, in twice the code.
        #[inline(never)]
        fn $name(frame: Frame<'_>, y: usize, lines: Option<[&Rows5<'_>; 2]>) {
            step::<$method, $most>(frame, y, lines);
        }
    };
}

steps!(Fast, Block, SgmLean, Sgm, SgmEdge);

/// The stages behind winners from outside, which do not depend on how many candidates there are.
macro_rules! external_steps {
    ($($method:ty),*) => {$(
        impl Steps for External<$method> {
            fn step_for(_: usize) -> Step {
                steps!(of_any, External<$method>, 0);
                of_any
            }
        }
    )*};
}

external_steps!(Fast, Block, SgmLean, Sgm, SgmEdge);

/// Forgets the frame before.
#[inline(never)]
pub(super) fn begin(mut frame: Frame<'_>) {
    fill_bytes(frame.columns, 0);
    texture::begin(&mut frame);
    fattening::begin(&mut frame);
    open::begin(&mut frame);
    repeats::begin(&mut frame);
    speckle::begin(&mut frame);
}

/// Takes row `y` of both images (`None` below the last one) and finishes the row that is due with it.
#[inline(always)]
fn step<S: Method, const MOST: usize>(mut frame: Frame<'_>, y: usize, lines: Option<[&Rows5<'_>; 2]>) {
    if let Some(newest) = y.checked_sub(S::RADIUS_Y) {
        withhold::restore_unsure(&mut frame, newest);
    }
    if let Some(lines) = lines {
        S::enter(&mut frame, y, lines);
    }
    texture::take_texture::<S>(&mut frame, lines);
    fattening::take_edges(&mut frame, lines);
    open::take_open(&mut frame, y, lines);
    repeats::take_repeats::<S>(&mut frame, y, lines);
    finish_row::<S, MOST>(&mut frame, y, lines);
}

/// Adds row `bottom` to the costs, makes the answers of the row that has all of its costs with it, `newest`,
/// and finishes the row that waits for those.
fn finish_row<S: Method, const MOST: usize>(
    frame: &mut Frame<'_>,
    bottom: usize,
    lines: Option<[&Rows5<'_>; 2]>,
) {
    let height = usize::from(frame.config.height);
    let newest = bottom.checked_sub(S::RADIUS_Y);
    if let Some(newest) = newest {
        fill::undo_fill(frame, newest);
        median::take_medians(frame, newest);
    }
    // The compiler would write all of the selection twice: once for the first lines, which bring no row out.
    let row = black_box(newest.filter(|&row| row < height));
    S::select::<MOST>(frame, bottom, lines, row);
    let Some(newest) = newest else { return };
    if newest < height {
        texture::flag_untextured::<S>(frame, newest);
        #[cfg(feature = "trace")]
        traced::winners::<S>(frame, newest, lines);
        left_right::make_answers::<S>(frame, newest, lines);
        #[cfg(feature = "trace")]
        traced::subpixel(frame, newest);
        open::refuse_unsure(frame, newest);
        repeats::refuse_repeats::<S>(frame, newest);
        fattening::refuse_fattening::<S>(frame, newest);
        rims::refuse_rims::<S>(frame, newest);
        confidence::note_margins(frame, newest);
        smooth::smooth_along_row(frame, newest);
        open::limit_lengths(frame);
        #[cfg(feature = "trace")]
        traced::smoothed(frame, newest);
    } else {
        speckle::end_surfaces(frame, newest);
    }
    confidence::make_confidences(frame, newest);
    speckle::drop_speckle(frame, newest);
    vertical::filter_vertically::<S>(frame, newest);
    #[cfg(feature = "trace")]
    traced::checked(frame, newest);
    fill::fill_gaps(frame, newest);
    repeats::empty_filled::<S>(frame, newest);
    confidence::finish_confidences(frame, newest);
    withhold::refuse_unsure(frame, newest);
}
