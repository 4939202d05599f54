//! C names of the functions without a state of their own: noise meter and depths.

/// Defines these functions, in the module of [`instantiate_c_api`](crate::instantiate_c_api).
#[doc(hidden)]
#[macro_export]
macro_rules! c_api_without_state {
    ([$($prefix:literal)?]) => {
        /// Clears a noise meter, which needs no matcher. Measure a frame as often as the light may change,
        /// and set the level in the configuration of the next ones.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_noise_clear"))]
        pub unsafe extern "C" fn stereopsis_noise_clear(meter: *mut CNoiseMeter) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::noise_clear(meter) }
        }

        /// Measures a line of either camera, 8-bit grey, 65535 bytes at most.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_noise_line"))]
        pub unsafe extern "C" fn stereopsis_noise_line(
            meter: *mut CNoiseMeter,
            line: *const u8,
            length: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::noise_line(meter, line, length) }
        }

        /// Writes the `STEREOPSIS_NOISE_` number of the lines so far, for `stereopsis_config_noise`, and
        /// unless `sigma_16ths` is null the standard deviation in 1/16 grey level; none and 0 before the
        /// first line.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_noise_level"))]
        pub unsafe extern "C" fn stereopsis_noise_level(
            meter: *mut CNoiseMeter,
            noise: *mut u8,
            sigma_16ths: *mut u16,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::noise_level(meter, noise, sigma_16ths) }
        }

        /// Converts `count` disparities to depths in whole millimetres, 0 for no answer, at infinity, or
        /// beyond 65.535 m. Both arrays may be one.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_millimetres"))]
        pub unsafe extern "C" fn stereopsis_millimetres(
            rig: *const CRig,
            disparities: *const u16,
            millimetres: *mut u16,
            count: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::millimetres(rig, disparities, millimetres, count) }
        }

        /// Converts `count` disparities, with standard deviations as from `stereopsis_sigma_px`, to depths in
        /// metres and their standard deviations: 0 and infinity for no answer, or at infinity. `sigma_px` and
        /// `sigma_m` may be one array, or both null: then depths alone are written. No other two may overlap.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_metres"))]
        pub unsafe extern "C" fn stereopsis_metres(
            rig: *const CRig,
            disparities: *const u16,
            sigma_px: *const f32,
            depth_m: *mut f32,
            sigma_m: *mut f32,
            count: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::metres(rig, disparities, sigma_px, depth_m, sigma_m, count) }
        }

        /// Converts the `count` disparities of row `row`, from its first column on, to points in the left
        /// camera's frame; all 0 for no answer, or at infinity. A row has at most 65535 of them. The arrays
        /// do not overlap.
        #[unsafe(export_name = concat!($($prefix,)? "stereopsis_points"))]
        pub unsafe extern "C" fn stereopsis_points(
            rig: *const CRig,
            row: u16,
            disparities: *const u16,
            points: *mut CPoint,
            count: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe { $crate::ffi::points(rig, row, disparities, points, count) }
        }
    };
}

pub use c_api_without_state;
