//! C names of the functions for calibration records and rectification.

/// Defines these functions, in the module of [`instantiate_c_api`](crate::instantiate_c_api).
#[doc(hidden)]
#[macro_export]
macro_rules! c_api_of_rectification {
    ([$($prefix:literal)?]) => {
        /// Checks a calibration record, what `stereo calib convert --to c` writes, in the first
        /// `STEREOPSIS_RECORD_BYTES` of `length` bytes, which need no alignment, and writes what it says
        /// about the raw images.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_record_read"))]
        pub unsafe extern "C" fn stereopsis_record_read(
            record: *const u8,
            length: usize,
            cameras: *mut CCameras,
        ) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { $crate::ffi::record_read(record, length, cameras) }
        }

        /// Returns the bytes of memory that a rectifier takes.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_rectifier_size"))]
        pub extern "C" fn stereopsis_rectifier_size() -> usize {
            StereopsisRectifier::size()
        }

        /// Returns the raw lines of each camera that a rectifier of this library holds, one of which is a
        /// copy.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_rectifier_lines"))]
        pub extern "C" fn stereopsis_rectifier_lines() -> usize {
            StereopsisRectifier::lines()
        }

        /// Creates a rectifier in the caller's memory of `length` bytes, aligned to `STEREOPSIS_ALIGN`, and
        /// writes the handle for its other calls; a null handle on an error, unless `handle` itself is
        /// invalid.
        ///
        /// The memory is not read, and belongs to the rectifier until `stereopsis_rectifier_deinit`.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_rectifier_init"))]
        pub unsafe extern "C" fn stereopsis_rectifier_init(
            memory: *mut c_void,
            length: usize,
            handle: *mut *mut RectifierHandle,
        ) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { StereopsisRectifier::init(memory, length, handle) }
        }

        /// Ends a rectifier, whose memory returns to the caller. The handle is the memory's address.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_rectifier_deinit"))]
        pub unsafe extern "C" fn stereopsis_rectifier_deinit(handle: *mut RectifierHandle) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { StereopsisRectifier::deinit(handle) }
        }

        /// Reads a calibration record and prepares its rectification, which is for lines of both cameras in
        /// step, into images of `width` x `height` pixels. `alpha` is OpenCV's: from 0, nothing but what both
        /// cameras see, to 1, all of both raw images; `STEREOPSIS_ALPHA_NATURAL` keeps the scale of the raw
        /// images. Writes the rectified rig for depths and, unless `lines` is null, how many lines a
        /// rectifier needs to hold for it, which is at least so many where the result is
        /// `STEREOPSIS_STATUS_RECTIFY_LINES`.
        ///
        /// It is in single precision: every core finds the same lines. A record or sizes that are refused
        /// leave the rectifier as it was; after `STEREOPSIS_STATUS_RECTIFY_LINES` or
        /// `STEREOPSIS_STATUS_RECTIFY_BENT` it is not started.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_rectifier_start"))]
        pub unsafe extern "C" fn stereopsis_rectifier_start(
            handle: *mut RectifierHandle,
            record: *const u8,
            length: usize,
            width: u16,
            height: u16,
            alpha: f32,
            rig: *mut CRig,
            lines: *mut usize,
        ) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { StereopsisRectifier::start(handle, record, length, [width, height], alpha, rig, lines) }
        }

        /// Begins a frame, and drops the one before.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_rectifier_begin_frame"))]
        pub unsafe extern "C" fn stereopsis_rectifier_begin_frame(handle: *mut RectifierHandle) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { StereopsisRectifier::begin_frame(handle) }
        }

        /// Takes the next raw line of both cameras, 8-bit grey, `length` bytes each, which is the record's
        /// width. The lines are copied; both may be one array.
        ///
        /// Returns `STEREOPSIS_STATUS_OK` where `stereopsis_rectifier_line` has lines, all of which have to
        /// be taken before the next raw line, else `STEREOPSIS_STATUS_NO_ROW_YET`;
        /// `STEREOPSIS_STATUS_FRAME_DONE` for raw lines below the last rectified one, which need not be
        /// pushed.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_rectifier_push"))]
        pub unsafe extern "C" fn stereopsis_rectifier_push(
            handle: *mut RectifierHandle,
            left: *const u8,
            right: *const u8,
            length: usize,
        ) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { StereopsisRectifier::push(handle, left, right, length) }
        }

        /// Takes the raw lines above again in place of lost ones, zeros for a frame's first ones, and returns
        /// what `stereopsis_rectifier_push` does.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_rectifier_push_lost"))]
        pub unsafe extern "C" fn stereopsis_rectifier_push_lost(handle: *mut RectifierHandle) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { StereopsisRectifier::push_lost(handle) }
        }

        /// Writes the next rectified line of both cameras, in the order of their rows, `length` bytes each,
        /// which is the rectified width, for `stereopsis_push`. A pixel that a camera does not see is 0.
        ///
        /// Returns `STEREOPSIS_STATUS_OK` with lines, `STEREOPSIS_STATUS_NO_ROW_YET` where raw lines are
        /// needed, `STEREOPSIS_STATUS_LOST` for a row that needs a lost one, for `stereopsis_push_lost`, and
        /// `STEREOPSIS_STATUS_FRAME_DONE` after the last row.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_rectifier_line"))]
        pub unsafe extern "C" fn stereopsis_rectifier_line(
            handle: *mut RectifierHandle,
            left: *mut u8,
            right: *mut u8,
            length: usize,
        ) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { StereopsisRectifier::line(handle, left, right, length) }
        }

        /// Writes which pixels of a rectified row each camera sees, 1 or 0, `length` bytes each, for
        /// `stereopsis_mask` when that row of disparities comes out. It needs no frame.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_rectifier_mask"))]
        pub unsafe extern "C" fn stereopsis_rectifier_mask(
            handle: *mut RectifierHandle,
            row: u16,
            left: *mut u8,
            right: *mut u8,
            length: usize,
        ) -> Status {
            // SAFETY: the caller keeps what the description asks for.
            unsafe { StereopsisRectifier::mask(handle, row, left, right, length) }
        }
    };
}

pub use c_api_of_rectification;
