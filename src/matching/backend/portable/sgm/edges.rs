//! A row's costs, averaged with those above and below as far as no edge is crossed.
//!
//! An edge is where the left image's brightness changes much from a row to the next one of the column, and
//! the ends of the image are edges: beyond them there may be another surface. With p the costs of a row's
//! pixels:
//!
//! ```text
//! above[d] = average(above of row y - 1, p[d] of row y)         p[d] of row y alone below an edge
//! below[d] = average(p[d] of row y + 1, p[d] of row y + 2)      p[d] of row y + 1 alone above an edge
//! cost[d]  = average(above[d], below[d])                        above[d] alone above an edge
//! ```
//!
//! No branch looks at the picture: masks choose what is averaged, and the average of a number with itself is
//! that number.

/// Whether in a column there is an edge between the row and the next one, and between that and the last.
/// Brightness changes `much` there, or one of them is outside of the image.
#[inline(always)]
pub(in crate::matching::backend) fn edges_at(guides: &[&[u8]; 3], x: usize, much: u8) -> [bool; 2] {
    let [here, next, last] = guides.map(|row| row.get(x));
    [(here, next), (next, last)].map(|rows| !matches!(rows, (Some(a), Some(b)) if a.abs_diff(*b) < much))
}
