//! Portable float maps: one 32-bit float a pixel, `Pf`, little-endian, rows from bottom to top.
//!
//! A value of positive infinity says that there is no answer, as in the Middlebury stereo pages' files.

use std::io::{self, BufRead, Read, Write};

/// One float for each pixel, rows from top to bottom.
#[derive(Clone, PartialEq, Debug)]
pub struct FloatMap {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The values, from the top left one.
    pub values: Vec<f32>,
}

/// Why a file is no float map.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PfmError {
    /// The file cannot be read, or ends too soon.
    #[error("{0}")]
    Read(#[from] io::Error),
    /// The header is not `Pf`, two sizes and a scale.
    #[error(
        "a one-channel PFM starts with the lines 'Pf', '<width> <height>' and a scale; line {line} is \
         '{found}'"
    )]
    Header {
        /// The line, from 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// More pixels than an image may have.
    #[error("{width} x {height} pixels are more than 2^28")]
    TooLarge {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
    },
}

/// Writes `values`, `width` in a row from the top, as a PFM file. Values behind the last whole row are left
/// out.
pub fn write(out: &mut dyn Write, width: usize, values: &[f32]) -> io::Result<()> {
    let rows = values.chunks_exact(width.max(1));
    // A negative scale says little-endian.
    write!(out, "Pf\n{width} {}\n-1.0\n", rows.len())?;
    let mut line = Vec::with_capacity(width * 4);
    for row in rows.rev() {
        line.clear();
        row.iter().for_each(|value| line.extend(value.to_le_bytes()));
        out.write_all(&line)?;
    }
    Ok(())
}

/// Reads a one-channel PFM file of either byte order. The scale's size is ignored, as everywhere.
pub fn read(from: &mut dyn BufRead) -> Result<FloatMap, PfmError> {
    let mut header = |line| -> Result<String, PfmError> {
        let mut text = Vec::new();
        // A file of another kind may have no line end for long.
        (&mut *from).take(100).read_until(b'\n', &mut text)?;
        String::from_utf8(text)
            .map(|text| text.trim_end().to_owned())
            .map_err(|_| PfmError::Header { line, found: "binary".into() })
    };
    let bad = |line, found: &str| PfmError::Header { line, found: found.into() };
    let magic = header(1)?;
    if magic != "Pf" {
        return Err(bad(1, &magic));
    }
    let size = header(2)?;
    let sides: Vec<usize> = size.split_ascii_whitespace().filter_map(|side| side.parse().ok()).collect();
    let &[width, height] = sides.as_slice() else { return Err(bad(2, &size)) };
    let scale = header(3)?;
    let little_endian = match scale.parse::<f64>() {
        Ok(value) if value < 0.0 => true,
        Ok(value) if value > 0.0 => false,
        _ => return Err(bad(3, &scale)),
    };
    let pixels = width.checked_mul(height).filter(|&pixels| pixels <= 1 << 28);
    let Some(pixels) = pixels else { return Err(PfmError::TooLarge { width, height }) };
    // It grows with what is there: a header may promise more than the file has.
    let mut bytes = Vec::new();
    (&mut *from).take(pixels as u64 * 4).read_to_end(&mut bytes)?;
    if bytes.len() < pixels * 4 {
        return Err(PfmError::Read(io::ErrorKind::UnexpectedEof.into()));
    }
    let to_float = if little_endian { f32::from_le_bytes } else { f32::from_be_bytes };
    let upwards: Vec<f32> = bytes.as_chunks::<4>().0.iter().map(|&b| to_float(b)).collect();
    let values = upwards.chunks_exact(width.max(1)).rev().flatten().copied().collect();
    Ok(FloatMap { width, height, values })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_rows_are_written_from_the_bottom() {
        let mut file = Vec::new();
        write(&mut file, 1, &[1.0, f32::INFINITY]).expect("memory takes all");
        assert_eq!(file, b"Pf\n1 2\n-1.0\n\x00\x00\x80\x7f\x00\x00\x80\x3f");
        let map = read(&mut file.as_slice()).expect("just written");
        assert_eq!(map, FloatMap { width: 1, height: 2, values: vec![1.0, f32::INFINITY] });
        assert!(matches!(read(&mut &file[..19]), Err(PfmError::Read(_))));
        assert!(matches!(read(&mut b"PF\n1 1\n-1\n".as_slice()), Err(PfmError::Header { line: 1, .. })));
        assert!(matches!(read(&mut b"Pf\n99999 99999\n-1\n".as_slice()), Err(PfmError::TooLarge { .. })));
    }
}
