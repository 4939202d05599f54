//! A row's costs, averaged into those of the rows above.

use super::features::{Features, between};
use super::group::Group;
use super::{PathWork, stride};
use crate::matching::paths::Along;

/// Adds a row; the first of a frame takes the costs' place.
#[inline(always)]
pub(super) fn enter<G: Group, S: Along, const CELLS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    features: &Features<'_>,
    is_first: bool,
) {
    let Features { left, right, ranges: [least, greatest] } = *features;
    let most = G::splat(work.penalties.cost);
    let stride = stride::<G, CELLS, ALL>(work);
    let columns = G::cells_mut(work.costs).chunks_exact_mut(stride / G::LANES);
    let candidates = right.along.windows(stride).zip(right.brightness.windows(stride));
    let candidates = candidates.zip(right.across.windows(stride).zip(right.census.windows(stride)));
    let ranges = least.windows(stride).zip(greatest.windows(stride));
    let pixels = left.brightness.iter().zip(left.across.iter().zip(left.census));
    let mut along = left.along.iter().copied();
    let (mut before, mut here) = (left.along.first().copied().unwrap_or(0), along.next().unwrap_or(0));
    for (((column, candidates), range), (&brightness, (&across, &census))) in
        columns.zip(candidates).zip(ranges).zip(pixels)
    {
        let next = along.next().unwrap_or(here);
        let number = Number::<G>::new(before, here, next);
        (before, here) = (here, next);
        let rest = Rest {
            brightness: G::splat(brightness >> 1),
            across: G::splat(across),
            census: G::splat(census),
            most,
            is_first,
        };
        let ((along, brightness), (across, census)) = candidates;
        let others = groups::<G>(brightness).zip(groups::<G>(across).zip(groups::<G>(census)));
        let others = groups::<G>(along).zip(others);
        if S::BETWEEN_PIXELS {
            let ranges = groups::<G>(range.0).zip(groups::<G>(range.1));
            for (cell, ((along, others), range)) in column.iter_mut().zip(others.zip(ranges)) {
                rest.put(cell, number.apart_between(along, range), others);
            }
        } else {
            for (cell, (along, others)) in column.iter_mut().zip(others) {
                rest.put(cell, number.number.apart(along), others);
            }
        }
    }
}

/// A pixel of the left image, but for what is compared between pixels.
struct Rest<G> {
    brightness: G,
    across: G,
    census: G,
    most: G,
    is_first: bool,
}

impl<G: Group> Rest<G> {
    /// Averages the cost of some candidates into what there is of the rows above, or puts it in its place.
    #[inline(always)]
    fn put(&self, cell: &mut G::Cell, along: G, (of_brightness, (of_across, of_census)): (G, (G, G))) {
        let brightness = self.brightness.apart(of_brightness);
        let rest = self.across.apart(of_across).plus(brightness.quarter()).plus(self.census.bits_apart(of_census));
        let cost = along.plus(along).plus(rest).min(self.most);
        *cell = if self.is_first { cost } else { G::of(*cell).average_up(cost) }.cell();
    }
}

/// The groups of a pixel's candidates.
#[inline(always)]
fn groups<G: Group>(candidates: &[u8]) -> impl Iterator<Item = G> {
    G::groups(candidates).iter().map(
        #[inline(always)]
        |&bytes| G::of_bytes(bytes),
    )
}

/// A number of the left image, in all lanes, with the range of those halfway to its neighbours.
struct Number<G> {
    number: G,
    least: G,
    greatest: G,
}

impl<G: Group> Number<G> {
    #[inline(always)]
    fn new(before: u8, here: u8, next: u8) -> Self {
        let (least, greatest) = between(before, here, next);
        Self { number: G::splat(here), least: G::splat(least), greatest: G::splat(greatest) }
    }

    /// How far the two are apart, where each may lie between its pixel and those beside it: the lesser of the distances of one
    /// number from the other's range (Birchfield & Tomasi 1998).
    #[inline(always)]
    fn apart_between(&self, other: G, (least, greatest): (G, G)) -> G {
        let from_range = self.number.minus_saturating(greatest).or(least.minus_saturating(self.number));
        let to_range = other.minus_saturating(self.greatest).or(self.least.minus_saturating(other));
        from_range.min(to_range)
    }
}
