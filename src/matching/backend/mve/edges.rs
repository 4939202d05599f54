//! Edges of a line, pixel by pixel: the compiler makes vectors of it.

use crate::matching::backend::work::FatteningWork;

/// [`Isa::push_edges`](crate::matching::backend::Isa::push_edges).
#[inline(never)]
pub(super) fn push(edges: &mut [u8], lines: [&[u8]; 3], least: u16) {
    let last = edges.len().saturating_sub(1);
    let sum = |[above, line, below]: [u8; 3]| u16::from(above) + 2 * u16::from(line) + u16::from(below);
    let at = |x: usize| sum(lines.map(|line| line.get(x).copied().unwrap_or(0)));
    let push = |edges: &mut u8, before: u16, after: u16| {
        *edges = (*edges << 1 & !FatteningWork::REFUSED) | u8::from(after.abs_diff(before) >= least);
    };
    let [above, line, below] = lines;
    let columns =
        above.iter().zip(line).zip(below).map(|((&above, &line), &below)| sum([above, line, below]));
    let inner = edges.iter_mut().skip(1).take(last.saturating_sub(1));
    for (edges, (before, after)) in inner.zip(columns.clone().zip(columns.skip(2))) {
        push(edges, before, after);
    }
    if let Some(edges) = edges.first_mut() {
        push(edges, at(0), at(1.min(last)));
    }
    // A line of one pixel has one end.
    if let Some(edges) = edges.get_mut(1..).and_then(<[u8]>::last_mut) {
        push(edges, at(last - 1), at(last));
    }
}
