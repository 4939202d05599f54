//! Obstacles in whole maps, frame after frame, as records for programs and as pictures for people.
//!
//! * [`ObstacleWatch`]: maps through the core's finder, its drive rule and its free space, which carry what
//!   they know from frame to frame. [`WatchedFrame`]: what it looks at. [`Vehicle`]: for whom.
//! * [`ObstacleRecord`]: what is found in a frame, as `obstacles.json` has it.
//! * [`picture`]: stixels on the left image, sectors below it; [`COLOURS`]: what its colours mean.
//! * [`Timeline`]: all frames as a table and as a picture.

mod picture;
mod record;
mod timeline;

pub use picture::{COLOURS, picture};
pub use record::ObstacleRecord;
pub use timeline::Timeline;

use crate::map::DisparityMap;
use image::{GrayImage, RgbImage};
use stereopsis::depth::DepthScale;
use stereopsis::imaging::PairMonitor;
use stereopsis::obstacles::{
    DriveConfig, DriveRule, FreeSpace, GroundSource, ObstacleConfig, ObstacleError, Obstacles,
};
use stereopsis::units::Disparity;

/// Columns and rows of cells that the finder here has room for.
const MOST: (usize, usize) = (1024, 255);

/// The default limits, with cells that grow with the picture: 160 x 96 of them or a few more, but no smaller
/// than by default, and no larger than cells can be.
pub fn config_for(width: usize, height: usize) -> ObstacleConfig {
    let default = ObstacleConfig::default();
    let cell = |side: usize, cells: usize, least: u8, most: u8| {
        u8::try_from(side.div_ceil(cells)).unwrap_or(most).clamp(least, most)
    };
    ObstacleConfig {
        cell_width: cell(width, 160, default.cell_width, 15),
        cell_height: cell(height, 96, default.cell_height, 16),
        ..default
    }
}

/// What drives, how fast, and what is known of its cameras' pose.
#[derive(Clone, Copy, Debug)]
pub struct Vehicle {
    /// Its corridor and its brakes.
    pub drive: DriveConfig,
    /// Its speed, mm/s.
    pub speed_mm_s: u16,
    /// Least height of an obstacle and least depth of a drop, mm.
    pub least_mm: u16,
    /// Where its ground comes from.
    pub ground: GroundSource,
}

impl Default for Vehicle {
    /// A small robot at half a metre a second.
    fn default() -> Self {
        let ObstacleConfig { ground, obstacle_mm, .. } = ObstacleConfig::default();
        Self { drive: DriveConfig::default(), speed_mm_s: 500, least_mm: obstacle_mm, ground }
    }
}

/// A frame to look at.
#[derive(Clone, Copy, Debug)]
pub struct WatchedFrame<'a> {
    /// The rig's scale.
    pub scale: &'a DepthScale,
    /// Its disparities.
    pub map: &'a DisparityMap,
    /// Rows that came, from the first one on.
    pub rows: usize,
    /// Largest disparity of the search.
    pub largest: Disparity,
    /// The left and the right picture, by which the cameras are judged, if they are known.
    pub pictures: Option<[&'a GrayImage; 2]>,
}

/// What a finder was started on.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Started {
    scale: DepthScale,
    size: [usize; 2],
    largest: Disparity,
    config: ObstacleConfig,
}

/// A finder over the frames of a sequence: the ground is carried, and obstacles are held with hysteresis.
#[derive(Debug)]
pub struct ObstacleWatch {
    vehicle: Vehicle,
    finder: Box<Obstacles<{ MOST.0 }, { MOST.1 }>>,
    rule: DriveRule,
    space: FreeSpace,
    started: Option<Started>,
    frames: usize,
}

impl ObstacleWatch {
    /// A watch without history.
    pub fn new(vehicle: Vehicle) -> Self {
        let (rule, space) = (DriveRule::new(vehicle.drive), FreeSpace::new(vehicle.drive.hysteresis));
        Self { vehicle, finder: Box::new(Obstacles::new()), rule, space, started: None, frames: 0 }
    }

    /// Finds what is in the next frame, and draws it on the left image.
    ///
    /// A frame of another size, of another rig, or of a larger search than any before begins anew.
    pub fn look(
        &mut self,
        frame: &WatchedFrame<'_>,
        left: &RgbImage,
    ) -> Result<(ObstacleRecord, RgbImage), ObstacleError> {
        let config = self.start_where_needed(frame)?;
        self.finder.begin();
        if let Some(pictures) = frame.pictures {
            self.judge(frame.largest, pictures);
        }
        let map = frame.map;
        // Where they were asked for, no answer has none.
        let are_sure = map.confidence.iter().any(|&sure| sure > 0);
        for y in 0..map.height.min(frame.rows) {
            let row = y * map.width..(y + 1) * map.width;
            let sure = if are_sure { &map.confidence[row.clone()] } else { &[] };
            self.finder.push(y, &map.disparity[row.clone()], &map.flags[row], sure);
        }
        // The record says so as well.
        let _ = self.finder.finish();
        let view = self.finder.as_mut_view();
        self.space.update(&view);
        let verdict = self.rule.decide(&view, self.vehicle.speed_mm_s);
        self.frames += 1;
        let record = ObstacleRecord::new(&config, &view, &self.space, &verdict, &self.vehicle);
        Ok((record.numbered(self.frames), picture(&config, &view, left)))
    }

    /// Lets the cameras be judged by their pictures.
    fn judge(&mut self, largest: Disparity, pictures: [&GrayImage; 2]) {
        let mut monitor = PairMonitor::new(largest.raw().div_ceil(Disparity::ONE));
        let [left, right] = pictures.map(|picture| {
            let width = picture.width().max(1) as usize;
            picture.as_raw().chunks_exact(width)
        });
        for (left, right) in left.zip(right) {
            monitor.lines(left, right);
        }
        self.finder.as_mut_view().cameras(&monitor);
    }

    /// Starts the finder on frames like this one, unless it is; returns its limits.
    fn start_where_needed(&mut self, frame: &WatchedFrame<'_>) -> Result<ObstacleConfig, ObstacleError> {
        let map = frame.map;
        let config = ObstacleConfig {
            ground: self.vehicle.ground,
            obstacle_mm: self.vehicle.least_mm,
            drop_mm: self.vehicle.least_mm,
            ..config_for(map.width, map.height)
        };
        let size = [map.width, map.height.min(MOST.1 * usize::from(config.cell_height))];
        let wanted = Started { scale: *frame.scale, size, largest: frame.largest, config };
        let serves = |now: &Started| {
            now.largest.raw() >= frame.largest.raw() && *now == Started { largest: now.largest, ..wanted }
        };
        if !self.started.as_ref().is_some_and(serves) {
            // Pictures have at most 4096 columns and rows.
            self.finder.start(&config, frame.scale, size.map(|side| side as u16), frame.largest)?;
            self.rule = DriveRule::new(self.vehicle.drive);
            self.space = FreeSpace::new(self.vehicle.drive.hysteresis);
            (self.started, self.frames) = (Some(wanted), 0);
        }
        Ok(config)
    }
}
