//! Remapping beside its twin, for any rig.

use crate::case;
use arbitrary::{Result, Unstructured};
use nalgebra::{Rotation3, Vector3};
use stereopsis::geometry::camera::{Camera, Distortion, ImageSize, Pose, StereoRig};
use stereopsis::geometry::rectify::{Crop, Rectification};
use stereopsis::imaging::{Remap, RemapTable};
use stereopsis_model::twin::remap as twin;

const WIDTH: usize = 100;
const LINES: usize = 61;
const SLOTS: usize = 2048;

/// A value from `-most` to `most`.
fn within(u: &mut Unstructured<'_>, most: f64) -> Result<f64> {
    Ok(f64::from(u.arbitrary::<i16>()?) / 32768.0 * most)
}

/// A rectified image is the twin's to the bit, and takes no more lines than there are.
pub fn equals_its_twin(u: &mut Unstructured<'_>) -> Result<()> {
    let mut size = || -> Result<ImageSize> {
        let (width, height) = (u.int_in_range(1..=WIDTH as u16)?, u.int_in_range(1..=LINES as u16 - 1)?);
        Ok(ImageSize { width, height })
    };
    let (raw, out) = (size()?, size()?);
    let camera = |u: &mut Unstructured<'_>| -> Result<Option<Camera<f64>>> {
        let focal = f64::from(raw.width.max(raw.height).max(8)) * (1.3 + within(u, 0.9)?);
        let (cx, cy) = (f64::from(raw.width) / 2.0 + within(u, 9.0)?, f64::from(raw.height) / 2.0);
        let lens = [within(u, 0.4)?, within(u, 0.1)?, within(u, 0.01)?, within(u, 0.01)?, within(u, 0.02)?];
        let camera = Camera::new(focal, focal * (1.0 + within(u, 0.1)?), cx, cy).ok();
        Ok(camera.and_then(|camera| camera.with_distortion(Distortion::from_opencv(lens)).ok()))
    };
    let (Some(first), Some(second)) = (camera(u)?, camera(u)?) else { return Ok(()) };
    let turn = Rotation3::new(Vector3::new(within(u, 0.6)?, within(u, 0.6)?, within(u, 1.6)?)).into_inner();
    let place = Vector3::new(within(u, 1.0)?, within(u, 1.0)?, within(u, 1.0)?);
    let Ok(pose) = Pose::new(turn, place) else { return Ok(()) };
    let Ok(rig) = StereoRig::new([first, second], pose, [raw; 2]) else { return Ok(()) };
    let crop = if u.arbitrary()? { Crop::Natural } else { Crop::Alpha(within(u, 1.0)?.abs()) };
    let Ok(both) = Rectification::new(&rig, crop, out) else { return Ok(()) };
    let picture = case::picture(u, raw.width.into(), raw.height.into())?;
    for warp in both.warps() {
        let Ok(table) = RemapTable::<SLOTS>::new(warp) else { continue };
        let mut remap = Box::new(Remap::<WIDTH, LINES, SLOTS>::new(table.clone()).expect("all lines fit"));
        let (expected, valid) = twin::remap(&table, &picture);
        let mut lines = picture.chunks_exact(raw.width.into());
        remap.begin();
        let width = usize::from(out.width);
        for (row, valid) in expected.chunks_exact(width).zip(valid.chunks_exact(width)) {
            while remap.wants_line() {
                remap.next_line().copy_from_slice(lines.next().expect("no more lines than there are"));
                remap.accept();
            }
            let (mut found, mut mask) = (vec![0; width], vec![9; width]);
            remap.row(&mut found, &mut mask).expect("its lines are there");
            assert_eq!((&found[..], &mask[..]), (row, valid));
        }
    }
    Ok(())
}
