//! C names of the functions that take winners computed elsewhere.

/// Defines these functions, in the module of [`instantiate_c_api`](crate::instantiate_c_api).
#[doc(hidden)]
#[macro_export]
macro_rules! c_api_of_winners {
    ([$($prefix:literal)?]) => {
        use $crate::ffi::{CWinner, WinnersHandle};

        /// Returns the bytes of memory that the second half of a matcher takes.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_winners_size"))]
        pub extern "C" fn stereopsis_winners_size() -> usize {
            StereopsisInstance::winners_size()
        }

        /// Returns the delay in lines of the second half: row y comes out when line y +
        /// `stereopsis_winners_latency()` goes in; the last rows come by `stereopsis_winners_flush`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_winners_latency"))]
        pub extern "C" fn stereopsis_winners_latency() -> usize {
            StereopsisInstance::winners_latency()
        }

        /// Creates the second half of a matcher in the caller's memory of `length` bytes, aligned to
        /// `STEREOPSIS_ALIGN`: it takes rows of winners that something else computed, such as gates or
        /// another core, and gives the rows that a matcher of this library gives. Writes the handle; a null
        /// handle on an error, unless `handle` itself is invalid. The memory is not read, and belongs to it
        /// until `stereopsis_winners_deinit`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_winners_init"))]
        pub unsafe extern "C" fn stereopsis_winners_init(
            memory: *mut c_void,
            length: usize,
            handle: *mut *mut WinnersHandle,
        ) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { StereopsisInstance::winners_init(memory, length, handle) }
        }

        /// Ends a second half, whose memory returns to the caller.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_winners_deinit"))]
        pub unsafe extern "C" fn stereopsis_winners_deinit(handle: *mut WinnersHandle) -> Status {
            // SAFETY: as above.
            unsafe { StereopsisInstance::winners_deinit(handle) }
        }

        /// Checks a configuration, which is copied, and prepares for the first frame. Writes 1 or 0: whether
        /// a check looks at the left camera's lines, and whether one looks at the winners' `second`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_winners_start"))]
        pub unsafe extern "C" fn stereopsis_winners_start(
            handle: *mut WinnersHandle,
            config: *const CConfig,
            needs_lines: *mut u8,
            needs_second: *mut u8,
        ) -> Status {
            // SAFETY: as above.
            unsafe { StereopsisInstance::winners_start(handle, config, needs_lines, needs_second) }
        }

        /// Begins a frame, and drops the one before.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_winners_begin_frame"))]
        pub unsafe extern "C" fn stereopsis_winners_begin_frame(handle: *mut WinnersHandle) -> Status {
            // SAFETY: as above.
            unsafe { StereopsisInstance::winners_begin_frame(handle) }
        }

        /// Writes the row whose winners the next call of `stereopsis_winners_push` takes, or of
        /// `stereopsis_winners_flush` after the last line; with `STEREOPSIS_STATUS_NO_ROW_YET` that call
        /// takes none, and nothing is written.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_winners_due"))]
        pub unsafe extern "C" fn stereopsis_winners_due(handle: *mut WinnersHandle, row: *mut u16) -> Status {
            // SAFETY: as above.
            unsafe { StereopsisInstance::winners_due(handle, row) }
        }

        /// Takes the next line of the left camera, `length` bytes, which is the configuration's width, and
        /// the `count` winners of the row of `stereopsis_winners_due`, as many as a line has pixels. The line
        /// may be null where no check looks at it. Null winners mean none where none are due, and a lost row
        /// where some are: it has no answers and `STEREOPSIS_FLAG_DAMAGED` on every pixel, and rows that it
        /// affects through checks have the flag.
        ///
        /// Returns `STEREOPSIS_STATUS_OK` with a row, or `STEREOPSIS_STATUS_NO_ROW_YET` with an empty one for
        /// the first lines of a frame. After an error, such as `STEREOPSIS_STATUS_WINNER_DAMAGED`, the same
        /// row may be given again.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_winners_push"))]
        pub unsafe extern "C" fn stereopsis_winners_push(
            handle: *mut WinnersHandle,
            left: *const u8,
            length: usize,
            winners: *const CWinner,
            count: usize,
            row: *mut CRow,
        ) -> Status {
            // SAFETY: as above.
            unsafe { StereopsisInstance::winners_take(handle, Some((left, length)), winners, count, row) }
        }

        /// Takes the winners that are due after the last line, as `stereopsis_winners_push` does: returns
        /// `STEREOPSIS_STATUS_OK` with a row, `STEREOPSIS_STATUS_NO_ROW_YET` with an empty one in frames of
        /// few lines, or `STEREOPSIS_STATUS_FRAME_DONE` with an empty one after the last row.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_winners_flush"))]
        pub unsafe extern "C" fn stereopsis_winners_flush(
            handle: *mut WinnersHandle,
            winners: *const CWinner,
            count: usize,
            row: *mut CRow,
        ) -> Status {
            // SAFETY: as above.
            unsafe { StereopsisInstance::winners_take(handle, None, winners, count, row) }
        }

        /// Writes the standard deviations of the last row of a second half, as `stereopsis_sigma_px` does.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_winners_sigma_px"))]
        pub unsafe extern "C" fn stereopsis_winners_sigma_px(
            handle: *mut WinnersHandle,
            sigma_px: *mut f32,
            count: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { StereopsisInstance::winners_sigma_px(handle, sigma_px, count) }
        }

        /// Writes `row` and `check` of `count` winners of a row.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_winners_seal"))]
        pub unsafe extern "C" fn stereopsis_winners_seal(
            winners: *mut CWinner,
            count: usize,
            row: u16,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::winners_seal(winners, count, row) }
        }
    };
}

pub use c_api_of_winners;
