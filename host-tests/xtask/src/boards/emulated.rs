//! `examples/boards/emulated`: the matchers of the boards as they stand in the boards' folders, in memory of
//! the chips' sizes, held to the host's rows.

use super::{cargo, products};
use crate::pictures::block_rows;
use crate::setup;
use crate::steps::{Failure, Outcome, command, output_within, run as run_command};
use firmware_scenes::scene::{Scene, SceneCamera};
use std::convert::Infallible;
use std::time::Duration;
use stereopsis::camera::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, StereoSource};

/// A program of the package, on an emulated machine with the chip's core.
struct Emulated {
    /// The boards' names.
    of: &'static str,
    program: &'static str,
    target: &'static str,
    machine: &'static str,
    /// The kernel that it has to choose.
    kernel: &'static str,
    scene: Scene,
    camera: Pixels,
}

/// What the cameras' pixels are.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pixels {
    Grey8,
    Rgb565,
}

const SIDE_BY_SIDE: Scene = Scene { width: 160, height: 120 };
const ON_SPI: Scene = Scene { width: 128, height: 128 };
const DISPARITIES: u16 = 32;

const ALL: [Emulated; 4] = [
    Emulated {
        of: "rp2350",
        program: "rp2350",
        target: "thumbv8m.main-none-eabihf",
        machine: "mps2-an505",
        kernel: "dsp",
        scene: SIDE_BY_SIDE,
        camera: Pixels::Grey8,
    },
    Emulated {
        of: "nrf5340",
        program: "spi",
        target: "thumbv8m.main-none-eabihf",
        machine: "mps2-an505",
        kernel: "dsp",
        scene: ON_SPI,
        camera: Pixels::Rgb565,
    },
    Emulated {
        of: "stm32h743",
        program: "stm32h743",
        target: "thumbv7em-none-eabihf",
        machine: "mps2-an500",
        kernel: "dsp",
        scene: SIDE_BY_SIDE,
        camera: Pixels::Grey8,
    },
    Emulated {
        of: "esp32c3",
        program: "spi",
        target: "riscv32imc-unknown-none-elf",
        machine: "virt",
        kernel: "planes",
        scene: ON_SPI,
        camera: Pixels::Rgb565,
    },
];

/// Builds and runs all of them.
pub fn run() -> Outcome {
    setup::firmware(&ALL.each_ref().map(|emulated| emulated.target))?;
    ALL.iter().try_for_each(Emulated::run)
}

impl Emulated {
    fn run(&self) -> Outcome {
        let Self { program, target, .. } = self;
        let words = format!("build --locked --release --target {target} --bin {program}");
        run_command(cargo("emulated", &words).env("CARGO_PROFILE_RELEASE_DEBUG", "false"))?;
        let mut qemu = command(setup::qemu_of(target), &["-machine", self.machine, "-nographic"]);
        if target.starts_with("riscv") {
            qemu.args(["-bios", "none"]);
        }
        qemu.args(["-semihosting-config", "enable=on,target=native", "-kernel"]);
        qemu.arg(products().join(target).join("release").join(program));
        let printed = output_within(&mut qemu, Duration::from_secs(60))?;
        let mut camera = Camera { scene: SceneCamera::new(self.scene), pixels: self.camera };
        let crc32 = crc32fast::hash(&block_rows(&mut camera, DISPARITIES)?);
        let expected = format!("{} rows, crc32 {crc32:08x}, {}", self.scene.height, self.kernel);
        println!("{}: {}", self.of, printed.trim());
        if printed.trim() == expected {
            return Ok(());
        }
        Err(Failure::new(format!("{}: the host has \"{expected}\"", self.of)))
    }
}

/// The scene, as it comes through the pixels of the cameras.
struct Camera {
    scene: SceneCamera,
    pixels: Pixels,
}

impl ErrorType for Camera {
    type Error = Infallible;
}

impl StereoSource for Camera {
    fn format(&self) -> LineFormat {
        self.scene.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        self.scene.start_frame()
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Infallible>> {
        let start = self.scene.next_lines(left, right)?;
        if self.pixels == Pixels::Rgb565 {
            left.iter_mut().chain(right).for_each(|grey| *grey = through_rgb565(*grey));
        }
        Ok(start)
    }
}

/// A grey level in five, six and five bits, and the grey level of those, by ITU-R BT.601: .299, .587 and .114
/// in 256ths.
fn through_rgb565(grey: u8) -> u8 {
    let widened = |bits: u32| {
        let level = u32::from(grey) >> (8 - bits);
        (level << (8 - bits)) + (level >> (2 * bits - 8))
    };
    ((77 * widened(5) + 150 * widened(6) + 29 * widened(5)) / 256) as u8
}
