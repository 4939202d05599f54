//! A row's costs, averaged into those of the rows above.

use super::PathWork;
use super::features::{Features, between};
use super::group::Group;
use crate::matching::paths::Along;

/// Adds a row; the first of a frame takes the costs' place.
#[inline(always)]
pub(super) fn enter<G: Group, S: Along>(work: &mut PathWork<'_>, features: &Features<'_>, is_first: bool) {
    let Features { left, right, gradients, brightness } = features;
    let width = work.width;
    let most = G::splat(work.penalties.cost);
    let columns = work.costs.chunks_exact_mut(work.stride);
    for (x, column) in columns.take(width).enumerate() {
        let at = |row: &[u8], x: usize| row.get(x.min(width - 1)).copied().unwrap_or(0);
        let look = |row: &[u8]| at(row, x);
        let along = Number::<G>::new(at(left.along, x.saturating_sub(1)), look(left.along), at(left.along, x + 1));
        let line = left.brightness;
        let bright = Number::new(at(line, x.saturating_sub(1)) >> 1, look(line) >> 1, at(line, x + 1) >> 1);
        let (across, census) = (G::splat(look(left.across)), G::splat(look(left.census)));
        let cells = G::cells_mut(column).iter_mut();
        let plain = groups::<G>(right.along, x).zip(groups::<G>(right.brightness, x));
        let plain = plain.zip(groups::<G>(right.across, x).zip(groups::<G>(right.census, x)));
        let put = |cell: &mut G::Cell, of_along: G, of_brightness: G, of_across: G, of_census: G| {
            let rest = across.apart(of_across).plus(of_brightness.quarter()).plus(census.bits_apart(of_census));
            let cost = of_along.plus(of_along).plus(rest).min(most);
            *cell = if is_first { cost } else { G::of(*cell).average_up(cost) }.cell();
        };
        if S::BETWEEN_PIXELS {
            let of_along = groups::<G>(gradients[0], x).zip(groups::<G>(gradients[1], x));
            let of_brightness = groups::<G>(brightness[0], x).zip(groups::<G>(brightness[1], x));
            let ranges = of_along.zip(of_brightness);
            for (cell, (((a, b), (across, census)), (of_along, of_brightness))) in cells.zip(plain.zip(ranges)) {
                put(cell, along.apart_between(a, of_along), bright.apart_between(b, of_brightness), across, census);
            }
        } else {
            for (cell, ((a, b), (across, census))) in cells.zip(plain) {
                put(cell, along.number.apart(a), bright.number.apart(b), across, census);
            }
        }
    }
}

/// The groups of a row from column `x` on.
#[inline(always)]
fn groups<'a, G: Group + 'a>(row: &'a [u8], x: usize) -> impl Iterator<Item = G> + 'a {
    G::groups(row.get(x..).unwrap_or(&[])).iter().map(|&bytes| G::of_bytes(bytes))
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
