//! Disparity to depth (`metres`), and what may follow: answers over frames, smaller rows, rows on a display
//! (`after`).

mod after;
mod metres;
