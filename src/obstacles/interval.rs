//! Heights as limits of parallax: what a row of cells shows of the ground.

use super::config::ObstacleConfig;
use super::ground::Ground;
use super::v_disparity::BINS;

/// What a row shows of the ground: its parallax, and how far from it an answer is still of the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    /// Parallax in the column of the principal point, 256ths of a step.
    expected_256ths: i32,
    /// Most above it, steps.
    up: i32,
    /// Most below it, steps.
    down: i32,
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
    /// Writes the numbers over a row of the v-disparity, which has been read by then.
    pub(super) fn store(&self, bins: &mut [u8; BINS]) {
        let [expected, up, down, ..] = bins.as_chunks_mut::<4>().0 else { return };
        (*up, *down) = (self.up.to_le_bytes(), self.down.to_le_bytes());
        *expected = self.expected_256ths.to_le_bytes();
    }

    pub(super) fn load(bins: &[u8; BINS]) -> Self {
        let number =
            |place: usize| bins.as_chunks::<4>().0.get(place).map_or(0, |bytes| i32::from_le_bytes(*bytes));
        Self { expected_256ths: number(0), up: number(1), down: number(2) }
    }

    /// What the row at half-row `halves` shows of a ground, if there is one.
    pub(super) fn new(ground: Option<Ground>, halves: i64, config: &ObstacleConfig, tolerance: i32) -> Self {
        // Without a ground it is beyond all that counts.
        let Some(ground) = ground else { return Self { expected_256ths: -1 << 28, up: 0, down: 0 } };
        let expected_256ths = ground.parallax_256ths(halves);
        let (height, at) = (i64::from(ground.height_mm), i64::from(expected_256ths.max(0) >> 8));
        // H (p - p_ground) / p = h at p - p_ground = p_ground h / (H - h), and -h at p_ground h / (H + h).
        let limit = |h: i64, left: i64| match left {
            1.. => ((at * h).checked_div(left).unwrap_or(0) as i32).max(tolerance),
            _ => 1 << 21,
        };
        let (up, down) = (i64::from(config.obstacle_mm), i64::from(config.drop_mm));
        Self { expected_256ths, up: limit(up, height - up), down: limit(down, height + down) }
    }

    /// What a cell of the row shows, where the ground's parallax has so much more than in the column of the
    /// principal point; what has less than `farthest` does not count.
    pub(super) fn at(&self, beside_256ths: i32, farthest: i32) -> Between {
        let expected = (self.expected_256ths + beside_256ths) >> 8;
        let low = if expected < farthest { i32::MIN } else { expected - self.down };
        Between { low, high: (expected + self.up).max(farthest - 1), expected }
    }
}
