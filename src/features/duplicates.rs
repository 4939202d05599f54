//! Removal of matches found again on another pyramid level.

use super::{Feature, Match};
use heapless::VecView;

/// Takes out matches that repeat one before them in the list: both of their ends lie less than `apart_px`
/// from the other's, along the row and down the column. How many there were.
///
/// A corner is often found on two levels, and matched on both. Matches are in the order of their left
/// features: where these begin with the full picture, what stays is the match of the finer level, whose
/// position is the better one. It takes as many comparisons as there are pairs of matches, at most. A match
/// of features that are not in the lists repeats nothing.
///
/// ```
/// use stereopsis::features::{Descriptor, Feature, Match, drop_duplicates};
/// let feature = |x_px, level| Feature { x_px, y_px: 9.0, score: 20, level, descriptor: Descriptor::NONE };
/// let left = [feature(20.0, 0), feature(40.0, 0), feature(20.5, 1)];
/// let right = [feature(35.0, 0), feature(14.2, 1), feature(15.0, 0)];
/// let of = |left, right| Match { left, right, different: 3 };
/// let mut matches = stereopsis::heapless::Vec::<_, 4>::from([of(0, 2), of(1, 0), of(2, 1)]);
/// assert_eq!(drop_duplicates(&left, &right, matches.as_mut_view(), 1.5), 1);
/// assert_eq!(matches, [of(0, 2), of(1, 0)]);
/// ```
pub fn drop_duplicates(
    left: &[Feature],
    right: &[Feature],
    matches: &mut VecView<Match>,
    apart_px: f32,
) -> usize {
    let near = |list: &[Feature], one: u16, other: u16| {
        let ends = list.get(usize::from(one)).zip(list.get(usize::from(other)));
        ends.is_some_and(|(a, b)| (a.x_px - b.x_px).abs() < apart_px && (a.y_px - b.y_px).abs() < apart_px)
    };
    let (all, mut kept) = (matches.len(), 0);
    for i in 0..all {
        let Some(one) = matches.get(i).copied() else { continue };
        let same = |other: &Match| near(left, one.left, other.left) && near(right, one.right, other.right);
        if matches.iter().take(kept).any(same) {
            continue;
        }
        if let Some(place) = matches.get_mut(kept) {
            *place = one;
            kept += 1;
        }
    }
    matches.truncate(kept);
    all - kept
}
