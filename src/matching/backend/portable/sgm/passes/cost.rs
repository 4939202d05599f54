//! A row's costs, averaged into those of the rows above.

use super::super::features::Features;
use super::{PathWork, stride};
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::candidates::Candidates;
use crate::matching::backend::portable::group::Group;
use crate::matching::memory::slices::{chunks, chunks_mut};

/// Adds a row.
#[inline(always)]
pub(super) fn enter<G: Group, S: SgmParameters, const CELLS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    features: &Features<'_>,
) {
    let Features { left, right, count } = *features;
    let most = G::splat(work.penalties.cost);
    let stride = stride::<G, CELLS, ALL>(work);
    let columns = chunks_mut(G::cells_mut(work.costs), stride / G::LANES);
    let mut rows = chunks(right, count);
    let [alongs, acrosses, censuses, brightnesses, least, greatest] =
        core::array::from_fn(|_| rows.next().unwrap_or(&[]));
    let candidates = alongs.windows(stride).zip(brightnesses.windows(stride));
    let candidates = candidates.zip(acrosses.windows(stride).zip(censuses.windows(stride)));
    let ranges = least.windows(stride).zip(greatest.windows(stride));
    let pixels = left.brightness.iter().zip(left.across.iter().zip(left.census));
    let pixels = left.along.iter().zip(pixels);
    // Some rows are moved in registers, the others read anew: a processor does both at a time.
    let moved = |row| Candidates::<G, CELLS, ALL>::new(row, stride);
    let read = |row| Candidates::<G, CELLS, false>::new(row, stride);
    let (mut along_row, mut brightness_row) = (moved(alongs), read(brightnesses));
    let (mut across_row, mut census_row) = (read(acrosses), read(censuses));
    let (mut least_row, mut greatest_row) = (moved(least), moved(greatest));
    for (((column, candidates), range), (&along, (&brightness, (&across, &census)))) in
        columns.zip(candidates).zip(ranges).zip(pixels)
    {
        let along = G::splat(along);
        let rest = Rest {
            brightness: G::splat(brightness >> 1),
            across: G::splat(across),
            census: G::splat(census),
            most,
        };
        let ((alongs, brightness), (across, census)) = candidates;
        let [brightness, across, census] =
            [brightness_row.next(brightness), across_row.next(across), census_row.next(census)];
        let others = brightness.iter().zip(across.iter().zip(census));
        if S::BETWEEN_PIXELS {
            let (least, greatest) = (least_row.next(range.0), greatest_row.next(range.1));
            for (cell, (others, (&least, &greatest))) in
                column.iter_mut().zip(others.zip(least.iter().zip(greatest)))
            {
                keep_loop();
                rest.put::<S>(
                    cell,
                    along.minus_saturating(greatest).or(least.minus_saturating(along)),
                    others,
                );
            }
        } else {
            for (cell, (others, &other)) in column.iter_mut().zip(others.zip(along_row.next(alongs))) {
                keep_loop();
                rest.put::<S>(cell, along.apart(other), others);
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
}

impl<G: Group> Rest<G> {
    /// Averages the cost of some candidates into what there is of the rows above.
    #[inline(always)]
    fn put<S: SgmParameters>(
        &self,
        cell: &mut G::Cell,
        along: G,
        (&of_brightness, (&of_across, &of_census)): (&G, (&G, &G)),
    ) {
        let brightness = self.brightness.apart(of_brightness);
        let rest =
            self.across.apart(of_across).plus(brightness.quarter()).plus(self.census.bits_apart(of_census));
        let cost = along.plus(along).plus(rest).min(self.most);
        *cell = if S::WITHIN_EDGES { cost } else { G::of(*cell).average_up(cost) }.cell();
    }
}
