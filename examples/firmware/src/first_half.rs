//! Codes, costs and their sums on this core, by the equations of `docs/bits.md`, in the bytes that
//! `stereo dump` writes: `census.bin`, `cost.bin` and `aggregated.bin`.
//!
//! The matcher's own are in a form that suits the core, and go through no row of memory; these are what an
//! engineer compares a block with. Of `sgm-edge`, which looks two rows ahead, there are no sums.

use crate::candidates::{
    ALONG_PATHS, Column, LANES, Lines, Looks, NAME, NO_LOOKS, WALKED, at, costs, feature, message, sum,
};
use crate::choice::{NOISE, ROOM};
use crate::host::{HostError, HostFile};
use stereopsis::imaging::{Noise, census_plus4, census_ring8, census_wide8, smooth};
use stereopsis::matching::{Config, Penalties};

const WITHIN_EDGES: bool = NAME.len() == 8 && NAME[4] == b'e';
/// Rows that the window looks up and down, and the columns' unit.
const RADIUS: usize = if NAME[0] == b'f' { 3 } else { 4 };
const UNIT: u8 = if NAME[0] == b'f' { 1 } else { 4 };
/// Rows of pixels that are held: those under the window and the one that leaves it.
const ROWS: usize = if ALONG_PATHS { 1 } else { 2 * RADIUS + 2 };
/// Columns of smoothed lines.
const SMOOTHED: usize = if matches!(NOISE, Noise::None) { 1 } else { ROOM };

/// What is kept from row to row.
pub struct FirstHalf {
    /// The last rows of both images, row `y` at `y % ROWS`.
    looks: [[Looks; 2]; ROWS],
    /// The columns' sums over the window, or their averages.
    columns: [Column; ROOM],
    /// The path to the left, and that from above, of each column.
    left: [Column; WALKED],
    down: [Column; WALKED],
    /// The left image's last row and the one above it.
    guides: [[u8; WALKED]; 2],
    smoothed: [[u8; SMOOTHED]; 5],
}

/// A file for each stage.
pub struct Files {
    census: HostFile,
    costs: HostFile,
    sums: HostFile,
}

impl Files {
    /// Empty files.
    ///
    /// # Errors
    /// When the host does not let them be made.
    pub fn create() -> Result<Self, HostError> {
        Ok(Self {
            census: HostFile::create(c"census.bin")?,
            costs: HostFile::create(c"cost.bin")?,
            sums: HostFile::create(c"aggregated.bin")?,
        })
    }
}

impl Default for FirstHalf {
    fn default() -> Self {
        Self::new()
    }
}

impl FirstHalf {
    /// Rows below the one whose sums are there.
    pub const DELAY: usize = if ALONG_PATHS { 1 } else { RADIUS };

    /// Nothing yet.
    pub const fn new() -> Self {
        Self {
            looks: [const { [NO_LOOKS; 2] }; ROWS],
            columns: [[0; LANES]; ROOM],
            left: [[0; LANES]; WALKED],
            down: [[0; LANES]; WALKED],
            guides: [[0; WALKED]; 2],
            smoothed: [[0; SMOOTHED]; 5],
        }
    }

    /// Takes row `y`, `None` below the last one, and writes its codes and costs, and the sums of the row
    /// [`DELAY`](Self::DELAY) above it.
    ///
    /// # Errors
    /// When the host did not take all of them.
    pub fn step(
        &mut self,
        y: usize,
        lines: Option<[&Lines<'_>; 2]>,
        config: &Config,
        files: &Files,
    ) -> Result<(), HostError> {
        let width = usize::from(config.width).min(ROOM);
        if let Some(lines) = lines {
            self.look(y, lines, width, config);
            self.write_row(y, width, &config.penalties, files)?;
        }
        if let Some(leaves) = y.checked_sub(2 * RADIUS + 1).filter(|_| !ALONG_PATHS) {
            for (x, column) in self.columns.iter_mut().enumerate().take(width) {
                let costs = costs(self.looks.get(leaves % ROWS), x, width, &config.penalties);
                column.iter_mut().zip(costs).for_each(|(sum, cost)| *sum = sum.wrapping_sub(cost));
            }
        }
        let row = y.checked_sub(Self::DELAY).filter(|&row| row < usize::from(config.height));
        match row {
            Some(row) if ALONG_PATHS && !WITHIN_EDGES => self.write_paths(row, width, config, files)?,
            Some(_) if !ALONG_PATHS => self.write_windows(width, files)?,
            _ => {}
        }
        if let Some(([left, _], [newest, above])) = lines.zip(Some(&mut self.guides)) {
            *above = *newest;
            match NOISE {
                Noise::None => newest.iter_mut().zip(left[2]).for_each(|(to, &pixel)| *to = pixel),
                _ => smooth(left, 2, newest),
            }
        }
        Ok(())
    }

    /// What the pixels of row `y` look like, in both images.
    fn look(&mut self, y: usize, lines: [&Lines<'_>; 2], width: usize, config: &Config) {
        let Some(looks) = self.looks.get_mut(y % ROWS) else { return };
        for (Looks { codes, features }, lines) in looks.iter_mut().zip(lines) {
            let mut seen = *lines;
            if NOISE != Noise::None {
                for (row, to) in self.smoothed.iter_mut().enumerate() {
                    smooth(lines, row, to.get_mut(..width).unwrap_or_default());
                }
                seen = self.smoothed.each_ref().map(|line| line.get(..width).unwrap_or_default());
            }
            match NAME[0] {
                b'f' => census_plus4(&seen, codes),
                b'b' => census_ring8(&seen, codes),
                _ => census_wide8(&seen, codes),
            }
            if ALONG_PATHS {
                for (x, to) in features.iter_mut().enumerate().take(width) {
                    *to = feature(&seen, x, width, config.penalties.gradient);
                }
            }
        }
    }

    /// Writes the codes and the costs of row `y`, and adds these to the columns.
    fn write_row(
        &mut self,
        y: usize,
        width: usize,
        penalties: &Penalties,
        files: &Files,
    ) -> Result<(), HostError> {
        let looks = self.looks.get(y % ROWS);
        for Looks { codes, .. } in looks.into_iter().flatten() {
            files.census.write(codes.get(..width).unwrap_or_default())?;
        }
        for (x, column) in self.columns.iter_mut().enumerate().take(width) {
            let costs = costs(looks, x, width, penalties);
            files.costs.write(&costs)?;
            for (to, cost) in column.iter_mut().zip(costs) {
                *to = match (ALONG_PATHS, y) {
                    (false, 0) => cost,
                    (false, _) => to.wrapping_add(cost),
                    (true, 0) => cost.div_ceil(2),
                    (true, _) => to.wrapping_add(cost).div_ceil(2),
                };
            }
        }
        Ok(())
    }

    /// Writes the sums over the window.
    fn write_windows(&self, width: usize, files: &Files) -> Result<(), HostError> {
        for x in 0..width {
            let mut sums = [0_u8; LANES];
            let under = self.columns.iter().take(width.min(x + 5)).skip(x.saturating_sub(4));
            for column in under {
                sums.iter_mut()
                    .zip(column)
                    .for_each(|(sum, of_column)| *sum = sum.wrapping_add(of_column / UNIT));
            }
            files.sums.write(&sums)?;
        }
        Ok(())
    }

    /// Writes the sums along the three paths into `row`.
    fn write_paths(
        &mut self,
        row: usize,
        width: usize,
        config: &Config,
        files: &Files,
    ) -> Result<(), HostError> {
        let penalties = &config.penalties;
        let [here, above] = &self.guides;
        let change = |x: usize, from: usize, of: &[u8; WALKED]| {
            let at = |line: &[u8; WALKED], x: usize| line.get(x).copied().unwrap_or(0);
            at(here, x).abs_diff(at(of, from))
        };
        let mut path = [0; LANES];
        for x in (0..width).rev() {
            let Some((average, to)) = self.columns.get(x).zip(self.left.get_mut(x)) else { break };
            let comes =
                if x + 1 < width { message(&path, change(x, x + 1, here), penalties) } else { [0; LANES] };
            path = sum(average, &comes);
            *to = path;
        }
        // Of the row above: the columns at x - 2 to x, and at x + 2.
        let mut behind = [self.down.first().copied().unwrap_or([0; LANES]); 3];
        for x in 0..width {
            let beyond = self.down.get((x + 2).min(width - 1)).copied().unwrap_or([0; LANES]);
            let Some(((average, left), down)) =
                self.columns.get(x).zip(self.left.get(x)).zip(self.down.get_mut(x))
            else {
                break;
            };
            behind = [behind[1], behind[2], *down];
            let both: Column = core::array::from_fn(|d| at(&behind[0], d).midpoint(at(&beyond, d)));
            let comes = if row > 0 { message(&both, change(x, x, above), penalties) } else { [0; LANES] };
            *down = sum(average, &comes);
            let comes = if x > 0 { message(&path, change(x, x - 1, here), penalties) } else { [0; LANES] };
            path = sum(average, &comes);
            let sums: Column = core::array::from_fn(|d| {
                at(&path, d).saturating_add(at(left, d)).saturating_add(at(down, d))
            });
            files.sums.write(&sums)?;
        }
        Ok(())
    }
}
