//! Correspondences from a file: lines of `x1,y1,x2,y2`.

use crate::command_line;
use crate::limits::{self, MATCHES};
use csv::{ReaderBuilder, StringRecord, Trim};
use std::path::{Path, PathBuf};
use stereopsis::geometry::two_view::Correspondence;

/// The columns of a correspondence: p in the first image, p' in the second, px.
pub const COLUMNS: [&str; 4] = ["x1", "y1", "x2", "y2"];

/// Why a file holds no correspondences: one line that names the file, the line, and what would be right.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct MatchesError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong in it.
    pub fault: MatchesFault,
}

/// What is wrong in a file of correspondences.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MatchesFault {
    /// The operating system refused to open or read the file, or it is no text.
    #[error("cannot be read ({0}); give a text file of x1,y1,x2,y2 lines")]
    Read(csv::Error),
    /// The file has no line.
    #[error("the file is empty; lines of x1,y1,x2,y2 are needed")]
    Empty,
    /// The header does not name a column that is needed.
    #[error("line 1: the column {0} is missing; the header x1,y1,x2,y2 is needed")]
    Column(&'static str),
    /// A line is shorter than the header.
    #[error("line {line}: {column} is missing; x1,y1,x2,y2 are needed")]
    Missing {
        /// The line, from 1.
        line: u64,
        /// The column.
        column: &'static str,
    },
    /// What should be a number is none, or is not finite.
    #[error("line {line}: {column}: '{found}' is not a finite number")]
    NotANumber {
        /// The line, from 1.
        line: u64,
        /// The column.
        column: &'static str,
        /// What stands there.
        found: String,
    },
    /// More lines than are read.
    #[error("there are more than {MATCHES} matches; give fewer")]
    TooMany,
}

/// Reads the file at `path`: comma-separated, with a header that names x1, y1, x2 and y2 in any order and
/// among others, or without one and those four first.
pub fn read_matches(path: &Path) -> Result<Vec<Correspondence<f64>>, MatchesError> {
    read(path).map_err(|fault| MatchesError { path: path.into(), fault })
}

fn read(path: &Path) -> Result<Vec<Correspondence<f64>>, MatchesFault> {
    let mut options = ReaderBuilder::new();
    options.has_headers(false).flexible(true).trim(Trim::All).comment(Some(b'#'));
    let bounded = limits::open(path, limits::TABLE_BYTES).map_err(|e| MatchesFault::Read(e.into()))?;
    let mut reader = options.from_reader(bounded);
    let mut lines = reader.records();
    let first = lines.next().ok_or(MatchesFault::Empty)?.map_err(MatchesFault::Read)?;
    let header = first.iter().all(|word| word.parse::<f64>().is_err());
    let places = if header { places(&first)? } else { [0, 1, 2, 3] };
    let mut seen = Vec::new();
    if !header {
        seen.push(correspondence(&first, places)?);
    }
    for line in lines {
        if seen.len() == MATCHES {
            return Err(MatchesFault::TooMany);
        }
        seen.push(correspondence(&line.map_err(MatchesFault::Read)?, places)?);
    }
    Ok(seen)
}

/// Where the four columns stand.
fn places(header: &StringRecord) -> Result<[usize; 4], MatchesFault> {
    let mut places = [0; 4];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        *place = header.iter().position(|word| word == column).ok_or(MatchesFault::Column(column))?;
    }
    Ok(places)
}

fn correspondence(record: &StringRecord, places: [usize; 4]) -> Result<Correspondence<f64>, MatchesFault> {
    let line = record.position().map_or(0, csv::Position::line);
    let mut numbers = [0.0; 4];
    for ((number, place), column) in numbers.iter_mut().zip(places).zip(COLUMNS) {
        let word = record.get(place).filter(|word| !word.is_empty());
        let word = word.ok_or(MatchesFault::Missing { line, column })?;
        // What is beyond a millionth of a number of f32 is no place in an image either.
        let parsed = word.parse().ok().filter(|number: &f64| number.is_finite() && number.abs() < 1e30);
        *number = parsed.ok_or_else(|| MatchesFault::NotANumber {
            line,
            column,
            found: command_line::word(word),
        })?;
    }
    let [u, v, u2, v2] = numbers;
    Ok(Correspondence::new(u, v, u2, v2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<Vec<Correspondence<f64>>, String> {
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        std::fs::write(file.path(), text).expect("a file");
        read_matches(file.path()).map_err(|e| e.to_string())
    }

    #[test]
    fn columns_are_found_by_name() {
        let expected = Ok(vec![Correspondence::new(1.0, 2.0, 3.0, 4.5)]);
        assert_eq!(of("x1,y1,x2,y2\n1,2,3,4.5\n"), expected);
        assert_eq!(of("1, 2, 3, 4.5, 7\r\n"), expected);
        assert_eq!(of("score,y2,x2,y1,x1\n9,4.5,3,2,1"), expected);
        assert_eq!(of("x1,y1,x2,y2\n"), Ok(Vec::new()));
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, said) in [
            ("", "empty"),
            ("x1,y1,x2\n1,2,3\n", "the column y2 is missing"),
            ("x1,y1,x2,y2\n1,2,3,4\n1,2,3\n", "line 3: y2 is missing"),
            ("x1,y1,x2,y2\n1,2,,4\n", "line 2: x2 is missing"),
            ("1,2,3,4\n1,nan,3,4\n", "line 2: y1: 'nan'"),
            ("1,2,3,4\n1,2,1e300,4\n", "line 2: x2: '1e300'"),
        ] {
            let error = of(text).expect_err(text);
            assert!(error.contains(said), "{text}: {error}");
        }
    }
}
