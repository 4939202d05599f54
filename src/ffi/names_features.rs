//! C names of the functions of features and their matches.

/// Defines these functions, in the module of [`instantiate_c_api`](crate::instantiate_c_api).
#[doc(hidden)]
#[macro_export]
macro_rules! c_api_of_features {
    ([$($prefix:literal)?]) => {
        use $crate::ffi::{CDetection, CDetectionCounts, CFeature, CSearch, DetectorHandle};

        /// Fills a configuration for pictures of `width` x `height` pixels: the five strongest corners of
        /// every 32 x 32 pixels, over 12 grey levels, for cameras that do not turn about their axes.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_detection_default"))]
        pub unsafe extern "C" fn stereopsis_detection_default(
            width: u16,
            height: u16,
            config: *mut CDetection,
        ) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { $crate::ffi::detection_default(width, height, config) }
        }

        /// Creates a detector of features in the caller's memory of `length` bytes, aligned to
        /// `STEREOPSIS_ALIGN`: for lines of up to `width` pixels, and `slots` corners that are kept in a row
        /// of cells, `per_cell` for each of them. Writes the handle; a null handle on an error, unless
        /// `handle` itself is invalid. The memory is not read, and belongs to the detector until
        /// `stereopsis_detector_deinit`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_detector_init"))]
        pub unsafe extern "C" fn stereopsis_detector_init(
            memory: *mut c_void,
            length: usize,
            width: u16,
            slots: u16,
            handle: *mut *mut DetectorHandle,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::detector_init(memory, length, [width, slots], handle) }
        }

        /// Ends a detector, whose memory returns to the caller.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_detector_deinit"))]
        pub unsafe extern "C" fn stereopsis_detector_deinit(handle: *mut DetectorHandle) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::detector_deinit(handle) }
        }

        /// Checks a configuration, which is copied, and begins a picture. Fails with
        /// `STEREOPSIS_STATUS_DETECTOR_WIDTH`, `_DETECTOR_CELLS` or `_DETECTOR_SLOTS`, and leaves the
        /// detector as it was.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_detector_start"))]
        pub unsafe extern "C" fn stereopsis_detector_start(
            handle: *mut DetectorHandle,
            config: *const CDetection,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::detector_start(handle, config) }
        }

        /// Takes the next line of a picture, 8-bit grey, `length` bytes, which is the configuration's width.
        /// Features that are ready are added to `features`, which has room for `capacity`, behind the `count`
        /// that are there, and `count` grows: 0 before the first line. With the last line all are ready.
        /// What finds no room is counted as dropped. Fails where `count` is over `capacity`, with
        /// `STEREOPSIS_STATUS_NO_LINE_LEFT` after the last line, and with `_LINE_LENGTH`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_detector_push"))]
        pub unsafe extern "C" fn stereopsis_detector_push(
            handle: *mut DetectorHandle,
            line: *const u8,
            length: usize,
            features: *mut CFeature,
            capacity: usize,
            count: *mut usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::detector_push(handle, line, length, features, capacity, count) }
        }

        /// Writes what became of the picture's corners.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_detector_counts"))]
        pub unsafe extern "C" fn stereopsis_detector_counts(
            handle: *mut DetectorHandle,
            counts: *mut CDetectionCounts,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::detector_counts(handle, counts) }
        }

        /// Fills a search: partners lie anywhere in the other picture, differ in at most 64 bits, and in less
        /// than 80 percent of those of the second best, which lies 4 px or more from the best.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_search_default"))]
        pub unsafe extern "C" fn stereopsis_search_default(search: *mut CSearch) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::search_default(search) }
        }

        /// Matches the features of two pictures, each with its best partner in both directions, for
        /// `stereopsis_fundamental` and the functions beside it. `fundamental` says on which lines partners
        /// lie, or is null. `slots` has five words for each feature of the longer list and needs no content.
        /// Writes up to `capacity` matches and their number.
        ///
        /// Returns `STEREOPSIS_STATUS_DROPPED` where `matches` had no room for all of them. Fails with
        /// `STEREOPSIS_STATUS_SEARCH` on numbers that make no search, with `_FUNDAMENTAL_RANK`, and with
        /// `_TOO_MANY` on over 65534 features. What is written overlaps nothing else.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_match_features"))]
        pub unsafe extern "C" fn stereopsis_match_features(
            search: *const CSearch,
            fundamental: *const f32,
            left: *const CFeature,
            left_count: usize,
            right: *const CFeature,
            right_count: usize,
            slots: *mut u16,
            matches: *mut CMatch,
            capacity: usize,
            count: *mut usize,
        ) -> Status {
            let (lists, counts) = ([left, right], [left_count, right_count]);
            let out = (matches, capacity, count);
            // SAFETY: as above.
            unsafe { $crate::ffi::match_features(search, fundamental, lists, counts, slots, out) }
        }
    };
}

pub use c_api_of_features;
