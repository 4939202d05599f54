//! The pictures of a recording's first frames, taken before it is played.

use super::{Entry, Header, Recording, RecordingError, most_rows};
use image::GrayImage;
use std::iter::Chain;
use std::mem;
use std::vec::IntoIter;

/// The records of a recording from its beginning, of which some were read already.
pub type FromStart = Chain<IntoIter<Result<Entry, RecordingError>>, Recording>;

/// The left and the right pictures of a recording's first frames, up to so many, and all of its records from
/// the beginning.
///
/// A row that did not come is the row above it. A frame of which no row came has no pictures.
pub fn first_pairs(mut recording: Recording, most: usize) -> (Vec<[GrayImage; 2]>, FromStart) {
    let header = recording.header();
    let none = || vec![None; usize::from(header.height)];
    let (mut rows, mut pairs, mut records, mut frames) = (none(), Vec::new(), Vec::new(), 0);
    // A file may hold any number of records of one frame.
    while frames <= most && records.len() <= most * most_rows(header.height) as usize {
        let Some(record) = recording.next() else { break };
        match &record {
            Ok(Entry::Frame(_)) => {
                frames += 1;
                pairs.extend(pictures(header, mem::replace(&mut rows, none())));
            }
            Ok(Entry::Line { start, left, right }) if frames > 0 => {
                if let Some(row) = rows.get_mut(usize::from(start.row)) {
                    *row = Some([left.clone(), right.clone()]);
                }
            }
            // What follows a fault of the file is not played either.
            Ok(Entry::Cut) | Err(_) => frames = most + 1,
            _ => {}
        }
        records.push(record);
    }
    pairs.extend(pictures(header, rows));
    pairs.truncate(most);
    (pairs, records.into_iter().chain(recording))
}

/// The left and the right picture of rows, of which one that did not come is the row above it; none where no
/// row came.
pub(super) fn pictures(header: Header, rows: Vec<Option<[Vec<u8>; 2]>>) -> Option<[GrayImage; 2]> {
    let (width, height) = (usize::from(header.width), usize::from(header.height));
    let mut above = rows.iter().flatten().next().cloned();
    let mut bytes = [(); 2].map(|()| Vec::with_capacity(width * height));
    for row in rows {
        above = row.or(above);
        for (bytes, line) in bytes.iter_mut().zip(above.iter().flatten()) {
            bytes.extend_from_slice(line);
        }
    }
    let size = (header.width.into(), header.height.into());
    let [left, right] = bytes.map(|bytes| GrayImage::from_raw(size.0, size.1, bytes));
    left.zip(right).map(|(left, right)| [left, right])
}
