//! Nearest obstacle per sector of the field of view, and stixels in pixels and millimetres.

use super::column::{Column, StixelKind};
use super::config::ObstacleConfig;
use super::finder::ObstaclesView;
use super::ground::Ground;
use super::setup::Setup;
use crate::units::Disparity;

/// What a sector shows.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SectorState {
    /// Too little is seen to say anything: never taken for free.
    #[default]
    Blind,
    /// There is no obstacle up to [`Sector::seen_mm`].
    Free,
    /// There is an obstacle.
    Obstacle,
    /// The ground ends.
    Drop,
}

/// The nearest surface in a sector.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sector {
    /// What the sector shows.
    pub state: SectorState,
    /// Bearing of the surface, or of the sector's middle where there is none, thousandths of a radian, to
    /// the right.
    pub bearing_mrad: i16,
    /// Depth of the surface along the optical axis, mm; 0 where there is none.
    pub depth_mm: u16,
    /// Standard deviation of [`Self::depth_mm`], mm.
    pub sigma_mm: u16,
    /// Distance of the surface in the plane of the optical axis and the rows, mm.
    pub range_mm: u16,
    /// Area of the connected surface, px, in whole cells.
    pub pixels: u32,
    /// Height of the surface's upper end above the ground, mm; 0 where no ground is known.
    pub height_mm: i16,
    /// Depth up to which the ground is seen in all columns that show it, mm; without a ground, 65535.
    pub seen_mm: u16,
}

/// The nearest obstacle or drop of a column of cells.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Stixel {
    /// What it is.
    pub kind: StixelKind,
    /// First row of pixels.
    pub top_row: u16,
    /// Last row of pixels.
    pub base_row: u16,
    /// Disparity; of a drop that of the ground at its edge.
    pub disparity: Disparity,
    /// Standard deviation of the disparity, steps of 1/32 px, at most 255.
    pub sigma_steps: u16,
    /// Depth, mm.
    pub depth_mm: u16,
    /// Uppermost row of pixels to which the ground is seen from the lowest one on; the first row below the
    /// cells where it is not, and 65535 where nothing is known.
    pub seen_row: u16,
}

impl Setup {
    /// Depth of a parallax, mm: 65535 beyond, and at or behind infinity.
    pub(super) fn depth_mm(&self, parallax: i32) -> u16 {
        let Ok(parallax @ 1..) = u32::try_from(parallax) else { return u16::MAX };
        let rounded = u64::from(self.millimetre_steps) + u64::from(parallax / 2);
        let depth = u32::try_from(rounded).unwrap_or(u32::MAX).checked_div(parallax);
        depth.unwrap_or(u32::MAX).min(u16::MAX.into()) as u16
    }

    /// Distance to the right of the optical axis of what column `x` of cells shows at a depth, mm.
    pub(super) fn across_mm(&self, x: usize, depth_mm: u16) -> i32 {
        let right = self.cells(&[]).right_16ths(x);
        (i64::from(depth_mm) * right).checked_div(self.rig.focal_16ths.into()).unwrap_or(0) as i32
    }

    /// The share that an obstacle leaves of the camera's height, of a number: of the depth of the ground that
    /// it hides it is the obstacle's depth, of its parallax it is that ground's.
    pub(super) fn above_obstacle(&self, number: u16, ground: &Ground) -> u16 {
        let (height, obstacle) = (u32::from(ground.height_mm), u32::from(self.config.obstacle_mm));
        let left = (u32::from(number) * height.saturating_sub(obstacle)).checked_div(height);
        left.unwrap_or(0) as u16
    }

    /// Deviation of a column's depth, mm.
    pub(super) fn sigma_mm(&self, column: &Column) -> u16 {
        let depth = u64::from(self.depth_mm(column.parallax));
        let parallax = column.parallax.max(1) as u64;
        let sigma = (depth * u64::from(column.sigma) + parallax / 2).checked_div(parallax);
        sigma.unwrap_or(0).min(u16::MAX.into()) as u16
    }

    /// Parallax of the ground in a cell.
    fn ground_at(&self, ground: &Ground, x: usize, row: u8) -> i32 {
        let cells = self.cells(&[]);
        ground.parallax(cells.halves(row.into()), cells.right_16ths(x))
    }

    /// Depth up to which column `x` sees the ground, mm; `None` where it does not.
    pub(super) fn seen_mm(&self, x: usize, column: &Column, ground: Option<&Ground>) -> Option<u16> {
        let depth = |ground: &Ground| self.depth_mm(self.ground_at(ground, x, column.seen));
        (usize::from(column.seen) < self.rows).then(|| ground.map_or(u16::MAX, depth))
    }

    /// The sector of a bearing.
    fn sector_of(&self, bearing_mrad: i16) -> usize {
        let [first, last] = self.ends_mrad.map(i32::from);
        let place = (i32::from(bearing_mrad) - first) * i32::from(self.config.sectors);
        let sector = place.checked_div((last - first).max(1)).unwrap_or(0);
        sector.min(i32::from(self.config.sectors) - 1).max(0) as usize
    }

    /// Bearing of a sector's middle, thousandths of a radian.
    pub(super) fn middle_mrad(&self, sector: usize) -> i16 {
        let [first, last] = self.ends_mrad.map(i32::from);
        let along = (last - first) * (2 * sector as i32 + 1);
        (first + along.checked_div(2 * i32::from(self.config.sectors)).unwrap_or(0)) as i16
    }
}

impl ObstaclesView<'_> {
    /// Number of columns of cells in a frame.
    pub fn columns(&self) -> usize {
        self.setup().map_or(0, |setup| setup.columns)
    }

    /// The ground of the last frame, if one is known whose pitch is sure ([`Ground::is_sure`]).
    pub fn ground(&self) -> Option<Ground> {
        self.plane().filter(Ground::is_sure)
    }

    /// The plane from which heights were measured in the last frame: the ground, or what is known of one of
    /// which too few rows are seen to be sure of its pitch.
    pub fn plane(&self) -> Option<Ground> {
        self.state.carried.ground
    }

    /// The stixel of a column of cells in the last frame; nothing, and no ground that is seen, for a column
    /// that is not there and in a frame that is not finished.
    pub fn stixel(&self, column: usize) -> Stixel {
        let setup = self.setup().filter(|setup| column < setup.columns && self.state.is_finished);
        let Some((setup, found)) = setup.zip(self.columns.get(column)) else {
            return Stixel { seen_row: u16::MAX, ..Stixel::default() };
        };
        let cell = u16::from(setup.config.cell_height);
        let rows = (u16::from(found.top) * cell, u16::from(found.base) * cell + cell - 1);
        let none = found.kind == StixelKind::Nothing;
        let steps = found.parallax - setup.offset_steps;
        Stixel {
            kind: found.kind,
            top_row: if none { 0 } else { rows.0 },
            base_row: if none { 0 } else { rows.1 },
            disparity: match none {
                true => Disparity::NONE,
                false => Disparity::from_raw(steps.clamp(0, Disparity::MAX.raw().into()) as u16),
            },
            sigma_steps: found.sigma.into(),
            depth_mm: if none { 0 } else { setup.depth_mm(found.parallax) },
            seen_row: u16::from(found.seen) * cell,
        }
    }

    /// Number of sectors.
    pub fn sectors(&self) -> usize {
        self.setup().map_or(0, |setup| setup.config.sectors.into())
    }

    /// Sector `index` of the last frame, counted from the left; blind for one that is not there.
    ///
    /// It is blind in a frame that is not to be trusted, and where no surface is found and at most half of
    /// its columns see the ground.
    pub fn sector(&self, index: usize) -> Sector {
        let Some(setup) = self.setup() else { return Sector::default() };
        let mut sector = Sector { bearing_mrad: setup.middle_mrad(index), ..Sector::default() };
        if self.blind().is_some() || index >= setup.config.sectors.into() {
            return sector;
        }
        let ground = self.state.carried.ground;
        let (mut columns, mut seeing, mut nearest) = (0, 0, None::<(usize, &Column)>);
        let (mut seen_mm, all) = (u16::MAX, self.columns.iter().zip(self.bearings.iter()).enumerate());
        for (x, (column, &bearing)) in all.take(setup.columns) {
            if setup.sector_of(bearing) != index {
                continue;
            }
            columns += 1;
            if let Some(seen) = setup.seen_mm(x, column, ground.as_ref()) {
                seeing += 1;
                seen_mm = seen_mm.min(seen);
            }
            if column.is_supported() && nearest.is_none_or(|(_, best)| column.parallax > best.parallax) {
                nearest = Some((x, column));
            }
        }
        if seeing > 0 {
            sector.seen_mm = seen_mm;
        }
        let Some((x, column)) = nearest else {
            if 2 * seeing > columns {
                sector.state = SectorState::Free;
            }
            return sector;
        };
        let drop = column.kind == StixelKind::Drop;
        sector.state = if drop { SectorState::Drop } else { SectorState::Obstacle };
        sector.bearing_mrad = self.bearings.get(x).copied().unwrap_or_default();
        sector.depth_mm = setup.depth_mm(column.parallax);
        sector.sigma_mm = setup.sigma_mm(&self.chosen(&setup, index, column));
        let across = i64::from(setup.across_mm(x, sector.depth_mm));
        let along = i64::from(sector.depth_mm);
        sector.range_mm = ((along * along + across * across) as u64).isqrt().min(u16::MAX.into()) as u16;
        let area = u32::from(setup.config.cell_width) * u32::from(setup.config.cell_height);
        sector.pixels = u32::from(column.surface) * area;
        if let Some(ground) = ground.filter(|_| !drop) {
            let below = setup.ground_at(&ground, x, column.top);
            sector.height_mm = ground.height_above(column.parallax, below);
        }
        sector
    }

    /// The nearest column of a sector, with what it is nearer than the mean of those within a px of it added
    /// to its deviation: the nearest of several is nearer by chance.
    fn chosen(&self, setup: &Setup, index: usize, nearest: &Column) -> Column {
        let all = self.columns.iter().zip(self.bearings.iter()).take(setup.columns);
        let inside =
            all.filter(|(column, bearing)| setup.sector_of(**bearing) == index && column.is_supported());
        let ahead = inside.map(|(column, _)| nearest.parallax - column.parallax);
        let of_it = ahead.filter(|&ahead| ahead <= Disparity::ONE.into());
        let (count, sum) = of_it.fold((0, 0), |(count, sum), ahead| (count + 1, sum + ahead));
        let (ahead, sigma) = (sum.checked_div(count).unwrap_or(0), i32::from(nearest.sigma));
        let sigma = ((sigma * sigma + ahead * ahead) as u32).isqrt().min(255) as u8;
        Column { sigma, ..*nearest }
    }

    /// Depth beyond which no distance is reported, mm.
    pub fn farthest_mm(&self) -> u16 {
        let parallax = |setup: Setup| {
            setup.depth_mm(i32::from(ObstacleConfig::FARTHEST_SIGMAS * setup.config.sigma_steps))
        };
        self.setup().map_or(0, parallax)
    }
}
