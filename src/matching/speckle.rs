//! Small patches dropped, in a band of five rows.
//!
//! A patch is a set of answers joined through their four neighbours, each step within a range. Its size is counted as
//! rows come in (a union-find over the band), and a row is judged when [`LOOK_AHEAD`] more rows have come: what is
//! counted is the patch as far as it shows in all rows down to there.
//!
//! Every pixel has one word: at the root of its patch the patch's size, elsewhere the place of another pixel of the
//! patch. A place is never in an older row than the pixel that refers to it, so nothing points at a row that has left
//! the band, and a patch that goes on keeps the size of its rows that have left.

use super::row::slot;
use crate::units::{Disparity, PixelFlags};

/// Rows that must follow before a row is judged.
pub(super) const LOOK_AHEAD: usize = 4;
/// Rows of the band: a ring, row `y` in slot `y % BAND`.
pub(super) const BAND: usize = LOOK_AHEAD + 1;
/// The widest line whose places fit beside [`ROOT`].
pub(super) const WIDEST: usize = ROOT as usize / BAND;

/// Marks a root; the other bits are its patch's size, or the largest number they hold.
const ROOT: u16 = 1 << 15;

/// The band of rows. All slices are `BAND` rows of `width`.
pub(super) struct Speckle<'a> {
    pub disparities: &'a [Disparity],
    pub nodes: &'a mut [u16],
    pub width: usize,
    /// Two neighbours differ by at most this, in steps of [`Disparity`].
    pub range: u16,
}

impl Speckle<'_> {
    /// Takes row `y`, whose disparities are in the band.
    pub(super) fn push(&mut self, y: usize) {
        self.join_along(y);
        if y > 0 {
            self.join_above(y);
        }
    }

    /// Whether the patch of the answered pixel (`x`, `y`), as far as it is known, has fewer than `pixels`.
    pub(super) fn is_small(&mut self, x: usize, y: usize, pixels: u16) -> PixelFlags {
        let root = self.root(self.place(x, y));
        let size = self.nodes.get(root).map_or(ROOT, |n| n & !ROOT);
        PixelFlags::SPECKLE.when(size < pixels)
    }

    /// Whether two neighbours are of one patch.
    #[inline(always)]
    pub(super) fn joins(&self, a: Disparity, b: Disparity) -> bool {
        similar(a, b, self.range)
    }

    fn place(&self, x: usize, y: usize) -> usize {
        (y % BAND) * self.width + x
    }

    /// Runs of similar answers along the row: the last pixel of each is the root of all.
    fn join_along(&mut self, y: usize) {
        let start = self.place(0, y);
        let Some(nodes) = self.nodes.get_mut(start..start + self.width) else { return };
        // From the end, so that the end of a run is known when its pixels are written.
        let (mut end, mut size) = (start, 0);
        let mut next = Disparity::NONE;
        for (x, &answer) in slot(self.disparities, y % BAND, self.width).iter().enumerate().rev() {
            if !similar(answer, next, self.range) {
                finish_run(nodes, end - start, size);
                end = start + x;
                size = 0;
            }
            size += 1;
            if let Some(node) = nodes.get_mut(x) {
                *node = end as u16;
            }
            next = answer;
        }
        finish_run(nodes, end - start, size);
    }

    /// Joins the row's patches to those above.
    fn join_above(&mut self, y: usize) {
        let (here, above) = (self.place(0, y), self.place(0, y - 1));
        let rows = slot(self.disparities, y % BAND, self.width).iter();
        let mut joined_before = false;
        let mut before = (Disparity::NONE, Disparity::NONE);
        for (x, (&answer, &up)) in rows.zip(slot(self.disparities, (y - 1) % BAND, self.width)).enumerate() {
            let joined = similar(answer, up, self.range);
            // Where both rows go on from a column that was joined, they are joined already.
            let known = joined_before & similar(before.0, answer, self.range) & similar(before.1, up, self.range);
            if joined & !known {
                self.join(above + x, here + x);
            }
            joined_before = joined;
            before = (answer, up);
        }
    }

    /// Joins the patch of an older pixel to that of one in the newest row, whose root is in the newest row.
    fn join(&mut self, older: usize, newest: usize) {
        let (a, b) = (self.root(older), self.root(newest));
        if a == b {
            return;
        }
        let size = self.nodes.get(a).map_or(0, |n| n & !ROOT);
        if let Some(root) = self.nodes.get_mut(b) {
            *root = ROOT | ((*root & !ROOT) + size).min(ROOT - 1);
        }
        if let Some(node) = self.nodes.get_mut(a) {
            *node = b as u16;
        }
    }

    /// The root of a pixel's patch. Each step halves the path for those who come after.
    fn root(&mut self, place: usize) -> usize {
        let mut place = place;
        // A path has no loop, so it is shorter than the band has pixels.
        for _ in 0..self.nodes.len() {
            let node = self.nodes.get(place).copied().unwrap_or(ROOT);
            if node & ROOT != 0 {
                break;
            }
            let parent = usize::from(node);
            let grandparent = self.nodes.get(parent).copied().unwrap_or(ROOT);
            if grandparent & ROOT != 0 {
                return parent;
            }
            if let Some(node) = self.nodes.get_mut(place) {
                *node = grandparent;
            }
            place = usize::from(grandparent);
        }
        place
    }
}

/// Makes the end of a run the root of its pixels.
fn finish_run(nodes: &mut [u16], end: usize, size: u16) {
    if let Some(node) = nodes.get_mut(end)
        && size > 0
    {
        *node = ROOT | size;
    }
}

/// Whether two neighbours are of one patch: both answers, within `range`.
#[inline(always)]
fn similar(a: Disparity, b: Disparity, range: u16) -> bool {
    // Without a branch: pictures decide nothing about the work.
    a.is_some() & b.is_some() & (a.raw().abs_diff(b.raw()) <= range)
}
