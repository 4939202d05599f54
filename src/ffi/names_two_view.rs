//! C names of the functions on matches of two views.

/// Defines these functions, in the module of [`instantiate_c_api`](crate::instantiate_c_api).
#[doc(hidden)]
#[macro_export]
macro_rules! c_api_of_two_views {
    ([$($prefix:literal)?]) => {
        use $crate::ffi::{CAgreement, CMatch, CPinhole, CPose};

        /// Computes the fundamental matrix F of `count` matches, eight or more, all of them right: row by
        /// row, with p^T F p' = 0 for p in the first image and p' in the second (eight-point algorithm).
        /// Fails on fewer, on numbers that are not finite, and where the matches leave F undetermined.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_eight_point"))]
        pub unsafe extern "C" fn stereopsis_eight_point(
            matches: *const CMatch,
            count: usize,
            fundamental: *mut f32,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::two_view_eight_point(matches, count, fundamental) }
        }

        /// Estimates F of `count` matches, some of them wrong, and which agree with it (RANSAC, at most
        /// 10 000 samples): `inliers` gets 1 for a match whose Sampson distance is up to `threshold_px`, and
        /// 0 for another. Equal seeds give equal results. Fails on fewer than eight matches, on numbers that
        /// are not finite, on a threshold that is not over 0, where not more than seven matches agree, and
        /// where they are on a plane; `inliers` may have been written then. What is written overlaps nothing
        /// else.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_fundamental"))]
        pub unsafe extern "C" fn stereopsis_fundamental(
            matches: *const CMatch,
            count: usize,
            threshold_px: f32,
            seed: u64,
            fundamental: *mut f32,
            inliers: *mut u8,
            agreement: *mut CAgreement,
        ) -> Status {
            // SAFETY: as above.
            unsafe {
                $crate::ffi::two_view_fundamental(
                    matches, count, threshold_px, seed, fundamental, inliers, agreement,
                )
            }
        }

        /// Recovers the pose of the second camera from F, with which most of the `count` matches are in
        /// front of both cameras. `inliers` says which matches count, as from `stereopsis_fundamental`; null
        /// for all of them. Fails where F is no fundamental matrix, a camera's numbers cannot be, or no pose
        /// has more than half of the matches in front.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_pose_of"))]
        pub unsafe extern "C" fn stereopsis_pose_of(
            matches: *const CMatch,
            inliers: *const u8,
            count: usize,
            fundamental: *const f32,
            first: *const CPinhole,
            second: *const CPinhole,
            pose: *mut CPose,
        ) -> Status {
            // SAFETY: as above.
            unsafe {
                $crate::ffi::two_view_pose(matches, inliers, count, fundamental, [first, second], pose)
            }
        }

        /// Triangulates `count` matches with least re-projection error: points in the first camera's frame,
        /// in the unit of the pose's translation; all 0 where the rays are nearly parallel or do not meet
        /// in front of both cameras. Fails where a camera's or the pose's numbers cannot be.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_triangulate"))]
        pub unsafe extern "C" fn stereopsis_triangulate(
            matches: *const CMatch,
            count: usize,
            first: *const CPinhole,
            second: *const CPinhole,
            pose: *const CPose,
            points: *mut CPoint,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::two_view_triangulate(matches, count, [first, second], pose, points) }
        }
    };
}

pub use c_api_of_two_views;
