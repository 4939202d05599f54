//! Matches of two views and what follows of them.

use super::arena::Arena;
use super::float;
use super::motion::features;
use super::stereopsis_c::*;
use arbitrary::{Result, Unstructured};
use stereopsis::ffi::{CMatch, CPinhole, CPose, CSearch, Status};

/// Matches: of a camera that moved sideways, or anywhere.
fn matches(u: &mut Unstructured<'_>, a: &mut Arena, count: usize) -> Result<*mut CMatch> {
    let mut all = Vec::new();
    let any = u.ratio(1, 4)?;
    for _ in 0..count {
        let [u1, v, shift, off] = u.arbitrary::<[u8; 4]>()?.map(f32::from);
        let seen = CMatch { u: u1, v, u2: u1 - shift / 8.0, v2: v + (off - 128.0) / 512.0 };
        all.push(if any { CMatch { u: float(u)?, v2: float(u)?, ..seen } } else { seen });
    }
    a.values(u, &all)
}

fn pinhole(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<*mut CPinhole> {
    let mut camera = CPinhole { fx: 200.0, fy: 200.0, cx: 128.0, cy: 128.0 };
    if u.ratio(1, 4)? {
        camera = CPinhole { fx: float(u)?, fy: float(u)?, cx: float(u)?, cy: float(u)? };
    }
    a.values(u, &[camera])
}

/// A fundamental matrix: of a sideways motion, or any numbers.
fn fundamental(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<*mut f32> {
    let mut f = [0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0];
    if u.ratio(1, 4)? {
        for value in &mut f {
            *value = float(u)?;
        }
    }
    a.values(u, &f)
}

pub fn two_views(u: &mut Unstructured<'_>, a: &mut Arena) -> Result<Status> {
    let n = u.int_in_range(0..=40)?;
    // SAFETY: arrays have as many elements as is said, or are what a call refuses.
    Ok(unsafe {
        match u.int_in_range(0..=6)? {
            0 => stereopsis_search_default(a.array(u, 1)?),
            1 | 2 => {
                let mut search = std::mem::MaybeUninit::<CSearch>::uninit();
                stereopsis_search_default(search.as_mut_ptr());
                let mut search = search.assume_init();
                if u.arbitrary()? {
                    search.along_px = float(u)?;
                    search.epipolar_px = float(u)?;
                    search.ratio_percent = u.arbitrary()?;
                    search.levels_apart = u.arbitrary()?;
                }
                let search = a.values(u, &[search])?;
                let along = fundamental(u, a)?;
                let (counts, capacity) = ([n, u.int_in_range(0..=40)?], u.int_in_range(0..=40)?);
                let (left, right) = (features(u, a, counts[0])?, features(u, a, counts[1])?);
                let slots = a.scratch(u, 5 * counts[0].max(counts[1]))?;
                let (matches, count) = (a.array(u, capacity)?, a.array(u, 1)?);
                stereopsis_match_features(
                    search, along, left, counts[0], right, counts[1], slots, matches, capacity, count,
                )
            }
            3 => stereopsis_eight_point(matches(u, a, n)?, n, a.array(u, 9)?),
            4 => {
                let (matches, threshold) = (matches(u, a, n)?, if u.arbitrary()? { 1.0 } else { float(u)? });
                let (f, inliers, agreement) = (a.array(u, 9)?, a.scratch(u, n)?, a.array(u, 1)?);
                stereopsis_fundamental(matches, n, threshold, u.arbitrary()?, f, inliers, agreement)
            }
            5 => {
                let (matches, inliers, f) = (matches(u, a, n)?, a.array(u, n)?, fundamental(u, a)?);
                let (first, second) = (pinhole(u, a)?, pinhole(u, a)?);
                stereopsis_pose_of(matches, inliers, n, f, first, second, a.array(u, 1)?)
            }
            _ => {
                let mut pose = CPose {
                    rotation: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
                    translation: [1.0, 0.0, 0.0],
                };
                if u.ratio(1, 4)? {
                    pose.rotation[u.int_in_range(0..=8)?] = float(u)?;
                    pose.translation[u.int_in_range(0..=2)?] = float(u)?;
                }
                let (matches, first, second) = (matches(u, a, n)?, pinhole(u, a)?, pinhole(u, a)?);
                let pose = a.values(u, &[pose])?;
                stereopsis_triangulate(matches, n, first, second, pose, a.array(u, n)?)
            }
        }
    })
}
