//! Heights as limits of parallax: what a row of cells shows of the ground.

use super::config::ObstacleConfig;
use super::ground::Ground;
use super::v_disparity::BINS;

/// Parallaxes between which a row shows ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    /// Below this is a drop; `i32::MIN` where no ground can be seen within the range that counts.
    pub(super) low: i32,
    pub(super) high: i32,
    pub(super) expected: i32,
}

impl Interval {
    /// Writes the numbers over a row of the v-disparity, which has been read by then.
    pub(super) fn store(&self, bins: &mut [u8; BINS]) {
        let [low, high, expected, ..] = bins.as_chunks_mut::<4>().0 else { return };
        (*low, *high) = (self.low.to_le_bytes(), self.high.to_le_bytes());
        *expected = self.expected.to_le_bytes();
    }

    pub(super) fn load(bins: &[u8; BINS]) -> Self {
        let number =
            |place: usize| bins.as_chunks::<4>().0.get(place).map_or(0, |bytes| i32::from_le_bytes(*bytes));
        Self { low: number(0), high: number(1), expected: number(2) }
    }

    /// What a row shows, of a ground with what it has there, if there is one.
    pub(super) fn new(
        ground: Option<(Ground, i32)>,
        config: &ObstacleConfig,
        tolerance: i32,
        far: i32,
    ) -> Self {
        let Some((ground, expected)) = ground else {
            return Interval { low: i32::MIN, high: far - 1, expected: 0 };
        };
        let (height, at) = (i64::from(ground.height_mm), i64::from(expected.max(0)));
        // H (p - p_ground) / p = h at p - p_ground = p_ground h / (H - h), and -h at p_ground h / (H + h).
        let limit = |h: i64, left: i64| match left {
            1.. => ((at * h).checked_div(left).unwrap_or(0) as i32).max(tolerance),
            _ => 1 << 21,
        };
        let (up, down) = (i64::from(config.obstacle_mm), i64::from(config.drop_mm));
        let high = (expected + limit(up, height - up)).max(far - 1);
        let low = if expected < far { i32::MIN } else { expected - limit(down, height + down) };
        Interval { low, high, expected }
    }
}
