//! Two views on every core, and the eight-point algorithm alone.

use super::frame::{figures, instructions};
use super::pose::{self, Pose};
use super::program::{Optimised, build_plain};
use super::tables::Readme;
use super::{emulate, plain};
use crate::elf::Sizes;
use crate::steps::{Failure, Outcome};
use firmware_boards as board;

/// The most flash that the eight-point algorithm may take made for size, bytes.
const MOST_EIGHT_POINT: u64 = 4 * 1024;

/// The eight-point algorithm alone.
struct EightPoint {
    instructions: u64,
    flash: u64,
}

/// Measures all of it; writes the table into docs/performance.md, or compares it.
pub fn run(readme: Readme) -> Outcome {
    let poses = plain::measured(readme, pose::run, Pose::summary)?;
    let EightPoint { instructions, flash } = eight_point()?;
    if flash > MOST_EIGHT_POINT {
        return Err(Failure::new(format!(
            "the eight-point algorithm takes {flash} bytes of flash, at most {MOST_EIGHT_POINT} may be"
        )));
    }
    let alone = format!(
        "\nThe eight-point algorithm alone, for eight and made for size, takes {flash} bytes of flash and \
         {instructions} instructions on m7.\n"
    );
    plain::into_readme::<Pose>(&(plain::table(&poses) + &alone), readme)
}

/// The program `eight_point` made for size, and how much flash it has more than without the algorithm.
fn eight_point() -> Outcome<EightPoint> {
    let build = |features: &str| build_plain(board::M7, "eight_point", Optimised::Size, features);
    let (with, without) = (build("")?, build("bare")?);
    let folder = tempfile::tempdir().map_err(|e| Failure::new(e.to_string()))?;
    let printed = emulate::run_elf(board::M7, &with, "m7-eight_point-small", folder.path())?;
    let figures = figures(&printed);
    let figure = |name: &str| {
        figures.get(name).copied().ok_or_else(|| Failure::new(format!("eight_point prints no {name}")))
    };
    let instructions = instructions(board::M7, figure("ticks")?) / figure("rounds")?.max(1);
    let sizes = Sizes::of(&with)?;
    sizes.without_panics()?;
    // The one without it has nothing of the library, which `Sizes` does not take for a firmware.
    let flash = sizes.flash().saturating_sub(Sizes::of_any(&without)?.flash());
    Ok(EightPoint { instructions, flash })
}
