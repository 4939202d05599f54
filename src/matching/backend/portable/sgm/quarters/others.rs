//! What costs are made of: right pixels, in the order of the candidates in a column, and left ones.

use super::columns::FOUR;
use super::lanes::{ONE, TOP};
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::features::Looks;
use crate::matching::memory::slices::part;

/// What four right pixels look like that are the candidates of a word: the least gradient along the line
/// between the pixel and its neighbours, or the pixel's own where nothing is compared between pixels, marked;
/// 128 less the greatest; the gradient across the line; the census; the brightness, halved.
pub(super) type Others = [u32; NUMBERS];
/// How many numbers that is.
pub(super) const NUMBERS: usize = 5;

/// What a row's costs are made with.
pub(super) struct Costs<'a> {
    pub left: Looks<'a>,
    /// Words of a column, in fours.
    pub rounds: usize,
    /// The most that a cost may be, in all lanes.
    pub most: u32,
    /// What an agreement has more in memory, in all lanes.
    pub margin: u32,
}

/// What is turned of each.
const TURNED: Others = [TOP, !TOP, 0, 0, 0];
/// What is added to each then.
const ADDED: Others = [0, ONE, 0, 0, 0];

/// Makes groups of right pixels, a whole number of fours of them, the first of which stands in that
/// column, and the others of a group so many `words` further to the right each. `right` are rows of
/// `count` features, and three numbers more. Groups behind the last column are left as they are, or of no
/// meaning.
#[inline(always)]
pub(super) fn gather<S: SgmParameters>(
    right: &[u8],
    count: usize,
    first: usize,
    words: usize,
    groups: &mut [Others],
) {
    // The rows of what stands in a group, in its order.
    let rows = if S::BETWEEN_PIXELS { [4, 5, 1, 2, 3] } else { [0, 0, 1, 2, 3] };
    let groups = groups.as_chunks_mut::<FOUR>().0;
    for (kind, (row, (turned, added))) in rows.into_iter().zip(TURNED.into_iter().zip(ADDED)).enumerate() {
        let from = row * count + first;
        let lane = |lane: usize| part(right, (from + lane * words).min(right.len())..).as_chunks::<FOUR>().0;
        let lanes = lane(0).iter().zip(lane(1)).zip(lane(2).iter().zip(lane(3)));
        for (groups, ((a, b), (c, d))) in groups.iter_mut().zip(lanes) {
            keep_loop();
            let pixels = a.iter().zip(b).zip(c.iter().zip(d));
            for (group, ((&a, &b), (&c, &d))) in groups.iter_mut().zip(pixels) {
                if let Some(four) = group.get_mut(kind) {
                    *four = (u32::from_le_bytes([a, b, c, d]) ^ turned).wrapping_add(added);
                }
            }
        }
    }
}
