//! C names of the functions of focus maps and of stereo odometry.

/// Defines these functions, in the module of [`instantiate_c_api`](crate::instantiate_c_api).
#[doc(hidden)]
#[macro_export]
macro_rules! c_api_of_focus_and_motion {
    ([$($prefix:literal)?]) => {
        use $crate::ffi::{
            CFocusConfig, CFocusPeak, COdometryConfig, CPicture, CStep, FocusHandle, OdometryHandle,
        };

        /// Fills a configuration for frames of `width` x `height` pixels: an answer a pixel, from windows of
        /// radius 3. Cells of 8 px and radius 0 are an answer a tile.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_focus_default"))]
        pub unsafe extern "C" fn stereopsis_focus_default(
            width: u16,
            height: u16,
            config: *mut CFocusConfig,
        ) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { $crate::ffi::focus_default(width, height, config) }
        }

        /// Creates a focus map in the caller's memory of `length` bytes, aligned to `STEREOPSIS_ALIGN`: for
        /// lines of up to `width` pixels, rows of up to `columns` cells, and frames of up to `cells` cells.
        /// Writes the handle; a null handle on an error, unless `handle` itself is invalid. The memory is not
        /// read, and belongs to the map until `stereopsis_focus_deinit`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_focus_init"))]
        pub unsafe extern "C" fn stereopsis_focus_init(
            memory: *mut c_void,
            length: usize,
            width: u16,
            columns: u16,
            cells: u32,
            handle: *mut *mut FocusHandle,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::focus_init(memory, length, [width, columns], cells, handle) }
        }

        /// Ends a focus map, whose memory returns to the caller.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_focus_deinit"))]
        pub unsafe extern "C" fn stereopsis_focus_deinit(handle: *mut FocusHandle) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::focus_deinit(handle) }
        }

        /// Checks a configuration, which is copied, and begins a stack of frames; what is left of another one
        /// is forgotten. Fails with `STEREOPSIS_STATUS_FOCUS_SIZE` or `_FOCUS_WINDOW`, and leaves the map as
        /// it was.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_focus_start"))]
        pub unsafe extern "C" fn stereopsis_focus_start(
            handle: *mut FocusHandle,
            config: *const CFocusConfig,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::focus_start(handle, config) }
        }

        /// Begins the next frame of the stack, in which everything is `scale` times as large as in the first
        /// one, 1/2 to 2: 1 where the lens does not breathe. Fails with `STEREOPSIS_STATUS_LINES_MISSING`
        /// before the last line of the frame before, with `_FOCUS_SCALE`, and with `_FOCUS_FRAMES` after
        /// 65535 frames.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_focus_begin_frame"))]
        pub unsafe extern "C" fn stereopsis_focus_begin_frame(
            handle: *mut FocusHandle,
            scale: f32,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::focus_begin_frame(handle, scale) }
        }

        /// Takes the next line of a frame, 8-bit grey, `length` bytes, which is the configuration's width.
        /// Fails with `STEREOPSIS_STATUS_NO_LINE_LEFT` where none is due, and with `_LINE_LENGTH`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_focus_push"))]
        pub unsafe extern "C" fn stereopsis_focus_push(
            handle: *mut FocusHandle,
            line: *const u8,
            length: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::focus_push(handle, line, length) }
        }

        /// Ends the stack: then all peaks are known. Fails with `STEREOPSIS_STATUS_LINES_MISSING` before the
        /// last line of a frame, and with `_NOT_STARTED` where it has ended.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_focus_finish"))]
        pub unsafe extern "C" fn stereopsis_focus_finish(handle: *mut FocusHandle) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::focus_finish(handle) }
        }

        /// Writes the peaks of the first `count` cells of row `row` of cells, at most 65535. Cells that are
        /// not in the frame are as those of too few frames. Fails with
        /// `STEREOPSIS_STATUS_FOCUS_NOT_FINISHED` before the end of the stack.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_focus_row"))]
        pub unsafe extern "C" fn stereopsis_focus_row(
            handle: *mut FocusHandle,
            row: u16,
            peaks: *mut CFocusPeak,
            count: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::focus_row(handle, row, peaks, count) }
        }

        /// Fills a configuration for pictures of `width` columns.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_odometry_default"))]
        pub unsafe extern "C" fn stereopsis_odometry_default(
            width: u16,
            config: *mut COdometryConfig,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::odometry_default(width, config) }
        }

        /// Creates an odometry of a rectified pair in the caller's memory of `length` bytes, aligned to
        /// `STEREOPSIS_ALIGN`, which follows up to `points` points, 16 to 65534. Writes the handle; a null
        /// handle on an error, unless `handle` itself is invalid. The memory is not read, and belongs to the
        /// odometry until `stereopsis_odometry_deinit`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_odometry_init"))]
        pub unsafe extern "C" fn stereopsis_odometry_init(
            memory: *mut c_void,
            length: usize,
            points: u16,
            handle: *mut *mut OdometryHandle,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::odometry_init(memory, length, points, handle) }
        }

        /// Ends an odometry, whose memory returns to the caller.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_odometry_deinit"))]
        pub unsafe extern "C" fn stereopsis_odometry_deinit(handle: *mut OdometryHandle) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::odometry_deinit(handle) }
        }

        /// Begins with a rectified rig, as from `stereopsis_rectifier_start`; what was known is forgotten.
        /// Fails where the rig's numbers are none, and with `STEREOPSIS_STATUS_ODOMETRY_CONFIG` where
        /// `far_px`, `near_px`, `most_disparity_px` or `most_samples` is not over 0, `sigma_px` is not 0.001
        /// to 1000, or `spacing_px` is negative, infinite or not a number.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_odometry_start"))]
        pub unsafe extern "C" fn stereopsis_odometry_start(
            handle: *mut OdometryHandle,
            rig: *const CRig,
            config: *const COdometryConfig,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::odometry_start(handle, rig, config) }
        }

        /// Takes the next frame: both rectified pictures, and the `count` features of the left one, as from
        /// `stereopsis_detector_push`. Writes the motion since the frame before. Fails with
        /// `STEREOPSIS_STATUS_PICTURE_SIZE` where pictures differ in size, or from those before, and with
        /// `_NOT_STARTED`; what is not known of a motion is no failure, and stands in `state`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_odometry_step"))]
        pub unsafe extern "C" fn stereopsis_odometry_step(
            handle: *mut OdometryHandle,
            left: *const CPicture,
            right: *const CPicture,
            features: *const CFeature,
            count: usize,
            step: *mut CStep,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::odometry_step(handle, [left, right], features, count, step) }
        }
    };
}

pub use c_api_of_focus_and_motion;
