//! A row's costs, averaged into those of the rows above.

use super::super::features::Features;
use super::{PathWork, stride};
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::candidates::Candidates;
use crate::matching::backend::portable::group::Group;
use crate::matching::memory::slices::{chunks, chunks_mut, part};

/// Adds a row.
#[inline(always)]
pub(super) fn enter<G: Group, S: SgmParameters, const CELLS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    features: &Features<'_>,
) {
    let Features { left, right, count } = *features;
    let most = G::splat(work.penalties.cost);
    let stride = stride::<G, CELLS, ALL>(work);
    let cells = stride / G::LANES;
    let mut rows = chunks(right, count);
    let rows: [_; 6] = core::array::from_fn(|_| rows.next().unwrap_or(&[]));
    let [alongs, acrosses, censuses, brightnesses, least, greatest] = rows;
    // Some rows are moved in registers, the others read anew: a processor does both at a time.
    let moved = |row| Candidates::<G, CELLS, ALL>::new(row, stride);
    let read = |row| Candidates::<G, CELLS, false>::new(row, stride);
    let (mut along_row, mut brightness_row) = (moved(alongs), read(brightnesses));
    let (mut across_row, mut census_row) = (read(acrosses), read(censuses));
    let (mut least_row, mut greatest_row) = (moved(least), moved(greatest));
    // The last block has what is left.
    for (block, columns) in G::cells_mut(work.costs).chunks_mut((BLOCK * cells).max(1)).enumerate() {
        let columns = chunks_mut(columns, cells);
        let first = block * BLOCK;
        let [along, across, census] =
            [left.along, left.across, left.census].map(|row| ready::<G>(part(row, first..), 0));
        let brightness = ready::<G>(part(left.brightness, first..), 1);
        let pixels = along.iter().zip(brightness.iter().zip(across.iter().zip(&census)));
        let [alongs, acrosses, censuses, brightnesses, least, greatest] =
            rows.map(|row| part(row, first..).windows(stride));
        let candidates = alongs.zip(brightnesses).zip(acrosses.zip(censuses));
        let ranges = least.zip(greatest);
        for (((column, candidates), range), (&along, (&brightness, (&across, &census)))) in
            columns.zip(candidates).zip(ranges).zip(pixels)
        {
            let along = G::splat_number(along);
            let rest = Rest {
                brightness: G::splat_number(brightness),
                across: G::splat_number(across),
                census: G::splat_number(census),
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
}

/// Left pixels whose numbers are made ready at a time.
const BLOCK: usize = 64;

/// Numbers, shifted to the right by some bits, ready to be put in all lanes.
#[inline(always)]
fn ready<G: Group>(numbers: &[u8], shift: u32) -> [G::Number; BLOCK] {
    let mut out = [G::Number::default(); BLOCK];
    for (to, &from) in out.iter_mut().zip(numbers) {
        *to = G::number(from >> shift);
    }
    out
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
