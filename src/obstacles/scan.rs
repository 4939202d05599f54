//! Sectors as a planar laser scan, in the meaning of ROS's `sensor_msgs/LaserScan` and of REP 117.

use super::finder::ObstaclesView;
use super::sector::SectorState;

/// Angles and limits of a scan: radians to the left, as ROS has them, and metres.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LaserScan {
    /// Angle of the first range, rad: the middle of the rightmost sector.
    pub angle_min: f32,
    /// Angle of the last range that was written, rad: the middle of the leftmost sector where all are.
    pub angle_max: f32,
    /// Angle between two ranges, rad.
    pub angle_increment: f32,
    /// Smallest range that can be measured, m: that of the largest disparity that is searched.
    pub range_min: f32,
    /// The range up to which a free sector is free, m: that up to which all of them are seen. Obstacles
    /// beyond it are there, but who takes a scan leaves them out.
    pub range_max: f32,
    /// Number of ranges that were written.
    pub count: usize,
}

impl ObstaclesView<'_> {
    /// Writes the ranges of the last frame's sectors from right to left, m, as many as `ranges` holds.
    ///
    /// Obstacles and drops have their distance, a free sector has infinity ("no return" up to the largest
    /// range), and a blind one is not a number ("invalid").
    pub fn laser_scan(&self, ranges: &mut [f32]) -> LaserScan {
        let Some(setup) = self.setup() else { return LaserScan::default() };
        let (sectors, mut free_mm) = (self.sectors(), self.farthest_mm());
        for (place, range) in ranges.iter_mut().enumerate().take(sectors) {
            let sector = self.sector(sectors - 1 - place);
            *range = match sector.state {
                SectorState::Obstacle | SectorState::Drop => f32::from(sector.range_mm) / 1000.0,
                SectorState::Free => {
                    free_mm = free_mm.min(sector.seen_mm);
                    f32::INFINITY
                }
                SectorState::Blind => f32::NAN,
            };
        }
        let [first, last] = setup.ends_mrad.map(|end| f32::from(end) / 1000.0);
        let (increment, count) = ((last - first) / sectors.max(1) as f32, ranges.len().min(sectors));
        let nearest_mm = setup.depth_mm(i32::from(setup.largest.raw()) + setup.offset_steps);
        LaserScan {
            angle_min: -(last - increment / 2.0),
            angle_max: -(first + increment / 2.0) - increment * (sectors - count) as f32,
            angle_increment: increment,
            range_min: f32::from(nearest_mm) / 1000.0,
            range_max: f32::from(free_mm) / 1000.0,
            count,
        }
    }
}
