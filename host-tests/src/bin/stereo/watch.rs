//! The options of `--obstacles`, and the files of what is found: of each frame, and of all of them.

use crate::failure::Failure;
use crate::place::{json, png};
use clap::Args;
use image::RgbImage;
use std::path::Path;
use stereopsis::depth::DepthScale;
use stereopsis::matching::Config;
use stereopsis::obstacles::{DriveConfig, GroundSource};
use stereopsis::units::Disparity;
use stereopsis_host::map::DisparityMap;
use stereopsis_host::mock::luma;
use stereopsis_host::obstacles::{ObstacleRecord, ObstacleWatch, Timeline, Vehicle, WatchedFrame};
use stereopsis_host::output::{OutputError, Staging};

/// What is written only where obstacles are asked for: of a frame, and of all frames.
pub const OBSTACLES: [&str; 2] = ["obstacles.json", "obstacles.png"];
pub const OVER_TIME: [&str; 2] = ["obstacles.csv", "obstacles.png"];

#[derive(Clone, Debug, Args)]
pub struct ObstacleArgs {
    /// Find the ground and what stands on it, of depths: obstacles.json and obstacles.png; of many frames one
    /// after the other, with the ground carried and obstacles held, also obstacles.csv
    #[arg(long)]
    pub obstacles: bool,
    /// Speed of the vehicle, m/s, for the decision and the time to contact: 0.5 where none is given
    #[arg(long, value_name = "M/S", requires = "obstacles", value_parser = speed,
        allow_negative_numbers = true)]
    pub speed: Option<u16>,
    /// Width of the corridor that it drives through, m: 0.4 where none is given
    #[arg(long, value_name = "M", requires = "obstacles", value_parser = long, allow_negative_numbers = true)]
    pub corridor: Option<u16>,
    /// Least height of an obstacle and least depth of a drop, m: 0.05 where none is given
    #[arg(long, value_name = "M", requires = "obstacles", value_parser = long, allow_negative_numbers = true)]
    pub least_height: Option<u16>,
    /// Height of the cameras above the ground, m, as a ruler tells; searched where none is given
    #[arg(long, value_name = "M", requires = "obstacles", value_parser = long, allow_negative_numbers = true)]
    pub camera_height: Option<u16>,
    /// Pitch of the cameras, degrees downward, as an inertial sensor tells; searched where none is given
    #[arg(long, value_name = "DEGREES", requires_all = ["obstacles", "camera_height"], value_parser = angle,
        allow_negative_numbers = true)]
    pub camera_pitch: Option<i16>,
    /// Roll of the cameras, degrees by which their right side is lower: 0 where none is given
    #[arg(long, value_name = "DEGREES", requires_all = ["obstacles", "camera_pitch"], value_parser = angle,
        allow_negative_numbers = true)]
    pub camera_roll: Option<i16>,
}

fn speed(text: &str) -> Result<u16, &'static str> {
    thousandths(text, 0.0, 65.0).ok_or("a speed from 0 to 65 is needed")
}

fn long(text: &str) -> Result<u16, &'static str> {
    thousandths(text, 0.01, 65.0).ok_or("a length from 0.01 to 65 is needed")
}

fn angle(text: &str) -> Result<i16, &'static str> {
    let degrees = text.parse::<f64>().ok().filter(|degrees| (-28.0..=28.0).contains(degrees));
    let angle = degrees.map(|degrees| (1000.0 * degrees.to_radians()).round() as i16);
    angle.ok_or("an angle from -28 to 28 is needed")
}

fn thousandths(text: &str, least: f64, most: f64) -> Option<u16> {
    let value = text.parse::<f64>().ok().filter(|value| (least..=most).contains(value));
    value.map(|value| (1000.0 * value).round() as u16)
}

/// What is found in a frame, drawn on it.
pub type Seen = (ObstacleRecord, RgbImage);

/// A watch with all that it found so far.
pub struct Watch {
    watch: ObstacleWatch,
    pub timeline: Timeline,
}

impl ObstacleArgs {
    /// A watch without history, if obstacles are asked for.
    pub fn watch(&self) -> Option<Watch> {
        let default = Vehicle::default();
        let drive =
            DriveConfig { corridor_mm: self.corridor.unwrap_or(default.drive.corridor_mm), ..default.drive };
        let roll_mrad = self.camera_roll.unwrap_or(0);
        let ground = match (self.camera_height, self.camera_pitch, default.ground) {
            (Some(height_mm), Some(pitch_mrad), _) => {
                GroundSource::Given { pitch_mrad, roll_mrad, height_mm }
            }
            (Some(height_mm), None, GroundSource::Searched { most_pitch, most_roll, .. }) => {
                let [least_height_mm, most_height_mm] = [height_mm; 2];
                GroundSource::Searched { least_height_mm, most_height_mm, most_pitch, most_roll }
            }
            (_, _, ground) => ground,
        };
        let vehicle = Vehicle {
            drive,
            speed_mm_s: self.speed.unwrap_or(default.speed_mm_s),
            least_mm: self.least_height.unwrap_or(default.least_mm),
            ground,
        };
        let watch = || Watch { watch: ObstacleWatch::new(vehicle), timeline: Timeline::default() };
        self.obstacles.then(watch)
    }
}

impl Watch {
    /// Finds what is in the next frame, of which so many rows came. Where there is no right image, the
    /// cameras are not judged.
    pub fn look(
        &mut self,
        label: &str,
        scale: &DepthScale,
        (map, rows): (&DisparityMap, usize),
        largest: Disparity,
        left: &RgbImage,
        right: Option<&RgbImage>,
    ) -> Result<Seen, Failure> {
        let grey = right.map(|right| [left, right].map(luma));
        let pictures = grey.as_ref().map(|grey| grey.each_ref());
        let frame = WatchedFrame { scale, map, rows, largest, pictures };
        let (record, picture) =
            self.watch.look(&frame, left).map_err(|e| Failure::new(format!("--obstacles: {e}")))?;
        self.timeline.push(label.to_owned(), record.clone());
        Ok((record, picture))
    }

    /// Writes the table and the picture of all frames.
    pub fn write(&self, staging: &mut Staging) -> Result<(), OutputError> {
        staging.write(OVER_TIME[0], |out| out.write_all(self.timeline.csv().as_bytes()))?;
        staging.write(OVER_TIME[1], |out| png(out, &self.timeline.picture()))
    }
}

/// Writes what was found in a frame.
pub fn write(staging: &mut Staging, names: [&str; 2], (record, picture): &Seen) -> Result<(), OutputError> {
    staging.write(names[0], |out| json(out, record))?;
    staging.write(names[1], |out| png(out, picture))
}

/// The largest disparity of a search.
pub fn largest(config: &Config) -> Disparity {
    end_of(config.min_disparity, config.disparities)
}

/// The end of a search of so many disparities from the first one.
pub fn end_of(first: u16, count: u16) -> Disparity {
    Disparity::from_pixels(first.saturating_add(count).min(Config::END))
}

/// Whether a folder's record is this one.
pub fn is_written(folder: &Path, (record, _): &Seen) -> bool {
    let mut bytes = Vec::new();
    let written = std::fs::read(folder.join(OBSTACLES[0]));
    json(&mut bytes, record).is_ok()
        && written.is_ok_and(|found| found == bytes)
        && folder.join(OBSTACLES[1]).is_file()
}
