//! The ground of real pairs of the folder in `STEREO_DATA`: beside a least-squares fit of the truth's points,
//! and where there is no truth, that the road is found.

use image::GrayImage;
use nalgebra::{Matrix3, Vector3};
use std::path::{Path, PathBuf};
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::matching::Filter;
use stereopsis::units::Disparity;
use stereopsis_host::calibration::Calibration;
use stereopsis_host::obstacles::{ObstacleRecord, ObstacleWatch, Vehicle, WatchedFrame};
use stereopsis_host::pfm;
use stereopsis_host::run::{MemoryPair, MethodName, run};

fn data(name: &str) -> PathBuf {
    let data = std::env::var_os("STEREO_DATA").expect("set STEREO_DATA to the folder with the data");
    Path::new(&data).join(name)
}

/// What is found in a pair.
fn found(rig: &RectifiedRig, pair: [PathBuf; 2], method: MethodName, disparities: u16) -> ObstacleRecord {
    let open = |path: PathBuf| image::open(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let [left, right] = pair.map(open);
    let pictures: [GrayImage; 2] = [left.to_luma8(), right.to_luma8()];
    let (width, height) = (left.width() as u16, left.height() as u16);
    let [l, r] = pictures.each_ref().map(|picture| picture.to_vec());
    let mut camera = MemoryPair::new(width, l, r).expect("two images of one size");
    let config = method.with_filter(Filter::Default, method.config(width, height, disparities));
    let map = run(method, &config, &mut camera, |_| ()).expect("a frame").map;
    let scale = DepthScale::new(rig).expect("a scale");
    let frame = WatchedFrame {
        scale: &scale,
        map: &map,
        rows: map.height,
        largest: Disparity::from_pixels(disparities),
        pictures: Some(pictures.each_ref()),
    };
    let mut watch = ObstacleWatch::new(Vehicle::default());
    watch.look(&frame, &left.to_rgb8()).expect("room for it").0
}

/// A plane of parallaxes: at the principal point, its growth along, and its growth down.
fn plane(points: &[[f64; 3]]) -> Vector3<f64> {
    let (mut square, mut sum) = (Matrix3::zeros(), Vector3::zeros());
    for &[x, y, parallax] in points {
        let row = Vector3::new(1.0, x, y);
        square += row * row.transpose();
        sum += row * parallax;
    }
    square.try_inverse().expect("points that are not in a line") * sum
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn the_ground_is_that_of_the_truth() {
    let folder = data("middlebury2014/Motorcycle");
    let [left, right, calib, truth] =
        ["im0.png", "im1.png", "calib.txt", "disp0GT.pfm"].map(|name| folder.join(name));
    let rig = Calibration::open(&calib, &left).expect("a calibration").rig;
    let bytes = std::fs::read(truth).expect("the truth");
    let truth = pfm::read(&mut bytes.as_slice()).expect("a float map");
    let (f, b) = (f64::from(rig.focal_px()), f64::from(rig.baseline_m()));
    let (cx, cy) = rig.principal_point();
    let points = truth.values.iter().enumerate().filter(|(_, d)| d.is_finite()).map(|(i, d)| {
        let [u, v] = [i % truth.width, i / truth.width].map(|at| at as f64);
        [u - f64::from(cx), v - f64::from(cy), f64::from(*d + rig.disparity_offset_px())]
    });
    let points: Vec<_> = points.collect();
    for method in [MethodName::Block, MethodName::Sgm] {
        let record = found(&rig, [left.clone(), right.clone()], method, 70);
        let ground = record.ground.expect("a ground whose pitch is sure");
        let (pitch, height) = (f64::from(ground.pitch_deg).to_radians(), f64::from(ground.height_m));
        // From what was found on, all points within a px, until they are the plane's own.
        let mut fit = Vector3::new(b / height * f * pitch.sin(), 0.0, b / height * pitch.cos());
        for _ in 0..20 {
            let near = |p: &&[f64; 3]| (p[2] - fit.dot(&Vector3::new(1.0, p[0], p[1]))).abs() < 1.0;
            let near: Vec<_> = points.iter().filter(near).copied().collect();
            assert!(5 * near.len() > points.len(), "{} of {} points", near.len(), points.len());
            fit = plane(&near);
        }
        let normal = Vector3::new(fit.y, fit.z, fit.x / f);
        let (true_height, true_pitch) = (b / normal.norm(), (normal.z / normal.y).atan().to_degrees());
        let roll = (fit.y / fit.z).atan().to_degrees();
        let off = f64::from(ground.pitch_deg) - true_pitch;
        println!("{method:?}: {ground:?}; truth {true_height:.3} m, {true_pitch:.2} degrees, roll {roll:.2}");
        assert!(off.abs() < 0.5 && (height / true_height - 1.0).abs() < 0.02, "{off} degrees");
        // A wall is behind the motorcycle: the robot would not drive through all of it.
        assert!(record.sectors.iter().all(|sector| sector.state == "obstacle"), "{record:?}");
    }
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn roads_are_found() {
    // The pairs come without a calibration; this is about that of the car, 1.6 m high.
    for name in ["urban1", "urban2"] {
        let file = |side: &str| data("stereo_nogt/urban").join(format!("{name}_{side}.png"));
        let rig = RectifiedRig::new(645.0, 0.57, 671.5, 195.0).expect("a rig");
        for method in [MethodName::Block, MethodName::Sgm] {
            let record = found(&rig, ["left", "right"].map(file), method, 128);
            let ground =
                record.ground.unwrap_or_else(|| panic!("{name}, {method:?}: no ground that is sure"));
            println!("{name} {method:?}: {ground:?} {}", record.line());
            assert!((1.45..1.75).contains(&ground.height_m), "{name}, {method:?}: {ground:?}");
            assert!((3.0..7.0).contains(&ground.pitch_deg), "{name}, {method:?}: {ground:?}");
        }
    }
}
