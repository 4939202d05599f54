//! Rigs that are turned far, and images of a few rows: what is valid is where the warp says, or the table is
//! refused.

use super::remap::{SLOTS, Table};
use nalgebra::{Point2, Rotation3, Vector3};
use stereopsis::geometry::camera::{Camera, Distortion, ImageSize, Pose, StereoRig};
use stereopsis::geometry::rectify::{Crop, Rectification, Warp};
use stereopsis::imaging::{RemapTable, RemapTableError};
use stereopsis_host::scene::Random;
use stereopsis_host::twin::remap as twin;

/// The largest distance between the places of a table that are in the raw image and the warp's, px; infinite
/// where the warp has none.
fn farthest_valid(table: &Table, warp: &Warp<f64>) -> f64 {
    let (size, raw) = (table.size(), table.raw_size());
    let mut most = 0.0_f64;
    for (u, v) in (0..size.height).flat_map(|v| (0..size.width).map(move |u| (u, v))) {
        let Some(place) = twin::place(table, u.into(), v.into()) else { continue };
        let [x, y] = place.map(|p| p.div_euclid(256) as f64 / 256.0);
        if x < 0.0 || y < 0.0 || x > f64::from(raw.width - 1) || y > f64::from(raw.height - 1) {
            continue;
        }
        let exact = warp.source(&Point2::new(u.into(), v.into()));
        most = most.max(exact.map_or(f64::INFINITY, |exact| (Point2::new(x, y) - exact.pixel).norm()));
    }
    most
}

/// A size of a few rows or of some more.
fn size(random: &mut Random) -> ImageSize {
    let rows = [3 + random.below(3), 3 + random.below(40)];
    ImageSize { width: 8 + random.below(90) as u16, height: *random.pick(&rows) as u16 }
}

#[test]
fn pixels_are_valid_where_the_warp_points() {
    let (mut tables, mut refused) = (0, 0);
    for seed in 0..6000 {
        let random = &mut Random::new(seed);
        let (raw, rectified) = (size(random), size(random));
        let mut by = |most: f64| most * (2.0 * random.unit() - 1.0);
        let focal = f64::from(raw.width.max(raw.height)) * (0.9 + by(0.5));
        let lens = [by(0.3), by(0.05), by(0.005), by(0.005), by(0.01)];
        let turns = [by(1.2), by(1.2), by(1.5)];
        let middle = (f64::from(raw.width) / 2.0 + by(2.0), f64::from(raw.height) / 2.0 + by(2.0));
        let one = Camera::new(focal, focal, middle.0, middle.1).expect("a camera");
        let one = one.with_distortion(Distortion::from_opencv(lens)).expect("a lens");
        let turn = Rotation3::from_euler_angles(turns[0], turns[1], turns[2]).into_inner();
        let pose = Pose::new(turn, Vector3::x()).expect("a pose");
        let rig = StereoRig::new([one; 2], pose, [raw; 2]).expect("a rig");
        let crop = if by(1.0) > 0.0 { Crop::Natural } else { Crop::Alpha(0.5 + by(0.5)) };
        let Ok(both) = Rectification::new(&rig, crop, rectified) else { continue };
        for warp in both.warps() {
            let table: RemapTable<SLOTS> = match Table::new(warp) {
                Ok(table) => table,
                Err(error) => {
                    assert_eq!(error, RemapTableError::TooBent, "seed {seed}");
                    refused += 1;
                    continue;
                }
            };
            let farthest = farthest_valid(&table, warp);
            assert!(farthest <= 0.06, "seed {seed}, {raw:?} to {rectified:?}: {farthest} px off");
            tables += 1;
        }
    }
    assert!(tables > 4000 && refused > 0, "{tables} tables, {refused} refused");
}
