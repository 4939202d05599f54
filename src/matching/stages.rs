//! One row through the stages, over slices: compiled once for each scheme, whatever the capacities.

use super::config::Config;
use super::consistency::Consistency;
use super::kernels::{Kernel, RowCodes, RowWork, Select, Winner, halves_mut};
use super::row::{HISTORY, slot};
use super::scheme::{Around, Scheme};
use super::speckle::{BAND, LOOK_AHEAD, Support};
use super::subpixel::refine;
use super::surface::{self, Runs};
use super::texture::Texture;
use crate::units::{Disparity, PixelFlags};
use core::marker::PhantomData;

/// The matcher's memory, cut to the frame's size.
pub struct Stages<'a, S: Scheme> {
    pub(super) scheme: PhantomData<S>,
    pub(super) width: usize,
    pub(super) stride: usize,
    pub(super) kernel: Kernel,
    pub(super) config: &'a Config,
    pub(super) left: &'a mut [u8],
    pub(super) right: &'a mut [u8],
    pub(super) columns: &'a mut [u8],
    pub(super) scratch: &'a mut [u32],
    pub(super) texture: Texture<'a>,
    pub(super) consistency: Consistency<'a>,
    pub(super) band: &'a mut [Disparity],
    pub(super) flags: &'a mut [PixelFlags],
    pub(super) support: Support<'a>,
    pub(super) finished: &'a mut [Disparity],
}

impl<S: Scheme> Stages<'_, S> {
    /// Census rows that are held: those under the window and the one that leaves it, row `y` in slot `y % CODES`.
    const CODES: usize = 2 * S::RADIUS_Y + 2;

    /// Forgets the frame before.
    pub(super) fn begin(self) {
        self.columns.fill(0);
        self.texture.clear();
        self.support.begin(self.band);
    }

    /// Takes row `y` of both images (`None` below the last one) and finishes the row that is due with it.
    pub(super) fn step(mut self, y: usize, lines: Option<[&Around<'_>; 2]>) {
        if let Some([left, right]) = lines {
            let place = y % Self::CODES;
            let (codes, of_right) = (slot_mut(self.left, place, self.width), slot_mut(self.right, place, self.width));
            self.kernel.census::<S>(left, codes);
            self.kernel.census::<S>(right, of_right);
            self.kernel.prepare::<S>(codes, of_right, usize::from(self.config.min_disparity));
        }
        if self.config.checks.texture_pixels > 0 {
            let line = lines.and_then(|[left, _]| left[2].get(..self.width));
            self.texture.push::<S>(line, &self.config.checks);
        }
        self.match_row(y);
    }

    /// Moves the window down to where row `bottom` is its lowest, answers for the row at its centre, and judges the one that
    /// waited for it.
    fn match_row(&mut self, bottom: usize) {
        let height = usize::from(self.config.height);
        let row = bottom.checked_sub(S::RADIUS_Y);
        if bottom < height + S::RADIUS_Y {
            if row.is_some() {
                self.consistency.begin();
            }
            self.select_winners(bottom, bottom < height, row);
        }
        let Some(row) = row else { return };
        if row < height {
            self.refuse(row);
        } else {
            // No surface goes on below the image.
            slot_mut(self.band, row % BAND, self.width).fill(Disparity::NONE);
        }
        let checks = &self.config.checks;
        let judged = row + BAND - LOOK_AHEAD;
        let flags = slot_mut(self.flags, judged % BAND, self.width);
        let finished = slot_mut(self.finished, judged % HISTORY, self.width);
        self.support.count(row, self.band, checks.surface_step, checks.speckle_pixels, flags, finished);
    }

    /// Runs the kernel and turns its winners into answers and flags; without a `row`, costs are only gathered.
    fn select_winners(&mut self, bottom: usize, enters: bool, row: Option<usize>) {
        let (width, config) = (self.width, self.config);
        let min_disparity = usize::from(config.min_disparity);
        let leaves = bottom.checked_sub(2 * S::RADIUS_Y + 1);
        let codes = |y: usize| RowCodes {
            left: slot(self.left, y % Self::CODES, width),
            right: slot(self.right, y % Self::CODES, width),
        };
        let enter = enters.then(|| codes(bottom));
        let leave = leaves.map(codes);
        let select = row.map(|_| Select {
            disparities: usize::from(config.disparities),
            second: config.checks.uniqueness_percent.is_some(),
        });
        let work = RowWork {
            width,
            stride: self.stride,
            min_disparity,
            enter,
            leave,
            columns: self.columns,
            scratch: self.scratch,
        };
        let place = row.unwrap_or(0) % BAND;
        let (answers, row_flags) = (slot_mut(self.band, place, width), slot_mut(self.flags, place, width));
        let rules = Rules::new(config);
        let mut first = 0;
        self.kernel.row::<S>(work, select, &mut |winners| {
            let place = first..first + winners.len();
            first = place.end;
            let (Some(answers), Some(flags)) = (answers.get_mut(place.clone()), row_flags.get_mut(place.clone()))
            else {
                return;
            };
            rules.answer(winners, answers, flags);
            if let Some(percent) = config.checks.uniqueness_percent {
                mark_ambiguous(winners, percent, flags);
            }
            self.consistency.offer(place.start, winners);
        });
    }

    /// Takes the answers away that the checks contradict, and averages what is left along the row.
    #[inline(never)]
    fn refuse(&mut self, row: usize) {
        let checks = &self.config.checks;
        let refused_ceiling = PixelFlags::CEILING.when(checks.refuse_ceiling);
        let refused = PixelFlags::OUTSIDE
            .union(PixelFlags::UNTEXTURED)
            .union(PixelFlags::AMBIGUOUS)
            .union(PixelFlags::MISMATCH)
            .union(refused_ceiling);
        // Where nothing is checked, nothing is over the tolerance.
        let tolerance = checks.left_right_px.unwrap_or(u8::MAX);
        let (flags, answers) =
            (slot_mut(self.flags, row % BAND, self.width), slot_mut(self.band, row % BAND, self.width));
        let lengths = &mut *self.support.lengths;
        // The kernel is done with its room.
        let Some((none, sums)) = halves_mut(self.scratch).split_first_mut() else { return };
        *none = 0;
        let mut runs = Runs::new(checks.surface_step);
        if checks.texture_pixels > 0 {
            self.texture.mark::<S>(u16::from(checks.texture_pixels), flags);
        }
        // Where there is no candidate there is no winner to check.
        for flags in flags.iter_mut().take(usize::from(self.config.min_disparity)) {
            *flags = PixelFlags::OUTSIDE;
        }
        let pixels = answers.iter_mut().zip(flags).zip(lengths.iter_mut().zip(sums));
        for ((x, ((answer, flags), (length, sum))), left) in pixels.enumerate().zip(self.consistency.left.iter()) {
            *flags = flags.union(self.consistency.mismatch(x, *left, tolerance));
            let refused = 0u16.wrapping_sub(u16::from(flags.intersects(refused)));
            *answer = Disparity::from_raw(answer.raw() | refused);
            (*length, *sum) = runs.next(*answer);
        }
        surface::average(answers, lengths, halves_mut(self.scratch), checks.smoothing_radius);
    }
}

/// How winners become answers.
struct Rules {
    min_disparity: u32,
    ceiling: u32,
    flat: PixelFlags,
}

impl Rules {
    fn new(config: &Config) -> Self {
        Self {
            min_disparity: u32::from(config.min_disparity),
            ceiling: u32::from(config.disparities) - 1,
            flat: PixelFlags::UNTEXTURED.when(config.checks.refuse_flat),
        }
    }

    /// The answers of some pixels, and what is known of the winners by themselves.
    #[inline(never)]
    fn answer(&self, winners: &[Winner], answers: &mut [Disparity], flags: &mut [PixelFlags]) {
        for (winner, (answer, flags)) in winners.iter().zip(answers.iter_mut().zip(flags)) {
            *answer = refine(winner, self.min_disparity);
            let flat = self.flat.when(winner.rises() == (0, 0));
            *flags = flat.union(PixelFlags::CEILING.when(winner.disparity() == self.ceiling));
        }
    }
}

/// Flags the pixels whose second best costs at most `percent` more of its own cost.
#[inline(never)]
fn mark_ambiguous(winners: &[Winner], percent: u8, flags: &mut [PixelFlags]) {
    let share = 100 - u32::from(percent.min(99));
    for (winner, flags) in winners.iter().zip(flags) {
        let ambiguous = winner.second < u32::MAX && winner.second * share <= winner.cost() * 100;
        *flags = flags.union(PixelFlags::AMBIGUOUS.when(ambiguous));
    }
}

fn slot_mut<T>(rows: &mut [T], index: usize, width: usize) -> &mut [T] {
    rows.get_mut(index * width..).and_then(|r| r.get_mut(..width)).unwrap_or_default()
}
