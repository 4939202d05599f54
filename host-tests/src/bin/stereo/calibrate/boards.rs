//! The boards in pictures of pairs, and what is wrong where there are none.

use crate::failure::Failure;
use std::cmp::Reverse;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use stereopsis::camera::LineSource;
use stereopsis::geometry::camera::ImageSize;
use stereopsis_host::calibrate::board::{self, Board, BoardError, Markers, Pattern};
use stereopsis_host::calibrate::{Calibrated, View};
use stereopsis_host::mock::MockCamera;

/// A pair in which the board was found in both images.
pub struct Found {
    pub paths: [PathBuf; 2],
    pub view: View,
}

/// Corners that are no farther apart are at the same place, px.
const ALIKE_PX: f64 = 0.1;
/// Images that are searched for a smaller board where none shows the one that is given.
const TRIED: usize = 6;
/// Sizes that are looked for of those that images show in place of the given one.
const OTHERS: usize = 3;

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
    refuse_other(pattern, &all)?;
    if markers.is_none() && all.iter().all(|(_, left, right)| left.board.is_err() && right.board.is_err()) {
        refuse_squares(pattern, all.iter().flat_map(|(paths, ..)| paths))?;
    }
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
    refuse_alike(&found)?;
    Ok((size, found))
}

/// Refuses views that say nothing of two cameras, for the left and the right images are the same, or of a
/// lens, for all boards stand alike.
fn refuse_alike(found: &[Found]) -> Result<(), Failure> {
    let far_px = |a: &View, [i, j]: [usize; 2], b: &View| {
        let is_same = a.numbers[i] == b.numbers[j];
        let both = a.corners[i].iter().zip(&b.corners[j]);
        both.map(|(a, b)| (a - b).norm()).fold(if is_same { 0.0 } else { f64::INFINITY }, f64::max)
    };
    let Some(Found { view: first, .. }) = found.first() else { return Ok(()) };
    if found.iter().all(|Found { view, .. }| far_px(view, [0, 1], view) < ALIKE_PX) {
        return Err(Failure::new(
            "--left and --right: both lists show the same camera: all corners are at the same places in \
             both; give the images of the left camera and those of the right one",
        ));
    }
    let is_alike = |view: &View| (0..2).all(|side| far_px(view, [side; 2], first) < ALIKE_PX);
    if found.len() >= Calibrated::LEAST_VIEWS && found.iter().all(|found| is_alike(&found.view)) {
        return Err(Failure::new(format!(
            "--left and --right: all {} boards stand alike; turn and move the board from view to view",
            found.len()
        )));
    }
    Ok(())
}

/// Refuses a pattern that counts squares, where the first images show a board with that many, which has a
/// corner less along and down.
fn refuse_squares<'a>(pattern: Pattern, images: impl Iterator<Item = &'a PathBuf>) -> Result<(), Failure> {
    let (columns, rows) = (pattern.columns() - 1, pattern.rows() - 1);
    let Some(fewer) = Pattern::new(columns, rows) else { return Ok(()) };
    for path in images.take(TRIED) {
        if look(path, fewer, None, None)?.board.is_ok() {
            return Err(Failure::new(format!(
                "--pattern: {} x {} is given, and {} shows a board with {columns} x {rows} inner corners: \
                 corners are counted, not squares; give --pattern {columns}x{rows}",
                pattern.columns(),
                pattern.rows(),
                path.display()
            )));
        }
    }
    Ok(())
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
fn refuse_other(pattern: Pattern, all: &[([PathBuf; 2], Seen, Seen)]) -> Result<(), Failure> {
    let images = 2 * all.len();
    let boards = || all.iter().flat_map(|(_, left, right)| [&left.board, &right.board]);
    let fitting = boards().filter(|board| board.is_ok()).count();
    let named: Vec<_> = boards().filter_map(|board| board.as_ref().err()?.other_board()).collect();
    if 3 * named.len() <= images {
        return Ok(());
    }
    let often = |size: &(usize, usize)| named.iter().filter(|other| *other == size).count();
    let mut sizes = named.clone();
    sizes.sort_by_key(|size| (Reverse(often(size)), *size));
    sizes.dedup();
    for (columns, rows) in sizes.into_iter().take(OTHERS) {
        let Some(other) = Pattern::new(columns, rows) else { continue };
        // A smaller pattern fits, too, where corners of the board were missed, and other images name part of
        // the board: what counts is where a size is found.
        let again = look_at_all(other, None, all.iter().map(|(paths, ..)| paths.clone()).collect())?;
        let shown = again.iter().flat_map(|(_, left, right)| [&left.board, &right.board]);
        let count = shown.filter(|board| board.is_ok()).count().max(often(&(columns, rows)));
        if 3 * count > images && count > fitting {
            return Err(Failure::new(format!(
                "--pattern: {} x {} is given, and {count} of {images} images show a board with {columns} x \
                 {rows} inner corners; give --pattern {columns}x{rows}",
                pattern.columns(),
                pattern.rows()
            )));
        }
    }
    Ok(())
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
