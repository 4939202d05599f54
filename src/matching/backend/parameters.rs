//! What a target's code has to know of a method when it is compiled: numbers alone.

/// The numbers of a matching method that its costs and its winners are made with.
pub trait MethodParameters: 'static {
    /// Columns to each side of a pixel that its cost is made of; texture is counted there.
    const RADIUS_X: usize;
    /// Rows above and below a pixel that its cost is made of: a row has its costs when so many rows below it
    /// are in.
    const RADIUS_Y: usize;
    /// The cost that a disparity one px beside the winner has for that alone, on a slanted surface. The
    /// sub-pixel fit leaves it out of the rise to both sides.
    const SLANT_COST: u8 = 0;
    /// Whether costs are added up along paths: then a left pixel's offer to its partner also costs what the
    /// two differ by, and answers are refused at rims and on patterns that repeat.
    const ALONG_PATHS: bool = false;
    /// Whether winners are computed by something else and handed over
    /// ([`External`](crate::matching::External)).
    const EXTERNAL_WINNERS: bool = false;
}

/// The numbers of a method whose cost is the Hamming distance of census codes summed over a window.
///
/// Every window's sum fits a byte. Where the bits under a window are more than that, the lowest digits of its
/// columns' sums are left out: `block` adds quarters of them, rounded down. On real pairs that hardly shows,
/// while the windows take half the registers of a vector, and two of ten bit planes less.
pub trait WindowParameters: MethodParameters {
    /// Bits of a census code: 4 for up, down, left and right, 8 for all neighbours of a ring.
    const BITS: usize;
    /// Bits of a column's sum.
    const COLUMN_BITS: usize;
    /// Lowest bits of a column's sum that are left out of a window's.
    const COLUMN_SHIFT: usize;
}

/// The numbers of a method whose costs are aggregated along paths.
pub trait SgmParameters: MethodParameters {
    /// Whether a pixel's gradient is compared with all between a candidate and halfway to those beside it
    /// (one of the two halves of Birchfield & Tomasi 1998), or just with the candidate's.
    const BETWEEN_PIXELS: bool;
    /// Whether a row's costs are averaged with those around it within edges: where brightness changes
    /// [much](crate::matching::Penalties::edges) down a column, another surface may begin.
    const WITHIN_EDGES: bool;
    /// Rows below that a row's costs are averaged with.
    const ROWS_BELOW: usize = if Self::WITHIN_EDGES { 2 } else { 1 };
    /// Bytes that are kept for every candidate.
    const VOLUMES: usize = if Self::WITHIN_EDGES { 5 } else { 3 };
}
