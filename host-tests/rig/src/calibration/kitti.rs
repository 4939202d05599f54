//! KITTI's `calib.txt`: projection matrices of rectified cameras, lengths in pixels and metres; and that of
//! the Karlsruhe sequences, its forerunner.
//!
//! `P = K [I | t]`, row by row: `f 0 cx f*tx; 0 f cy ..; 0 0 1 ..`. The baseline of two cameras is
//! `(P_right[3] - P_left[3]) / -f`. KITTI counts its cameras from 0 (grey 0 and 1, colour 2 and 3). A
//! Karlsruhe file counts them from 1: `K1`, `D1`, `R1` are the camera that was calibrated, `P1` the rectified
//! one, and `P1_roi` that of the region which the images of the sequences show.

use super::{Calibration, Fault, Intrinsics, numbers, rig};
use std::path::{Path, PathBuf};

/// The grey cameras' folders; every other path means the colour cameras.
const GREY_FOLDERS: [&str; 4] = ["image_0", "image_1", "image_00", "image_01"];
const FORM: &str = "a line of 12 numbers of the rectified camera";

/// A projection matrix: its label, the line's number from 1, and its numbers.
struct Matrix<'a> {
    label: &'a str,
    line: usize,
    numbers: &'a str,
}

/// Whether the file has labelled projection matrices, or two bare lines of numbers at least.
pub(super) fn is_one(text: &str) -> bool {
    labelled(text).next().is_some() || bare(text).is_some()
}

/// Whether the file has such matrices as numbers. `P1` in YAML is followed by a list or a mapping.
pub(super) fn has_numbers_of_both(text: &str) -> bool {
    bare(text).is_some() || labelled(text).any(|(_, matrix)| starts_with_number(matrix.numbers))
}

fn starts_with_number(text: &str) -> bool {
    text.split_ascii_whitespace().next().is_some_and(|word| word.parse::<f64>().is_ok())
}

/// `P0: ...`, `P_rect_00: ...` or `P1_roi: ...`, with the camera's number; other labels (Tr, R_rect, ...) say
/// nothing about a rectified pair. Of a file that says what the region of its images is, only those matrices.
fn labelled(text: &str) -> impl Iterator<Item = (usize, Matrix<'_>)> {
    let region = region(text);
    text.lines().zip(1..).filter_map(move |(content, line)| {
        let (label, numbers) = content.split_once(':')?;
        let label = label.trim();
        let camera = label.strip_prefix("P_rect_").or_else(|| label.strip_prefix('P'))?;
        let camera = camera.strip_suffix(region)?.parse().ok()?;
        Some((camera, Matrix { label, line, numbers }))
    })
}

/// What ends the labels of the cameras that the images are of.
fn region(text: &str) -> &'static str {
    if has_numbers(text, "P1_roi") { "_roi" } else { "" }
}

/// Whether the cameras are called 1 and 2, as in the Karlsruhe sequences: KITTI's files never do. `K1` in
/// YAML is followed by a list or a mapping.
pub(super) fn counts_from_one(text: &str) -> bool {
    has_numbers(text, "K1") || has_numbers(text, "P1_roi")
}

/// Whether a line has this label and a number after it.
fn has_numbers(text: &str, wanted: &str) -> bool {
    let mut labelled = text.lines().filter_map(|line| line.split_once(':'));
    labelled.any(|(label, numbers)| label.trim() == wanted && starts_with_number(numbers))
}

/// Two lines of numbers without labels: left, then right.
fn bare(text: &str) -> Option<[Matrix<'_>; 2]> {
    let mut lines = text.lines().zip(1..).filter(|(content, _)| !content.trim().is_empty());
    let (left, right) = (lines.next()?, lines.next()?);
    let only_two = lines.next().is_none();
    (only_two && starts_with_number(left.0) && starts_with_number(right.0)).then_some([
        Matrix { label: "left", line: left.1, numbers: left.0 },
        Matrix { label: "right", line: right.1, numbers: right.0 },
    ])
}

pub(super) fn read(text: &str, left_image: &Path) -> Result<Calibration, Fault> {
    let [left, right] = match bare(text) {
        Some(pair) => pair,
        None => choose(text, left_image)?,
    };
    let p: [f64; 12] = numbers(left.label, left.line, left.numbers)?;
    let q: [f64; 12] = numbers(right.label, right.line, right.numbers)?;
    let camera = |key, p: &[f64; 12]| Intrinsics { key, fx: p[0], fy: p[5], cx: p[2], cy: p[6] };
    let keys = format!("{} and {}", left.label, right.label);
    let size = size(text, left.label)?;
    Ok(Calibration {
        path: PathBuf::new(),
        format: if counts_from_one(text) { "Karlsruhe" } else { "KITTI" },
        // A focal length of 0 is refused by its name before the quotient counts.
        rig: rig(camera(left.label, &p), camera(right.label, &q), &keys, (q[3] - p[3]) / -p[0])?,
        width: size.map(|[width, _]| width),
        height: size.map(|[_, height]| height),
        disparities: None,
    })
}

/// Columns and rows of a camera's rectified images, which the raw recordings' `S_rect_00: ...` says of
/// `P_rect_00`.
fn size(text: &str, label: &str) -> Result<Option<[u16; 2]>, Fault> {
    let Some(camera) = label.strip_prefix("P_rect_") else { return Ok(None) };
    let wanted = format!("S_rect_{camera}");
    let said = text.lines().zip(1..).find_map(|(content, line)| {
        let (label, numbers) = content.split_once(':')?;
        (label.trim() == wanted).then_some((line, numbers))
    });
    let Some((line, said)) = said else { return Ok(None) };
    // A size that is no size fits no image, which is said when there is one.
    Ok(Some(numbers::<2>(&wanted, line, said)?.map(|pixels| pixels as u16)))
}

/// fx, skew, cx, fy, cy of both cameras, with their labels.
pub(super) fn matrices(text: &str) -> Result<[(String, [f64; 5]); 2], Fault> {
    let [left, right] = match bare(text) {
        Some(pair) => pair,
        None => choose(text, Path::new(""))?,
    };
    let of = |matrix: Matrix<'_>| {
        let p: [f64; 12] = numbers(matrix.label, matrix.line, matrix.numbers)?;
        Ok((matrix.label.to_owned(), [p[0], p[1], p[2], p[5], p[6]]))
    };
    Ok([of(left)?, of(right)?])
}

/// fx, skew, cx, fy, cy of the camera of a file that has only one matrix, with its label; `None` of other
/// files.
pub(super) fn alone(text: &str) -> Option<Result<(String, [f64; 5]), Fault>> {
    let mut lines = text.lines().zip(1..).filter(|(content, _)| !content.trim().is_empty());
    let (content, line) = lines.next().filter(|_| lines.next().is_none())?;
    let matrix = labelled(text).next().map(|(_, matrix)| matrix);
    let is_bare = content.split_ascii_whitespace().next()?.parse::<f64>().is_ok();
    let matrix = matrix.or(is_bare.then_some(Matrix { label: "the camera", line, numbers: content }))?;
    let numbers = numbers(matrix.label, line, matrix.numbers);
    Some(numbers.map(|p: [f64; 12]| (matrix.label.to_owned(), [p[0], p[1], p[2], p[5], p[6]])))
}

/// The matrices of the pair that the left image belongs to: the only pair of a Karlsruhe file; KITTI's colour
/// cameras 2 and 3 where the file has them, unless the path names a grey camera.
fn choose<'a>(text: &'a str, left_image: &Path) -> Result<[Matrix<'a>; 2], Fault> {
    let grey =
        left_image.components().any(|part| GREY_FOLDERS.iter().any(|folder| part.as_os_str() == *folder));
    let has_colour = labelled(text).any(|(camera, _)| camera == 2 || camera == 3);
    let (left, right) = match () {
        () if counts_from_one(text) => (1, 2),
        () if grey || !has_colour => (0, 1),
        () => (2, 3),
    };
    let find = |wanted: usize| {
        let mut found = labelled(text).filter(|(camera, _)| *camera == wanted).map(|(_, matrix)| matrix);
        match (found.next(), found.next()) {
            (_, Some(second)) => Err(Fault::Twice { key: second.label.into(), line: second.line }),
            (Some(first), None) => Ok(first),
            (None, None) => Err(Fault::Missing(format!("P{wanted}{}", region(text)), FORM)),
        }
    };
    Ok([find(left)?, find(right)?])
}
