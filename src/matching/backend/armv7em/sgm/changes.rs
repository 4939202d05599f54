//! What a path pays on its way into each pixel of a row, by the change of the left image's brightness.

use super::splat;
use super::walk::Step;
use crate::dsp::{saturating_subtract, select};
use crate::matching::memory::slices::part;

/// Pixels in a word.
const GROUP: usize = 4;
/// Bytes from one kind of step to the next.
const APART: u8 = size_of::<Step>() as u8;

/// Where the step into each pixel stands among the three, in bytes, from the brightness `here` and where the
/// path comes from: as many as there are places. The changes from which on the second step is taken, and the
/// third, are `edges`. 4 instructions a pixel.
#[inline(never)]
pub(super) fn changes(here: &[u8], from: &[u8], edges: [u8; 2], out: &mut [u8]) {
    let edges = edges.map(splat);
    let step = |here: u32, from: u32| {
        let change = saturating_subtract(here, from) | saturating_subtract(from, here);
        let under = edges.map(|edge| select(change, edge, 0, splat(APART)));
        2 * splat(APART) - under[0] - under[1]
    };
    let (places, rest) = out.as_chunks_mut::<GROUP>();
    let done = places.len() * GROUP;
    let pixels = here.as_chunks::<GROUP>().0.iter().zip(from.as_chunks::<GROUP>().0);
    for (place, (&here, &from)) in places.iter_mut().zip(pixels) {
        *place = step(u32::from_le_bytes(here), u32::from_le_bytes(from)).to_le_bytes();
    }
    for (place, (&here, &from)) in rest.iter_mut().zip(part(here, done..).iter().zip(part(from, done..))) {
        *place = step(here.into(), from.into()) as u8;
    }
}
