//! All frames of a sequence, as a table and as a picture.

use super::ObstacleRecord;
use super::picture::{BLIND, DROP, FREE, OBSTACLE};
use super::record::SectorRecord;
use image::{Rgb, RgbImage};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Columns of pixels of a sector, of the decision beside them, and of the gap between.
const SECTOR: u32 = 12;
const DECISION: u32 = 16;
const GAP: u32 = 4;
/// Rows of pixels of a frame: as many as make the picture this high, within limits.
const HEIGHT: u32 = 480;
const LEAST_ROWS: u32 = 2;
const MOST_ROWS: u32 = 16;
/// Distance at which the colour of a surface is half as bright, m.
const HALF_M: f32 = 2.0;
/// What a stop is drawn in, which neither a free sector nor a surface is.
const STOP: Rgb<u8> = Rgb([0xc0, 0x10, 0x10]);

/// A frame of the table.
#[derive(Clone, Debug)]
struct Moment {
    label: String,
    record: ObstacleRecord,
}

/// What was found in the frames so far.
#[derive(Clone, Default, Debug)]
pub struct Timeline(Vec<Moment>);

impl Timeline {
    /// Header of the table.
    const HEADER: &str = "frame,since_start,reason,ground_height_m,ground_pitch_deg,ground_sigma_px,\
                          nearest_m,nearest_sigma_m,nearest_bearing_deg,decision,distance_m,contact_s,\
                          free_sectors,blind_sectors\n";

    /// Adds a frame.
    pub fn push(&mut self, label: String, record: ObstacleRecord) {
        self.0.push(Moment { label, record });
    }

    /// The last frame.
    pub fn last(&self) -> Option<&ObstacleRecord> {
        self.0.last().map(|moment| &moment.record)
    }

    /// The frames as comma-separated values, a line for each; what is not known is left empty.
    pub fn csv(&self) -> String {
        fn or_empty(value: Option<f32>) -> String {
            value.map_or_else(String::new, |value| format!("{value:.3}"))
        }
        let mut table = Self::HEADER.to_owned();
        for Moment { label, record } in &self.0 {
            let nearest = record.nearest().map(|i| &record.sectors[i]);
            let ground = record.ground.as_ref();
            let count = |state| record.free_space.iter().filter(|sector| sector.state == state).count();
            let numbers = [
                ground.map(|ground| ground.height_m),
                ground.map(|ground| ground.pitch_deg),
                ground.map(|ground| ground.sigma_px),
                nearest.and_then(|sector| sector.depth_m),
                nearest.and_then(|sector| sector.sigma_m),
                nearest.map(|sector| sector.bearing_deg),
            ];
            let decision = &record.decision;
            let _ = writeln!(
                table,
                "{label},{},{},{},{},{},{},{},{}",
                record.frame,
                decision.reason.as_deref().unwrap_or_default(),
                numbers.map(or_empty).join(","),
                decision.decision,
                or_empty(decision.distance_m),
                or_empty(decision.contact_s),
                count("free"),
                count("blind")
            );
        }
        table
    }

    /// The frames from the first one, at the top, down: sectors from the left, with hysteresis, and beside
    /// them the decision. Free is green, obstacles are orange and drops purple, the brighter the nearer, and
    /// blind is grey; a stop is red, and slow orange.
    pub fn picture(&self) -> RgbImage {
        let frames = self.0.len().max(1) as u32;
        let rows = (HEIGHT / frames).clamp(LEAST_ROWS, MOST_ROWS);
        let sectors = self.0.iter().map(|moment| moment.record.free_space.len()).max().unwrap_or(0) as u32;
        let width = sectors * SECTOR + GAP + DECISION;
        RgbImage::from_fn(width, frames * rows, |u, v| {
            let Some(moment) = self.0.get((v / rows) as usize) else { return BLIND };
            if u < sectors * SECTOR {
                return moment.record.free_space.get((u / SECTOR) as usize).map_or(BLIND, colour);
            }
            match moment.record.decision.decision {
                _ if u < sectors * SECTOR + GAP => Rgb([0; 3]),
                "clear" => FREE,
                "slow" => OBSTACLE,
                "stop" => STOP,
                _ => BLIND,
            }
        })
    }

    /// How often each decision was taken, in a line.
    pub fn line(&self) -> String {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for moment in &self.0 {
            *counts.entry(moment.record.decision.decision).or_default() += 1;
        }
        let counts: Vec<_> = counts.iter().map(|(decision, n)| format!("{decision} {n}")).collect();
        counts.join(", ")
    }
}

/// The colour of a sector.
fn colour(sector: &SectorRecord) -> Rgb<u8> {
    let share = HALF_M / (HALF_M + sector.depth_m.unwrap_or(0.0));
    let bright = |colour: Rgb<u8>| Rgb(colour.0.map(|value| (f32::from(value) * share) as u8));
    match sector.state {
        "free" => FREE,
        "obstacle" => bright(OBSTACLE),
        "drop" => bright(DROP),
        _ => BLIND,
    }
}
