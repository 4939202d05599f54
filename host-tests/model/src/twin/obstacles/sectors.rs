//! The nearest surface of each sector, by looking at every column for every sector.

use super::{Found, Kind, Line, Scene, Standing};
use stereopsis::obstacles::SectorState;

/// What a sector shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Sector {
    /// What it is.
    pub state: SectorState,
    /// Bearing of the surface, or of the middle, mrad to the right.
    pub bearing_mrad: i128,
    /// Depth of the surface, mm.
    pub depth_mm: i128,
    /// Deviation of the depth, mm.
    pub sigma_mm: i128,
    /// Distance of the surface in the plane of the rows, mm.
    pub range_mm: i128,
    /// Area of the connected surface, px.
    pub pixels: i128,
    /// Height of its upper end above the ground, mm.
    pub height_mm: i128,
    /// Depth up to which all columns that show the ground show it, mm.
    pub seen_mm: i128,
}

impl Scene<'_> {
    /// Thousandths of a radian to the right of the optical axis, before rounding.
    pub fn bearing(&self, pixel: f64) -> f64 {
        1000.0 * ((16.0 * pixel - self.cx_16ths as f64) / self.focal_16ths as f64).atan()
    }

    /// Bearing of the middle of a column of cells, before rounding.
    pub fn column_bearing(&self, column: usize) -> f64 {
        let width = f64::from(self.config.cell_width);
        self.bearing(column as f64 * width + (width - 1.0) / 2.0)
    }

    pub(super) fn depth_mm(&self, parallax: i128) -> i128 {
        if parallax <= 0 { 65_535 } else { ((self.millimetre_steps + parallax / 2) / parallax).min(65_535) }
    }
}

/// All sectors of a frame, from the left; all are blind where it is not to be trusted.
pub fn sectors(scene: &Scene<'_>, found: &Found) -> Vec<Sector> {
    let [columns, _] = scene.size();
    let count = i128::from(scene.config.sectors);
    let last = (columns * usize::from(scene.config.cell_width) - 1) as f64;
    let [first, last] = [0.0, last].map(|pixel| scene.bearing(pixel).round() as i128);
    let of = |column: usize| {
        let along = scene.column_bearing(column).round() as i128 - first;
        (along * count / (last - first).max(1)).clamp(0, count - 1)
    };
    let middle = |sector: i128| first + (last - first) * (2 * sector + 1) / (2 * count);
    (0..count)
        .map(|sector| {
            let inside: Vec<_> = (0..columns).filter(|&x| of(x) == sector).collect();
            one(scene, found, &inside, middle(sector))
        })
        .collect()
}

/// A sector of these columns.
fn one(scene: &Scene<'_>, found: &Found, inside: &[usize], middle_mrad: i128) -> Sector {
    let mut sector = Sector {
        state: SectorState::Blind,
        bearing_mrad: middle_mrad,
        depth_mm: 0,
        sigma_mm: 0,
        range_mm: 0,
        pixels: 0,
        height_mm: 0,
        seen_mm: 0,
    };
    if found.blind.is_some() {
        return sector;
    }
    let [_, rows] = scene.size();
    let seen = |x: usize, standing: &Standing| {
        let at = |line: Line| line.at(scene.halves(standing.seen), scene.right(x));
        let ground = found.ground.map(|line| scene.depth_mm(at(line)));
        (standing.seen < rows).then(|| ground.unwrap_or(65_535))
    };
    let seen: Vec<_> = inside.iter().filter_map(|&x| seen(x, &found.columns[x])).collect();
    sector.seen_mm = seen.iter().copied().min().unwrap_or(0);
    if 2 * seen.len() > inside.len() {
        sector.state = SectorState::Free;
    }
    let mut standing: Vec<_> =
        inside.iter().filter_map(|&x| Some((x, found.columns[x].found.as_ref()?))).collect();
    // Of equals the left one.
    standing.sort_by_key(|(x, segment)| (-segment.parallax, *x));
    let Some((x, nearest)) = standing.first() else { return sector };
    let (config, parallax) = (&scene.config, nearest.parallax);
    let (width, height) = (i128::from(config.cell_width), i128::from(config.cell_height));
    let depth = scene.depth_mm(parallax);
    let across = depth * scene.right(*x) / scene.focal_16ths;
    sector.state = if nearest.kind == Kind::Drop { SectorState::Drop } else { SectorState::Obstacle };
    sector.bearing_mrad = scene.column_bearing(*x).round() as i128;
    sector.depth_mm = depth;
    // Those within a px of the nearest, it among them.
    let ahead: Vec<_> = standing.iter().map(|(_, s)| parallax - s.parallax).filter(|&a| a <= 32).collect();
    let mean = ahead.iter().sum::<i128>() / ahead.len() as i128;
    let sigma = (nearest.sigma * nearest.sigma + mean * mean).isqrt().min(255);
    sector.sigma_mm = ((depth * sigma + parallax / 2) / parallax).min(65_535);
    sector.range_mm = ((depth * depth + across * across).isqrt()).min(65_535);
    sector.pixels = found.columns[*x].surface.min(65_535) as i128 * width * height;
    if let Some(line) = found.ground.filter(|_| nearest.kind != Kind::Drop) {
        let above =
            line.height_mm * (parallax - line.at(scene.halves(nearest.top), scene.right(*x))) / parallax;
        sector.height_mm = above.clamp(-32_768, 32_767);
    }
    sector
}
