//! The circle of the segment test (Rosten & Drummond 2006).

/// The circle of radius 3 as (row, column) of a square of seven, clockwise from above the centre.
pub(super) const CIRCLE: [(usize, usize); 16] = [
    (0, 3),
    (0, 4),
    (1, 5),
    (2, 6),
    (3, 6),
    (4, 6),
    (5, 5),
    (6, 4),
    (6, 3),
    (6, 2),
    (5, 1),
    (4, 0),
    (3, 0),
    (2, 0),
    (1, 1),
    (0, 2),
];
