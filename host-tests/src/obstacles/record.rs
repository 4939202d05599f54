//! What is found in a frame, for `obstacles.json`.

use super::Vehicle;
use serde::Serialize;
use std::fmt::Write as _;
use stereopsis::obstacles::{
    Decision, FreeSpace, Ground, ObstacleConfig, ObstaclesView, Sector, SectorState, Stixel, StixelKind,
    Verdict,
};
use stereopsis::units::Disparity;

/// What is found in a frame. Angles are in degrees, to the right; lengths in metres.
#[derive(Clone, Debug, Serialize)]
pub struct ObstacleRecord {
    /// Number of the frame since the sequence began, or began anew: 1 is the first.
    pub frame: usize,
    /// Why the frame is not to be trusted, if it is not.
    pub blind: Option<String>,
    /// Columns and rows of pixels in a cell.
    pub cell: [u8; 2],
    /// The ground, if one is known whose pitch is sure: three deviations of it are within half a degree.
    pub ground: Option<GroundRecord>,
    /// The plane from which heights are measured: the ground, or what is known of one of which too few rows
    /// are seen to be sure of its pitch.
    pub plane: Option<GroundRecord>,
    /// What is nearest by bearing, from the left.
    pub sectors: Vec<SectorRecord>,
    /// The sectors with hysteresis over the frames: an obstacle is let go of with the third frame without it.
    pub free_space: Vec<SectorRecord>,
    /// The sectors in the meaning of ROS's LaserScan.
    pub scan: ScanRecord,
    /// What stands in each column of cells that something stands in.
    pub stixels: Vec<StixelRecord>,
    /// What the vehicle has to do.
    pub decision: DecisionRecord,
}

/// A ground plane.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct GroundRecord {
    /// Height of the camera above it, m.
    pub height_m: f32,
    /// Downward pitch of the camera, degrees.
    pub pitch_deg: f32,
    /// Deviation of the pitch, degrees.
    pub pitch_sigma_deg: f32,
    /// Roll of the camera, degrees: positive where its right side is the lower one.
    pub roll_deg: f32,
    /// Deviation of its disparities, px.
    pub sigma_px: f32,
}

/// A sector; see [`Sector`].
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SectorRecord {
    /// Blind, free, obstacle or drop.
    pub state: &'static str,
    /// Bearing of what is there, or of the middle.
    pub bearing_deg: f32,
    /// Depth of what is there.
    pub depth_m: Option<f32>,
    /// Deviation of the depth.
    pub sigma_m: Option<f32>,
    range_m: Option<f32>,
    pixels: u32,
    height_m: Option<f32>,
    seen_m: f32,
}

/// A laser scan from right to left, angles in radians to the left. A range is a number of metres; "inf" where
/// the sector is free, and null where it is blind.
#[derive(Clone, Debug, Serialize)]
pub struct ScanRecord {
    angle_min: f32,
    angle_max: f32,
    angle_increment: f32,
    range_min: f32,
    range_max: f32,
    ranges: Vec<RangeRecord>,
}

/// A range of a scan.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(untagged)]
pub enum RangeRecord {
    /// Metres.
    Metres(f32),
    /// Nothing returns.
    Free(&'static str),
    /// It is not valid.
    Blind(()),
}

/// A stixel.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct StixelRecord {
    kind: &'static str,
    /// First and last column of pixels.
    columns: [usize; 2],
    /// First and last row of pixels.
    rows: [u16; 2],
    disparity_px: f32,
    sigma_px: f32,
    depth_m: f32,
}

/// What the vehicle has to do at its speed.
#[derive(Clone, Debug, Serialize)]
pub struct DecisionRecord {
    /// Clear, slow, stop or blind.
    pub decision: &'static str,
    /// Distance of what is in the way, less two deviations, m.
    pub distance_m: Option<f32>,
    /// Why nothing is known.
    pub reason: Option<String>,
    speed_m_s: f32,
    corridor_m: f32,
    stopping_m: f32,
    /// Time until it reaches what is in the way.
    pub contact_s: Option<f32>,
}

fn metres(mm: impl Into<f32>) -> f32 {
    mm.into() / 1000.0
}

fn pixels(steps: u16) -> f32 {
    f32::from(steps) / f32::from(Disparity::ONE)
}

impl ObstacleRecord {
    /// What a frame shows.
    pub(super) fn new(
        config: &ObstacleConfig,
        frame: &ObstaclesView<'_>,
        space: &FreeSpace,
        verdict: &Verdict,
        vehicle: &Vehicle,
    ) -> Self {
        let stixels = (0..frame.columns()).filter_map(|x| {
            let stixel = frame.stixel(x);
            (stixel.kind != StixelKind::Nothing).then(|| StixelRecord::new(config, x, &stixel))
        });
        Self {
            frame: 1,
            blind: frame.blind().map(|reason| format!("{reason:?}")),
            cell: [config.cell_width, config.cell_height],
            ground: frame.ground().as_ref().map(GroundRecord::new),
            plane: frame.plane().as_ref().map(GroundRecord::new),
            sectors: (0..frame.sectors()).map(|i| SectorRecord::new(&frame.sector(i))).collect(),
            free_space: (0..frame.sectors()).map(|i| SectorRecord::new(&space.sector(i))).collect(),
            scan: ScanRecord::new(frame),
            stixels: stixels.collect(),
            decision: DecisionRecord::new(verdict, vehicle),
        }
    }

    /// The record as that of frame `number` of its sequence.
    pub(super) fn numbered(self, number: usize) -> Self {
        Self { frame: number, ..self }
    }

    /// Index in [`Self::sectors`] of the nearest surface.
    pub fn nearest(&self) -> Option<usize> {
        let depths = self.sectors.iter().enumerate().filter_map(|(i, sector)| Some((i, sector.depth_m?)));
        depths.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
    }

    /// The decision and the ground in a line.
    pub fn line(&self) -> String {
        let DecisionRecord { decision, distance_m, reason, .. } = &self.decision;
        let mut line = (*decision).to_owned();
        if let Some(distance_m) = distance_m {
            let _ = write!(line, ", {distance_m:.2} m ahead");
        }
        if let Some(reason) = reason {
            let _ = write!(line, " ({reason})");
        }
        match (&self.ground, &self.plane) {
            (Some(GroundRecord { height_m, pitch_deg, .. }), _) => {
                let _ = write!(line, "; ground {height_m:.2} m below, pitch {pitch_deg:.1} degrees down");
            }
            (None, Some(GroundRecord { pitch_sigma_deg, .. })) => {
                let _ = write!(
                    line,
                    "; ground seen over too few rows (its pitch sure to {:.1} degrees, over .5)",
                    3.0 * pitch_sigma_deg
                );
            }
            (None, None) => line += "; no ground",
        }
        line
    }
}

impl GroundRecord {
    fn new(ground: &Ground) -> Self {
        Self {
            height_m: metres(ground.height_mm),
            pitch_deg: ground.pitch_rad().to_degrees(),
            pitch_sigma_deg: ground.pitch_sigma_rad().to_degrees(),
            roll_deg: ground.roll_rad().to_degrees(),
            sigma_px: (ground.variance as f32).sqrt() / f32::from(Disparity::ONE),
        }
    }
}

impl SectorRecord {
    fn new(sector: &Sector) -> Self {
        let shows = matches!(sector.state, SectorState::Obstacle | SectorState::Drop);
        let of = |mm: u16| shows.then(|| metres(mm));
        Self {
            state: match sector.state {
                SectorState::Blind => "blind",
                SectorState::Free => "free",
                SectorState::Obstacle => "obstacle",
                SectorState::Drop => "drop",
            },
            bearing_deg: metres(sector.bearing_mrad).to_degrees(),
            depth_m: of(sector.depth_mm),
            sigma_m: of(sector.sigma_mm),
            range_m: of(sector.range_mm),
            pixels: sector.pixels,
            height_m: (sector.state == SectorState::Obstacle).then(|| metres(sector.height_mm)),
            seen_m: metres(sector.seen_mm),
        }
    }
}

impl ScanRecord {
    fn new(frame: &ObstaclesView<'_>) -> Self {
        let mut ranges = [0.0; ObstacleConfig::MOST_SECTORS];
        let scan = frame.laser_scan(&mut ranges);
        let range = |&range: &f32| match range {
            r if r.is_nan() => RangeRecord::Blind(()),
            r if r.is_infinite() => RangeRecord::Free("inf"),
            r => RangeRecord::Metres(r),
        };
        Self {
            angle_min: scan.angle_min,
            angle_max: scan.angle_max,
            angle_increment: scan.angle_increment,
            range_min: scan.range_min,
            range_max: scan.range_max,
            ranges: ranges.iter().take(scan.count).map(range).collect(),
        }
    }
}

impl StixelRecord {
    fn new(config: &ObstacleConfig, x: usize, stixel: &Stixel) -> Self {
        let width = usize::from(config.cell_width);
        Self {
            kind: if stixel.kind == StixelKind::Drop { "drop" } else { "obstacle" },
            columns: [x * width, x * width + width - 1],
            rows: [stixel.top_row, stixel.base_row],
            disparity_px: pixels(stixel.disparity.raw()),
            sigma_px: pixels(stixel.sigma_steps),
            depth_m: metres(stixel.depth_mm),
        }
    }
}

impl DecisionRecord {
    fn new(verdict: &Verdict, vehicle: &Vehicle) -> Self {
        let (decision, distance_mm, reason) = match verdict.decision {
            Decision::Clear => ("clear", None, None),
            Decision::Slow(mm) => ("slow", Some(mm), None),
            Decision::Stop(mm) => ("stop", Some(mm), None),
            Decision::Blind(reason) => ("blind", None, Some(format!("{reason:?}"))),
        };
        Self {
            decision,
            distance_m: distance_mm.map(metres),
            reason,
            speed_m_s: metres(vehicle.speed_mm_s),
            corridor_m: metres(vehicle.drive.corridor_mm),
            stopping_m: metres(verdict.stopping_mm),
            contact_s: verdict.contact_ms.map(|ms| ms as f32 / 1000.0),
        }
    }
}
