//! Two views in C: fundamental matrix, relative pose and points of matches.
#![allow(unsafe_code)]

use super::Status;
use super::points::CPoint;
use super::state::{any_shared, checked, share_bytes};
use super::status::either;
use crate::geometry::camera::{Camera, Pose};
use crate::geometry::robust::{RobustConfig, RobustError, robust_fundamental};
use crate::geometry::two_view::{
    Correspondence, EightPointError, Essential, Fundamental, RecoverError, TwoViews, eight_point,
};
use core::mem::offset_of;
use core::slice::{from_raw_parts, from_raw_parts_mut};
use nalgebra::{Matrix3, Vector3};

/// Point of the first image and the point of the second image that matches it, undistorted, px.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(C)]
pub struct CMatch {
    /// Column in the first image.
    pub u: f32,
    /// Row in the first image.
    pub v: f32,
    /// Column in the second image.
    pub u2: f32,
    /// Row in the second image.
    pub v2: f32,
}

/// The type of C and the correspondence of Rust are four floats in the same order.
const _: () = assert!(
    size_of::<CMatch>() == size_of::<Correspondence<f32>>()
        && align_of::<CMatch>() == align_of::<Correspondence<f32>>()
        && offset_of!(Correspondence<f32>, first) == offset_of!(CMatch, u)
        && offset_of!(Correspondence<f32>, second) == offset_of!(CMatch, u2)
);

/// Camera without lens distortion.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(C)]
pub struct CPinhole {
    /// Focal length along rows, px.
    pub fx: f32,
    /// Focal length along columns, px.
    pub fy: f32,
    /// Principal point, column, px.
    pub cx: f32,
    /// Principal point, row, px.
    pub cy: f32,
}

/// Pose of the second camera beside the first: P = R P' + t.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(C)]
pub struct CPose {
    /// Rotation R, from the second camera's frame into the first one's, row by row.
    pub rotation: [f32; 9],
    /// Translation t, from the first camera to the second. Two views do not say how long it is:
    /// `stereopsis_pose_of` writes length 1, and points come out in its unit.
    pub translation: [f32; 3],
}

/// How far matches agree with a fundamental matrix.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(C)]
pub struct CAgreement {
    /// Number of matches within the threshold.
    pub inliers: u32,
    /// Root mean square of their Sampson distances, px.
    pub rms_px: f32,
    /// Probability that an estimate as good was missed, by the matches within 1.5 thresholds.
    pub miss_probability: f32,
}

impl From<EightPointError> for Status {
    fn from(e: EightPointError) -> Self {
        match e {
            EightPointError::TooFew => Self::TooFewMatches,
            EightPointError::NotFinite => Self::MatchNotFinite,
            EightPointError::Plane => Self::MatchesOnPlane,
            _ => Self::MatchesDegenerate,
        }
    }
}

impl From<RobustError> for Status {
    fn from(e: RobustError) -> Self {
        match e {
            RobustError::TooFew => Self::TooFewMatches,
            RobustError::NotFinite => Self::MatchNotFinite,
            RobustError::Threshold => Self::MatchThreshold,
            RobustError::Plane => Self::MatchesOnPlane,
            _ => Self::MatchesDisagree,
        }
    }
}

impl From<RecoverError> for Status {
    fn from(_: RecoverError) -> Self {
        Self::PoseAmbiguous
    }
}

impl CPinhole {
    fn camera(&self) -> Result<Camera<f32>, Status> {
        Camera::new(self.fx, self.fy, self.cx, self.cy).map_err(|_| Status::PinholeNumbers)
    }
}

/// Borrows `count` values at a pointer.
///
/// # Safety
///
/// `values` is null or points to `count` values that nothing writes during `'a`; every bit pattern is a `T`.
unsafe fn borrow<'a, T>(values: *const T, count: usize) -> Result<&'a [T], Status> {
    checked(values)?;
    if count > isize::MAX as usize / size_of::<T>() {
        return Err(Status::TooMany);
    }
    // SAFETY: the caller's promise; it is not null, aligned, and not too long.
    Ok(unsafe { from_raw_parts(values, count) })
}

/// Borrows `count` matches.
///
/// # Safety
///
/// As [`borrow`] asks.
unsafe fn matches<'a>(matches: *const CMatch, count: usize) -> Result<&'a [Correspondence<f32>], Status> {
    // SAFETY: the caller's promise; the layouts are the same, and floats may have any bits.
    unsafe { borrow(matches.cast(), count) }
}

/// Returns the matrix of nine numbers, row by row.
fn matrix_of([a, b, c, d, e, f, g, h, i]: [f32; 9]) -> Matrix3<f32> {
    Matrix3::new(a, b, c, d, e, f, g, h, i)
}

/// Reads a fundamental matrix.
///
/// # Safety
///
/// `matrix` is null or points to nine numbers.
pub(super) unsafe fn fundamental_of(matrix: *const f32) -> Result<Fundamental<f32>, Status> {
    checked(matrix)?;
    // SAFETY: the caller's promise, and it is aligned.
    let matrix = matrix_of(unsafe { matrix.cast::<[f32; 9]>().read() });
    Fundamental::from_matrix(&matrix).map_err(|_| Status::FundamentalRank)
}

/// Returns the nine numbers of a matrix, row by row.
pub(super) fn rows_of(matrix: &Matrix3<f32>) -> [f32; 9] {
    let mut rows = [0.0; 9];
    rows.iter_mut().zip(matrix.transpose().iter()).for_each(|(to, from)| *to = *from);
    rows
}

/// Solves for F, as `stereopsis_eight_point`.
///
/// # Safety
///
/// `seen` is null or points to `count` matches, `fundamental` is null or points to nine numbers.
pub unsafe fn two_view_eight_point(seen: *const CMatch, count: usize, fundamental: *mut f32) -> Status {
    let solve = || {
        checked(fundamental)?;
        // SAFETY: the caller's promise.
        let found = eight_point(unsafe { matches(seen, count) }?)?;
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { fundamental.cast::<[f32; 9]>().write(rows_of(found.matrix())) };
        Ok(Status::Ok)
    };
    either(solve())
}

/// Estimates F of matches some of which are wrong, as `stereopsis_fundamental`.
///
/// # Safety
///
/// `seen` and `inliers` are null or point to `count` elements each, `fundamental` to nine numbers,
/// `agreement` to a structure's bytes.
pub unsafe fn two_view_fundamental(
    seen: *const CMatch,
    count: usize,
    threshold_px: f32,
    seed: u64,
    fundamental: *mut f32,
    inliers: *mut u8,
    agreement: *mut CAgreement,
) -> Status {
    let estimate = || {
        checked(fundamental).and(checked(inliers)).and(checked(agreement))?;
        // SAFETY: the caller's promise.
        let seen = unsafe { matches(seen, count) }?;
        let matrix = (fundamental.cast_const().cast(), size_of::<[f32; 9]>());
        let agreed = (agreement.cast_const().cast(), size_of::<CAgreement>());
        let read = [(seen.as_ptr().cast(), size_of_val(seen))];
        if any_shared(&[(inliers.cast_const().cast(), count), matrix, agreed], &read) {
            return Err(Status::Overlap);
        }
        // SAFETY: the caller's promise. All bytes are 0, which are values of `bool`, before they are one.
        let inliers = unsafe {
            inliers.write_bytes(0, count);
            from_raw_parts_mut(inliers.cast::<bool>(), count)
        };
        let config = RobustConfig { seed, ..RobustConfig::new(threshold_px) };
        let found = robust_fundamental(seen, &config, inliers)?;
        let (rms_px, miss_probability) = (found.rms_px, found.miss_probability);
        // SAFETY: the caller's promise, and they are aligned.
        unsafe {
            fundamental.cast::<[f32; 9]>().write(rows_of(found.fundamental.matrix()));
            agreement.write(CAgreement { inliers: found.inliers as u32, rms_px, miss_probability });
        }
        Ok(Status::Ok)
    };
    either(estimate())
}

/// Recovers the relative pose, as `stereopsis_pose_of`.
///
/// # Safety
///
/// `seen` is null or points to `count` matches, `inliers` to as many bytes, the others to what they are
/// called.
pub unsafe fn two_view_pose(
    seen: *const CMatch,
    inliers: *const u8,
    count: usize,
    fundamental: *const f32,
    [first, second]: [*const CPinhole; 2],
    pose: *mut CPose,
) -> Status {
    let recover = || {
        checked(pose)?;
        // SAFETY: the caller's promise.
        let (seen, cameras) = unsafe { (matches(seen, count)?, cameras(first, second)?) };
        // SAFETY: the caller's promise.
        let inliers = if inliers.is_null() { &[] } else { unsafe { borrow(inliers, count) }? };
        // SAFETY: the caller's promise.
        let fundamental = unsafe { fundamental_of(fundamental) }?;
        let [first, second] = cameras;
        let essential = Essential::from_fundamental(&fundamental, &first, &second)
            .map_err(|_| Status::FundamentalRank)?;
        let agreeing =
            seen.iter().enumerate().filter(|(i, _)| inliers.get(*i).is_none_or(|&inlier| inlier != 0));
        let found = essential.recover_pose(agreeing.map(|(_, seen)| *seen), &first, &second)?;
        let (rotation, t) = (rows_of(found.pose.rotation()), found.pose.direction());
        let found = CPose { rotation, translation: [t.x, t.y, t.z] };
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { pose.write(found) };
        Ok(Status::Ok)
    };
    either(recover())
}

/// Reads two cameras.
///
/// # Safety
///
/// Both are null or point to a camera.
unsafe fn cameras(first: *const CPinhole, second: *const CPinhole) -> Result<[Camera<f32>; 2], Status> {
    checked(first)?;
    checked(second)?;
    // SAFETY: the caller's promise, and they are aligned.
    unsafe { Ok([first.read().camera()?, second.read().camera()?]) }
}

/// Triangulates matches, as `stereopsis_triangulate`.
///
/// # Safety
///
/// `seen` and `points` are null or point to `count` elements each, the others to what they are called.
pub unsafe fn two_view_triangulate(
    seen: *const CMatch,
    count: usize,
    [first, second]: [*const CPinhole; 2],
    pose: *const CPose,
    points: *mut CPoint,
) -> Status {
    let triangulate = || {
        checked(pose)?;
        checked(points)?;
        // SAFETY: the caller's promise.
        let (seen, [first, second], pose) =
            unsafe { (matches(seen, count)?, cameras(first, second)?, pose.read()) };
        if share_bytes(points.cast(), count * size_of::<CPoint>(), seen.as_ptr().cast(), size_of_val(seen)) {
            return Err(Status::Overlap);
        }
        let pose = Pose::new(matrix_of(pose.rotation), Vector3::from(pose.translation))
            .map_err(|_| Status::PoseNumbers)?;
        let views = TwoViews::new(first, second, pose).map_err(|_| Status::PoseNumbers)?;
        for (i, seen) in seen.iter().enumerate() {
            let [x_m, y_m, z_m] = views.optimal(seen).map_or([0.0; 3], |found| found.point.coords.into());
            // SAFETY: the caller's promise, and it is aligned.
            unsafe { points.add(i).write(CPoint { x_m, y_m, z_m }) };
        }
        Ok(Status::Ok)
    };
    either(triangulate())
}
