//! Obstacles in a whole map, as a record for programs and as a picture for people.
//!
//! * [`find`]: a map through the core's finder, which lives in a static as in firmware.
//! * [`ObstacleRecord`]: what is found, as `obstacles.json` has it.
//! * [`picture`]: stixels on the left image, sectors below it.

mod picture;
mod record;

pub use picture::picture;
pub use record::ObstacleRecord;

use crate::map::DisparityMap;
use std::sync::{Mutex, PoisonError};
use stereopsis::depth::DepthScale;
use stereopsis::obstacles::{ObstacleConfig, ObstacleError, Obstacles, ObstaclesView};
use stereopsis::units::Disparity;

/// Columns and rows of cells that the finder here has room for.
const MOST: (usize, usize) = (1024, 255);

static FINDER: Mutex<Obstacles<{ MOST.0 }, { MOST.1 }>> = Mutex::new(Obstacles::new());

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

/// Finds what is in a map of a frame, and gives it to `then`.
pub fn find<T>(
    config: &ObstacleConfig,
    scale: &DepthScale,
    map: &DisparityMap,
    then: impl FnOnce(&ObstaclesView<'_>) -> T,
) -> Result<T, ObstacleError> {
    // A finder that panicked while it was held is as good as new after `start`.
    let mut finder = FINDER.lock().unwrap_or_else(PoisonError::into_inner);
    let largest = map.disparity.iter().filter(|d| d.is_some()).map(|d| d.raw()).max();
    let most_rows = MOST.1 * usize::from(config.cell_height);
    // Pictures have at most 4096 columns and rows.
    let size = [map.width, map.height.min(most_rows)].map(|side| side as u16);
    finder.start(config, scale, size, Disparity::from_raw(largest.unwrap_or(0)))?;
    for y in 0..map.height {
        let row = y * map.width..(y + 1) * map.width;
        finder.push(y, &map.disparity[row.clone()], &map.flags[row.clone()], &map.confidence[row]);
    }
    // The record says so as well.
    let _ = finder.finish();
    Ok(then(&finder.as_mut_view()))
}
