//! Rows of a stage of the dense path as files: bytes, and text for Verilog's `$readmemh`.
//!
//! A stage has for each row a fixed number of elements of 1, 2, 4 or 8 bytes, the lowest byte first:
//!
//! | stage | elements of a row | bytes of an element, from the lowest |
//! | --- | --- | --- |
//! | `census` | 2 width | the code: all of the left row, then all of the right one |
//! | `cost` | width x disparities | the cost; the disparities of a pixel follow one another |
//! | `aggregated` | width x disparities | the sum over the window or along the paths |
//! | `winner` | width | the 8 bytes of a [`WinnerRecord`](stereopsis::matching::WinnerRecord) |
//! | `left-right` | width | the disparity that the partner keeps, flags |
//! | `subpixel`, `smoothed` | width | 2: disparity, 1/32 px; 65535 for none |
//! | `checked` | width | 2: disparity, flags, 0 |
//! | `final` | width | 2: disparity, flags, confidence (0 where it was not asked for) |
//!
//! What is in the text is the same elements, one a line, as hexadecimal numbers; a comment names each row.

use crate::twin::stages::Stages;
use serde::Serialize;
use std::io::{self, Write};
use std::ops::Range;
use std::str::FromStr;
use stereopsis::units::{Disparity, PixelFlags};

/// A stage whose rows can be written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Stage {
    /// Census codes.
    Census,
    /// What each candidate costs by itself.
    Cost,
    /// What each candidate costs over the window or along the paths.
    Aggregated,
    /// Winners.
    Winner,
    /// What the winners' partners keep, and flags.
    LeftRight,
    /// Answers to a fraction of a pixel.
    Subpixel,
    /// Answers averaged along the row.
    Smoothed,
    /// Answers after the filters over several rows.
    Checked,
    /// What comes out.
    Final,
}

impl Stage {
    /// All of them, in running order.
    pub const ALL: [Self; 9] = [
        Self::Census,
        Self::Cost,
        Self::Aggregated,
        Self::Winner,
        Self::LeftRight,
        Self::Subpixel,
        Self::Smoothed,
        Self::Checked,
        Self::Final,
    ];

    /// The name on the command line and of the files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Census => "census",
            Self::Cost => "cost",
            Self::Aggregated => "aggregated",
            Self::Winner => "winner",
            Self::LeftRight => "left-right",
            Self::Subpixel => "subpixel",
            Self::Smoothed => "smoothed",
            Self::Checked => "checked",
            Self::Final => "final",
        }
    }

    /// Bytes of an element.
    pub const fn element_bytes(self) -> usize {
        match self {
            Self::Census | Self::Cost | Self::Aggregated => 1,
            Self::LeftRight | Self::Subpixel | Self::Smoothed => 2,
            Self::Checked | Self::Final => 4,
            Self::Winner => 8,
        }
    }

    /// The bytes of row `y`.
    pub fn row(self, stages: &Stages, y: usize) -> Vec<u8> {
        let width = stages.answers.width;
        let row = y * width..(y + 1) * width;
        let disparity = |d: &Disparity| d.raw().to_le_bytes();
        let answer = |i: usize, d: Disparity, flags: PixelFlags| {
            let [low, high] = d.raw().to_le_bytes();
            let confidence = stages.answers.confidence.get(i).copied().unwrap_or(0);
            [low, high, flags.bits(), if self == Self::Final { confidence } else { 0 }]
        };
        // Costs of all methods fit a byte.
        let volume = |volume: &crate::twin::cost::Volume| -> Vec<u8> {
            (0..width).flat_map(|x| volume.at(x, y).iter().map(|&cost| cost as u8)).collect()
        };
        match self {
            Self::Census => {
                stages.census.iter().flat_map(|codes| &codes[row.clone()]).map(|&code| code as u8).collect()
            }
            Self::Cost => volume(&stages.costs),
            Self::Aggregated => volume(&stages.aggregated),
            Self::Winner => stages.winners[row].iter().flat_map(|record| record.bytes()).collect(),
            Self::LeftRight => row.flat_map(|i| [stages.winners[i].kept(), stages.flags[i].bits()]).collect(),
            Self::Subpixel => stages.subpixel[row].iter().flat_map(disparity).collect(),
            Self::Smoothed => stages.smoothed[row].iter().flat_map(disparity).collect(),
            Self::Checked => row.flat_map(|i| answer(i, stages.checked.0[i], stages.checked.1[i])).collect(),
            Self::Final => {
                row.flat_map(|i| answer(i, stages.answers.disparity[i], stages.answers.flags[i])).collect()
            }
        }
    }
}

impl FromStr for Stage {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|stage| stage.name() == name)
            .ok_or_else(|| format!("the stages are {}", Self::ALL.map(Self::name).join(", ")))
    }
}

/// What is in the files. Names are a contract with programs that read it.
#[derive(Clone, Debug, Serialize)]
pub struct Manifest {
    /// The version of the library.
    pub version: &'static str,
    /// The stage.
    pub stage: &'static str,
    /// The method.
    pub method: &'static str,
    /// Pixels in a row of the pictures.
    pub width: u16,
    /// Rows of the pictures.
    pub height: u16,
    /// Disparities searched.
    pub disparities: u16,
    /// The smallest one, px.
    pub min_disparity: u16,
    /// Bytes of an element.
    pub element_bytes: usize,
    /// Elements of a row.
    pub elements_per_row: usize,
    /// The first row in the files.
    pub first_row: usize,
    /// The CRC-32 (of IEEE 802.3, as zlib has it) of each row's bytes.
    pub row_crc32: Vec<u32>,
    /// The CRC-32 of all bytes.
    pub crc32: u32,
}

/// Rows of a stage.
pub struct Dump {
    stage: Stage,
    first: usize,
    rows: Vec<Vec<u8>>,
}

impl Dump {
    /// Rows of a stage.
    pub fn new(stage: Stage, stages: &Stages, rows: Range<usize>) -> Self {
        Self { stage, first: rows.start, rows: rows.map(|y| stage.row(stages, y)).collect() }
    }

    /// All rows of a stage, of so many bytes each, as something else made them.
    pub fn of_rows(stage: Stage, bytes: &[u8], row_bytes: usize) -> Self {
        Self { stage, first: 0, rows: bytes.chunks(row_bytes.max(1)).map(<[u8]>::to_vec).collect() }
    }

    /// The stage.
    pub fn stage(&self) -> Stage {
        self.stage
    }

    /// Writes the bytes.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        self.rows.iter().try_for_each(|row| out.write_all(row))
    }

    /// Writes the text for `$readmemh`.
    pub fn write_mem(&self, out: &mut dyn Write) -> io::Result<()> {
        for (y, row) in (self.first..).zip(&self.rows) {
            writeln!(out, "// row {y}")?;
            for element in row.chunks_exact(self.stage.element_bytes()) {
                element.iter().rev().try_for_each(|byte| write!(out, "{byte:02x}"))?;
                writeln!(out)?;
            }
        }
        Ok(())
    }

    /// Says what is in the files; of the search, what is given.
    pub fn manifest(&self, search: &stereopsis::matching::Config, method: &'static str) -> Manifest {
        let bytes = self.stage.element_bytes();
        Manifest {
            version: env!("CARGO_PKG_VERSION"),
            stage: self.stage.name(),
            method,
            width: search.width,
            height: search.height,
            disparities: search.disparities,
            min_disparity: search.min_disparity,
            element_bytes: bytes,
            elements_per_row: self.rows.first().map_or(0, |row| row.len() / bytes),
            first_row: self.first,
            row_crc32: self.rows.iter().map(|row| crc32fast::hash(row)).collect(),
            crc32: crc32fast::hash(&self.rows.concat()),
        }
    }
}
