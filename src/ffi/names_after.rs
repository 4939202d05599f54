//! C names of the functions before and after the matcher: balance, decimation, and the filter over frames.

/// Defines these functions, in the module of [`instantiate_c_api`](crate::instantiate_c_api).
#[doc(hidden)]
#[macro_export]
macro_rules! c_api_before_and_after {
    ([$($prefix:literal)?]) => {
        use $crate::ffi::{CBalance, CHistogram, CTemporal};

        /// Clears a histogram, one for each camera, before a frame.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_histogram_clear"))]
        pub unsafe extern "C" fn stereopsis_histogram_clear(histogram: *mut CHistogram) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { $crate::ffi::histogram_clear(histogram) }
        }

        /// Counts every eighth pixel of row `row`, 8-bit grey, 65535 bytes at most.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_histogram_line"))]
        pub unsafe extern "C" fn stereopsis_histogram_line(
            histogram: *mut CHistogram,
            row: u16,
            line: *const u8,
            length: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::histogram_line(histogram, row, line, length) }
        }

        /// Estimates from the histograms of a frame, of the lines as the cameras gave them, by which gain and
        /// offset the right camera's next frame becomes as bright as the left one's. Cameras that differ by
        /// less than 16 grey levels in the mean, and frames without contrast, are left as they are: a gain of
        /// 256 and an offset of 0.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_balance_between"))]
        pub unsafe extern "C" fn stereopsis_balance_between(
            left: *const CHistogram,
            right: *const CHistogram,
            balance: *mut CBalance,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::balance_between(left, right, balance) }
        }

        /// Balances a line of the right camera in place, 8-bit grey, `length` bytes, before the matcher takes
        /// it.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_balance_line"))]
        pub unsafe extern "C" fn stereopsis_balance_line(
            balance: *const CBalance,
            line: *mut u8,
            length: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::balance_line(balance, line, length) }
        }

        /// Takes the `count` disparities of row `row`, at most 65535, into blocks of `block` x `block`
        /// pixels, 2 to 8 a side. With the last row of blocks it writes `count / block` disparities to
        /// `smaller`, which are row `row / block` of the smaller image, and returns `STEREOPSIS_STATUS_OK`;
        /// else it returns `STEREOPSIS_STATUS_NO_ROW_YET`. Each is the median of its block's answers, the
        /// nearer of two middle ones, where at least half of the pixels have one; disparities stay in pixels
        /// of the full image. `rows` holds `block * count` words from call to call and needs no content: a
        /// frame's rows come from 0 on, without gaps. The arrays do not overlap.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_decimate"))]
        pub unsafe extern "C" fn stereopsis_decimate(
            rows: *mut u16,
            block: u16,
            row: u16,
            disparities: *const u16,
            count: usize,
            smaller: *mut u16,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::decimate(rows, block, row, disparities, count, smaller) }
        }

        /// Fills a configuration of the filter over frames: it averages within one pixel with weight 1/4, and
        /// holds answers for two frames.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_temporal_default"))]
        pub unsafe extern "C" fn stereopsis_temporal_default(config: *mut CTemporal) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::temporal_default(config) }
        }

        /// Prepares the filter's memory, a word and a byte for each of `count` pixels, all rows together or
        /// one by one: before the first frame, after a cut, or when the cameras were moved.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_temporal_forget"))]
        pub unsafe extern "C" fn stereopsis_temporal_forget(
            averages: *mut u16,
            ages: *mut u8,
            count: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::temporal_forget(averages, ages, count) }
        }

        /// Filters a row of `count` disparities over its part of the filter's memory: writes the running
        /// averages, which hold answers over short gaps, to `filtered`, and a `STEREOPSIS_ORIGIN_` number for
        /// each to `origins`. The arrays do not overlap. Fails on a shift over 4.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_temporal_row"))]
        pub unsafe extern "C" fn stereopsis_temporal_row(
            config: *const CTemporal,
            averages: *mut u16,
            ages: *mut u8,
            disparities: *const u16,
            filtered: *mut u16,
            origins: *mut u8,
            count: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe {
                $crate::ffi::temporal_row(config, [averages, filtered], [ages, origins], disparities, count)
            }
        }
    };
}

pub use c_api_before_and_after;
