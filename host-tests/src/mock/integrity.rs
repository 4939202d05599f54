//! Whether a file is whole, for the formats whose decoders accept half a file.
//!
//! The JPEG decoder fills what is missing with grey and says nothing; the PNG decoder stops reading after the
//! last row. Both formats have an end mark, and their segments say how long they are, so the walk costs no
//! decoding.

/// What the walk through a file's segments found.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Integrity {
    /// The end mark is there.
    Whole,
    /// The file ends before its end mark.
    Truncated,
    /// A segment is not what the format has at this place.
    Corrupt(&'static str),
}

/// Walks the chunks of a PNG file up to IEND.
pub(super) fn png(file: &[u8]) -> Integrity {
    let mut rest = file.get(8..).unwrap_or(&[]);
    loop {
        // A chunk: length of its data, name, data, check sum.
        let Some((&[a, b, c, d, n0, n1, n2, n3], after)) = rest.split_first_chunk::<8>() else {
            return Integrity::Truncated;
        };
        if ![n0, n1, n2, n3].iter().all(u8::is_ascii_alphabetic) {
            return Integrity::Corrupt("a chunk has no name");
        }
        let length = u32::from_be_bytes([a, b, c, d]) as usize;
        match after.get(length.saturating_add(4)..) {
            None => return Integrity::Truncated,
            Some(_) if [n0, n1, n2, n3] == *b"IEND" => return Integrity::Whole,
            Some(next) => rest = next,
        }
    }
}

/// Compares a WebP file with the length in its RIFF header.
pub(super) fn webp(file: &[u8]) -> Integrity {
    let length = file.get(4..).and_then(|rest| rest.first_chunk()).map(|&bytes| u32::from_le_bytes(bytes));
    match length {
        Some(length) if file.len() >= 8 && file.len() - 8 >= length as usize => Integrity::Whole,
        _ => Integrity::Truncated,
    }
}

/// Walks the segments of a JPEG file, through the entropy-coded data of every scan, up to the end-of-image
/// mark.
pub(super) fn jpeg(file: &[u8]) -> Integrity {
    const START_OF_SCAN: u8 = 0xda;
    const END_OF_IMAGE: u8 = 0xd9;
    let mut rest = file.get(2..).unwrap_or(&[]);
    let mut scans = 0;
    loop {
        let Some((&mark, after)) = rest.split_first() else { return Integrity::Truncated };
        if mark != 0xff {
            return Integrity::Corrupt("a segment has no mark");
        }
        let Some((&kind, after)) = after.split_first() else { return Integrity::Truncated };
        match kind {
            // Fill bytes may stand before a mark.
            0xff => rest = &rest[1..],
            END_OF_IMAGE if scans == 0 => return Integrity::Corrupt("it ends without a scan"),
            END_OF_IMAGE => return Integrity::Whole,
            0x00 | 0x02..=0xbf | 0xd8 => return Integrity::Corrupt("a segment has an unknown mark"),
            // TEM and the restart marks stand alone.
            0x01 | 0xd0..=0xd7 => rest = after,
            _ => {
                let Some(&[high, low]) = after.first_chunk::<2>() else { return Integrity::Truncated };
                let length = usize::from(u16::from_be_bytes([high, low]));
                if length < 2 {
                    return Integrity::Corrupt("a segment is shorter than its own length");
                }
                let Some(next) = after.get(length..) else { return Integrity::Truncated };
                rest = next;
                if kind == START_OF_SCAN {
                    scans += 1;
                    match next_mark(next) {
                        Some(at) => rest = &next[at..],
                        None => return Integrity::Truncated,
                    }
                }
            }
        }
    }
}

/// Where entropy-coded data ends: the first mark that is neither a stuffed zero nor a restart.
fn next_mark(data: &[u8]) -> Option<usize> {
    data.windows(2).position(|pair| pair[0] == 0xff && !matches!(pair[1], 0x00 | 0xd0..=0xd7 | 0xff))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jpeg_is_whole_at_its_end_mark_only() {
        let file = [
            0xff, 0xd8, 0xff, 0xe0, 0, 4, 0xff, 0xd9, 0xff, 0xda, 0, 2, 7, 0xff, 0, 0xff, 0xd0, 9, 0xff, 0xd9,
        ];
        assert_eq!(jpeg(&file), Integrity::Whole);
        assert_eq!(jpeg(&[&file[..], b"trailer"].concat()), Integrity::Whole);
        for cut in 2..file.len() {
            assert_eq!(jpeg(&file[..cut]), Integrity::Truncated, "cut at {cut}");
        }
        assert!(matches!(jpeg(&[0xff, 0xd8, 0xff, 0xd9]), Integrity::Corrupt(_)));
    }

    #[test]
    fn a_png_is_whole_at_its_last_chunk_only() {
        let file = [b"\x89PNG\r\n\x1a\n\0\0\0\x01tEXtA1234".as_slice(), b"\0\0\0\0IEND1234"].concat();
        assert_eq!(png(&file), Integrity::Whole);
        for cut in 8..file.len() {
            assert_eq!(png(&file[..cut]), Integrity::Truncated, "cut at {cut}");
        }
        assert!(matches!(png(b"\x89PNG\r\n\x1a\n\0\0\0\0\0\0\0\0"), Integrity::Corrupt(_)));
    }
}
