//! Autofocus search: coarse steps, golden section (Kiefer 1953), then a parabola.

use nalgebra::ComplexField;

/// Positions measured over the whole range.
const COARSE: u32 = 7;

/// Where to measure next.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FocusSearchStep {
    /// At that position.
    Measure(u16),
    /// Nowhere: this is the sharpest.
    Best(u16),
    /// Nowhere: it is equally sharp everywhere.
    Flat,
}

/// A search in a range of positions whose sharpness rises to one peak and falls behind it.
///
/// Seven positions over the range. Then golden section between the neighbours of the sharpest, which keeps
/// 0.62 of them for each frame whatever the shape of the peak (Kiefer 1953), while these are much less sharp.
/// On top of the peak differences are as small as noise: its flanks locate it, and the frames that are
/// left go there. Last, the least squares of all.
#[derive(Clone, Debug)]
pub struct FocusSearch {
    least: u16,
    most: u16,
    samples: [(u16, u32); Self::MOST_FRAMES as usize],
    count: u8,
}

impl FocusSearch {
    /// The most frames that are measured.
    pub const MOST_FRAMES: u8 = 12;
    /// Steps of the range, to one of which the search is exact, also beside the ends of the range.
    pub const STEPS: u16 = 64;
    /// The sharpest position is at least so many percent as sharp as the least sharp one, if there is
    /// texture: noise in a few hundred pixels makes less of twelve frames.
    const LEAST_RISE: u64 = 141;

    /// A search from `least` to `most`; contradictory ends are put in order.
    pub const fn new(least: u16, most: u16) -> Self {
        let (least, most) = if least <= most { (least, most) } else { (most, least) };
        Self { least, most, samples: [(0, 0); Self::MOST_FRAMES as usize], count: 0 }
    }

    /// Frames that were measured.
    pub fn frames(&self) -> u8 {
        self.count
    }

    /// The sharpness at the position where the motor says that it is; behind the last frame it is forgotten.
    /// A position beyond an end of the range counts as that end.
    pub fn measured(&mut self, position: u16, sharpness: u32) {
        let position = position.clamp(self.least, self.most);
        if let Some(place) = self.samples.get_mut(usize::from(self.count)) {
            *place = (position, sharpness);
            self.count += 1;
            let (known, _) = self.samples.split_at_mut(self.count.into());
            known.sort_unstable_by_key(|(position, _)| *position);
        }
    }

    /// What to do next. Without new measurements the answer is the same.
    pub fn next(&self) -> FocusSearchStep {
        let range = u32::from(self.most.saturating_sub(self.least));
        let taken = u32::from(self.count);
        if taken < COARSE {
            return FocusSearchStep::Measure(
                self.least.saturating_add((range * taken / (COARSE - 1)) as u16),
            );
        }
        let known = self.samples.get(..usize::from(self.count)).unwrap_or(&[]);
        let values = known.iter().map(|(_, sharpness)| *sharpness);
        let (least, most) = (values.clone().min().unwrap_or(0), values.max().unwrap_or(0));
        if most == 0 || 100 * u64::from(most) < Self::LEAST_RISE * u64::from(least) {
            return FocusSearchStep::Flat;
        }
        let place = known.iter().position(|(_, sharpness)| *sharpness == most).unwrap_or(0);
        let at = |place: usize| known.get(place).copied().unwrap_or((0, 0));
        let (before, top, after) =
            (at(place.saturating_sub(1)), at(place), at((place + 1).min(known.len() - 1)));
        let (left, right) = (top.0 - before.0, after.0 - top.0);
        let step = (range / u32::from(Self::STEPS)).max(1) as u16;
        let spacing = (range / (COARSE - 1)) as u16;
        let bounds =
            (top.0.saturating_sub(spacing).max(self.least), top.0.saturating_add(spacing).min(self.most));
        let (place, width) = vertex(known, top, bounds);
        if self.count >= Self::MOST_FRAMES {
            return FocusSearchStep::Best(place);
        }
        let falls = |side: (u16, u32)| side.0 == top.0 || 2 * u64::from(top.1) > 3 * u64::from(side.1);
        if falls(before) && falls(after) && left.max(right) > step {
            // 0.382 of the larger part, from the sharpest position.
            let part = |length: u16| ((u32::from(length) * 25_033) >> 16).max(1) as u16;
            return FocusSearchStep::Measure(if left > right {
                top.0 - part(left)
            } else {
                top.0 + part(right)
            });
        }
        // To either side in turn, farther and nearer; to the other one at an end of the range.
        let width = width.clamp(step, spacing.max(step));
        let (place, width) = (i32::from(place), i32::from(width));
        let off = match taken - COARSE {
            0 => width,
            1 => -width,
            2 => width / 2,
            3 => -width / 2,
            _ => width * 3 / 4,
        };
        let inside = i32::from(self.least)..=i32::from(self.most);
        let to = if inside.contains(&(place + off)) { place + off } else { place - off * 2 / 3 };
        FocusSearchStep::Measure(to.clamp(*inside.start(), *inside.end()) as u16)
    }
}

/// How one over the sharpness, less what it is in focus, falls behind the square of the distance: with so
/// many times its own square it keeps up. From discs of blur before textures of several sizes; a peak that is
/// seen from one side lies 20 positions of 1023 off without.
const SLOWER: f32 = 1.5;

/// The lowest point of the parabola through what the samples are less sharp than `top`, `top / sharpness`, by
/// least squares.
///
/// Differences of pixels shrink with the area of the blur, so one over the sharpness grows with the square of
/// the distance from focus, and somewhat slower far from it ([`SLOWER`]): a peak near an end of the range,
/// with samples on one side, is found as well. Weighted by a high power of the sharpness: the fourth is one
/// over the variance of one over the sharpness under constant noise, the rest for the blur of a disc, of
/// which all this is only near to true. The top sample's place where the parabola has no lowest point. Beside
/// it, how far off the sharpness has fallen by 15 percent.
fn vertex(samples: &[(u16, u32)], top: (u16, u32), (least, most): (u16, u16)) -> (u16, u16) {
    let scale = f32::from(most - least).max(1.0);
    let (mut s, mut t) = ([0.0_f32; 5], [0.0_f32; 3]);
    for &(position, sharpness) in samples.iter().filter(|(_, sharpness)| *sharpness > 0) {
        let share = sharpness as f32 / top.1 as f32;
        let x = (f32::from(position) - f32::from(top.0)) / scale;
        let square = share * share;
        let fourth = square * square;
        let mut power = fourth * fourth * fourth * fourth;
        for (k, sum) in s.iter_mut().enumerate() {
            *sum += power;
            if let Some(t) = t.get_mut(k) {
                let fall = 1.0 / share - 1.0;
                *t += power * (fall + SLOWER * fall * fall);
            }
            power *= x;
        }
    }
    // The normal equations of m + l x + q x^2 by Cramer's rule; the determinant of all three cancels in -l /
    // (2 q).
    let ([s0, s1, s2, s3, s4], [t0, t1, t2]) = (s, t);
    let q = s0 * (s2 * t2 - s3 * t1) - s1 * (s1 * t2 - s3 * t0) + s2 * (s1 * t1 - s2 * t0);
    let l = s0 * (t1 * s4 - s3 * t2) - t0 * (s1 * s4 - s3 * s2) + s2 * (s1 * t2 - t1 * s2);
    // The determinant, with which q is the parabola's own.
    let all = s0 * (s2 * s4 - s3 * s3) - s1 * (s1 * s4 - s3 * s2) + s2 * (s1 * s3 - s2 * s2);
    if q > 0.0 && all > 0.0 {
        let place = f32::from(top.0) - l / (2.0 * q) * scale;
        let width = ComplexField::sqrt(0.15 * all / q) * scale;
        // A cast of what is out of range is the nearest end.
        (((place + 0.5) as u16).clamp(least, most), width as u16)
    } else {
        (top.0, 0)
    }
}
