//! Two views on every core: the table of README.md.

use super::board::{self, Board};
use super::frame::{figures, instructions};
use super::pose::{self, Pose};
use super::program::{Optimised, build_plain};
use super::results::measured;
use super::{emulate, tables};
use crate::elf::Sizes;
use crate::steps::{Failure, Outcome};

/// The part of README.md.
pub const POSE: tables::Part = tables::Part { name: "pose", command: "cargo xtask firmware --all" };

/// What is measured, the smallest board, which has too little RAM, left out. One core of each kind made for size is enough:
/// the others take as much.
const CASES: [(Board, Optimised); 7] = [
    (board::M3, Optimised::Speed),
    (board::M4, Optimised::Speed),
    (board::M7, Optimised::Speed),
    (board::M7, Optimised::Size),
    (board::M33, Optimised::Speed),
    (board::M55, Optimised::Speed),
    (board::RV32, Optimised::Speed),
];

/// The most flash that the eight-point algorithm may take made for size, bytes.
const MOST_EIGHT_POINT: u64 = 4 * 1024;

/// The eight-point algorithm alone.
struct EightPoint {
    instructions: u64,
    flash: u64,
}

/// Measures all of it; writes the table into README.md, or compares it.
pub fn run(readme: tables::Readme) -> Outcome {
    let poses = measured(&CASES, readme, pose::run, Pose::told)?;
    let alone = eight_point()?;
    let part = tables::with_compiler(&table(&poses, &alone))?;
    println!("{part}");
    if alone.flash > MOST_EIGHT_POINT {
        let (flash, most) = (alone.flash, MOST_EIGHT_POINT);
        return Err(Failure::new(format!(
            "the eight-point algorithm takes {flash} bytes of flash, at most {most} may be"
        )));
    }
    tables::into_readme(&POSE, &part, readme)
}

/// The program `eight_point` made for size, and how much flash it has more than without the algorithm.
fn eight_point() -> Outcome<EightPoint> {
    let build = |features: &str| build_plain(board::M7, "eight_point", Optimised::Size, features);
    let (with, without) = (build("")?, build("bare")?);
    let folder = tempfile::tempdir().map_err(|e| Failure::new(e.to_string()))?;
    let printed = emulate::run_elf(board::M7, &with, "m7-eight_point-small", folder.path())?;
    let figures = figures(&printed);
    let figure =
        |name: &str| figures.get(name).copied().ok_or_else(|| Failure::new(format!("eight_point prints no {name}")));
    let instructions = instructions(board::M7, figure("ticks")?) / figure("rounds")?.max(1);
    let sizes = Sizes::of(&with)?;
    sizes.without_panics()?;
    // The one without it has nothing of the library, which `Sizes` does not take for a firmware.
    let flash = sizes.flash().saturating_sub(Sizes::of_any(&without)?.flash());
    Ok(EightPoint { instructions, flash })
}

fn table(poses: &[Pose], alone: &EightPoint) -> String {
    let mut table =
        "| core | made for | F of 8 | F of 128, a third wrong | and pose and points | static RAM | stack | flash | \
                     panic symbols |\n| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n"
            .to_owned();
    for pose in poses {
        let taken = &pose.taken;
        table += &format!(
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
            taken.core,
            taken.made_for(),
            pose.eight_point_instructions,
            pose.robust_instructions,
            pose.instructions,
            taken.static_ram_bytes,
            taken.stack_bytes,
            taken.flash_bytes,
            taken.panic_symbols
        );
    }
    table += &format!(
        "\nThe eight-point algorithm alone, for eight and made for size, takes {} bytes of flash and {} instructions on m7.\n",
        alone.flash, alone.instructions
    );
    table
}
