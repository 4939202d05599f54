//! Brute-force matching with a ratio test (Lowe 2004) and a mutual check.

use super::{Descriptor, Feature, MatchConfig, MatchConfigError};
use heapless::VecView;

/// A feature of the left picture and one of the right, by their places in the lists.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Match {
    /// The left feature's place.
    pub left: u16,
    /// The right feature's place.
    pub right: u16,
    /// Bits in which they differ.
    pub different: u16,
}

/// More bits than can differ: no partner.
const NOBODY: u16 = Descriptor::BITS + 1;

/// The best partner of a feature so far.
#[derive(Clone, Copy, Debug)]
struct Best {
    different: u16,
    partner: u16,
}

impl Best {
    const NONE: Self = Self { different: NOBODY, partner: 0 };
    const ZERO: Self = Self { different: 0, partner: 0 };

    /// Keeps a partner that differs in fewer bits than the best so far; of equals the first stays.
    fn offer(&mut self, different: u16, partner: u16) {
        if different < self.different {
            *self = Self { different, partner };
        }
    }
}

/// What a matcher keeps for the features of one place in both lists, 10 bytes.
#[derive(Clone, Copy, Debug)]
pub struct MatchSlot {
    of_left: Best,
    of_right: Best,
    /// Bits in which one left feature differs from the right one in this place.
    different: u16,
}

impl MatchSlot {
    /// Not in use. All zeros.
    pub const EMPTY: Self = Self { of_left: Best::ZERO, of_right: Best::ZERO, different: 0 };
}

/// Matches up to `N` features of one picture with up to `N` of another, 65534 at most.
///
/// It takes `10 N` bytes, all zeros in a `static`. Matching takes as many comparisons of 256 bits as there
/// are pairs of features that the search admits, and one pass more over the right ones for each left one.
///
/// A match is the best partner of its left feature, clearly better than any other that lies elsewhere (Lowe,
/// "Distinctive image features from scale-invariant keypoints", IJCV 2004, 7.1), and its left feature is the
/// best partner of the right one. Of partners that are equally good, the first in the list is the best one.
///
/// ```
/// use stereopsis::features::{Descriptor, Feature, FeatureMatcher, MatchConfig};
/// let feature = |x_px, word| {
///     Feature { x_px, y_px: 9.0, score: 20, level: 0, descriptor: Descriptor([word; 8]) }
/// };
/// let left = [feature(20.0, 0x00ff), feature(40.0, 0xff00)];
/// let right = [feature(35.0, 0xff01), feature(16.0, 0x00ff)];
/// let mut matches = stereopsis::heapless::Vec::<_, 4>::new();
/// let dropped = FeatureMatcher::<8>::new().run(&left, &right, &MatchConfig::new(), matches.as_mut_view())?;
/// assert_eq!(dropped, 0);
/// let found: Vec<_> = matches.iter().map(|m| (m.left, m.right, m.different)).collect();
/// assert_eq!(found, [(0, 1, 0), (1, 0, 8)]);
/// # Ok::<(), stereopsis::features::MatchConfigError>(())
/// ```
#[derive(Debug)]
pub struct FeatureMatcher<const N: usize> {
    slots: [MatchSlot; N],
}

/// A borrowed [`FeatureMatcher`] of any size.
#[derive(Debug)]
pub struct FeatureMatcherView<'a> {
    slots: &'a mut [MatchSlot],
}

impl<const N: usize> FeatureMatcher<N> {
    /// A matcher.
    pub const fn new() -> Self {
        const { assert!(N <= FeatureMatcherView::MOST, "a match says its features' places in 16 bits") };
        Self { slots: [MatchSlot::EMPTY; N] }
    }

    /// The matcher without its capacity.
    pub fn as_mut_view(&mut self) -> FeatureMatcherView<'_> {
        FeatureMatcherView { slots: &mut self.slots }
    }

    /// Matches two lists, see [`FeatureMatcherView::run`].
    pub fn run(
        &mut self,
        left: &[Feature],
        right: &[Feature],
        search: &MatchConfig,
        out: &mut VecView<Match>,
    ) -> Result<u32, MatchConfigError> {
        self.as_mut_view().run(left, right, search, out)
    }
}

impl<'a> FeatureMatcherView<'a> {
    /// The most features of a list: counting in 16 bits ends one beyond the last place.
    pub const MOST: usize = u16::MAX as usize - 1;

    /// A matcher in the caller's memory, a slot for each feature of the longer list; it does not matter what
    /// the slots hold, and those beyond [`Self::MOST`] are left alone.
    pub fn new(slots: &'a mut [MatchSlot]) -> Self {
        let most = slots.len().min(Self::MOST);
        Self { slots: slots.get_mut(..most).unwrap_or_default() }
    }

    /// Adds the matches to `out`, in the order of the left features. How many it had no place for.
    pub fn run(
        &mut self,
        left: &[Feature],
        right: &[Feature],
        search: &MatchConfig,
        out: &mut VecView<Match>,
    ) -> Result<u32, MatchConfigError> {
        self.run_into(left, right, search, |found| out.push(found).is_ok())
    }

    /// Matches two lists as [`Self::run`] does, with matches to what says whether it has room for one.
    pub(crate) fn run_into(
        &mut self,
        left: &[Feature],
        right: &[Feature],
        search: &MatchConfig,
        mut out: impl FnMut(Match) -> bool,
    ) -> Result<u32, MatchConfigError> {
        search.check()?;
        let needed = left.len().max(right.len());
        let slots = self.slots.get_mut(..needed).ok_or(MatchConfigError::TooMany { needed })?;
        slots.iter_mut().for_each(|slot| slot.of_right = Best::NONE);
        for (here, feature) in (0..).zip(left) {
            let best = best_partner(here, feature, right, search, slots);
            if let Some(slot) = slots.get_mut(usize::from(here)) {
                slot.of_left = best;
            }
        }
        let mut dropped = 0;
        for (here, slot) in (0..).zip(slots.iter()).take(left.len()) {
            let best = slot.of_left;
            let back = slots.get(usize::from(best.partner)).map(|slot| slot.of_right.partner);
            if best.different < NOBODY && back == Some(here) {
                let found = Match { left: here, right: best.partner, different: best.different };
                dropped += u32::from(!out(found));
            }
        }
        Ok(dropped)
    }
}

/// The partner of a left feature in place `here`, [`Best::NONE`] if none is clearly the best. The
/// right features keep its distance in either case.
fn best_partner(
    here: u16,
    feature: &Feature,
    right: &[Feature],
    search: &MatchConfig,
    slots: &mut [MatchSlot],
) -> Best {
    let places = search.around(feature);
    let mut best = Best::NONE;
    for ((partner, other), slot) in (0..).zip(right).zip(slots.iter_mut()) {
        slot.different = NOBODY;
        if search.admits(&places, other) {
            slot.different = feature.descriptor.distance(&other.descriptor);
            best.offer(slot.different, partner);
            slot.of_right.offer(slot.different, here);
        }
    }
    let Some(chosen) = right.get(usize::from(best.partner)) else { return Best::NONE };
    let elsewhere = |other: &Feature| {
        !core::ptr::eq(other, chosen)
            && ((other.x_px - chosen.x_px).abs() >= search.apart_px
                || (other.y_px - chosen.y_px).abs() >= search.apart_px)
    };
    let others =
        right.iter().zip(slots.iter()).filter(|(other, _)| elsewhere(other)).map(|(_, slot)| slot.different);
    // With nobody else, or nobody else who is admitted, half of the bits is what a stranger would differ in.
    let second = others.min().unwrap_or(NOBODY).min(Descriptor::BITS / 2);
    let clear = 100 * u32::from(best.different) < u32::from(search.ratio_percent) * u32::from(second);
    if clear && best.different <= search.most_different { best } else { Best::NONE }
}

impl<const N: usize> Default for FeatureMatcher<N> {
    fn default() -> Self {
        Self::new()
    }
}
