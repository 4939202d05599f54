//! Obstacles from whole maps of disparity: cells, the line of the ground, stixels, sectors and decisions,
//! each in its plainest form.
//!
//! * [`Scene`]: a map, its rig and its limits. [`find`]: what is in it.
//! * `ground`: the line of the ground by counting cells and by least squares. `carried`: the same over
//!   frames. `stixels`: the cheapest labels of a column by trying all predecessors. `surfaces`: those of
//!   columns by flooding. `sectors`: the nearest of each by looking at all columns.
//! * `watchdog`: whether a frame is to be trusted. `held`: what counts of all frames so far. `beside`: what
//!   left the picture at its sides. `drive`: a decision from all columns of a corridor.

mod beside;
mod carried;
mod drive;
mod ground;
mod held;
mod sectors;
mod stixels;
mod surfaces;
mod watchdog;

pub use drive::{Decided, Driver};
pub use ground::Line;
pub use held::{counts, free_space};
pub use sectors::{Sector, sectors};
pub use stixels::{Kind, Standing};

use stereopsis::obstacles::{BlindReason, GroundSource, ObstacleConfig};
use stereopsis::units::{Disparity, PixelFlags};

/// A map of disparities with what is needed to find obstacles in it.
#[derive(Clone, Debug)]
pub struct Scene<'a> {
    /// Limits.
    pub config: ObstacleConfig,
    /// Focal length, sixteenths of a px.
    pub focal_16ths: i128,
    /// Column of the principal point, sixteenths of a px.
    pub cx_16ths: i128,
    /// Row of the principal point, halves of a px.
    pub cy_halves: i128,
    /// Baseline, sixteenths of a mm.
    pub baseline_16ths: i128,
    /// Focal length times baseline, mm times steps.
    pub millimetre_steps: i128,
    /// Offset of the principal points, steps.
    pub offset: i128,
    /// Pixels in a row.
    pub width: usize,
    /// Rows of pixels.
    pub height: usize,
    /// Largest disparity, steps.
    pub largest: u16,
    /// Disparities, row by row.
    pub disparities: &'a [Disparity],
    /// Flags.
    pub flags: &'a [PixelFlags],
    /// Confidences, or none.
    pub confidences: &'a [u8],
    /// Whether each row of pixels came.
    pub came: &'a [bool],
    /// What the monitor of the cameras says against them.
    pub cameras: Option<BlindReason>,
    /// The plane of a given pose, in the whole numbers that the core rounds it to: [`Line::of_pose`] says
    /// what they are to be near to.
    pub given: Option<Line>,
}

/// What is in a map.
#[derive(Clone, PartialEq, Debug)]
pub struct Found {
    /// Why the frame is not to be trusted, if it is not.
    pub blind: Option<BlindReason>,
    /// The disparity of each cell, row by row.
    pub cells: Vec<Option<i128>>,
    /// The ground, with those of earlier frames averaged in.
    pub ground: Option<Line>,
    /// What stands in each column.
    pub columns: Vec<Standing>,
}

impl Scene<'_> {
    /// Columns and rows of cells.
    pub fn size(&self) -> [usize; 2] {
        let (w, h) = (usize::from(self.config.cell_width), usize::from(self.config.cell_height));
        [self.width / w, self.height / h]
    }

    /// Half-row of the middle of a row of cells.
    pub fn halves(&self, row: usize) -> i128 {
        let height = i128::from(self.config.cell_height);
        (2 * row as i128 + 1) * height - 1
    }

    /// Least parallax of what counts.
    pub fn farthest(&self) -> i128 {
        i128::from(ObstacleConfig::FARTHEST_SIGMAS) * i128::from(self.config.sigma_steps)
    }

    /// How far the middle of a column of cells is to the right of the principal point, sixteenths of a px.
    pub fn right(&self, column: usize) -> i128 {
        let width = i128::from(self.config.cell_width);
        16 * width * column as i128 + 8 * (width - 1) - self.cx_16ths
    }

    /// Whether no column sees the ground in a row of pixels; without a known one, whether the row is in the
    /// upper half of those above the principal point.
    fn is_sky(&self, y: usize, ground: Option<Line>) -> bool {
        let ends = [0, self.size()[0] - 1].map(|column| self.right(column));
        match (self.config.ground, ground) {
            (GroundSource::Absent, _) => false,
            (_, Some(line)) => ends.iter().all(|right| line.exact(y as i128, *right) < 0),
            (_, None) => (y as i128) < self.cy_halves.div_euclid(4),
        }
    }

    /// The answers in every third column of a cell, in the order in which they come.
    fn answers(&self, column: usize, row: usize, ground: Option<Line>) -> Vec<i128> {
        let (w, h) = (usize::from(self.config.cell_width), usize::from(self.config.cell_height));
        let pixels = (0..h).flat_map(|y| (0..w).step_by(3).map(move |x| (x, y)));
        let pixels = pixels.map(|(x, y)| (row * h + y) * self.width + column * w + x);
        let counts = |&i: &usize| {
            let doubtful = PixelFlags::FILLED.union(PixelFlags::DAMAGED);
            let sky = if self.is_sky(i / self.width, ground) { self.config.sky_confidence } else { 0 };
            let least = self.config.min_confidence.max(sky);
            let sure = self.confidences.is_empty() || self.confidences[i] >= least;
            let comes = self.came[i / self.width] && self.disparities[i].is_some();
            comes && !self.flags[i].intersects(doubtful) && sure
        };
        pixels.filter(counts).map(|i| i128::from(self.disparities[i].raw())).collect()
    }

    /// The nearer of the two groups of a cell, of those with a quarter of its pixels.
    fn cell(&self, column: usize, row: usize, ground: Option<Line>) -> Option<i128> {
        let mut groups: [Vec<i128>; 2] = [Vec::new(), Vec::new()];
        for d in self.answers(column, row, ground) {
            let joins = |group: &Vec<i128>| group.last().is_none_or(|last| (d - last).abs() <= 32);
            if let Some(group) = groups.iter_mut().find(|group| joins(group)) {
                group.push(d);
            } else if groups[1].len() == 1 {
                groups[1] = vec![d];
            }
        }
        let most = usize::from(self.config.cell_width).div_ceil(3) * usize::from(self.config.cell_height);
        let large = groups.iter().filter(|group| !group.is_empty() && 4 * group.len() >= most);
        let mean = |group: &Vec<i128>| {
            let n = group.len() as i128;
            // To the nearest step, halves up.
            (2 * group.iter().sum::<i128>() + n) / (2 * n)
        };
        large.map(mean).max()
    }
}

/// What is in a map, with the ground that earlier frames gave, and the frames since one was last measured.
pub fn find(scene: &Scene<'_>, carried: &mut (Option<Line>, u32)) -> Found {
    let [columns, rows] = scene.size();
    let cells: Vec<_> = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (column, row)))
        .map(|(column, row)| scene.cell(column, row, carried.0))
        .collect();
    let blind = watchdog::blind(scene, &cells);
    let ground = match scene.config.ground {
        GroundSource::Absent => None,
        GroundSource::Given { .. } => {
            *carried = (scene.given, 0);
            scene.given
        }
        GroundSource::Searched { .. } => {
            let measured = if blind.is_none() { ground::fit(scene, &cells, carried.0) } else { None };
            carried::carry(scene, carried, measured);
            carried.0
        }
    };
    let columns = surfaces::stixels(scene, &cells, ground);
    Found { blind, cells, ground, columns }
}
