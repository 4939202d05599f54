//! The boards in pictures of pairs, and what is wrong where there are none.

use crate::failure::Failure;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use stereopsis::camera::LineSource;
use stereopsis::geometry::camera::ImageSize;
use stereopsis_host::calibrate::View;
use stereopsis_host::calibrate::board::{self, Board, BoardError, Markers, Pattern};
use stereopsis_host::mock::MockCamera;

/// A pair in which the board was found in both images.
pub struct Found {
    pub paths: [PathBuf; 2],
    pub view: View,
}

/// An image with its board.
struct Seen {
    size: ImageSize,
    board: Result<Board, BoardError>,
}

/// The pairs with a board in both images, and the images' size.
pub fn boards(
    pattern: Pattern,
    markers: Option<&Markers>,
    pairs: Vec<[PathBuf; 2]>,
    notes: &mut Vec<String>,
) -> Result<(ImageSize, Vec<Found>), Failure> {
    let all = look_at_all(pattern, markers, pairs)?;
    // The size that most images have.
    let sizes = all.iter().flat_map(|(_, left, right)| [left.size, right.size]);
    let mut counts: Vec<(usize, ImageSize)> = Vec::new();
    for size in sizes {
        match counts.iter_mut().find(|(_, other)| *other == size) {
            Some((count, _)) => *count += 1,
            None => counts.push((1, size)),
        }
    }
    let size = counts.iter().max_by_key(|(count, _)| *count).map(|(_, size)| *size);
    let size = size.ok_or_else(|| Failure::new("--left and --right: no image has a partner"))?;
    refuse_other(pattern, all.iter().flat_map(|(_, left, right)| [&left.board, &right.board]))?;
    let mut found = Vec::new();
    for (paths, left, right) in all {
        if let Some((path, seen)) = paths.iter().zip([&left, &right]).find(|(_, seen)| seen.size != size) {
            notes.push(format!(
                "{}: {} x {} px, most images have {} x {}; the pair is left out",
                path.display(),
                seen.size.width,
                seen.size.height,
                size.width,
                size.height
            ));
            continue;
        }
        match (left.board, right.board) {
            (Ok(left), Ok(right)) => found.push(Found { paths, view: View::new([left, right]) }),
            (Err(e), _) => notes.push(format!("{}: {e}; the pair is left out", paths[0].display())),
            (_, Err(e)) => notes.push(format!("{}: {e}; the pair is left out", paths[1].display())),
        }
    }
    Ok((size, found))
}

/// The boards of all pairs, in their order, by as many threads as there are processors.
fn look_at_all(
    pattern: Pattern,
    markers: Option<&Markers>,
    pairs: Vec<[PathBuf; 2]>,
) -> Result<Vec<([PathBuf; 2], Seen, Seen)>, Failure> {
    let look_at = |paths: [PathBuf; 2]| {
        let left = look(&paths[0], pattern, markers, None)?;
        let right = look(&paths[1], pattern, markers, left.board.as_ref().ok())?;
        Ok((paths, left, right))
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let waiting = Mutex::new(pairs.into_iter().enumerate());
    let work = || {
        let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
        std::iter::from_fn(next).map(|(i, paths)| (i, look_at(paths))).collect::<Vec<_>>()
    };
    let mut all = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
        let mut all = work();
        for other in others {
            match other.join() {
                Ok(more) => all.extend(more),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        all
    });
    all.sort_by_key(|(i, _)| *i);
    all.into_iter().map(|(_, seen)| seen).collect()
}

/// Refuses a pattern where more images show a board of one other size.
fn refuse_other<'a>(
    pattern: Pattern,
    boards: impl Iterator<Item = &'a Result<Board, BoardError>>,
) -> Result<(), Failure> {
    let (mut images, mut fitting) = (0, 0);
    let mut others: Vec<(usize, (usize, usize))> = Vec::new();
    for board in boards {
        images += 1;
        match board.as_ref().map_err(BoardError::other_board) {
            Ok(_) => fitting += 1,
            Err(Some(size)) => match others.iter_mut().find(|(_, other)| *other == size) {
                Some((count, _)) => *count += 1,
                None => others.push((1, size)),
            },
            Err(None) => {}
        }
    }
    match others.into_iter().max_by_key(|(count, _)| *count) {
        Some((count, (columns, rows))) if 3 * count > images && count > fitting => {
            Err(Failure::new(format!(
                "--pattern: {} x {} is given, and {count} of {images} images show a board with {columns} x \
                 {rows} inner corners; give --pattern {columns}x{rows}",
                pattern.columns(),
                pattern.rows()
            )))
        }
        _ => Ok(()),
    }
}

fn look(
    path: &Path,
    pattern: Pattern,
    markers: Option<&Markers>,
    like: Option<&Board>,
) -> Result<Seen, Failure> {
    let camera = MockCamera::open(path)?;
    let (width, height) = (camera.format().width, camera.format().height);
    let grey = camera.grey_picture();
    let board = match markers {
        Some(markers) => board::find_marked(&grey, pattern, markers),
        None => board::find(&grey, pattern, like),
    };
    Ok(Seen { size: ImageSize { width, height }, board })
}
