//! One row through the stages, over slices: compiled once for each scheme, whatever the capacities.

use super::config::{Checks, Config};
use super::consistency::Consistency;
use super::kernels::{Kernel, RowCodes, RowWork, Select, Winner};
use super::row::{HISTORY, slot};
use super::scheme::{Around, Scheme};
use super::speckle::{BAND, LOOK_AHEAD, Speckle};
use super::texture::Texture;
use super::{smooth::smooth, subpixel::refine};
use crate::units::{Disparity, PixelFlags};

/// The matcher's memory, cut to the frame's size.
pub struct Stages<'a, S: Scheme> {
    pub(super) width: usize,
    pub(super) stride: usize,
    pub(super) kernel: Kernel,
    pub(super) config: &'a Config,
    pub(super) left: &'a mut [u8],
    pub(super) right: &'a mut [u8],
    pub(super) columns: &'a mut [u8],
    pub(super) sums: &'a mut [S::Sum],
    pub(super) masked: &'a mut [S::Sum],
    pub(super) enter: &'a mut [u8],
    pub(super) leave: &'a mut [u8],
    pub(super) texture: Texture<'a>,
    pub(super) consistency: Consistency<'a>,
    /// The row's answers before they are smoothed.
    pub(super) answers: &'a mut [Disparity],
    pub(super) band: &'a mut [Disparity],
    pub(super) flags: &'a mut [PixelFlags],
    pub(super) nodes: &'a mut [u16],
    pub(super) finished: &'a mut [Disparity],
}

impl<S: Scheme> Stages<'_, S> {
    /// Census rows that are held: those under the window and the one that leaves it, row `y` in slot `y % CODES`.
    const CODES: usize = 2 * S::RADIUS_Y + 2;

    /// Forgets the frame before.
    pub(super) fn begin(self) {
        self.columns.fill(0);
        self.texture.clear();
    }

    /// Takes row `y` of both images (`None` below the last one) and finishes the row that is due with it.
    pub(super) fn step(mut self, y: usize, lines: Option<[&Around<'_>; 2]>) {
        if let Some([left, right]) = lines {
            S::census(left, slot_mut(self.left, y % Self::CODES, self.width));
            S::census(right, slot_mut(self.right, y % Self::CODES, self.width));
        }
        let line = lines.and_then(|[left, _]| left[2].get(..self.width));
        self.texture.push::<S>(line, &self.config.checks);
        self.match_row(y);
        if let Some(row) = y.checked_sub(S::RADIUS_Y + LOOK_AHEAD) {
            self.judge_row(row);
        }
    }

    /// Moves the window down to where row `bottom` is its lowest, and answers for the row at its centre.
    fn match_row(&mut self, bottom: usize) {
        let height = usize::from(self.config.height);
        if bottom >= height + S::RADIUS_Y {
            return;
        }
        let row = bottom.checked_sub(S::RADIUS_Y);
        if row.is_some() {
            self.consistency.begin();
        }
        self.select_winners(bottom, bottom < height, row);
        if let Some(row) = row {
            self.refuse(row);
            let radius = usize::from(self.config.checks.smoothing_radius);
            smooth(self.answers, radius, slot_mut(self.band, row % BAND, self.width));
            if self.config.checks.speckle_pixels > 0 {
                self.speckle().push(row);
            }
        }
    }

    /// Runs the kernel and turns its winners into answers and flags; without a `row`, costs are only gathered.
    fn select_winners(&mut self, bottom: usize, enters: bool, row: Option<usize>) {
        let (width, config) = (self.width, self.config);
        let min_disparity = usize::from(config.min_disparity);
        let leaves = bottom.checked_sub(2 * S::RADIUS_Y + 1);
        let enter = enters.then(|| {
            reverse(slot(self.right, bottom % Self::CODES, width), min_disparity, self.enter);
            RowCodes { left: slot(self.left, bottom % Self::CODES, width), right: self.enter }
        });
        let leave = leaves.map(|y| {
            reverse(slot(self.right, y % Self::CODES, width), min_disparity, self.leave);
            RowCodes { left: slot(self.left, y % Self::CODES, width), right: self.leave }
        });
        let select = row.map(|_| Select {
            disparities: usize::from(config.disparities),
            min_disparity,
            second: config.checks.uniqueness_percent.is_some(),
        });
        let work = RowWork {
            width,
            stride: self.stride,
            enter,
            leave,
            columns: self.columns,
            sums: self.sums,
            masked: self.masked,
        };
        let row_flags = row.map_or(&mut [][..], |row| slot_mut(self.flags, row % BAND, width));
        let (answers, consistency) = (&mut *self.answers, &mut self.consistency);
        self.kernel.row::<S>(work, select, |x, winners| {
            let answers = answers.get_mut(x..).unwrap_or_default();
            let flags = row_flags.get_mut(x..).unwrap_or_default();
            for ((winner, answer), flags) in winners.iter().zip(answers).zip(flags) {
                *answer = refine(winner, min_disparity);
                *flags = first_flags(winner, config);
            }
            consistency.offer(x, winners);
        });
    }

    /// Takes the answers away that the checks contradict.
    fn refuse(&mut self, row: usize) {
        let checks = &self.config.checks;
        let refused_ceiling = PixelFlags::CEILING.when(checks.refuse_ceiling);
        let refused = PixelFlags::OUTSIDE
            .union(PixelFlags::UNTEXTURED)
            .union(PixelFlags::AMBIGUOUS)
            .union(PixelFlags::MISMATCH)
            .union(refused_ceiling);
        let flags = slot_mut(self.flags, row % BAND, self.width);
        if checks.texture_pixels > 0 {
            self.texture.mark::<S>(u16::from(checks.texture_pixels), flags);
        }
        for (x, (answer, flags)) in self.answers.iter_mut().zip(flags).enumerate() {
            let mismatch = match checks.left_right_px {
                Some(tolerance) => self.consistency.mismatch(x, tolerance),
                None => PixelFlags::CLEAR,
            };
            // Where there is no candidate there is no winner to check.
            *flags = if flags.contains(PixelFlags::OUTSIDE) { PixelFlags::OUTSIDE } else { flags.union(mismatch) };
            *answer = if flags.intersects(refused) { Disparity::NONE } else { *answer };
        }
    }

    /// Decides which answers of a row are part of a patch that is large enough. The row is finished with that.
    fn judge_row(&mut self, row: usize) {
        let pixels = self.config.checks.speckle_pixels;
        let width = self.width;
        let mut speckle =
            Speckle { disparities: self.band, nodes: self.nodes, width, range: self.config.checks.speckle_range.raw() };
        let answers = slot(speckle.disparities, row % BAND, width);
        let flags = slot_mut(self.flags, row % BAND, width);
        let finished = slot_mut(self.finished, row % HISTORY, width);
        for (finished, answer) in finished.iter_mut().zip(answers) {
            *finished = *answer;
        }
        if pixels == 0 {
            return;
        }
        let mut before = (Disparity::NONE, PixelFlags::CLEAR);
        for (x, ((&answer, flags), finished)) in answers.iter().zip(flags).zip(finished).enumerate() {
            // A pixel joined to the one before is of its patch.
            let small = match before {
                (left, small) if speckle.joins(left, answer) => small,
                _ if answer.is_some() => speckle.is_small(x, row, pixels),
                _ => PixelFlags::CLEAR,
            };
            *flags = flags.union(small);
            *finished = if small.is_clear() { answer } else { Disparity::NONE };
            before = (answer, small);
        }
    }

    fn speckle(&mut self) -> Speckle<'_> {
        Speckle {
            disparities: self.band,
            nodes: self.nodes,
            width: self.width,
            range: self.config.checks.speckle_range.raw(),
        }
    }
}

/// What is known of a winner by itself.
#[inline(always)]
fn first_flags(winner: &Winner, config: &Config) -> PixelFlags {
    if winner.candidates == 0 {
        return PixelFlags::OUTSIDE;
    }
    let ceiling = PixelFlags::CEILING.when(winner.disparity + 1 == config.disparities);
    let ambiguous = PixelFlags::AMBIGUOUS.when(is_ambiguous(winner, &config.checks));
    ceiling.union(ambiguous)
}

#[inline(always)]
fn is_ambiguous(winner: &Winner, checks: &Checks) -> bool {
    checks.uniqueness_percent.is_some_and(|percent| {
        let share = 100 - u32::from(percent.min(99));
        winner.second < u16::MAX && u32::from(winner.second) * share <= u32::from(winner.cost) * 100
    })
}

/// A right row as the kernels read it: from right to left, moved by the smallest disparity, its first code repeated.
fn reverse(codes: &[u8], min_disparity: usize, out: &mut [u8]) {
    let inside = codes.get(..codes.len().saturating_sub(min_disparity)).unwrap_or(&[]);
    let (reversed, repeated) = out.split_at_mut_checked(inside.len()).unwrap_or_default();
    // Eight codes are turned around as one word.
    let (last, words) = inside.as_rchunks::<8>();
    let (out_words, out_last) = reversed.as_chunks_mut::<8>();
    for (out, word) in out_words.iter_mut().zip(words.iter().rev()) {
        *out = u64::from_le_bytes(*word).to_be_bytes();
    }
    for (out, code) in out_last.iter_mut().zip(last.iter().rev()) {
        *out = *code;
    }
    repeated.fill(codes.first().copied().unwrap_or(0));
}

fn slot_mut<T>(rows: &mut [T], index: usize, width: usize) -> &mut [T] {
    rows.get_mut(index * width..).and_then(|r| r.get_mut(..width)).unwrap_or_default()
}
