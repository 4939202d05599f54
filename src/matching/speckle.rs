//! Small patches dropped, in a band of five rows.
//!
//! A patch is a set of answers joined through their four neighbours, each step within a range. Its size is counted as
//! rows come in (a union-find over the band), and a row is judged when [`LOOK_AHEAD`] more rows have come: what is
//! counted is the patch as far as it shows in all rows down to there.
//!
//! Every pixel has one word: at the root of its patch the patch's size, elsewhere the place of another pixel of the
//! patch. A place is never in an older row than the pixel that refers to it, so nothing points at a row that has left
//! the band, and a patch that goes on keeps the size of its rows that have left.

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
        let Some(row) = self.disparities.get(start..start + self.width) else { return };
        let Some(nodes) = self.nodes.get_mut(start..start + self.width) else { return };
        let mut end = 0;
        let mut size = 0;
        let mut next = Disparity::NONE;
        for (x, &disparity) in row.iter().enumerate().rev() {
            let joined = similar(disparity, next, self.range);
            end = if joined { end } else { x };
            size = if joined { size + 1 } else { 1 };
            if let Some(node) = nodes.get_mut(x) {
                *node = (start + end) as u16;
            }
            if let Some(node) = nodes.get_mut(end) {
                *node = ROOT | size;
            }
            next = disparity;
        }
    }

    /// Joins the row's patches to those above.
    fn join_above(&mut self, y: usize) {
        let (here, above) = (self.place(0, y), self.place(0, y - 1));
        let mut before = (Disparity::NONE, Disparity::NONE);
        for x in 0..self.width {
            let at = |place: usize| self.disparities.get(place).copied().unwrap_or_default();
            let (disparity, up) = (at(here + x), at(above + x));
            if similar(disparity, up, self.range) {
                // Where both rows go on as they were joined one column before, they are joined already.
                let known = similar(before.0, before.1, self.range)
                    && similar(before.0, disparity, self.range)
                    && similar(before.1, up, self.range);
                if !known {
                    self.join(above + x, here + x);
                }
            }
            before = (disparity, up);
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

/// Whether two neighbours are of one patch: both answers, within `range`.
#[inline(always)]
fn similar(a: Disparity, b: Disparity, range: u16) -> bool {
    a.distance(b).is_some_and(|d| d <= range)
}
