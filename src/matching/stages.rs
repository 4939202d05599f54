//! One row through the stages, over slices: compiled once for each scheme, whatever the capacities.

use super::answers::{self, Winners};
use super::confidence;
use super::config::Config;
use super::down;
use super::fill;
use super::kernels::{Kernel, Winner, bytes_of, halves_mut, winners_mut};
use super::median;
use super::memory::first;
use super::row::{HISTORY, slot};
use super::scheme::{Around, Scheme};
use super::speckle::{BAND, LOOK_AHEAD, Support};
use super::surface;
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
    pub(super) codes: &'a mut [u8],
    pub(super) columns: &'a mut [u8],
    pub(super) scratch: &'a mut [u32],
    pub(super) texture: Texture<'a>,
    pub(super) winners: &'a mut [Winner],
    pub(super) right: &'a mut [u16],
    pub(super) band: &'a mut [Disparity],
    pub(super) flags: &'a mut [PixelFlags],
    pub(super) support: Support<'a>,
    pub(super) finished: &'a mut [Disparity],
}

impl<S: Scheme> Stages<'_, S> {
    /// Forgets the frame before.
    #[inline(never)]
    pub(super) fn begin(self) {
        self.columns.fill(0);
        self.texture.clear();
        self.support.begin(self.band);
    }

    /// Takes row `y` of both images (`None` below the last one) and finishes the row that is due with it.
    pub(super) fn step(mut self, y: usize, lines: Option<[&Around<'_>; 2]>) {
        if let Some([left, right]) = lines {
            S::enter(&mut self, y, [left, right]);
        }
        if self.config.checks.texture_pixels > 0 {
            let line = lines.and_then(|[left, _]| left[2].get(..self.width));
            self.texture.push::<S>(line, &self.config.checks);
        }
        self.match_row(y, lines);
    }

    /// Flags the row `index`, which just came out, as one that rests on a lost line.
    pub(super) fn mark_damaged(self, index: usize, keeps_answers: bool) {
        for flags in slot_mut(self.flags, index % BAND, self.width) {
            let others = if keeps_answers { *flags } else { flags.without(PixelFlags::FILLED) };
            *flags = others.union(PixelFlags::DAMAGED);
        }
        if !keeps_answers {
            slot_mut(self.finished, index % HISTORY, self.width).fill(Disparity::NONE);
            if self.config.confidence {
                // Where the winners share the scratch, they are the first in it.
                let winners = if self.winners.is_empty() { winners_mut(self.scratch) } else { self.winners };
                first(bytes_of(winners), self.width).fill(0);
            }
        }
    }

    /// Adds row `bottom`, answers for the row that has its costs with it, and judges the one that waited for
    /// that.
    fn match_row(&mut self, bottom: usize, lines: Option<[&Around<'_>; 2]>) {
        let height = usize::from(self.config.height);
        let row = bottom.checked_sub(S::RADIUS_Y);
        if let Some(row) = row {
            self.prepare(row);
        }
        S::select(self, bottom, lines, row.filter(|&row| row < height));
        let Some(row) = row else { return };
        if row < height {
            self.answer(row);
        } else {
            // No surface goes on below the image.
            slot_mut(self.band, row % BAND, self.width).fill(Disparity::NONE);
        }
        let checks = &self.config.checks;
        let judged = row + BAND - LOOK_AHEAD;
        if let Some(judged) = row.checked_sub(LOOK_AHEAD).filter(|_| self.config.confidence) {
            self.tell(judged);
        }
        let flags = slot_mut(self.flags, judged % BAND, self.width);
        let finished = slot_mut(self.finished, judged % HISTORY, self.width);
        if checks.median {
            self.support.count_in_place(row, self.band, checks, flags, finished);
        } else {
            self.support.count(row, self.band, checks, flags, finished);
        }
        // The first row has none above it, and the last have none so far below.
        if S::SMOOTH_DOWN && checks.smoothing_radius > 0 && row > LOOK_AHEAD && row < height {
            down::smooth(self.kernel, judged, self.finished, slot(self.band, row % BAND, self.width));
        }
        let flags = slot_mut(self.flags, judged % BAND, self.width);
        let finished = slot_mut(self.finished, judged % HISTORY, self.width);
        if checks.fill_pixels > 0 {
            fill::fill(finished, flags, checks.fill_pixels, checks.fill_step);
        }
        if self.config.confidence {
            confidence::judge(finished, flags, first(bytes_of(self.winners), self.width));
        }
    }

    /// Makes the confidences of the row to be judged, where its winners stood.
    fn tell(&mut self, judged: usize) {
        let (width, finished, band) = (self.width, &*self.finished, &*self.band);
        let row = slot(band, judged % BAND, width);
        let answers = if self.config.checks.median { slot(finished, judged % HISTORY, width) } else { row };
        let [near, far] = confidence::ROWS;
        let above =
            |off: usize| judged.checked_sub(off).map_or(&[][..], |y| slot(finished, y % HISTORY, width));
        let below = |off: usize| slot(band, (judged + off) % BAND, width);
        let around =
            confidence::Around { answers, row, columns: [above(near), above(far), below(near), below(far)] };
        let confidences = first(bytes_of(self.winners), width);
        confidence::tell(&around, slot_mut(self.flags, judged % BAND, width), confidences);
    }

    /// Makes room for `row`: the row that came out last goes into the history as it was judged, and the
    /// medians are made of the one to be judged next, for which the band must still hold the row above
    /// it.
    fn prepare(&mut self, row: usize) {
        let checks = &self.config.checks;
        if checks.fill_pixels > 0 {
            let (flags, out) = (slot(self.flags, row % BAND, self.width), row % HISTORY);
            fill::take_back(slot_mut(self.finished, out, self.width), flags);
        }
        let judged = row + BAND - LOOK_AHEAD;
        let of_band = |row: usize| slot(self.band, row % BAND, self.width);
        if checks.median {
            let finished = slot_mut(self.finished, judged % HISTORY, self.width);
            median::median(self.kernel, [row, judged, judged + 1].map(of_band), finished);
        }
    }

    /// Turns winners into answers, but for those that the checks contradict, and averages them along the row.
    fn answer(&mut self, row: usize) {
        let checks = &self.config.checks;
        let (flags, answers) =
            (slot_mut(self.flags, row % BAND, self.width), slot_mut(self.band, row % BAND, self.width));
        if checks.texture_pixels > 0 {
            self.texture.mark::<S>(u16::from(checks.texture_pixels), flags);
        }
        // The kernel is done with its room.
        let winners = Winners { winners: self.winners, right: self.right, room: self.scratch };
        answers::answer::<S>(self.kernel, self.config, winners, answers, flags);
        if self.config.confidence {
            confidence::keep(
                self.config,
                confidence::margins(self.config, self.support.lengths),
                answers,
                flags,
            );
        }
        surface::average(self.kernel, answers, self.support.lengths, halves_mut(self.scratch), checks);
    }
}

/// The same, to write.
#[cfg_attr(all(target_pointer_width = "32", not(stereopsis_dsp)), inline(never))]
pub(super) fn slot_mut<T>(rows: &mut [T], index: usize, width: usize) -> &mut [T] {
    rows.get_mut(index * width..).and_then(|r| r.get_mut(..width)).unwrap_or_default()
}
