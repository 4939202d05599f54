//! Where the lens stood: a line for each frame of a stack.

use crate::{command_line, limits};
use csv::{ReaderBuilder, StringRecord, Trim};
use std::path::{Path, PathBuf};
use stereopsis::focus::{LensError, ThinLens};

/// Why a file holds no positions of a lens: one line that names the file and what would be right.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct PositionsError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong in it.
    pub fault: PositionsFault,
}

/// What is wrong in a file of positions.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PositionsFault {
    /// The operating system refused to open or read the file, or it is no text.
    #[error("cannot be read ({0}); give a text file with a line for each frame")]
    Read(csv::Error),
    /// There are fewer lines than frames.
    #[error("has {found} positions for {frames} frames; give one a frame, in the order of their names")]
    Count {
        /// Positions in the file.
        found: usize,
        /// Frames of the stack.
        frames: usize,
    },
    /// There are more lines than frames.
    #[error(
        "has more than {frames} positions for {frames} frames; give one a frame, in the order of their names"
    )]
    TooMany {
        /// Frames of the stack.
        frames: usize,
    },
    /// What should be a number is none.
    #[error("line {line}: '{found}' is not a position in millimetres")]
    NotANumber {
        /// The line, from 1.
        line: u64,
        /// What stands there.
        found: String,
    },
    /// The lens has no answer for it.
    #[error("line {line}: {found} mm: {reason}")]
    Lens {
        /// The line, from 1.
        line: u64,
        /// What stands there.
        found: f64,
        /// Why not.
        reason: LensError,
    },
}

/// What a column of positions tells.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Meaning {
    /// From the lens to the sensor.
    Image,
    /// From the lens to what is in focus.
    Object,
    /// One of the two, told apart by size.
    Either,
}

/// Columns that are known, with what they tell and how many millimetres their unit has.
const COLUMNS: [(&str, Meaning, f64); 7] = [
    ("image_distance_mm", Meaning::Image, 1.0),
    ("sensor_distance_mm", Meaning::Image, 1.0),
    ("focus_distance_mm", Meaning::Object, 1.0),
    ("object_distance_mm", Meaning::Object, 1.0),
    ("focus_distance_m", Meaning::Object, 1000.0),
    ("object_distance_m", Meaning::Object, 1000.0),
    ("position_mm", Meaning::Either, 1.0),
];

/// Reads the file at `path`: for each of `frames` frames the distance between the lens and the sensor, m.
///
/// A header names one of the columns `image_distance_mm` (lens to sensor), `focus_distance_mm` or
/// `focus_distance_m` (lens to what is in focus). Otherwise the last number of a line counts, in mm: if all
/// are at most two focal lengths, they are distances to the sensor, else to what is in focus, which is nearer
/// than that in no picture that is smaller than what it shows.
pub fn read_positions(path: &Path, lens: ThinLens<f64>, frames: usize) -> Result<Vec<f32>, PositionsError> {
    read(path, lens, frames).map_err(|fault| PositionsError { path: path.into(), fault })
}

fn read(path: &Path, lens: ThinLens<f64>, frames: usize) -> Result<Vec<f32>, PositionsFault> {
    let mut options = ReaderBuilder::new();
    options.has_headers(false).flexible(true).trim(Trim::All).comment(Some(b'#'));
    let bounded = limits::open(path, limits::TABLE_BYTES).map_err(|e| PositionsFault::Read(e.into()))?;
    let mut reader = options.from_reader(bounded);
    // The header, and one more than there may be: a file may have no end.
    let records = reader.records().take(frames.saturating_add(2));
    let records: Vec<_> = records.collect::<Result<_, _>>().map_err(PositionsFault::Read)?;
    let header = records.first().filter(|first| first.iter().all(|word| word.parse::<f64>().is_err()));
    let place = |header: &StringRecord| {
        let known = header.iter().enumerate().find_map(|(place, word)| {
            let word = word.to_ascii_lowercase();
            COLUMNS
                .iter()
                .find(|(name, ..)| *name == word)
                .map(|&(_, meaning, unit)| (Some(place), meaning, unit))
        });
        known.unwrap_or((None, Meaning::Either, 1.0))
    };
    let (column, meaning, unit) = header.map_or((None, Meaning::Either, 1.0), place);
    let lines = &records[usize::from(header.is_some())..];
    let mut values = Vec::new();
    for record in lines {
        let line = record.position().map_or(0, csv::Position::line);
        let word = record.get(column.unwrap_or(record.len().saturating_sub(1))).unwrap_or("");
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        values.push((
            line,
            number.ok_or_else(|| PositionsFault::NotANumber { line, found: command_line::word(word) })?
                * unit,
        ));
    }
    if values.len() > frames {
        return Err(PositionsFault::TooMany { frames });
    }
    if values.len() < frames {
        return Err(PositionsFault::Count { found: values.len(), frames });
    }
    let are_near = values.iter().all(|&(_, mm)| mm / 1000.0 <= 2.0 * lens.focal());
    let is_image = meaning == Meaning::Image || meaning == Meaning::Either && are_near;
    let image = |(line, mm): (u64, f64)| {
        let metres = mm / 1000.0;
        let image =
            if is_image { lens.object_distance(metres).map(|_| metres) } else { lens.image_distance(metres) };
        image.map(|image| image as f32).map_err(|reason| PositionsFault::Lens { line, found: mm, reason })
    };
    values.into_iter().map(image).collect()
}
