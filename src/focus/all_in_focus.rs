//! Rows of the all-in-focus picture, reported while a frame comes in.

/// A row of the all-in-focus picture, reported while a frame comes in.
#[derive(Clone, Copy, Debug)]
pub struct AllInFocusRow<'a> {
    /// The row of cells, from the top.
    pub index: usize,
    /// Whether each cell is sharper in this frame than in all before: who copies those pixels has, in the
    /// end, a picture that is sharp all over.
    pub sharper: &'a [bool],
}
