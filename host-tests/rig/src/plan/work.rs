//! What a search takes of a microcontroller: estimates from what was measured.
//!
//! The work of a frame is that of its pixels. For a pixel it grows with the disparities as the measured sizes
//! of that core and method have it: along a straight line between them, and outside of them as the table of
//! growth has it: of a Cortex-M55 for a method in vectors, else of a Cortex-M4. So it is exact at the sizes
//! that were measured.
//!
//! The static RAM of a measured width and number of disparities is that of the measured program. Of any other
//! it is a bound that holds on every core, up to 3.1 KB above what a core takes.

use super::measured::{Growth, Measured, firmware, growth};
use crate::method::MethodName;
use serde::Serialize;
use stereopsis::geometry::camera::ImageSize;

/// The cores that were measured, and the clock of a well-known microcontroller with each: nRF51, STM32F1,
/// STM32F4, STM32H7, RP2350, Ensemble E7, RP2350; the last one's is that of a soft core. MHz.
pub const CORES: [(&str, f64); 8] = [
    ("m0", 16.0),
    ("m3", 72.0),
    ("m4", 168.0),
    ("m7", 480.0),
    ("m33", 150.0),
    ("m55", 400.0),
    ("rv32", 150.0),
    ("rv32v", 100.0),
];

/// What a method takes on a core. Names are those of `stereo plan --json`.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Work {
    /// The core's short name.
    pub core: &'static str,
    /// The method's name.
    pub method: &'static str,
    /// Estimated instructions for a frame.
    pub instructions: f64,
    /// The clock, MHz.
    pub clock_mhz: f64,
    /// Estimated frames in a second, at one instruction a clock.
    pub frames_per_s: f64,
    /// Bytes of static RAM: those of the measured program, or those that the pipeline takes at most.
    pub ram_bytes: usize,
    /// Whether the bytes of RAM were measured at this width and number of disparities.
    pub ram_is_measured: bool,
    /// Bytes of stack that were in use at the measured sizes, at most.
    pub stack_bytes: u32,
    /// Bytes of flash of the measured programs, at most: the dense path and the program around it.
    pub flash_bytes: u32,
}

/// The tables, read once.
pub struct Tables {
    firmware: Vec<Measured>,
    growth: Vec<Growth>,
}

impl Tables {
    /// Those of this build.
    pub fn read() -> Self {
        Self { firmware: firmware(), growth: growth() }
    }

    /// What a search takes; `None` where the method was not measured on the core.
    pub fn work(
        &self,
        core: &'static str,
        clock_mhz: f64,
        method: MethodName,
        size: ImageSize,
        disparities: u16,
    ) -> Option<Work> {
        let measured: Vec<_> =
            self.firmware.iter().filter(|m| m.core == core && m.method == method).collect();
        let points: Vec<_> = measured.iter().map(|m| (m.disparities, m.per_pixel)).collect();
        let per_pixel = self.per_pixel(core, method, &points, disparities)?;
        let instructions = per_pixel * f64::from(size.width) * f64::from(size.height);
        let ram = self.ram_bytes(core, method, size.width, disparities);
        Some(Work {
            core,
            method: method.name(),
            instructions,
            clock_mhz,
            frames_per_s: clock_mhz * 1e6 / instructions,
            ram_bytes: ram.unwrap_or_else(|| method.pipeline_bytes(size.width, disparities)),
            ram_is_measured: ram.is_some(),
            stack_bytes: measured.iter().map(|m| m.stack_bytes).max()?,
            flash_bytes: measured.iter().map(|m| m.flash_bytes).max()?,
        })
    }

    /// Bytes of static RAM that were measured, which do not depend on the images' height; `None` where the
    /// width or the number of disparities was not measured.
    fn ram_bytes(&self, core: &str, method: MethodName, width: u16, disparities: u16) -> Option<usize> {
        let is_it =
            |m: &&Measured| (m.core, m.method, m.width, m.disparities) == (core, method, width, disparities);
        self.firmware.iter().find(is_it).map(|m| m.ram_bytes as usize)
    }

    /// Instructions for a pixel, from those at the measured numbers of disparities, which ascend.
    fn per_pixel(
        &self,
        core: &str,
        method: MethodName,
        points: &[(u16, f64)],
        disparities: u16,
    ) -> Option<f64> {
        let (&first, &last) = (points.first()?, points.last()?);
        let (at, known) = if disparities < first.0 { first } else { last };
        if (first.0..=last.0).contains(&disparities) {
            return Some(between(points, disparities));
        }
        let grows_as = if method.compares_brightness() { MethodName::Sgm } else { MethodName::Block };
        let is_in_vectors = core == "m55" || core == "rv32v" && grows_as == MethodName::Sgm;
        let core = if is_in_vectors { "m55" } else { "m4" };
        let growth = self.growth.iter().find(|growth| growth.core == core && growth.method == grows_as)?;
        Some(known * between(&growth.points, disparities) / between(&growth.points, at))
    }
}

/// On the straight lines between points that ascend; outside of them as far in proportion from the nearest
/// one.
fn between(points: &[(u16, f64)], at: u16) -> f64 {
    let at = f64::from(at);
    for pair in points.windows(2) {
        let [(x0, y0), (x1, y1)] = [pair[0], pair[1]].map(|(x, y)| (f64::from(x), y));
        if (x0..=x1).contains(&at) {
            return y0 + (y1 - y0) * (at - x0) / (x1 - x0);
        }
    }
    let nearest = points.first().filter(|(x, _)| at < f64::from(*x)).or(points.last());
    nearest.map_or(0.0, |&(x, y)| y * at / f64::from(x))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn instructions(core: &'static str, method: MethodName, size: (u16, u16), disparities: u16) -> f64 {
        let size = ImageSize { width: size.0, height: size.1 };
        Tables::read().work(core, 100.0, method, size, disparities).expect("it was measured").instructions
    }

    /// Lines of `docs/performance.md`.
    #[test]
    fn what_was_measured_is_said_as_it_was() {
        let page = include_str!("../../../../docs/performance.md");
        for (core, method, size, disparities) in [
            ("m4", MethodName::Fast, (160, 120), 32),
            ("m4", MethodName::Sgm, (320, 240), 64),
            ("m55", MethodName::Block, (320, 240), 64),
            ("m0", MethodName::SgmEdge, (96, 64), 16),
        ] {
            let line = format!("| {core} | `{method}` | {}x{} | {disparities} | ", size.0, size.1);
            let number = page.split(&line).nth(1).and_then(|rest| rest.split(' ').next());
            let number: f64 = number.and_then(|n| n.parse().ok()).expect("the line is there");
            assert!((instructions(core, method, size, disparities) - number).abs() < 1e-6 * number);
        }
    }

    /// A core's program takes less than the bound of all cores, and is not said to take the bound.
    #[test]
    fn memory_is_that_of_the_core_where_it_was_measured() {
        let tables = Tables::read();
        for m in firmware() {
            let size = ImageSize { width: m.width, height: 120 };
            let work = tables.work(m.core, 100.0, m.method, size, m.disparities).expect("it was measured");
            assert_eq!((work.ram_bytes, work.ram_is_measured), (m.ram_bytes as usize, true), "{m:?}");
            let bound = m.method.pipeline_bytes(m.width, m.disparities);
            assert!((bound - 3100..=bound).contains(&work.ram_bytes), "{m:?}: {bound}");
            let size = ImageSize { width: m.width + 4, height: 120 };
            let work = tables.work(m.core, 100.0, m.method, size, m.disparities).expect("it was measured");
            let bound = m.method.pipeline_bytes(m.width + 4, m.disparities);
            assert_eq!((work.ram_bytes, work.ram_is_measured), (bound, false), "{m:?}");
        }
    }

    /// The other sizes of the table of growth, of 640x60 pixels: a narrow picture costs more for each pixel.
    #[test]
    fn what_was_measured_at_other_sizes_is_near() {
        for Growth { core, method, points } in growth() {
            for (disparities, per_pixel) in points {
                let estimate = instructions(core, method, (640, 60), disparities) / f64::from(640 * 60);
                let off = estimate / per_pixel - 1.0;
                assert!(off.abs() < 0.2, "{core} {method} {disparities}: {off}");
            }
        }
    }

    #[test]
    fn every_core_was_measured_with_every_method() {
        for (core, _) in CORES {
            for method in MethodName::ALL {
                assert!(instructions(core, method, (320, 240), 128) > 1e6, "{core} {method}");
            }
        }
    }
}
