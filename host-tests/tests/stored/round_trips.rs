//! Configurations, calibrations and results come back as they were.

use nalgebra::{Matrix3, Point3, Rotation3, Unit, Vector3};
use serde::{Serialize, de::DeserializeOwned};
use std::fmt::Debug;
use stereopsis::camera::{GainSteps, LineFormat, Mt9v034Window, PixelFormat};
use stereopsis::depth::{DepthRange, DepthScale, TemporalConfig};
use stereopsis::features::{Epipolar, FeatureConfig, Level, MatchConfig};
use stereopsis::focus::{Breathing, FocusCalibration, FocusConfig, MicroLens, ThinLens};
use stereopsis::geometry::absolute::Projection;
use stereopsis::geometry::camera::{
    Camera, Distortion, Fisheye, ImageSize, Lens, Pose, RectifiedRig, StereoRig,
};
use stereopsis::geometry::known_shape::{Sighting, SquareMark};
use stereopsis::geometry::rectify::{Crop, RowHealth};
use stereopsis::geometry::robust::RobustConfig;
use stereopsis::geometry::two_view::{Essential, Fundamental, Homography, RelativePose};
use stereopsis::imaging::{CameraHealth, ExposureLimits, Noise};
use stereopsis::matching::{Block, Config, Filter, Kernel, Sgm};
use stereopsis::motion::bundle::{BundleConfig, Gauge, Loss};
use stereopsis::motion::odometry::{OdometryConfig, RefinementConfig, State};
use stereopsis::motion::structure::StructureConfig;
use stereopsis::pipeline::FaultCounters;
use stereopsis::units::{Disparity, Metres, Millimetres, PixelFlags};

/// What is read back from JSON and from postcard's bytes.
fn read_back<T: Serialize + DeserializeOwned + Debug>(value: &T) -> [T; 2] {
    let json = serde_json::to_string(value).unwrap_or_else(|e| panic!("{value:?}: {e}"));
    let bytes = postcard::to_allocvec(value).unwrap_or_else(|e| panic!("{value:?}: {e}"));
    [
        serde_json::from_str(&json).unwrap_or_else(|e| panic!("{json}: {e}")),
        postcard::from_bytes(&bytes).unwrap_or_else(|e| panic!("{value:?}: {e}")),
    ]
}

/// It comes back to the bit.
fn exact<T: Serialize + DeserializeOwned + Debug + PartialEq>(value: T) {
    for back in read_back(&value) {
        assert_eq!(back, value);
    }
}

/// A matrix comes back to a few roundings: it is brought to its form anew.
fn near<T: Serialize + DeserializeOwned + Debug>(value: T, matrix: impl Fn(&T) -> Matrix3<f32>) {
    for back in read_back(&value) {
        let off = (matrix(&back) - matrix(&value)).amax();
        assert!(off <= 4.0 * f32::EPSILON * matrix(&value).amax(), "{back:?} is {off} off {value:?}");
    }
}

fn camera() -> Camera<f32> {
    let lens = Distortion { k1: -0.31, k2: 0.12, p1: 1e-3, p2: -2e-4, k3: 0.01, k4: 0.0, k5: 0.0, k6: 0.0 };
    let camera = Camera::new(501.3, 499.7, 319.2, 241.8).expect("a camera");
    camera.with_skew(0.25).expect("a skew").with_distortion(lens).expect("a lens")
}

/// Its rotation turns by a right angle, which is exact.
fn pose() -> Pose<f32> {
    let turn = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    Pose::new(turn, Vector3::new(0.06, -0.001, 0.002)).expect("a pose")
}

/// Its rotation has numbers that are rounded.
fn tilted() -> Pose<f32> {
    let turn = Rotation3::from_euler_angles(0.01_f32, -0.4, 0.2);
    Pose::new(*turn.matrix(), Vector3::new(0.06, -0.001, 0.002)).expect("a pose")
}

#[test]
fn configurations() {
    let config = Config::for_method::<Sgm>(320, 240, 64).with_filter::<Sgm>(Filter::Strict);
    exact(Config { noise: Noise::default(), confidence: true, ..config });
    exact(Config::for_method::<Block>(160, 120, 32));
    exact(FeatureConfig::new(320, 240));
    let fundamental = Fundamental::from_matrix(&Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0));
    let fundamental = fundamental.expect("the matrix of a rectified pair");
    let epipolar = Some(Epipolar { fundamental, tolerance_px: 1.5 });
    let bounded = MatchConfig { along_px: 96.0, across_px: 8.5, ..MatchConfig::new() };
    exact(MatchConfig { epipolar, ..bounded });
    // A search without bounds is infinitely far, which JSON has no number for.
    let bytes = postcard::to_allocvec(&MatchConfig::new()).expect("bytes");
    assert_eq!(postcard::from_bytes::<MatchConfig>(&bytes), Ok(MatchConfig::new()));
    exact(FocusConfig::tiles(320, 240));
    exact(TemporalConfig::default());
    exact(RobustConfig::new(1.5_f32));
    exact(OdometryConfig::new(640));
    exact(RefinementConfig::<f32>::new(5));
    exact(StructureConfig::new(1.5_f64));
    exact(BundleConfig { loss: Loss::Huber(1.25_f32), ..BundleConfig::new(Gauge::Views(0..2)) });
    exact(Gauge::Baseline { held: 0, other: 3 });
    exact(Crop::Alpha(0.5_f32));
    exact(LineFormat { width: 320, height: 240, pixel: PixelFormat::Grey8 });
    exact(Level::FULL.downsampled::<4>());
    exact(ExposureLimits {
        least_us: 20,
        most_us: 8000,
        most_gain_16ths: 64,
        exposure_step_us: 32,
        gain_steps: GainSteps::Doublings,
    });
    exact(Mt9v034Window { left: 56, top: 0, ..Mt9v034Window::WHOLE });
}

#[test]
fn calibrations() {
    exact(RectifiedRig::with_offset(351.37, 0.0603, 159.6, 119.1, 161.2).expect("a rig"));
    exact(camera());
    let fisheye = Fisheye { k1: 0.1_f64, k2: -0.02, k3: 0.003, k4: 0.0 };
    exact(
        Camera::new(300.1, 300.2, 320.3, 240.4).expect("a camera").with_distortion(fisheye).expect("a lens"),
    );
    exact::<Lens<f32>>(*camera().lens());
    exact(pose());
    near(tilted(), |pose| *pose.rotation());
    let size = ImageSize { width: 640, height: 480 };
    exact(StereoRig::new([camera(); 2], pose(), [size; 2]).expect("a rig"));
    exact(ThinLens::new(0.004_f32).expect("a lens"));
    let lens = ThinLens::new(0.004).expect("a lens");
    exact(FocusCalibration::fit(lens, &[(100, 2.0), (500, 0.2), (700, 0.139)]).expect("a line"));
    exact(MicroLens::new(4000).expect("a lens"));
    exact(Breathing::new(1.03).expect("a scale"));
    exact(SquareMark::new(0.16_f32).expect("a mark"));
}

#[test]
fn results() {
    exact(FaultCounters::default());
    exact(CameraHealth::Good);
    exact(RowHealth::Worn);
    exact(State::Tracked);
    exact(Kernel::detect());
    exact(vec![Disparity::from_pixels(7), Disparity::NONE]);
    exact((PixelFlags::MISMATCH, Millimetres(524), Metres(0.524)));
    let scale = DepthScale::new(&RectifiedRig::new(350.0, 0.06, 160.0, 120.0).expect("a rig"));
    let range = scale.expect("a scale").range(&Config::for_method::<Block>(320, 240, 64), 0.1);
    exact::<DepthRange>(range.expect("depths"));
    near(Fundamental::from_cameras(&tilted(), &camera(), &camera()).expect("apart"), |f| *f.matrix());
    near(Essential::from_pose(&tilted()).expect("apart"), |e| *e.matrix());
    near(Homography::from_matrix(&tilted().rotation().scale(3.0)).expect("a plane"), |h| *h.matrix());
    near(Projection::new(&camera(), &tilted()), |p| p.matrix().fixed_view::<3, 3>(0, 0).into());
    near(RelativePose::of(&tilted()).expect("apart"), |pose| *pose.rotation());
    let bearing = Unit::new_normalize(Vector3::new(0.1_f32, 0.2, 1.0));
    for back in read_back(&Sighting { distance_m: 2.0, sigma_m: 0.01, bearing, angle_rad: 0.1 }) {
        assert!((back.bearing.into_inner() - bearing.into_inner()).amax() < 1e-6, "{back:?}");
    }
    let seen = read_back(&tilted())[0].transform(&Point3::new(0.1, 0.2, 1.0));
    assert!((seen - tilted().transform(&Point3::new(0.1, 0.2, 1.0))).amax() < 1e-6);
}
