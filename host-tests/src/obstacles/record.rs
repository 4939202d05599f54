//! What is found in a frame, for `obstacles.json`.

use serde::Serialize;
use stereopsis::obstacles::{
    Decision, DriveConfig, DriveRule, ObstacleConfig, ObstaclesView, Sector, SectorState, Stixel, StixelKind,
};
use stereopsis::units::Disparity;

/// Speed at which the decision is taken, mm/s.
const SPEED_MM_S: u16 = 500;

/// What is found in a frame. Angles are in degrees, to the right; lengths in metres.
#[derive(Clone, Debug, Serialize)]
pub struct ObstacleRecord {
    /// Why the frame is not to be trusted, if it is not.
    pub blind: Option<String>,
    /// Columns and rows of pixels in a cell.
    pub cell: [u8; 2],
    /// The ground, if one is known.
    pub ground: Option<GroundRecord>,
    /// What is nearest by bearing, from the left.
    pub sectors: Vec<SectorRecord>,
    /// The sectors in the meaning of ROS's LaserScan.
    pub scan: ScanRecord,
    /// What stands in each column of cells that something stands in.
    pub stixels: Vec<StixelRecord>,
    /// What a small robot would do.
    pub decision: DecisionRecord,
}

/// A ground plane.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct GroundRecord {
    /// Height of the camera above it, m.
    pub height_m: f32,
    /// Downward pitch of the camera, degrees.
    pub pitch_deg: f32,
    /// Deviation of its disparities, px.
    pub sigma_px: f32,
}

/// A sector; see [`Sector`].
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SectorRecord {
    state: &'static str,
    bearing_deg: f32,
    depth_m: Option<f32>,
    sigma_m: Option<f32>,
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

/// What a small robot would do, which is [`DriveConfig::default`] at half a metre a second.
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
    contact_s: Option<f32>,
}

fn metres(mm: impl Into<f32>) -> f32 {
    mm.into() / 1000.0
}

fn pixels(steps: u16) -> f32 {
    f32::from(steps) / f32::from(Disparity::ONE)
}

impl ObstacleRecord {
    /// What a frame shows.
    pub fn new(config: &ObstacleConfig, frame: &ObstaclesView<'_>) -> Self {
        let ground = frame.ground().map(|ground| GroundRecord {
            height_m: metres(ground.height_mm),
            pitch_deg: ground.pitch_rad().to_degrees(),
            sigma_px: (ground.variance as f32).sqrt() / f32::from(Disparity::ONE),
        });
        let stixels = (0..frame.columns()).filter_map(|x| {
            let stixel = frame.stixel(x);
            (stixel.kind != StixelKind::Nothing).then(|| StixelRecord::new(config, x, &stixel))
        });
        Self {
            blind: frame.blind().map(|reason| format!("{reason:?}")),
            cell: [config.cell_width, config.cell_height],
            ground,
            sectors: (0..frame.sectors()).map(|i| SectorRecord::new(&frame.sector(i))).collect(),
            scan: ScanRecord::new(frame),
            stixels: stixels.collect(),
            decision: DecisionRecord::new(frame),
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
    fn new(frame: &ObstaclesView<'_>) -> Self {
        let drive = DriveConfig::default();
        let verdict = DriveRule::new(drive).decide(frame, SPEED_MM_S);
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
            speed_m_s: metres(SPEED_MM_S),
            corridor_m: metres(drive.corridor_mm),
            stopping_m: metres(verdict.stopping_mm),
            contact_s: verdict.contact_ms.map(|ms| ms as f32 / 1000.0),
        }
    }
}
