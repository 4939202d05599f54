//! C names of the functions of decisions, of the free space over frames, and of the cameras' health.

/// Defines these functions, in the module of [`instantiate_c_api`](crate::instantiate_c_api).
#[doc(hidden)]
#[macro_export]
macro_rules! c_api_of_driving {
    ([$($prefix:literal)?]) => {
        use $crate::ffi::{
            CDriveConfig, CVerdict, DriveHandle, FreeSpaceHandle,
        };

        /// Fills a configuration for a small robot: 0.4 m wide, stands 0.2 m before an obstacle, 100 ms from
        /// picture to brakes, 1 m/s^2.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_drive_default"))]
        pub unsafe extern "C" fn stereopsis_drive_default(config: *mut CDriveConfig) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { $crate::ffi::drive_default(config) }
        }

        /// Creates a drive rule in the caller's memory of `length` bytes, aligned to `STEREOPSIS_ALIGN`.
        /// Writes the handle; a null handle on an error, unless `handle` itself is invalid. The memory is not
        /// read, and belongs to the rule until `stereopsis_drive_deinit`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_drive_init"))]
        pub unsafe extern "C" fn stereopsis_drive_init(
            memory: *mut c_void,
            length: usize,
            handle: *mut *mut DriveHandle,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::drive_init(memory, length, handle) }
        }

        /// Ends a rule, whose memory returns to the caller.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_drive_deinit"))]
        pub unsafe extern "C" fn stereopsis_drive_deinit(handle: *mut DriveHandle) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::drive_deinit(handle) }
        }

        /// Sets how the vehicle drives, and forgets the frames before.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_drive_start"))]
        pub unsafe extern "C" fn stereopsis_drive_start(
            handle: *mut DriveHandle,
            config: *const CDriveConfig,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::drive_start(handle, config) }
        }

        /// Writes the way that the vehicle needs to stand: margin + v t + v^2 / (2 a), mm.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_drive_stopping_mm"))]
        pub unsafe extern "C" fn stereopsis_drive_stopping_mm(
            handle: *mut DriveHandle,
            speed_mm_s: u16,
            stopping_mm: *mut u16,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::drive_stopping_mm(handle, speed_mm_s, stopping_mm) }
        }

        /// Decides on the frame of a finder that was finished last, at a speed. In this order: blind where
        /// another one has begun since, or the frame is not to be trusted; stop for what is within the
        /// stopping distance, or left the picture at a side within the corridor; blind where the ground is
        /// not found, or too little of the corridor is seen, as where it is wider than the picture; slow down
        /// for what is within twice the stopping distance or the time to contact; clear. What left the
        /// picture is held until it is seen again: `stereopsis_drive_start` forgets it, once the vehicle has
        /// turned. No hardware is called.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_drive_decide"))]
        pub unsafe extern "C" fn stereopsis_drive_decide(
            handle: *mut DriveHandle,
            obstacles: *mut ObstaclesHandle,
            speed_mm_s: u16,
            verdict: *mut CVerdict,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::drive_decide(handle, obstacles, speed_mm_s, verdict) }
        }

        /// Returns the speed of a vehicle of which odometry gave the last step, mm/s; 65535 at most, and for
        /// a period of 0.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_speed_mm_s"))]
        pub extern "C" fn stereopsis_speed_mm_s(step_mm: u16, period_us: u32) -> u16 {
            $crate::ffi::drive_speed_mm_s(step_mm, period_us)
        }

        /// Creates a free space over frames in the caller's memory of `length` bytes, aligned to
        /// `STEREOPSIS_ALIGN`: `confirm` frames in a row have to show an obstacle before it counts, and for
        /// `release` frames without it it still does. All sectors are blind. Writes the handle; a null handle
        /// on an error, unless `handle` itself is invalid. The memory is not read, and belongs to the free
        /// space until `stereopsis_free_space_deinit`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_free_space_init"))]
        pub unsafe extern "C" fn stereopsis_free_space_init(
            memory: *mut c_void,
            length: usize,
            confirm: u8,
            release: u8,
            handle: *mut *mut FreeSpaceHandle,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::free_space_init(memory, length, [confirm, release], handle) }
        }

        /// Ends a free space, whose memory returns to the caller.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_free_space_deinit"))]
        pub unsafe extern "C" fn stereopsis_free_space_deinit(handle: *mut FreeSpaceHandle) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::free_space_deinit(handle) }
        }

        /// Takes the last finished frame of a finder. A sector that turns blind is blind at once, whatever it
        /// was before.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_free_space_update"))]
        pub unsafe extern "C" fn stereopsis_free_space_update(
            handle: *mut FreeSpaceHandle,
            obstacles: *mut ObstaclesHandle,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::free_space_update(handle, obstacles) }
        }

        /// Writes the first `count` sectors from the left, at most 65535; blind ones where there are none.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_free_space_sectors"))]
        pub unsafe extern "C" fn stereopsis_free_space_sectors(
            handle: *mut FreeSpaceHandle,
            sectors: *mut CSector,
            count: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::free_space_sectors(handle, sectors, count) }
        }

        /// Creates a monitor of two cameras in the caller's memory of `length` bytes, aligned to
        /// `STEREOPSIS_ALIGN`. To find swapped cameras it tries disparities up to `most_disparity` on every
        /// eighth line. Writes the handle; a null handle on an error, unless `handle` itself is invalid. The
        /// memory is not read, and belongs to the monitor until `stereopsis_pair_monitor_deinit`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_pair_monitor_init"))]
        pub unsafe extern "C" fn stereopsis_pair_monitor_init(
            memory: *mut c_void,
            length: usize,
            most_disparity: u16,
            handle: *mut *mut PairMonitorHandle,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::pair_monitor_init(memory, length, most_disparity, handle) }
        }

        /// Ends a monitor, whose memory returns to the caller.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_pair_monitor_deinit"))]
        pub unsafe extern "C" fn stereopsis_pair_monitor_deinit(handle: *mut PairMonitorHandle) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::pair_monitor_deinit(handle) }
        }

        /// Begins a frame.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_pair_monitor_begin_frame"))]
        pub unsafe extern "C" fn stereopsis_pair_monitor_begin_frame(
            handle: *mut PairMonitorHandle,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::pair_monitor_begin_frame(handle) }
        }

        /// Takes the next rectified line of both cameras, 8-bit grey, `length` bytes each, at most 65535.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_pair_monitor_push"))]
        pub unsafe extern "C" fn stereopsis_pair_monitor_push(
            handle: *mut PairMonitorHandle,
            left: *const u8,
            right: *const u8,
            length: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::pair_monitor_push(handle, [left, right], length) }
        }

        /// Writes the condition of the left and of the right camera, `STEREOPSIS_CAMERA_` numbers, and
        /// whether the two are swapped.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_pair_monitor_health"))]
        pub unsafe extern "C" fn stereopsis_pair_monitor_health(
            handle: *mut PairMonitorHandle,
            left: *mut u8,
            right: *mut u8,
            swapped: *mut u8,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::pair_monitor_health(handle, [left, right], swapped) }
        }
    };
}

pub use c_api_of_driving;
