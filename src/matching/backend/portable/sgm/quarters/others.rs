//! What right pixels look like, in the order in which columns have them as candidates.

use super::lanes::{ONE, TOP};
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::memory::slices::{chunks, part};

/// What four right pixels look like that are the candidates of a word: the least gradient along the line
/// between the pixel and its neighbours, or the pixel's own where nothing is compared between pixels, marked;
/// 128 less the greatest; the gradient across the line; the census; the brightness, halved.
pub(super) type Others = [u32; 5];

/// What is turned of each.
const TURNED: Others = [TOP, !TOP, 0, 0, 0];
/// What is added to each then.
const ADDED: Others = [0, ONE, 0, 0, 0];

/// Makes groups of right pixels, the first of which stands in that column, and the others of a group so many
/// `words` further to the right each. `right` are rows of `count` features. Groups behind the last column
/// are left as they are.
#[inline(always)]
pub(super) fn gather<S: SgmParameters>(
    right: &[u8],
    count: usize,
    first: usize,
    words: usize,
    groups: &mut [Others],
) {
    let mut rows = chunks(right, count);
    let [along, across, census, brightness, least, greatest] =
        core::array::from_fn(|_| rows.next().unwrap_or_default());
    let (least, greatest) = if S::BETWEEN_PIXELS { (least, greatest) } else { (along, along) };
    let rows = [least, greatest, across, census, brightness];
    for (kind, (row, (turned, added))) in rows.into_iter().zip(TURNED.into_iter().zip(ADDED)).enumerate() {
        let lane = |lane: usize| part(row, (first + lane * words).min(row.len())..);
        let pixels = lane(0).iter().zip(lane(1)).zip(lane(2).iter().zip(lane(3)));
        for (group, ((&a, &b), (&c, &d))) in groups.iter_mut().zip(pixels) {
            keep_loop();
            if let Some(four) = group.get_mut(kind) {
                *four = (u32::from_le_bytes([a, b, c, d]) ^ turned).wrapping_add(added);
            }
        }
    }
}
