//! Matches of two lists of features in C.
#![allow(unsafe_code)]

use super::features::CFeature;
use super::state::{any_shared, checked};
use super::status::either;
use super::two_view::fundamental_of;
use super::{CMatch, Status};
use crate::features::{
    Epipolar, Feature, FeatureMatcherView, Match, MatchConfig, MatchConfigError, MatchSlot,
};
use core::slice::{from_raw_parts, from_raw_parts_mut};

/// What a match of two features has to be, filled by `stereopsis_search_default` and then open to changes.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(C)]
pub struct CSearch {
    /// How far partners may lie apart along the row, px.
    pub along_px: f32,
    /// How far partners may lie apart across the rows, px.
    pub across_px: f32,
    /// The second best partner is one that lies at least so far from the best, px.
    pub apart_px: f32,
    /// How far from its epipolar line a partner may lie, px, where a fundamental matrix is given.
    pub epipolar_px: f32,
    /// Most bits in which the descriptors of partners differ.
    pub most_different: u16,
    /// A match has fewer different bits than so many percent of the second best partner: 1 to 100.
    pub ratio_percent: u8,
    /// Largest difference of pyramid level between partners.
    pub levels_apart: u8,
}

impl From<MatchConfigError> for Status {
    fn from(e: MatchConfigError) -> Self {
        match e {
            MatchConfigError::TooMany { .. } => Self::TooMany,
            _ => Self::Search,
        }
    }
}

/// Fills a search, as `stereopsis_search_default`.
///
/// # Safety
///
/// `search` is null or points to a search's bytes.
pub unsafe fn search_default(search: *mut CSearch) -> Status {
    either(checked(search).map(|()| {
        let MatchConfig {
            ratio_percent, apart_px, most_different, levels_apart, along_px, across_px, ..
        } = MatchConfig::new();
        let filled = CSearch {
            along_px,
            across_px,
            apart_px,
            epipolar_px: 1.0,
            most_different,
            ratio_percent,
            levels_apart,
        };
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { search.write(filled) };
        Status::Ok
    }))
}

/// A match takes a slot of five words for each feature of the longer list, any bits of which are one.
const _: () = assert!(size_of::<MatchSlot>() == 10 && align_of::<MatchSlot>() == 2);

/// Matches two lists, as `stereopsis_match_features`.
///
/// # Safety
///
/// `search` is null or points to a search, `fundamental` is null or points to nine numbers, `lists` to as
/// many features as `counts` says, `slots` to five words for each feature of the longer one, `matches` to
/// `capacity` matches, and `count` to a number.
pub unsafe fn match_features(
    search: *const CSearch,
    fundamental: *const f32,
    lists: [*const CFeature; 2],
    counts: [usize; 2],
    slots: *mut u16,
    (matches, capacity, count): (*mut CMatch, usize, *mut usize),
) -> Status {
    let run = || {
        checked(search)?;
        lists.into_iter().try_for_each(checked)?;
        checked(slots)?;
        checked(matches)?;
        checked(count)?;
        let [left_count, right_count] = counts;
        let longer = left_count.max(right_count);
        if longer > FeatureMatcherView::MOST || capacity > isize::MAX as usize / size_of::<CMatch>() {
            return Err(Status::TooMany);
        }
        let [left, right] = lists;
        let bytes = |count: usize| count * size_of::<CFeature>();
        let written = [
            (slots.cast_const().cast(), longer * size_of::<MatchSlot>()),
            (matches.cast_const().cast(), capacity * size_of::<CMatch>()),
            (count.cast_const().cast(), size_of::<usize>()),
        ];
        let read = [(left.cast(), bytes(left_count)), (right.cast(), bytes(right_count))];
        if any_shared(&written, &read) {
            return Err(Status::Overlap);
        }
        // SAFETY: the caller's promise, and it is aligned.
        let search = unsafe { search.read() };
        let epipolar = if fundamental.is_null() {
            None
        } else {
            // SAFETY: the caller's promise.
            let fundamental = unsafe { fundamental_of(fundamental) }?;
            Some(Epipolar { fundamental, tolerance_px: search.epipolar_px })
        };
        let search = MatchConfig {
            ratio_percent: search.ratio_percent,
            apart_px: search.apart_px,
            most_different: search.most_different,
            levels_apart: search.levels_apart,
            along_px: search.along_px,
            across_px: search.across_px,
            epipolar,
        };
        // SAFETY: the caller's promise; what is written is apart from all else. Features may have any bits,
        // and slots are all 0 before they are taken for slots.
        let (left, right, slots) = unsafe {
            slots.write_bytes(0, 5 * longer);
            (
                from_raw_parts(left.cast::<Feature>(), left_count),
                from_raw_parts(right.cast::<Feature>(), right_count),
                from_raw_parts_mut(slots.cast::<MatchSlot>(), longer),
            )
        };
        let mut found = 0;
        let keep = |one: Match| {
            let pair = left.get(usize::from(one.left)).zip(right.get(usize::from(one.right)));
            let Some((left, right)) = pair.filter(|_| found < capacity) else { return false };
            let (u, v, u2, v2) = (left.x_px, left.y_px, right.x_px, right.y_px);
            // SAFETY: the caller's promise.
            unsafe { matches.add(found).write(CMatch { u, v, u2, v2 }) };
            found += 1;
            true
        };
        let dropped = FeatureMatcherView::new(slots).run_into(left, right, &search, keep)?;
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { count.write(found) };
        Ok(if dropped == 0 { Status::Ok } else { Status::Dropped })
    };
    either(run())
}
