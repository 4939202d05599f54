//! Focus maps beside their twins.

use crate::case;
use arbitrary::{Result, Unstructured};
use image::GrayImage;
use stereopsis::focus::{Breathing, FocusConfig};
use stereopsis_host::focus::memory::MapMemory;
use stereopsis_model::twin::focus as twin;

/// The peaks of any stack, by any configuration that is taken, are the twin's to the bit.
pub fn equals_its_twin(u: &mut Unstructured<'_>) -> Result<()> {
    let config = FocusConfig {
        width: u.int_in_range(1..=24)?,
        height: u.int_in_range(1..=14)?,
        cell_px: u.int_in_range(1..=9)?,
        radius: u.int_in_range(0..=3)?,
        exposure_varies: u.arbitrary()?,
    };
    let (mut frames, mut scales) = (Vec::<GrayImage>::new(), Vec::new());
    for _ in 0..u.int_in_range(3..=12)? {
        frames.push(case::pair(u, config.width.into(), config.height.into())?.0);
        scales.push(0.8 + f32::from(u.arbitrary::<u8>()?) / 512.0);
    }
    let mut memory = MapMemory::new(&config);
    let mut map = memory.view().expect("memory of its size");
    if map.start(&config).is_err() {
        return Ok(());
    }
    for (frame, &scale) in frames.iter().zip(&scales) {
        map.begin_frame(Breathing::new(scale).expect("a scale")).expect("a frame that is due");
        for line in frame.chunks_exact(config.width.into()) {
            map.push(line, |_| {}).expect("a line that is due");
        }
    }
    map.finish().expect("whole frames");
    let columns = config.columns();
    let plain = |i: usize| {
        let peak = map.peak(i % columns, i / columns).ok()?;
        let numbers = [peak.position_q8, peak.sigma_q8, peak.noise_q8, peak.confidence.into()];
        assert!(peak.position_q8 <= 256 * (frames.len() as u32 - 1), "{peak:?} of {}", frames.len());
        Some(numbers.map(i64::from))
    };
    let peaks: Vec<Option<twin::Peak>> = (0..config.cells()).map(plain).collect();
    assert_eq!(peaks, twin::peaks(&config, &frames, &scales), "{config:?}");
    Ok(())
}
