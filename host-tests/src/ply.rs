//! Coloured point clouds as binary little-endian PLY files.
//!
//! Coordinates are metres in the left camera's frame: X right, Y down, Z forward. A viewer whose Y points up
//! shows the cloud upside down until it is turned half round the X axis.

use std::io::{self, Write};

/// A point in metres with the colour of its pixel.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct ColouredPoint {
    /// X, Y and Z in the left camera's frame, m.
    pub position_m: [f32; 3],
    /// Red, green, blue.
    pub colour: [u8; 3],
}

/// Writes the points in their order.
pub fn write(out: &mut dyn Write, points: &[ColouredPoint]) -> io::Result<()> {
    write_in(out, points, "metres")
}

/// The same with a length of one that is another.
pub fn write_in(out: &mut dyn Write, points: &[ColouredPoint], unit: &str) -> io::Result<()> {
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\ncomment {unit}; X right, Y down, Z forward from the \
         camera, of a pair the left one\nelement vertex {}\nproperty float x\nproperty float y\nproperty \
         float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
        points.len()
    )?;
    for point in points {
        let mut record = [0; 15];
        for (bytes, coordinate) in record.as_chunks_mut::<4>().0.iter_mut().zip(point.position_m) {
            *bytes = coordinate.to_le_bytes();
        }
        record[12..].copy_from_slice(&point.colour);
        out.write_all(&record)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vertex_has_fifteen_bytes_behind_the_header() {
        let mut file = Vec::new();
        write(&mut file, &[ColouredPoint { position_m: [1.0, -2.0, 0.5], colour: [9, 8, 7] }])
            .expect("memory takes all");
        let header = file.windows(11).position(|w| w == b"end_header\n").expect("a header") + 11;
        assert_eq!(&file[header..], b"\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f\x09\x08\x07");
        assert!(file.windows(16).any(|w| w == b"element vertex 1"));
    }
}
