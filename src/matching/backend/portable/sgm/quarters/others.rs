//! What costs are made of: right pixels, in the order of the candidates in a column, and left ones.

use super::columns::FOUR;
use crate::matching::backend::loops::{keep_length, keep_loop};
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::features::Looks;
use crate::matching::memory::slices::part;
use core::cell::Cell;

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

/// Pixels of a group.
pub(super) const LANES: usize = size_of::<u32>();

/// What is turned of each number's byte, and what is added to it then: the first is marked, the second is
/// taken from 128.
const MADE_OF: [(u8, u8); NUMBERS] = [(0, 0x80), (0xff, 0x81), (0, 0), (0, 0), (0, 0)];

/// Makes the groups `to` of the groups `from`, whole fours of them. Each is a lane further to the right than
/// the one that it is made of: three of its pixels are that one's last three, and its last pixel is the next
/// one from `column` on. `right` are rows of `count` features, and three numbers more. Groups behind the last
/// column are left as they are, or of no meaning.
#[inline(never)]
pub(super) fn shift_in<S: SgmParameters>(
    (right, count): (&[u8], usize),
    column: usize,
    from: &[[Cell<u32>; NUMBERS]],
    to: &[[Cell<u32>; NUMBERS]],
) {
    // The rows of what stands in a group, in its order.
    let rows = if S::BETWEEN_PIXELS { [4, 5, 1, 2, 3] } else { [0, 0, 1, 2, 3] };
    let (from, to) = (keep_length(from), keep_length(to));
    let fours = from.as_chunks::<FOUR>().0.iter().zip(to.as_chunks::<FOUR>().0);
    for (kind, (row, (turned, added))) in rows.into_iter().zip(MADE_OF).enumerate() {
        let pixels = part(right, (row * count + column).min(right.len())..).as_chunks::<FOUR>().0;
        for ((from, to), pixels) in fours.clone().zip(pixels) {
            keep_loop();
            for ((from, to), pixel) in from.iter().zip(to).zip(pixels) {
                if let (Some(from), Some(to)) = (from.get(kind), to.get(kind)) {
                    let last = (pixel ^ turned).wrapping_add(added);
                    to.set(from.get() >> 8 | u32::from(last) << 24);
                }
            }
        }
    }
}
