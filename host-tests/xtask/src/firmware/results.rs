//! A program without sizes to choose, run on one core: what it prints, what it takes, and what it leaves: a
//! file that has to be the host's, and `summary.json`.

use super::frame::{calibrated, figures, instructions};
use super::program::{Optimised, build_plain};
use super::{emulate, log};
use crate::elf::Sizes;
use crate::steps::{Failure, Outcome};
use firmware_boards::Board;
use serde::Serialize;
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use stereopsis_host::output::{OutputError, Staging};

/// What every such program takes. Names and units of the fields are a contract with programs that read
/// `summary.json`.
#[derive(Serialize)]
pub struct Taken {
    pub core: &'static str,
    board: &'static str,
    target: &'static str,
    /// `release` is made for speed, `small` for size.
    profile: &'static str,
    pub static_ram_bytes: u64,
    pub stack_bytes: u64,
    pub flash_bytes: u64,
    pub panic_symbols: usize,
    allocation_symbols: usize,
}

impl Taken {
    /// What it is made for, in words.
    pub fn made_for(&self) -> &'static str {
        if self.profile == Optimised::Speed.profile() { "speed" } else { "size" }
    }

    /// What came of a program, and this, in a line.
    pub fn summary(&self, program: &str, found: &str) -> String {
        let Self { core, profile, static_ram_bytes: ram, stack_bytes: stack, flash_bytes: flash, .. } = self;
        format!("{core}-{program}-{profile}: {found}; RAM {ram} bytes, stack {stack}, flash {flash}")
    }
}

/// A program that ran and left what the host finds.
pub struct Ran {
    /// What it is called in messages.
    name: String,
    board: Board,
    figures: HashMap<String, u64>,
    pub taken: Taken,
}

impl Ran {
    /// Builds the program of this name and runs it; fails when the file `NAME.bin` is not, to the bit, what
    /// the host has for it, when its clock is another, and when it can panic.
    pub fn of(board: Board, program: &str, optimised: Optimised, host: &[u8]) -> Outcome<Self> {
        Self::with(board, program, optimised, &[], host)
    }

    /// The same of a program that reads files, by their names and bytes.
    pub fn with(
        board: Board,
        program: &str,
        optimised: Optimised,
        files: &[(&str, &[u8])],
        host: &[u8],
    ) -> Outcome<Self> {
        let name = format!("{}-{program}-{}", board.core, optimised.profile());
        let failed = |what: String| Failure::new(format!("{name}: {what}"));
        let elf = build_plain(board, program, optimised, "")?;
        let folder = tempfile::tempdir().map_err(|e| failed(e.to_string()))?;
        for (file, bytes) in files {
            let written = fs::write(folder.path().join(file), bytes);
            written.map_err(|e| failed(format!("{file}: {e}")))?;
        }
        let printed = emulate::run_elf(board, &elf, &name, folder.path())?;
        for line in log::read(&elf, &name, folder.path())? {
            println!("{name}: {line}");
        }
        let file = format!("{program}.bin");
        let there = fs::read(folder.path().join(&file)).map_err(|e| failed(format!("{file}: {e}")))?;
        same(&file, &there, host).map_err(failed)?;
        let figures: HashMap<_, _> =
            figures(&printed).into_iter().map(|(name, n)| (name.to_owned(), n)).collect();
        let figure =
            |name: &str| figures.get(name).copied().ok_or_else(|| failed(format!("it prints no {name}")));
        calibrated(board, figure("calibration_ticks")?).map_err(failed)?;
        let sizes = Sizes::of(&elf)?;
        sizes.without_panics()?;
        let taken = Taken {
            core: board.core,
            board: board.machine,
            target: board.target,
            profile: optimised.profile(),
            static_ram_bytes: sizes.static_ram,
            stack_bytes: figure("stack_bytes")?,
            flash_bytes: sizes.flash(),
            panic_symbols: sizes.panics.len(),
            allocation_symbols: sizes.allocations.len(),
        };
        Ok(Self { name, board, figures, taken })
    }

    /// A figure that the program prints.
    pub fn figure(&self, name: &str) -> Outcome<u64> {
        self.figures.get(name).copied().ok_or_else(|| self.failed(format!("it prints no {name}")))
    }

    /// The same, of ticks, in instructions.
    pub fn instructions(&self, ticks: &str) -> Outcome<u64> {
        Ok(instructions(self.board, self.figure(ticks)?))
    }

    /// That this went wrong.
    pub fn failed(&self, what: String) -> Failure {
        Failure::new(format!("{}: {what}", self.name))
    }

    /// Fails with the first that is more than it may be: what it is, how much, the most.
    pub fn within(&self, limits: &[(&str, u64, u64)]) -> Outcome {
        match limits.iter().find(|(_, is, most)| is > most) {
            Some((what, is, most)) => Err(self.failed(format!("{is} {what}, at most {most} may be"))),
            None => Ok(()),
        }
    }
}

/// Whether the board found what the host found; else where their files differ.
fn same(file: &str, board: &[u8], host: &[u8]) -> Result<(), String> {
    if board.len() != host.len() {
        return Err(format!("{file} has {} bytes, the host's {}", board.len(), host.len()));
    }
    match board.iter().zip(host).position(|(a, b)| a != b) {
        Some(at) => Err(format!("byte {at} of {file} is not the host's")),
        None => Ok(()),
    }
}

/// Writes `summary.json` into a folder.
pub fn write(summary: &impl Serialize, out: &Path) -> Outcome {
    let write = || -> Result<(), OutputError> {
        let mut staging = Staging::new(out)?;
        staging.write("summary.json", |file| {
            serde_json::to_writer_pretty(&mut *file, summary)?;
            file.write_all(b"\n")
        })?;
        staging.commit(&[])
    };
    write().map_err(|e| Failure::new(format!("--out: {e}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_bit_makes_a_difference() {
        assert_eq!(same("a.bin", &[1, 2, 3], &[1, 2, 3]), Ok(()));
        assert_eq!(same("a.bin", &[1, 2, 3], &[1, 2, 7]).unwrap_err(), "byte 2 of a.bin is not the host's");
        assert_eq!(same("a.bin", &[1, 2], &[1, 2, 3]).unwrap_err(), "a.bin has 2 bytes, the host's 3");
    }
}
