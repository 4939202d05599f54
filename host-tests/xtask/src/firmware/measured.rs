//! What is measured of one program on one core: a frame, the spread over pictures, checksums.

use super::frame::Frame;

/// What was measured of one program.
pub struct Measured {
    /// The built-in scene.
    pub frame: Frame,
    /// Instructions over different pictures, by their names, the built-in scene's among them; or none.
    pub spread: Vec<(&'static str, u64)>,
    /// Checksums on real pictures.
    pub checksums: Vec<Checksum>,
}

/// One core's checksum on one pair.
pub struct Checksum {
    /// The pair's name.
    pub pair: String,
    /// Of disparities and flags.
    pub crc32: u32,
}

/// How far instructions lie apart, of their mean.
pub fn spread(counts: &[(&str, u64)]) -> f64 {
    let counts = counts.iter().map(|&(_, count)| count as f64);
    let (least, most) = counts.clone().fold((f64::MAX, f64::MIN), |(l, m), c| (l.min(c), m.max(c)));
    let mean = counts.clone().sum::<f64>() / counts.count().max(1) as f64;
    (most - least) / mean
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_is_of_the_mean() {
        assert_eq!(spread(&[("a", 90), ("b", 100), ("c", 110)]), 0.2);
        assert_eq!(spread(&[("a", 7)]), 0.0);
    }
}
