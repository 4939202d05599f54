//! C names of the functions of line queues.

/// Defines these functions, in the module of [`instantiate_c_api`](crate::instantiate_c_api).
#[doc(hidden)]
#[macro_export]
macro_rules! c_api_of_line_queues {
    ([$($prefix:literal)?]) => {
        use $crate::ffi::{CLine, LineQueueHandle};

        /// Creates a queue of lines of `line_bytes` bytes, 1 to 65535, in the caller's memory of `length`
        /// bytes, aligned to `STEREOPSIS_ALIGN`: as many slots as have room, at least two. Writes the handle;
        /// a null handle on an error, unless `handle` itself is invalid. Fails with
        /// `STEREOPSIS_STATUS_LINE_BYTES` for other lengths, with `STEREOPSIS_STATUS_MEMORY_TOO_SHORT` for
        /// fewer slots.
        ///
        /// One slot less than there are holds lines that wait, among them the one that is being read. So two
        /// slots are enough where each line is done before the next one begins; three let a line come in
        /// while another one is read.
        ///
        /// A queue takes lines from one interrupt, which calls `stereopsis_line_queue_begin` and `_finish`,
        /// to one program, which calls `stereopsis_line_queue_next` and `_done`. Either side may interrupt
        /// the other, on one core or on two; there is no lock. The memory is not read, and belongs to the
        /// queue until `stereopsis_line_queue_deinit`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_line_queue_init"))]
        pub unsafe extern "C" fn stereopsis_line_queue_init(
            memory: *mut c_void,
            length: usize,
            line_bytes: usize,
            handle: *mut *mut LineQueueHandle,
        ) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { $crate::ffi::line_queue_init(memory, length, line_bytes, handle) }
        }

        /// Ends a queue, whose memory returns to the caller: when neither side uses it any more.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_line_queue_deinit"))]
        pub unsafe extern "C" fn stereopsis_line_queue_deinit(handle: *mut LineQueueHandle) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::line_queue_deinit(handle) }
        }

        /// In the interrupt: writes where the next line goes, `line_bytes` bytes aligned to 8, for a DMA or a
        /// loop to fill. Where all slots but one hold lines that wait, the result is
        /// `STEREOPSIS_STATUS_NO_SLOT`, `bytes` is left as it was, and the line counts as lost. A slot that
        /// was not finished is given once more.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_line_queue_begin"))]
        pub unsafe extern "C" fn stereopsis_line_queue_begin(
            handle: *mut LineQueueHandle,
            bytes: *mut *mut u8,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::line_queue_begin(handle, bytes) }
        }

        /// In the interrupt: hands the line of `stereopsis_line_queue_begin` over, with the number of its
        /// frame, its row and its time. Fails with `STEREOPSIS_STATUS_LINE_NOT_BEGUN` without one.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_line_queue_finish"))]
        pub unsafe extern "C" fn stereopsis_line_queue_finish(
            handle: *mut LineQueueHandle,
            frame: u32,
            row: u16,
            timestamp_us: u64,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::line_queue_finish(handle, frame, row, timestamp_us) }
        }

        /// In the program: writes the line that has waited longest, or answers
        /// `STEREOPSIS_STATUS_NO_LINE_YET` and writes nothing. It is the same line until
        /// `stereopsis_line_queue_done`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_line_queue_next"))]
        pub unsafe extern "C" fn stereopsis_line_queue_next(
            handle: *mut LineQueueHandle,
            line: *mut CLine,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::line_queue_next(handle, line) }
        }

        /// In the program: gives the slot of the line of `stereopsis_line_queue_next` back to the interrupt.
        /// Fails with `STEREOPSIS_STATUS_LINE_NOT_TAKEN` without one.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_line_queue_done"))]
        pub unsafe extern "C" fn stereopsis_line_queue_done(handle: *mut LineQueueHandle) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::line_queue_done(handle) }
        }

        /// Writes how many lines have found no slot; either side may ask.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_line_queue_overruns"))]
        pub unsafe extern "C" fn stereopsis_line_queue_overruns(
            handle: *mut LineQueueHandle,
            overruns: *mut u32,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::line_queue_overruns(handle, overruns) }
        }
    };
}

pub use c_api_of_line_queues;
