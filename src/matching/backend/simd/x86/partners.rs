//! The left-right check's offers, and what the partners of a register of winners keep, looked up among as
//! many right columns at a time.

use crate::matching::backend::portable::group::Group;
use crate::matching::backend::portable::left_right_rows;
use crate::matching::memory::slices::part;
use crate::matching::memory::winners::WinnerRows;

/// A register of bytes of which any may be looked up.
pub(in crate::matching::backend::simd) trait Places: Group {
    /// Of how many candidates at most a pixel's partner has a lane of its own, modulo 256.
    const MOST: usize = 256 - Self::LANES;

    /// The numbers of the lanes that `places` are, and zero where there is no such lane.
    fn at(self, places: Self) -> Self;

    /// The first bytes of a row, and zeros where it has less.
    #[inline(always)]
    fn of_first(row: &[u8]) -> Self {
        let mut longer = [0; 64];
        let bytes = Self::groups(row).first().or_else(
            #[inline(always)]
            || {
                longer.iter_mut().zip(row).for_each(|(to, from)| *to = *from);
                Self::groups(&longer).first()
            },
        );
        bytes.map_or(Self::splat(0), |&bytes| Self::of_bytes(bytes))
    }

    /// Writes the first bytes of a row, as many as it has.
    #[inline(always)]
    fn put_first(self, row: &mut [u8]) {
        if let Some(cell) = Self::cells_mut(row).first_mut() {
            *cell = self.cell();
        } else {
            let mut longer = [0; 64];
            Self::cells_mut(&mut longer).iter_mut().for_each(|cell| *cell = self.cell());
            row.iter_mut().zip(longer).for_each(|(to, from)| *to = from);
        }
    }

    /// [`left_right_rows::offer`], with what right columns keep of it: disparities.
    #[inline(always)]
    fn offer(costs: &[u8], disparities: &[u8], _candidates: usize, right: &mut [u16], kept: &mut [u8]) {
        offer_each(costs, disparities, right, kept);
    }
}

/// [`Places::offer`], one winner after the other.
#[inline(always)]
pub(in crate::matching::backend::simd) fn offer_each(
    costs: &[u8],
    disparities: &[u8],
    right: &mut [u16],
    kept: &mut [u8],
) {
    left_right_rows::offer(costs, disparities, right);
    for (to, from) in kept.iter_mut().zip(right) {
        *to = *from as u8;
    }
}

/// [`left_right_rows::keep`]. `of_right` is room for a byte a winner.
#[inline(always)]
pub(super) fn keep<G: Places>(
    winners: &WinnerRows<'_>,
    pixels: Option<[&[u8]; 2]>,
    candidates: usize,
    right: &mut [u16],
    [kept, of_right]: [&mut [u8]; 2],
) {
    if candidates > G::MOST {
        return left_right_rows::keep(winners, pixels, right, kept);
    }
    let disparities = &*winners.disparities;
    let costs = match pixels {
        Some([left, partners]) => {
            look_up::<G>(disparities, candidates, partners, kept);
            left_right_rows::compare(winners.costs, left, kept);
            &*kept
        }
        None => &*winners.costs,
    };
    G::offer(costs, disparities, candidates, right, of_right);
    look_up::<G>(disparities, candidates, of_right, kept);
}

/// The numbers of the right columns that are partners, one for each winner.
#[inline(always)]
fn look_up<G: Places>(disparities: &[u8], candidates: usize, right: &[u8], found: &mut [u8]) {
    for (x, (found, disparities)) in found.chunks_mut(G::LANES).zip(disparities.chunks(G::LANES)).enumerate()
    {
        // Lanes after the first of these that a pixel's partner is, modulo 256.
        let mut partners = G::of_first(LANES).minus(G::of_first(disparities));
        let mut numbers = G::splat(0);
        for behind in 0..=candidates.div_ceil(G::LANES).min(x) {
            let right = G::of_first(part(right, (x - behind) * G::LANES..));
            numbers = numbers.or(right.at(partners));
            partners = partners.plus(G::splat(G::LANES as u8));
        }
        numbers.put_first(found);
    }
}

/// The numbers of all lanes.
const LANES: &[u8; 64] = &{
    let mut lanes = [0; 64];
    let mut lane = 0;
    while lane < 64 {
        lanes[lane] = lane as u8;
        lane += 1;
    }
    lanes
};
