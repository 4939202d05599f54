//! What left the picture at its sides while it was in the corridor.

use super::{Found, Scene};
use stereopsis::obstacles::Hysteresis;

/// A side of the picture with what is held beside it: a distance, mm, and the frames since it was seen.
#[derive(Clone, Copy, Default, Debug)]
pub struct Beside {
    held: Option<(i128, u32)>,
}

/// What a frame shows at a side: in the corridor and about to leave, in it and wider, or not in it.
#[derive(Clone, Copy, PartialEq)]
enum Shown {
    Leaving(i128),
    Wide(i128),
    There(i128),
}

/// A side of a frame.
pub struct Side<'a> {
    pub scene: &'a Scene<'a>,
    pub found: &'a Found,
    pub is_right: bool,
    pub half_mm: i128,
    pub way_mm: i128,
}

impl Side<'_> {
    /// Columns from this side on.
    fn order(&self) -> Vec<usize> {
        let columns = 0..self.scene.size()[0];
        if self.is_right { columns.rev().collect() } else { columns.collect() }
    }

    /// How far outward a column looks at a depth, mm.
    fn outward(&self, x: usize, mm: i128) -> i128 {
        let across = mm * self.scene.right(x) / self.scene.focal_16ths;
        if self.is_right { across } else { -across }
    }

    /// The same of the part of the picture that both cameras see, which begins on the left at the disparity.
    fn outward_of_both(&self, x: usize, mm: i128) -> i128 {
        if self.is_right || mm == 0 {
            return self.outward(x, mm);
        }
        let disparity = (self.scene.millimetre_steps / mm - self.scene.offset).max(0);
        -(mm * (self.scene.right(x) + disparity / 2) / self.scene.focal_16ths)
    }

    /// Depth less two deviations and parallax of a column's surface.
    fn surface(&self, x: usize) -> Option<(i128, i128)> {
        let found = self.found.columns[x].found.as_ref()?;
        let depth = self.scene.depth_mm(found.parallax);
        let sigma = ((depth * found.sigma + found.parallax / 2) / found.parallax).min(65_535);
        Some(((depth - (2 * sigma).min(65_535)).max(0), found.parallax))
    }

    fn shown(&self) -> Option<Shown> {
        let order = self.order();
        let cell = usize::from(self.scene.config.cell_width);
        let inner = order[18_usize.div_ceil(cell).min(order.len() - 1)];
        let is_beside = |x: usize, mm: i128| {
            self.outward(x, mm) >= self.outward_of_both(inner, (mm - self.way_mm).max(0)).max(0)
        };
        let beside: Vec<_> = (0..order.len())
            .filter_map(|place| Some((place, self.surface(order[place])?.0)))
            .filter(|&(place, mm)| is_beside(order[place], mm))
            .collect();
        let leaves = |&(place, mm): &(usize, i128)| {
            let is_inside = self.outward(order[place], mm).abs() <= self.half_mm;
            is_inside && self.outward_of_both(order[0], mm) < self.half_mm
        };
        let Some(&(first, mm)) = beside.iter().filter(|at| leaves(at)).min_by_key(|&&(_, mm)| mm) else {
            return beside.iter().map(|&(_, mm)| mm).min().map(Shown::There);
        };
        let of = |place: usize| self.surface(order[place]).map(|(_, parallax)| parallax);
        let mut inmost = first;
        while inmost + 1 < order.len() && of(inmost + 1).is_some_and(|p| p + 32 >= of(first).unwrap_or(0)) {
            inmost += 1;
        }
        Some(if is_beside(order[inmost], mm) { Shown::Leaving(mm) } else { Shown::Wide(mm) })
    }
}

impl Beside {
    /// The distance that counts.
    pub fn mm(&self) -> Option<i128> {
        self.held.map(|(mm, _)| mm)
    }

    /// Takes a frame, the last of so many in a row with something in the corridor.
    pub fn take(&mut self, side: &Side<'_>, in_a_row: usize, rule: Hysteresis) {
        let shown = side.shown();
        let missed = self.held.map_or(0, |(_, missed)| missed);
        let is_it = |mm: i128| self.held.is_none_or(|(held, _)| mm <= held + held / 8);
        self.held = match shown {
            Some(Shown::Leaving(mm)) if is_it(mm) => {
                let is_sure = self.held.is_some() || in_a_row >= usize::from(rule.confirm.max(2));
                is_sure.then_some((mm.max(1), 0))
            }
            Some(Shown::There(mm)) if is_it(mm) => None,
            Some(Shown::Wide(mm)) if is_it(mm) && missed <= u32::from(rule.release) => None,
            _ => self.held.map(|(mm, missed)| (mm, (missed + 1).min(255))),
        };
    }
}
