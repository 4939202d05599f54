//! Rectified lines of gently turned cameras, to the bit: four pixels at a time on some processors.

use super::emulated;
use image::{GrayImage, Luma};
use nalgebra::{Rotation3, Vector3};
use stereopsis::geometry::{
    camera::{Camera, Distortion, ImageSize, Pose, StereoRig},
    rectify::{Crop, Rectification},
};
use stereopsis::imaging::{RemapError, RemapTable};
use stereopsis_model::held::remapped;
use stereopsis_model::scene::Random;
use stereopsis_model::twin::remap as twin;

const SLOTS: usize = 2048;

/// Lenses that bring columns closer and farther, rows that fall and rise, bands that begin again at any row,
/// images that end in the middle of four pixels.
#[test]
fn remapped_images_equal_their_twins() {
    let mut compared = 0;
    for seed in 0..if emulated() { 60 } else { 400 } {
        let random = &mut Random::new(seed);
        // As long as the lines of the bands, or shorter.
        let widths = [200, 8 + random.below(190) as u16];
        let size = ImageSize { width: *random.pick(&widths), height: 8 + random.below(60) as u16 };
        let mut by = |most: f64| most * (2.0 * random.unit() - 1.0);
        let focal = f64::from(size.width.max(size.height)) * (1.6 + by(0.9));
        let middle = (f64::from(size.width) / 2.0 + by(3.0), f64::from(size.height) / 2.0 + by(3.0));
        let lens = [by(0.3), by(0.05), by(0.002), by(0.002), 0.0];
        let turn = Vector3::new(by(0.05), by(0.05), by(0.15));
        let crop = if by(1.0) > 0.0 { Crop::Natural } else { Crop::Alpha(0.5 + by(0.5)) };
        let one = Camera::new(focal, focal, middle.0, middle.1).expect("a camera");
        let one = one.with_distortion(Distortion::from_opencv(lens)).expect("a lens");
        let pose = Pose::new(Rotation3::new(turn).into_inner(), Vector3::x()).expect("a pose");
        let rig = StereoRig::new([one; 2], pose, [size; 2]).expect("a rig");
        let Ok(both) = Rectification::new(&rig, crop, size) else { continue };
        let raw =
            GrayImage::from_fn(size.width.into(), size.height.into(), |_, _| Luma([random.below(256) as u8]));
        for table in both.warps().iter().filter_map(|warp| RemapTable::<SLOTS>::new(warp).ok()) {
            let expected = Ok(twin::remap(&table, &raw));
            // As few rows as will do, powers of two among them, and all.
            let held = [
                remapped::<200, 5, SLOTS>(&table, &raw),
                remapped::<200, 8, SLOTS>(&table, &raw),
                remapped::<200, 17, SLOTS>(&table, &raw),
                remapped::<200, 24, SLOTS>(&table, &raw),
                remapped::<200, 69, SLOTS>(&table, &raw),
                remapped::<4096, 69, SLOTS>(&table, &raw),
            ];
            let is_too_few = |held: &Result<_, RemapError>| matches!(held, Err(RemapError::Lines { .. }));
            for held in held.into_iter().filter(|held| !is_too_few(held)) {
                assert!(held == expected, "seed {seed}");
                compared += 1;
            }
        }
    }
    assert!(compared > if emulated() { 100 } else { 700 }, "{compared} images");
}
