//! C names of the functions of obstacles, ground and free space.

/// Defines these functions, in the module of [`instantiate_c_api`](crate::instantiate_c_api).
#[doc(hidden)]
#[macro_export]
macro_rules! c_api_of_obstacles {
    ([$($prefix:literal)?]) => {
        use $crate::ffi::{
            CGround, CObstacleConfig, CScan, CSector, CStixel, ObstaclesHandle, PairMonitorHandle,
        };

        /// Fills a configuration: cells of 4 x 5 px, a deviation of 0.15 px, a ground that is searched 0.1 m
        /// to 3 m below the camera, obstacles and drops of 5 cm, and 16 sectors.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_default"))]
        pub unsafe extern "C" fn stereopsis_obstacles_default(config: *mut CObstacleConfig) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { $crate::ffi::obstacles_default(config) }
        }

        /// Creates a finder of obstacles in the caller's memory of `length` bytes, aligned to
        /// `STEREOPSIS_ALIGN`: for frames of up to `columns` columns and `rows` rows of cells, 1 to 255.
        /// Writes the handle; a null handle on an error, unless `handle` itself is invalid. The memory is not
        /// read, and belongs to the finder until `stereopsis_obstacles_deinit`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_init"))]
        pub unsafe extern "C" fn stereopsis_obstacles_init(
            memory: *mut c_void,
            length: usize,
            columns: u16,
            rows: u16,
            handle: *mut *mut ObstaclesHandle,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::obstacles_init(memory, length, [columns, rows], handle) }
        }

        /// Ends a finder, whose memory returns to the caller.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_deinit"))]
        pub unsafe extern "C" fn stereopsis_obstacles_deinit(handle: *mut ObstaclesHandle) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::obstacles_deinit(handle) }
        }

        /// Starts on frames of `width` x `height` pixels from a rectified rig, with disparities of up to
        /// `largest_px`; what was carried from frame to frame is forgotten. Columns and rows of pixels that
        /// fill no cell are left out. Fails with `STEREOPSIS_STATUS_OBSTACLE_CELLS`, `_OBSTACLE_SECTORS`,
        /// `_OBSTACLE_POSE`, `_OBSTACLE_LIMITS`, `_OBSTACLE_GROUND` or `_OBSTACLE_SIZE`, or where the rig's
        /// numbers are none, and leaves the finder as it was.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_start"))]
        pub unsafe extern "C" fn stereopsis_obstacles_start(
            handle: *mut ObstaclesHandle,
            config: *const CObstacleConfig,
            rig: *const CRig,
            width: u16,
            height: u16,
            largest_px: u16,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::obstacles_start(handle, config, rig, [width, height], largest_px) }
        }

        /// Begins a frame. One that was not finished is forgotten.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_begin_frame"))]
        pub unsafe extern "C" fn stereopsis_obstacles_begin_frame(handle: *mut ObstaclesHandle) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::obstacles_begin_frame(handle) }
        }

        /// Takes what a monitor says of both cameras in this frame, before it is finished: a camera without a
        /// picture and swapped cameras make it blind.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_cameras"))]
        pub unsafe extern "C" fn stereopsis_obstacles_cameras(
            handle: *mut ObstaclesHandle,
            monitor: *mut PairMonitorHandle,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::obstacles_cameras(handle, monitor) }
        }

        /// Sets the pose of the camera from this frame on, as from an inertial sensor: its downward pitch
        /// and its roll, positive where its right side is the lower one, -500 to 500 thousandths of a radian,
        /// and its height above the ground, mm. Fails with `STEREOPSIS_STATUS_OBSTACLE_POSE`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_set_pose"))]
        pub unsafe extern "C" fn stereopsis_obstacles_set_pose(
            handle: *mut ObstaclesHandle,
            pitch_mrad: i16,
            roll_mrad: i16,
            height_mm: u16,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::obstacles_set_pose(handle, pitch_mrad, roll_mrad, height_mm) }
        }

        /// Takes a row as it leaves the matcher; rows that are left out count as lost. Fails with
        /// `STEREOPSIS_STATUS_ROW` for one that is not in the frame, or not below all that came, and with
        /// `_LINE_LENGTH` for one that is too short.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_push"))]
        pub unsafe extern "C" fn stereopsis_obstacles_push(
            handle: *mut ObstaclesHandle,
            row: *const CRow,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::obstacles_push(handle, row) }
        }

        /// Ends a frame: finds its ground, stixels and surfaces, and writes a `STEREOPSIS_BLIND_` number: why
        /// the frame is not to be trusted, or 0. A frame that is blind is no failure.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_finish"))]
        pub unsafe extern "C" fn stereopsis_obstacles_finish(
            handle: *mut ObstaclesHandle,
            blind: *mut u8,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::obstacles_finish(handle, blind) }
        }

        /// Writes the ground of the last finished frame.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_ground"))]
        pub unsafe extern "C" fn stereopsis_obstacles_ground(
            handle: *mut ObstaclesHandle,
            ground: *mut CGround,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::obstacles_ground(handle, ground) }
        }

        /// Writes the stixels of the first `count` columns of cells from the left, at most 65535. Columns
        /// that are not in the frame show nothing.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_stixels"))]
        pub unsafe extern "C" fn stereopsis_obstacles_stixels(
            handle: *mut ObstaclesHandle,
            stixels: *mut CStixel,
            count: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::obstacles_stixels(handle, stixels, count) }
        }

        /// Writes the first `count` sectors from the left, at most 65535. Sectors that there are not are
        /// blind, as all are in a frame that is not to be trusted.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_sectors"))]
        pub unsafe extern "C" fn stereopsis_obstacles_sectors(
            handle: *mut ObstaclesHandle,
            sectors: *mut CSector,
            count: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::obstacles_sectors(handle, sectors, count) }
        }

        /// Writes the disparities of the first `count` cells of row `row` of cells, at most 65535, in 1/32
        /// px; `STEREOPSIS_NONE` for no answer, and for a cell that is not in the frame.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_cells"))]
        pub unsafe extern "C" fn stereopsis_obstacles_cells(
            handle: *mut ObstaclesHandle,
            row: u16,
            disparities: *mut u16,
            count: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::obstacles_cells(handle, row, disparities, count) }
        }

        /// Writes the ranges of the sectors from right to left, m, at most `count`, and the angles of the
        /// scan, as ROS's LaserScan has them: a free sector is infinite, a blind one is not a number. Floats
        /// beyond the last sector are 0.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_obstacles_scan"))]
        pub unsafe extern "C" fn stereopsis_obstacles_scan(
            handle: *mut ObstaclesHandle,
            ranges: *mut f32,
            count: usize,
            scan: *mut CScan,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::obstacles_scan(handle, ranges, count, scan) }
        }

        $crate::ffi::c_api_of_driving!([$($prefix)?]);
    };
}

pub use c_api_of_obstacles;
