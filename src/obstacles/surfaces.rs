//! Connected surfaces: stixels side by side that have enough cells together.

use super::column::{Column, StixelKind};
use super::stixel::Labelling;

/// How often a column whose nearest segment belongs to no surface looks for one behind it.
const TRIES: usize = 3;

/// Whether two columns side by side show one surface: of one kind, in rows that overlap or touch, and within
/// the step of a surface, or of drops with their edges at most a row apart: the ground's parallax there may
/// grow by more than that step from a row to the next.
fn connected(a: &Column, b: &Column, same_surface: i32) -> bool {
    let is_one_edge = a.kind == StixelKind::Drop && a.base.abs_diff(b.base) <= 1;
    a.kind != StixelKind::Nothing
        && a.kind == b.kind
        && (is_one_edge || (a.parallax - b.parallax).abs() <= same_surface)
        && a.top <= b.base.saturating_add(1)
        && b.top <= a.base.saturating_add(1)
}

/// Finds the nearest stixel of each column that belongs to a surface of at least
/// [`min_pixels`](super::ObstacleConfig::min_pixels).
///
/// A column whose nearest segment does not, a speck, looks for the next one behind it, twice at most; what is
/// a speck then is left out.
pub(super) fn stixels(labelling: &Labelling<'_>, columns: &mut [Column], labels: &mut [u8]) {
    for (x, column) in columns.iter_mut().enumerate() {
        *column = labelling.column(x, i32::MAX, labels);
    }
    for tried in 1..=TRIES {
        support(columns, labelling);
        if tried == TRIES {
            break;
        }
        for (x, column) in columns.iter_mut().enumerate() {
            if column.kind != StixelKind::Nothing && !column.is_supported() {
                let seen = column.seen.max(labelling.hidden(x, column));
                *column = Column { seen, ..labelling.column(x, column.parallax, labels) };
            }
        }
    }
    for (x, column) in columns.iter_mut().enumerate().filter(|(_, column)| !column.is_supported()) {
        *column = Column { seen: column.seen.max(labelling.hidden(x, column)), ..Column::EMPTY };
    }
}

/// Sums up the cells of each run of connected columns.
fn support(columns: &mut [Column], labelling: &Labelling<'_>) {
    let config = &labelling.config;
    let area = u32::from(config.cell_width) * u32::from(config.cell_height);
    let (mut rest, mut place) = (columns, 0);
    while let Some(first) = rest.first() {
        let (mut last, mut length, mut cells, mut all, mut standing) = (*first, 0, 0, 0, 0);
        for (x, next) in (place..).zip(&*rest) {
            if length > 0 && !connected(&last, next, labelling.same_surface) {
                break;
            }
            // Where fewer disparities can be searched, answers agree more often by chance.
            let own = u32::from(next.cells) << u32::from(x >= labelling.narrow);
            (last, length, cells, all) = (*next, length + 1, cells + u32::from(next.cells), all + own);
            standing += if labelling.stands(x, next) { own } else { 0 };
        }
        let (run, after) = rest.split_at_mut_checked(length).unwrap_or_default();
        if run.is_empty() {
            return;
        }
        for column in run {
            let enough = column.kind != StixelKind::Nothing
                && (all.max(2 * standing) * area >= 2 * u32::from(config.min_pixels));
            column.surface = if enough { cells.min(u16::MAX.into()) as u16 } else { 0 };
        }
        (rest, place) = (after, place + length);
    }
}
