//! The functions' names in C.

/// Makes the functions of `stereopsis.h` in this crate, for a method of [`matching`](crate::matching), the
/// longest line and the most disparities: once in a `staticlib` or `cdylib`.
///
/// ```
/// stereopsis::instantiate_c_api!(Fast, width = 160, disparities = 32);
/// # fn main() { assert_eq!(stereopsis_c::stereopsis_max_width(), 160); }
/// ```
///
/// They stand in the module `stereopsis_c`, for callers in Rust. `disparities` is a multiple of 16, at most
/// 256, and `width` at least as large; another choice does not compile. The header is made from this macro's
/// text by `cargo xtask header`, so it is written as plain items.
#[macro_export]
macro_rules! instantiate_c_api {
    ($method:ident, width = $width:expr, disparities = $disparities:expr $(,)?) => {
        #[doc(hidden)]
        type StereopsisInstance =
            $crate::ffi::Instance<$crate::matching::$method, { $width }, { $disparities }>;

        /// The functions of `stereopsis.h`.
        #[allow(unsafe_code, clippy::missing_safety_doc)]
        pub mod stereopsis_c {
            use super::StereopsisInstance;
            use core::ffi::{c_char, c_void};
            use $crate::ffi::{CConfig, CCounters, CNoiseMeter, CRig, CRow, Handle, Status};

            /// The library's interface: a program that was compiled with another `STEREOPSIS_ABI` must not go
            /// on.
            #[unsafe(no_mangle)]
            pub extern "C" fn stereopsis_abi() -> u32 {
                $crate::ffi::STEREOPSIS_ABI
            }

            /// The library's version, such as "1.2.3".
            #[unsafe(no_mangle)]
            pub extern "C" fn stereopsis_version() -> *const c_char {
                $crate::ffi::version_text().as_ptr()
            }

            /// What a status says, in a line without an end; there is a text for every number.
            #[unsafe(no_mangle)]
            pub extern "C" fn stereopsis_status_text(status: i32) -> *const c_char {
                $crate::ffi::status_text(status).as_ptr()
            }

            /// Bytes of memory that a matcher takes.
            #[unsafe(no_mangle)]
            pub extern "C" fn stereopsis_size() -> usize {
                StereopsisInstance::size()
            }

            /// What the memory's address has to be a multiple of; `STEREOPSIS_ALIGN` at most.
            #[unsafe(no_mangle)]
            pub extern "C" fn stereopsis_align() -> usize {
                StereopsisInstance::align()
            }

            /// The longest line that this library was built for, in pixels.
            #[unsafe(no_mangle)]
            pub extern "C" fn stereopsis_max_width() -> usize {
                StereopsisInstance::max_width()
            }

            /// The most disparities that this library was built for.
            #[unsafe(no_mangle)]
            pub extern "C" fn stereopsis_max_disparities() -> usize {
                StereopsisInstance::max_disparities()
            }

            /// Row y comes out when line y + `stereopsis_latency()` goes in; the last rows come by
            /// `stereopsis_flush`.
            #[unsafe(no_mangle)]
            pub extern "C" fn stereopsis_latency() -> usize {
                StereopsisInstance::latency()
            }

            /// Makes a matcher in the caller's memory of `length` bytes, and gives the handle for all other
            /// calls; a null handle on an error, unless `handle` itself is what is wrong.
            ///
            /// The memory needs no content, and is the matcher's alone until `stereopsis_deinit`. Memory that
            /// still holds a matcher, such as RAM that a warm start does not clear, is refused as already
            /// initialised.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_init(
                memory: *mut c_void,
                length: usize,
                handle: *mut *mut Handle,
            ) -> Status {
                // SAFETY: the caller keeps what the function's description asks for.
                unsafe { StereopsisInstance::init(memory, length, handle) }
            }

            /// Ends a matcher; the memory is the caller's again. The handle is the memory's address.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_deinit(handle: *mut Handle) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::deinit(handle) }
            }

            /// Fills a configuration: frames of `width` x `height` pixels, a search over `disparities` from
            /// 0, the checks of a `STEREOPSIS_PRESET_`, and the method's penalties. Sizes are checked by
            /// `stereopsis_start`.
            #[unsafe(no_mangle)]
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

            /// Makes a configuration one for cameras with `noise`, a `STEREOPSIS_NOISE_` such as
            /// `stereopsis_noise_level` tells: sets that, and the checks of a `STEREOPSIS_PRESET_` and
            /// the method's penalties for it. Size, search and `confidence` stay as they are.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_config_noise(
                preset: i32,
                noise: u8,
                config: *mut CConfig,
            ) -> Status {
                // SAFETY: as above.
                unsafe { $crate::ffi::config_noise::<$crate::matching::$method>(preset, noise, config) }
            }

            /// Checks a configuration, which is copied, and gets ready for the first frame. It can be called
            /// again, for another configuration; a frame that is under way is lost, and counters go to
            /// zero.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_start(handle: *mut Handle, config: *const CConfig) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::start(handle, config, false) }
            }

            /// `stereopsis_start` between two frames, for the noise of the one before as it may be: counters
            /// go on, and a frame that is under way counts as broken off. A configuration that is refused
            /// changes nothing.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_restart(
                handle: *mut Handle,
                config: *const CConfig,
            ) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::start(handle, config, true) }
            }

            /// Begins a frame and forgets the one before.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_begin_frame(handle: *mut Handle) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::begin_frame(handle) }
            }

            /// Takes the next line of both cameras, 8-bit grey, `length` bytes each: the configuration's
            /// width. The lines are copied; both may be one array.
            ///
            /// `STEREOPSIS_STATUS_OK` with a row, or `STEREOPSIS_STATUS_NO_ROW_YET` with an empty one for the
            /// first lines of a frame. On an error the row is left as it is.
            #[unsafe(no_mangle)]
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

            /// In place of `stereopsis_push`, of a line that did not come, for a reason of the
            /// `STEREOPSIS_LOST_` numbers: the line above stands in. Rows whose matching window saw it
            /// have no answers and `STEREOPSIS_FLAG_DAMAGED` on every pixel, rows that it can have
            /// touched otherwise keep theirs and have the flag, and every other row is what it would be
            /// without the loss. Answers as `stereopsis_push` does.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_push_lost(
                handle: *mut Handle,
                fault: i32,
                row: *mut CRow,
            ) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::push_lost(handle, fault, row) }
            }

            /// Takes answers of the row that came out last away where a camera did not see, such as the black
            /// border of a rectified image: masks of the left and of the right image's row, `length`
            /// bytes each, 0 for a pixel that was not seen; null where all were. An answer goes, and has
            /// `STEREOPSIS_FLAG_OUTSIDE`, where its own pixel or its partner was not seen. The row's
            /// arrays change in place.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_mask(
                handle: *mut Handle,
                left: *const u8,
                right: *const u8,
                length: usize,
            ) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::mask(handle, left, right, length) }
            }

            /// What was counted since `stereopsis_start`.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_counters(
                handle: *mut Handle,
                counters: *mut CCounters,
            ) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::counters(handle, counters) }
            }

            /// Gives the next row when all lines are in: `STEREOPSIS_STATUS_OK` with a row, or
            /// `STEREOPSIS_STATUS_FRAME_DONE` with an empty one when all are out.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_flush(handle: *mut Handle, row: *mut CRow) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::flush(handle, row) }
            }

            /// Standard deviations of the row that came out last, in px, for `count` columns: all of the row.
            /// Infinite where there is no answer. Before a frame's first row it is
            /// `STEREOPSIS_STATUS_NO_ROW_YET`, and nothing is written.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_sigma_px(
                handle: *mut Handle,
                sigma_px: *mut f32,
                count: usize,
            ) -> Status {
                // SAFETY: as above.
                unsafe { StereopsisInstance::sigma_px(handle, sigma_px, count) }
            }

            /// A meter that has seen no line; it needs no matcher. As often as light may change: measure a
            /// frame, and give what it says to the configuration of the next ones.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_noise_clear(meter: *mut CNoiseMeter) -> Status {
                // SAFETY: as above.
                unsafe { $crate::ffi::noise_clear(meter) }
            }

            /// Measures a line of either camera, 8-bit grey, 65535 bytes at most.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_noise_line(
                meter: *mut CNoiseMeter,
                line: *const u8,
                length: usize,
            ) -> Status {
                // SAFETY: as above.
                unsafe { $crate::ffi::noise_line(meter, line, length) }
            }

            /// The `STEREOPSIS_NOISE_` number of the lines so far, for `stereopsis_config_noise`, and unless
            /// `sigma_16ths` is null the deviation in 1/16 grey level; none and 0 before the first line.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_noise_level(
                meter: *mut CNoiseMeter,
                noise: *mut u8,
                sigma_16ths: *mut u16,
            ) -> Status {
                // SAFETY: as above.
                unsafe { $crate::ffi::noise_level(meter, noise, sigma_16ths) }
            }

            /// Depths of `count` disparities to the nearest millimetre, 0 for none: no answer, at infinity,
            /// or beyond 65.535 m. Both may be one array.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn stereopsis_millimetres(
                rig: *const CRig,
                disparities: *const u16,
                millimetres: *mut u16,
                count: usize,
            ) -> Status {
                // SAFETY: as above.
                unsafe { $crate::ffi::millimetres(rig, disparities, millimetres, count) }
            }
        }
    };
}
