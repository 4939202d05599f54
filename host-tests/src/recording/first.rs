//! The pictures of a recording's first frame, taken before it is played.

use super::{Entry, Header, Recording, RecordingError, most_rows};
use image::GrayImage;
use std::iter::Chain;
use std::vec::IntoIter;

/// The records of a recording from its beginning, of which some were read already.
pub type FromStart = Chain<IntoIter<Result<Entry, RecordingError>>, Recording>;

/// The left and the right picture of a recording's first frame, and all of its records from the beginning.
///
/// A row that did not come is the row above it. There are no pictures where no row came.
pub fn first_pair(mut recording: Recording) -> (Option<[GrayImage; 2]>, FromStart) {
    let header = recording.header();
    let mut rows = vec![None; usize::from(header.height)];
    let mut records = Vec::new();
    let mut frames = 0;
    // A file may hold any number of records of one frame.
    while frames < 2 && records.len() <= most_rows(header.height) as usize {
        let Some(record) = recording.next() else { break };
        match &record {
            Ok(Entry::Frame(_)) => frames += 1,
            Ok(Entry::Line { start, left, right }) if frames == 1 => {
                if let Some(row) = rows.get_mut(usize::from(start.row)) {
                    *row = Some([left.clone(), right.clone()]);
                }
            }
            // What follows a fault of the file is not played either.
            Ok(Entry::Cut) | Err(_) => frames = 2,
            _ => {}
        }
        records.push(record);
    }
    (pictures(header, rows), records.into_iter().chain(recording))
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
