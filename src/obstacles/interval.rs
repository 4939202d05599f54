//! Heights as limits of parallax: what a row of cells shows of the ground.

use super::config::ObstacleConfig;
use super::ground::Ground;

/// Most that the parallax of something on the ground may be off the ground's, steps.
const MOST: i64 = 1 << 21;

/// What a row of cells shows of the ground: its parallax, and how far from it an answer is still of the
/// ground.
#[derive(Clone, Copy, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Interval {
    /// Parallax in the column of the principal point, 256ths of a step.
    expected_256ths: i32,
    /// Most above it, steps.
    up: i32,
    /// Most below it, steps.
    down: i32,
    /// How far an answer may be from it where the ground has to be seen, steps: three eighths of an obstacle.
    close: i32,
}

/// Parallaxes between which a cell shows ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct Between {
    /// Below this is a drop; `i32::MIN` where no ground can be seen within the range that counts.
    pub(super) low: i32,
    pub(super) high: i32,
    pub(super) expected: i32,
}

impl Interval {
    /// A row before the first frame, all zeros.
    pub(super) const ZERO: Self = Self { expected_256ths: 0, up: 0, down: 0, close: 0 };

    /// Whether a parallax is close to the ground's, where that has so much more than in the column of the
    /// principal point.
    pub(super) fn is_close(&self, parallax: i32, beside_256ths: i32) -> bool {
        (parallax - ((self.expected_256ths + beside_256ths) >> 8)).abs() <= self.close
    }

    /// What the row at half-row `halves` shows of a ground, if there is one.
    pub(super) fn new(ground: Option<Ground>, halves: i64, config: &ObstacleConfig, tolerance: i32) -> Self {
        // Without a ground it is beyond all that counts.
        let Some(ground) = ground else {
            return Self { expected_256ths: -1 << 28, ..Self::ZERO };
        };
        let expected_256ths = ground.parallax_256ths(halves);
        let (height, at) = (i64::from(ground.height_mm), i64::from(expected_256ths.max(0) >> 8));
        // H (p - p_ground) / p = h at p - p_ground = p_ground h / (H - h), and -h at p_ground h / (H + h).
        let limit = |h: i64, left: i64| match left {
            1.. => ((at * h).checked_div(left).unwrap_or(0).min(MOST) as i32).max(tolerance),
            _ => MOST as i32,
        };
        let (up, down) = (i64::from(config.obstacle_mm), i64::from(config.drop_mm));
        let (up, down) = (limit(up, height - up), limit(down, height + down));
        Self { expected_256ths, up, down, close: (3 * up / 8).max(tolerance) }
    }

    /// What a cell of the row shows, where the ground's parallax has so much more than in the column of the
    /// principal point; what has less than `farthest` does not count.
    pub(super) fn at(&self, beside_256ths: i32, farthest: i32) -> Between {
        let expected = (self.expected_256ths + beside_256ths) >> 8;
        let low = if expected < farthest { i32::MIN } else { expected - self.down };
        Between { low, high: (expected + self.up).max(farthest - 1), expected }
    }
}
