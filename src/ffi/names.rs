//! C names of the functions, made by a macro: those of the matcher here, the others in the files beside.

/// Defines the functions of `stereopsis.h`, once in a `staticlib` or `cdylib`, for a method of
/// [`matching`](crate::matching), the longest line and the largest number of disparities.
///
/// ```
/// stereopsis::instantiate_c_api!(Fast, width = 160, disparities = 32);
/// # fn main() { assert_eq!(stereopsis_c::stereopsis_max_width(), 160); }
/// ```
///
/// Rust callers find them in the module `stereopsis_c`. `disparities` is a multiple of 16, at most 256, and
/// `width` at least as large; another does not compile. `cargo xtask header` makes the header from this text.
///
/// In this order, each may be left out: `height`, the rows of the largest rectified image (else `width`);
/// `lines`, the raw lines of each camera that a rectifier holds, one of which is a copy (else 33); and
/// `prefix`, which begins the functions' names in C, so that a program may have several instances:
///
/// ```
/// mod near {
///     stereopsis::instantiate_c_api!(Fast, width = 160, disparities = 64, prefix = "near_");
/// }
/// mod far {
///     stereopsis::instantiate_c_api!(Sgm, width = 320, disparities = 32, lines = 40, prefix = "far_");
/// }
/// # fn main() {
/// assert!(near::stereopsis_c::stereopsis_size() < far::stereopsis_c::stereopsis_size());
/// # }
/// ```
#[macro_export]
macro_rules! instantiate_c_api {
    ($method:ident, width = $width:expr, disparities = $disparities:expr
     $(, height = $height:expr)? $(, lines = $lines:expr)? $(, prefix = $prefix:literal)? $(,)?) => {
        #[doc(hidden)]
        type StereopsisRectifier = $crate::ffi::Rectifier<
            { $crate::ffi::rectifier_width($width) }, { $crate::ffi::first_of([$($lines,)? 33]) },
            { $crate::ffi::rectifier_slots($width, $crate::ffi::first_of([$($height,)? $width])) },
        >;
        $crate::ffi::instantiate_c_api!(@functions $method, $width, $disparities, [$($prefix)?]);
    };
    (@functions $method:ident, $width:expr, $disparities:expr, [$($prefix:literal)?]) => {
        #[doc(hidden)]
        type StereopsisInstance =
            $crate::ffi::Instance<$crate::matching::$method, { $width }, { $disparities }>;

        /// The functions of `stereopsis.h`.
        #[allow(unsafe_code, clippy::missing_safety_doc)]
        pub mod stereopsis_c {
            use super::{StereopsisInstance, StereopsisRectifier};
            use core::ffi::{c_char, c_void};
            use $crate::ffi::{
                CCameras, CConfig, CCounters, CNoiseMeter, CPoint, CRig, CRow, Handle, RectifierHandle,
                Status,
            };

            /// Returns the version of the library's interface: a program compiled with another
            /// `STEREOPSIS_ABI` must not continue.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_abi"))]
            pub extern "C" fn stereopsis_abi() -> u32 {
                $crate::ffi::STEREOPSIS_ABI
            }

            /// Returns the library's version, such as "1.2.3".
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_version"))]
            pub extern "C" fn stereopsis_version() -> *const c_char {
                $crate::ffi::version_text().as_ptr()
            }

            /// Returns the text of any number as a status, one line without an end.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_status_text"))]
            pub extern "C" fn stereopsis_status_text(status: i32) -> *const c_char {
                $crate::ffi::status_text(status).as_ptr()
            }

            /// Returns the bytes of memory that a matcher takes.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_size"))]
            pub extern "C" fn stereopsis_size() -> usize {
                StereopsisInstance::size()
            }

            /// Returns the alignment that a matcher's memory needs, at most `STEREOPSIS_ALIGN`.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_align"))]
            pub extern "C" fn stereopsis_align() -> usize {
                StereopsisInstance::align()
            }

            /// Returns the longest line that this library was built for, in pixels.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_max_width"))]
            pub extern "C" fn stereopsis_max_width() -> usize {
                StereopsisInstance::max_width()
            }

            /// Returns the largest number of disparities that this library was built for.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_max_disparities"))]
            pub extern "C" fn stereopsis_max_disparities() -> usize {
                StereopsisInstance::max_disparities()
            }

            /// Returns the delay in lines: row y comes out when line y + `stereopsis_latency()` goes in; the
            /// last rows come by `stereopsis_flush`.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_latency"))]
            pub extern "C" fn stereopsis_latency() -> usize {
                StereopsisInstance::latency()
            }

            /// Creates a matcher in the caller's memory of `length` bytes, and writes the handle for all
            /// other calls; a null handle on an error, unless `handle` itself is invalid.
            ///
            /// The memory needs no content, and belongs to the matcher until `stereopsis_deinit`. Memory that
            /// still holds a matcher, such as RAM that a warm start does not clear, is refused as already
            /// initialised.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_init"))]
            pub unsafe extern "C" fn stereopsis_init(
                memory: *mut c_void,
                length: usize,
                handle: *mut *mut Handle,
            ) -> Status {
                // SAFETY: the caller keeps what the function's description asks for.
                unsafe { StereopsisInstance::init(memory, length, false, handle) }
            }

            /// Creates a matcher in memory that was never written, such as that of `malloc`: it is not read,
            /// and a matcher that it still holds is overwritten.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_init_fresh"))]
            pub unsafe extern "C" fn stereopsis_init_fresh(
                memory: *mut c_void,
                length: usize,
                handle: *mut *mut Handle,
            ) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::init(memory, length, true, handle) }
            }

            /// Ends a matcher, whose memory returns to the caller. The handle is the memory's address.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_deinit"))]
            pub unsafe extern "C" fn stereopsis_deinit(handle: *mut Handle) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::deinit(handle) }
            }

            /// Fills a configuration: frames of `width` x `height` pixels, a search over `disparities` from
            /// 0, the checks of a `STEREOPSIS_PRESET_`, and the method's penalties. Sizes are checked by
            /// `stereopsis_start`.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_config_default"))]
            pub unsafe extern "C" fn stereopsis_config_default(
                width: u16,
                height: u16,
                disparities: u16,
                preset: i32,
                config: *mut CConfig,
            ) -> Status {
                // SAFETY: as above.
                unsafe {
                    $crate::ffi::config_default::<$crate::matching::$method>(
                        width,
                        height,
                        disparities,
                        preset,
                        config,
                    )
                }
            }

            /// Sets a configuration's `noise`, a `STEREOPSIS_NOISE_` as from `stereopsis_noise_level`, with
            /// the checks of a `STEREOPSIS_PRESET_` and the method's penalties for it. Size, search and
            /// confidences are kept.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_config_noise"))]
            pub unsafe extern "C" fn stereopsis_config_noise(
                preset: i32,
                noise: u8,
                config: *mut CConfig,
            ) -> Status {
                // SAFETY: as above.
                unsafe { $crate::ffi::config_noise::<$crate::matching::$method>(preset, noise, config) }
            }

            /// Checks a configuration, which is copied, and prepares for the first frame. Another call drops
            /// a frame that is under way, and clears the counters.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_start"))]
            pub unsafe extern "C" fn stereopsis_start(handle: *mut Handle, config: *const CConfig) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::start(handle, config, false) }
            }

            /// Changes the configuration between two frames, for instance for the noise of the last one:
            /// counters continue, and a frame that is under way counts as broken. A refused configuration
            /// changes nothing.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_restart"))]
            pub unsafe extern "C" fn stereopsis_restart(
                handle: *mut Handle,
                config: *const CConfig,
            ) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::start(handle, config, true) }
            }

            /// Begins a frame, and drops the one before.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_begin_frame"))]
            pub unsafe extern "C" fn stereopsis_begin_frame(handle: *mut Handle) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::begin_frame(handle) }
            }

            /// Takes the next line of both cameras, 8-bit grey, `length` bytes each, which is the
            /// configuration's width. The lines are copied; both may be one array.
            ///
            /// Returns `STEREOPSIS_STATUS_OK` with a row, or `STEREOPSIS_STATUS_NO_ROW_YET` with an empty one
            /// for the first lines of a frame. An error leaves the row unchanged.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_push"))]
            pub unsafe extern "C" fn stereopsis_push(
                handle: *mut Handle,
                left: *const u8,
                right: *const u8,
                length: usize,
                row: *mut CRow,
            ) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::push(handle, left, right, length, row) }
            }

            /// Takes the line above in place of a lost one, with the `STEREOPSIS_LOST_` number of its fault,
            /// where `stereopsis_push` would be called. Rows whose matching window contains the lost line
            /// have no answers and `STEREOPSIS_FLAG_DAMAGED` on every pixel, rows that it affects otherwise
            /// keep theirs and have the flag, and every other row is what it would be without the loss.
            /// Returns what `stereopsis_push` returns.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_push_lost"))]
            pub unsafe extern "C" fn stereopsis_push_lost(
                handle: *mut Handle,
                fault: i32,
                row: *mut CRow,
            ) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::push_lost(handle, fault, row) }
            }

            /// Removes answers of the last row at pixels that a camera did not see, such as the black border
            /// of a rectified image. The masks of the left and the right image's row have `length` bytes
            /// each, 0 for an unseen pixel; a null mask means that all were seen. An answer whose pixel or
            /// partner was not seen is removed and flagged `STEREOPSIS_FLAG_OUTSIDE`. The row's arrays change
            /// in place. Before a frame's first row the result is `STEREOPSIS_STATUS_NO_ROW_YET`.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_mask"))]
            pub unsafe extern "C" fn stereopsis_mask(
                handle: *mut Handle,
                left: *const u8,
                right: *const u8,
                length: usize,
            ) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::mask(handle, left, right, length) }
            }

            /// Writes the counts since `stereopsis_start`.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_counters"))]
            pub unsafe extern "C" fn stereopsis_counters(
                handle: *mut Handle,
                counters: *mut CCounters,
            ) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::counters(handle, counters) }
            }

            /// Gives the next row after the last line: `STEREOPSIS_STATUS_OK` with a row, or
            /// `STEREOPSIS_STATUS_FRAME_DONE` with an empty one after the last row.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_flush"))]
            pub unsafe extern "C" fn stereopsis_flush(handle: *mut Handle, row: *mut CRow) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::flush(handle, row) }
            }

            /// Writes the standard deviations of the last row, px, for all its `count` columns, infinite
            /// where there is no answer. Before a frame's first row the result is
            /// `STEREOPSIS_STATUS_NO_ROW_YET`, and nothing is written.
            #[unsafe(export_name = concat!($($prefix,)? "stereopsis_sigma_px"))]
            pub unsafe extern "C" fn stereopsis_sigma_px(
                handle: *mut Handle,
                sigma_px: *mut f32,
                count: usize,
            ) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::sigma_px(handle, sigma_px, count) }
            }

            $crate::ffi::c_api_of_winners!([$($prefix)?]);
            $crate::ffi::c_api_of_line_queues!([$($prefix)?]);
            $crate::ffi::c_api_of_rectification!([$($prefix)?]);
            $crate::ffi::c_api_without_state!([$($prefix)?]);
            $crate::ffi::c_api_before_and_after!([$($prefix)?]);
            $crate::ffi::c_api_of_two_views!([$($prefix)?]);
            $crate::ffi::c_api_of_features!([$($prefix)?]);
            $crate::ffi::c_api_of_focus_and_motion!([$($prefix)?]);
            $crate::ffi::c_api_of_obstacles!([$($prefix)?]);
        }
    };
}

/// Returns the first of one or two values: that of a macro's caller, or the default.
pub const fn first_of<const N: usize>(values: [usize; N]) -> usize {
    assert!(N > 0, "there is a default");
    values[0]
}
pub use instantiate_c_api;
