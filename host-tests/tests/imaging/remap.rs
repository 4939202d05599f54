//! Raw lines to rectified ones: to the bit what the naive twin says, near the exact warp, within the rows
//! that were said.

use image::GrayImage;
use nalgebra::{Point2, Rotation3, Vector3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::geometry::{
    camera::{Camera, Distortion, ImageSize, Pose, StereoRig},
    rectify::{Crop, Rectification, Warp},
};
use stereopsis::imaging::{Remap, RemapError, RemapTable, RemapTableError};
use stereopsis_host::scene::Random;
use stereopsis_host::twin::remap as twin;
use stereopsis_model::held::remapped;

pub const SLOTS: usize = 4096;
pub type Table = RemapTable<SLOTS>;

pub fn noise(size: ImageSize, seed: u64) -> GrayImage {
    let mut random = Random::new(seed);
    GrayImage::from_fn(size.width.into(), size.height.into(), |_, _| image::Luma([random.below(256) as u8]))
}

pub fn camera(size: ImageSize, focal: f64, lens: [f64; 5]) -> Camera<f64> {
    let (cx, cy) = (f64::from(size.width) / 2.0 + 1.7, f64::from(size.height) / 2.0 - 2.3);
    let camera = Camera::new(focal, focal * 1.01, cx, cy).expect("a camera");
    camera.with_distortion(Distortion::from_opencv(lens)).expect("a lens")
}

pub fn rectified(
    size: ImageSize,
    cameras: [Camera<f64>; 2],
    turn: [f64; 3],
    crop: Crop<f64>,
) -> Rectification<f64> {
    let turn = Rotation3::new(Vector3::from(turn)).into_inner();
    let pose = Pose::new(turn, Vector3::new(0.06, 0.0005, -0.001)).expect("a pose");
    let rig = StereoRig::new(cameras, pose, [size; 2]).expect("a rig");
    Rectification::new(&rig, crop, size).expect("rectified")
}

/// The largest distance between a table's places and the warp's, px, over all pixels that are in the raw
/// image.
fn farthest(table: &Table, warp: &Warp<f64>) -> f64 {
    let mut most = 0.0_f64;
    for (u, v) in (0..table.size().height).flat_map(|v| (0..table.size().width).map(move |u| (u, v))) {
        let exact = warp.source(&Point2::new(u.into(), v.into())).expect("in front");
        if !exact.is_described || !warp.is_in_raw(&exact.pixel) {
            continue;
        }
        if let Some(place) = twin::place(table, u.into(), v.into()) {
            // What pixels are weighted by: 256ths.
            let [x, y] = place.map(|p| p.div_euclid(256) as f64 / 256.0);
            most = most.max((Point2::new(x, y) - exact.pixel).norm());
        }
    }
    most
}

/// The raw rows that must be held at once, of those that each row needs: from the first one of a row to the
/// last one that was needed before or is needed now.
fn rows_held(table: &Table) -> u16 {
    let (mut last_so_far, mut most) = (0, 0);
    for (first, last) in (0..table.size().height).filter_map(|row| table.raw_rows(row)) {
        last_so_far = last.max(last_so_far);
        most = most.max(last_so_far - first + 1);
    }
    most
}

pub const QVGA: ImageSize = ImageSize { width: 320, height: 240 };

#[test]
fn one_degree_works_in_sixteen_rows() {
    let one = camera(QVGA, 300.0, [0.0; 5]);
    // The first camera stays as it is, the second turns by all of it.
    let roll = [0.0, 0.0, 1.0_f64.to_radians()];
    let both = rectified(QVGA, [one; 2], roll, Crop::Natural);
    for warp in both.warps() {
        let table = Table::new(warp).expect("a table");
        assert!(table.rows() < 16, "{} rows", table.rows());
        let raw = noise(QVGA, 5);
        assert_eq!(remapped::<320, 16, SLOTS>(&table, &raw).expect("enough rows"), twin::remap(&table, &raw));
        assert!(std::mem::size_of::<RemapTable<{ Table::slots(QVGA, 5) }>>() <= 12 * 1024);
    }
}

#[test]
fn too_small_a_band_is_refused_with_what_would_do() {
    let one = camera(QVGA, 300.0, [0.0; 5]);
    let both = rectified(QVGA, [one; 2], [0.0, 0.0, 0.2], Crop::Natural);
    let warp = &both.warps()[1];
    let table = Table::new(warp).expect("a table");
    let Err(RemapError::Lines { needed }) = Remap::<320, 16, SLOTS>::new(table.clone()) else {
        panic!("16 lines are too few")
    };
    assert!((50..90).contains(&needed), "{needed}");
    assert!(remapped::<320, 90, SLOTS>(&table, &noise(QVGA, 6)).is_ok());
    assert_eq!(
        Remap::<319, 90, SLOTS>::new(table.clone()).map(|_| ()),
        Err(RemapError::Width { needed: 320 })
    );
    let needed = RemapTable::<0>::slots(QVGA, 6);
    assert_eq!(RemapTable::<8>::new(warp).map(|_| ()), Err(RemapTableError::Slots { needed }));
    assert!(matches!(needed, 140..400), "{needed}");
    // What was there before is gone with the warp that was refused.
    let flat = rectified(ImageSize { width: 8, height: 8 }, [one; 2], [0.0; 3], Crop::Natural);
    let mut small = RemapTable::<20>::new(&flat.warps()[0]).expect("a few slots");
    assert!(small.rows() > 0 && small.raw_rows(0).is_some());
    assert_eq!(small.set(warp), Err(RemapTableError::Slots { needed }));
    let none = ImageSize { width: 0, height: 0 };
    assert_eq!((small.size(), small.raw_size(), small.rows()), (none, none, 0));
    let mut remap = Remap::<320, 90, SLOTS>::new(table).expect("enough");
    let (mut line, mut valid) = ([0; 320], [0; 320]);
    let early = remap.row(&mut line, &mut valid);
    let (_, last) = remap.table().raw_rows(0).expect("inside");
    assert_eq!(early, Err(RemapError::Early { needed: last + 1 }));
    for _ in 0..200 {
        remap.accept();
    }
    assert_eq!(remap.row(&mut line, &mut valid), Err(RemapError::Late { row: 0 }));
    assert_eq!(remap.row(&mut line[1..], &mut valid), Err(RemapError::BufferTooShort { needed: 320 }));
}

#[test]
fn a_strong_lens_stays_within_a_twentieth_of_a_pixel() {
    // A barrel of 90 degrees across; then lenses that fold before the corners, which are too much to be shown
    // whole.
    let barrel = |focal, lens| camera(QVGA, focal, lens);
    let mild =
        [barrel(200.0, [-0.15, 0.03, 0.0, 0.0, 0.0]), barrel(200.0, [-0.16, 0.035, 0.001, -0.0005, 0.0])];
    let folding =
        [barrel(165.0, [-0.23, 0.045, 0.001, -0.0005, -0.003]), barrel(165.0, [-0.3, 0.01, 0.0, 0.0, 0.0])];
    let turn = [0.02, -0.03, 0.015];
    let whole_view = rectified(QVGA, folding, turn, Crop::Alpha(1.0));
    assert_eq!(Table::new(&whole_view.warps()[1]).map(|_| ()), Err(RemapTableError::TooBent));
    for (cameras, crop) in [
        (mild, Crop::Natural),
        (mild, Crop::Alpha(0.0)),
        (mild, Crop::Alpha(1.0)),
        (folding, Crop::Natural),
        (folding, Crop::Alpha(0.0)),
    ] {
        let both = rectified(QVGA, cameras, turn, crop);
        for warp in both.warps() {
            let table = Table::new(warp).expect("a table");
            assert_eq!(table.rows(), rows_held(&table));
            let far = farthest(&table, warp);
            assert!(far <= 0.05, "{crop:?}: {far} px with cells of {} px", 1 << table.shift());
            let raw = noise(QVGA, 7);
            assert_eq!(
                remapped::<320, 242, SLOTS>(&table, &raw).expect("enough rows"),
                twin::remap(&table, &raw)
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 24,
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Any rig, any awkward size: the twin to the bit, near the warp, in as many rows as the table says and
    /// no fewer.
    #[test]
    fn any_rig(
        width in 2..150_u16, height in 2..120_u16, wide in 0.6..2.0_f64,
        lens in [-0.25..0.1_f64, -0.02..0.05, -0.003..0.003, -0.003..0.003, 0.0..0.01],
        turn in [-0.1..0.1_f64, -0.1..0.1, -0.1..0.1], alpha in prop::option::of(0.0..1.0_f64),
            seed in any::<u64>(),
    ) {
        let size = ImageSize { width, height };
        // Up to 80 degrees along the longer side.
        let focal = f64::from(width.max(height).max(24)) * wide;
        let one = Camera::new(focal, focal, f64::from(width) / 2.0, f64::from(height) / 2.0);
        let one = one.expect("a camera").with_distortion(Distortion::from_opencv(lens)).expect("a lens");
        let pose = Pose::new(Rotation3::new(Vector3::from(turn)).into_inner(), Vector3::x()).expect("a pose");
        let rig = StereoRig::new([one; 2], pose, [size; 2]).expect("a rig");
        let crop = alpha.map_or(Crop::Natural, Crop::Alpha);
        let Ok(both) = Rectification::new(&rig, crop, size) else { return Ok(()) };
        for warp in both.warps() {
            let table = match Table::new(warp) {
                Ok(table) => table,
                // A few pixels of a wide lens.
                Err(RemapTableError::TooBent) => continue,
                Err(error) => panic!("{error}"),
            };
            prop_assert_eq!(table.rows(), rows_held(&table));
            prop_assert!(farthest(&table, warp) <= 0.05, "{}", farthest(&table, warp));
            let raw = noise(size, seed);
            let expected = twin::remap(&table, &raw);
            prop_assert_eq!(&remapped::<150, 121, SLOTS>(&table, &raw).expect("enough rows"), &expected);
            // Powers of two take another way through the band.
            if table.rows() <= 32 {
                prop_assert_eq!(&remapped::<150, 33, SLOTS>(&table, &raw).expect("enough rows"), &expected);
            }
        }
    }
}
