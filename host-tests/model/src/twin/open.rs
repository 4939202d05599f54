//! Where an image is open: places without edges that reach up to its first row.

use super::{Picture, fattening};
use stereopsis::matching::Config;
use stereopsis::units::{Disparity, PixelFlags};

/// The pixels that are in or beside an open block of four columns, as each row's answers see them.
pub(super) struct Open {
    width: usize,
    near: Vec<bool>,
}

impl Open {
    /// Looks at every other row of the left picture; answers of row `y` are those of line `y + below`.
    pub fn of(config: &Config, left: &Picture<'_>, below: usize) -> Self {
        let (width, height) = (left.width, left.height);
        let blocks = width / 4;
        let mut open = vec![true; blocks];
        let mut rows = Vec::new();
        for y in 0..height {
            if y % 2 == 0 {
                let smooth: Vec<bool> = (0..blocks).map(|block| is_smooth(config, left, block, y)).collect();
                open = joined(&smooth, &open);
            }
            rows.push(open.clone());
        }
        let mut near = Vec::new();
        for y in 0..height {
            let open = &rows[(y + below).min(height - 1)];
            let is_open = |block: usize| open.get(block).copied().unwrap_or(false);
            near.extend(
                (0..width).map(|x| (x / 4).saturating_sub(1)..=x / 4 + 1).map(|mut b| b.any(is_open)),
            );
        }
        Self { width, near }
    }

    /// Whether a pixel is in or beside an open block.
    pub fn is_near(&self, pixel: usize) -> bool {
        self.near[pixel]
    }

    /// The answers and flags of row `y` without those of too small a margin.
    pub fn refuse(
        &self,
        config: &Config,
        y: usize,
        margins: &[u16],
        mut answers: Vec<Disparity>,
        mut flags: Vec<PixelFlags>,
    ) -> (Vec<Disparity>, Vec<PixelFlags>) {
        for x in 0..self.width {
            let is_refused = margins[x].min(127) < u16::from(config.checks.open_margin);
            if is_refused && answers[x].is_some() && self.is_near(y * self.width + x) {
                (answers[x], flags[x]) = (Disparity::NONE, flags[x].union(PixelFlags::AMBIGUOUS));
            }
        }
        (answers, flags)
    }
}

/// Whether a block of row `y` has no edge along the row, and less than the same eight times the gradient down
/// the columns in its sum.
fn is_smooth(config: &Config, left: &Picture<'_>, block: usize, y: usize) -> bool {
    let columns = 4 * block..4 * block + 4;
    let sum = |y: isize| columns.clone().map(|x| i32::from(left.at(x as isize, y))).sum::<i32>();
    let down = sum(y as isize + 1) - sum(y as isize - 1);
    down.abs() < fattening::least_gradient(config)
        && !columns.clone().any(|x| fattening::is_edge(config, left, x, y))
}

/// The smooth blocks that are joined along the row to a smooth one that is open above.
fn joined(smooth: &[bool], above: &[bool]) -> Vec<bool> {
    let mut open = vec![false; smooth.len()];
    let mut waiting: Vec<usize> = (0..smooth.len()).filter(|&block| smooth[block] && above[block]).collect();
    while let Some(block) = waiting.pop() {
        open[block] = true;
        let beside = [block.checked_sub(1), Some(block + 1)].into_iter().flatten();
        waiting.extend(beside.filter(|&next| next < smooth.len() && smooth[next] && !open[next]));
    }
    open
}
