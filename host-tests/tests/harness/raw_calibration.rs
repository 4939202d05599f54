//! One rig in every format that is read, and files that are wrong: one line that names what.

use nalgebra::{Matrix3, Vector3};
use std::path::PathBuf;
use stereopsis::geometry::camera::{Distortion, Fisheye, ImageSize, Lens};
use stereopsis_host::calibration::RawCalibration;
use tempfile::TempDir;

const SIZE: ImageSize = ImageSize { width: 640, height: 480 };

const YAML: &str = "%YAML:1.0
---
image_width: 640
image_height: 480
K1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.0e+02, 0., 3.2e+02, 0., 5.1e+02, 2.4e+02, 0., 0., 1. ]
D1: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -0.25, 0.0625, 0.001, -0.002, 0. ]
K2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.05e+02, 0., 3.25e+02, 0., 5.15e+02, 2.45e+02, 0., 0., 1. ]
D2: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -0.125, 0.03125, 0., 0., 0. ]
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 0.8, -0.6, 0., 0.6, 0.8, 0., 0., 0., 1. ]
T: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ -0.1, 0.02, 0.01 ]
";

const XML: &str = "<?xml version=\"1.0\"?>
<opencv_storage>
<imageSize>640 480</imageSize>
<cameraMatrixLeft type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols><dt>d</dt>
  <data>5.0e+02 0. 320. 0. 510. 240. 0. 0. 1.</data></cameraMatrixLeft>
<distCoeffsLeft type_id=\"opencv-matrix\"><rows>1</rows><cols>5</cols><dt>d</dt>
  <data>-0.25 0.0625 0.001 -0.002 0.</data></distCoeffsLeft>
<cameraMatrixRight type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols><dt>d</dt>
  <data>505. 0. 325. 0. 515. 245. 0. 0. 1.</data></cameraMatrixRight>
<distCoeffsRight type_id=\"opencv-matrix\"><rows>1</rows><cols>5</cols><dt>d</dt>
  <data>-0.125 0.03125 0. 0. 0.</data></distCoeffsRight>
<R type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols><dt>d</dt><data>0.8 -0.6 0. 0.6 0.8 0. 0. 0. \
                   1.</data></R>
<T type_id=\"opencv-matrix\"><rows>3</rows><cols>1</cols><dt>d</dt><data>-0.1 0.02 0.01</data></T>
</opencv_storage>
";

const JSON: &str = r#"{"image_size": [640, 480], "K1": [[500, 0, 320], [0, 510, 240], [0, 0, 1]],
"D1": [-0.25, 0.0625, 0.001, -0.002, 0], "K2": [[505, 0, 325], [0, 515, 245], [0, 0, 1]],
"D2": [[-0.125, 0.03125, 0, 0, 0]], "R": [[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1]],
    "T": [-0.1, 0.02, 0.01]}"#;

const KALIBR: &str = "cam0:
  camera_model: pinhole
  intrinsics: [500.0, 510.0, 320.0, 240.0]
  distortion_model: radtan
  distortion_coeffs: [-0.25, 0.0625, 0.001, -0.002]
  resolution: [640, 480]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
  - [0.8, -0.6, 0.0, -0.1]
  - [0.6, 0.8, 0.0, 0.02]
  - [0.0, 0.0, 1.0, 0.01]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: pinhole
  intrinsics: [505.0, 515.0, 325.0, 245.0]
  distortion_model: radtan
  distortion_coeffs: [-0.125, 0.03125, 0.0, 0.0]
  resolution: [640, 480]
";

/// A camera_info: its rectification turns about Z, by a cosine and a sine.
fn ros(k: &str, d: &str, [c, s]: [f64; 2], shift: f64) -> String {
    format!(
        "image_width: 640\nimage_height: 480\ncamera_name: one\ncamera_matrix:\n  rows: 3\n  cols: 3\n  \
         data: {k}\ndistortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: \
         {d}\nrectification_matrix:\n  rows: 3\n  cols: 3\n  data: [{c}, {}, 0., {s}, {c}, 0., 0., 0., \
         1.]\nprojection_matrix:\n  rows: 3\n  cols: 4\n  data: [400., 0., 300., {shift}, 0., 400., 200., \
         0., 0., 0., 1., 0.]\n",
        -s
    )
}

fn open(texts: &[&str], unit_m: f64) -> Result<RawCalibration, String> {
    let folder = TempDir::new().expect("a temporary folder");
    let put = |(i, text): (usize, &&str)| -> PathBuf {
        let path = folder.path().join(format!("file{i}"));
        std::fs::write(&path, text).expect("a file");
        path
    };
    let paths: Vec<_> = texts.iter().enumerate().map(put).collect();
    RawCalibration::open(&paths, Some(SIZE), Some(unit_m)).map_err(|e| e.to_string())
}

#[test]
fn one_rig_in_every_format() {
    for (text, format) in [(YAML, "OpenCV"), (XML, "OpenCV"), (JSON, "OpenCV"), (KALIBR, "Kalibr")] {
        let found = open(&[text], 1.0).expect(format);
        assert_eq!(found.format, format);
        let [left, right] = found.rig.cameras();
        assert_eq!((left.focal_px(), left.principal_point()), ((500.0, 510.0), (320.0, 240.0)));
        assert_eq!((right.focal_px(), right.principal_point()), ((505.0, 515.0), (325.0, 245.0)));
        assert_eq!(*left.lens(), Distortion::from_opencv([-0.25, 0.0625, 0.001, -0.002, 0.0]).into());
        assert_eq!(*right.lens(), Distortion::from_opencv([-0.125, 0.03125, 0.0, 0.0, 0.0]).into());
        // P' = R P + T.
        let (r, t) = found.rig.pose().to_opencv();
        assert!((r - Matrix3::new(0.8, -0.6, 0.0, 0.6, 0.8, 0.0, 0.0, 0.0, 1.0)).amax() < 1e-12, "{format}");
        assert!((t - Vector3::new(-0.1, 0.02, 0.01)).amax() < 1e-12, "{format}");
    }
    // Intrinsics and extrinsics in two files.
    let (inner, outer) = YAML.split_at(YAML.find("R: !!").expect("R"));
    assert_eq!(
        open(&[inner, &format!("%YAML:1.0\n---\n{outer}")], 1.0).map(|c| c.rig),
        open(&[YAML], 1.0).map(|c| c.rig)
    );
}

#[test]
fn a_camera_info_for_each_camera() {
    let k = "[500., 0., 320., 0., 510., 240., 0., 0., 1.]";
    let left = ros(k, "[-0.25, 0.0625, 0., 0., 0.]", [1.0, 0.0], 0.0);
    let right = ros(k, "[-0.25, 0.0625, 0., 0., 0.]", [0.8, 0.6], -40.0);
    for order in [[&left, &right], [&right, &left]] {
        let found = open(&order.map(|text| text.as_str()), 1.0).expect("a pair");
        assert_eq!(found.format, "ROS");
        // The rectified frame is the left camera's; the right one stands 0.1 m along its X.
        assert!((found.rig.pose().translation() - Vector3::new(0.1, 0.0, 0.0)).amax() < 1e-12);
        let (r, _) = found.rig.pose().to_opencv();
        assert!((r - Matrix3::new(0.8, 0.6, 0.0, -0.6, 0.8, 0.0, 0.0, 0.0, 1.0)).amax() < 1e-12, "{r}");
    }
    let narrow = right.replace("image_width: 640", "image_width: 320");
    let error = open(&[&left, &narrow], 1.0).expect_err("two sizes");
    assert!(error.contains("640 x 480 of one camera, 320 x 480 of the other"), "{error}");
    let error = open(&[&left], 1.0).expect_err("one camera");
    assert!(error.contains("--calib a second time"), "{error}");
}

#[test]
fn lenses_of_other_models() {
    let wide: Lens<f64> = Fisheye::from_opencv([-0.25, 0.0625, 0.001, -0.002]).into();
    let of = |texts: &[&str]| *open(texts, 1.0).expect("a rig").rig.cameras()[0].lens();
    assert_eq!(of(&[&KALIBR.replace("radtan", "equidistant")]), wide);
    let camera_info = |model: &str, lens: &str, shift| {
        let text = ros("[500., 0., 320., 0., 510., 240., 0., 0., 1.]", lens, [1.0, 0.0], shift);
        text.replace("plumb_bob", model)
    };
    let of_ros = |model, lens| of(&[&camera_info(model, lens, 0.0), &camera_info(model, lens, -40.0)]);
    assert_eq!(of_ros("equidistant", "[-0.25, 0.0625, 0.001, -0.002]"), wide);
    let rational = [-0.25, 0.0625, 0.001, -0.002, 0.5, 0.125, 0.25, 0.75];
    let text = format!("{rational:?}");
    assert_eq!(of_ros("rational_polynomial", &text), Distortion::from_opencv_rational(rational).into());
    // OpenCV's own, and how its programs mark the other model.
    let longer = JSON.replacen("-0.002, 0]", "-0.002, 0.5, 0.125, 0.25, 0.75, 0, 0, 0, 0, 0, 0]", 1);
    assert_eq!(of(&[&longer]), Distortion::from_opencv_rational(rational).into());
    let four = JSON.replace("-0.002, 0]", "-0.002]").replace("0.03125, 0, 0, 0]", "0.03125, 0, 0]");
    for marked in ["\"fisheye_model\": 1", "\"model\": \"Fisheye\""] {
        assert_eq!(of(&[&four.replacen('{', &format!("{{{marked}, "), 1)]), wide);
    }
}

#[test]
fn rectified_formats_are_read_too() {
    let middlebury = "cam0=[500 0 320; 0 500 240; 0 0 1]\ncam1=[500 0 330; 0 500 240; 0 0 \
                      1]\ndoffs=10\nbaseline=100\nwidth=640\nheight=480\n";
    let found = open(&[middlebury], 1.0).expect("Middlebury");
    assert_eq!((found.format, found.rig.cameras()[1].principal_point()), ("Middlebury", (330.0, 240.0)));
    assert!((found.rig.baseline_m() - 0.1).abs() < 1e-7);
    let kitti = "P0: 700 0 600 0 0 700 180 0 0 0 1 0\nP1: 700 0 600 -350 0 700 180 0 0 0 1 0\n";
    let found = open(&[kitti], 1.0).expect("KITTI");
    assert_eq!((found.format, found.rig.baseline_m()), ("KITTI", 0.5));
}

#[test]
fn what_is_wrong_is_said_in_one_line() {
    let less = |key: &str| {
        let begin = YAML.find(&format!("{key}: !!")).expect("a key");
        // Up to the next line that is not indented.
        let rest = YAML[begin..]
            .lines()
            .skip(1)
            .skip_while(|line| line.starts_with(' '))
            .map(|line| format!("{line}\n"));
        let rest: String = rest.collect();
        format!("{}{rest}", &YAML[..begin])
    };
    let with = |from: &str, to: &str| {
        assert!(YAML.contains(from), "{from}");
        YAML.replacen(from, to, 1)
    };
    for (text, said) in [
        (less("K1"), "K1 is missing"),
        (less("D2"), "D2 is missing"),
        (less("R"), "R is missing"),
        (less("T"), "T is missing"),
        (with("-0.25", ".Nan"), "D1: a number is not finite"),
        (with("-0.25", "nan"), "not finite"),
        (with("-0.25", "many"), "'many' is not a number"),
        (with("0.8, -0.6", "0.9, -0.6"), "R: the matrix is no rotation"),
        (with("0.6, 0.8, 0., 0., 0., 1.", "0.6, 0.8, 0., 0., 0., -1."), "no rotation"),
        (with("[ -0.1, 0.02, 0.01 ]", "[ 0., 0., 0. ]"), "the baseline is zero"),
        (with("[ -0.1, 0.02, 0.01 ]", "[ -100., 20., 10. ]"), "--unit mm"),
        (with("[ -0.1, 0.02, 0.01 ]", "[ -0.1, 0.02 ]"), "T: has 2 numbers; 3 are needed"),
        (with("5.0e+02", "-5.0e+02"), "K1: the focal lengths"),
        (with("image_width: 640", "image_width: 641"), "width says 641"),
        (with("0.001, -0.002, 0. ]", "0.001, -0.002, 0., 0., 0., 0., 0.5 ]"), "thin prisms"),
        (
            with("%YAML:1.0\n---\n", "%YAML:1.0\n---\nfisheye_model: 1\n"),
            "a fisheye lens has four coefficients",
        ),
        (with("data: [ 5.0e+02", "data: [ [ 5.0e+02"), "not well-formed"),
        (KALIBR.replacen("radtan", "fov", 1), "'fov' is not supported; calibrate with radtan or equidistant"),
        (KALIBR.replacen("T_cn_cnm1", "T_cam_imu", 1), "T_cn_cnm1 is missing"),
        (XML.replacen("</R>", "", 1), "not well-formed"),
        ("hello".into(), "no calibration of two cameras"),
        (" \n".into(), "empty"),
    ] {
        let error = open(&[&text], 1.0).expect_err(said);
        assert!(error.contains(said) && !error.contains('\n') && error.contains("file0"), "{said}: {error}");
    }
    let millimetres = with("[ -0.1, 0.02, 0.01 ]", "[ -100., 20., 10. ]");
    let rig = open(&[&millimetres], 0.001).expect("in millimetres").rig;
    assert!((rig.baseline_m() - open(&[YAML], 1.0).expect("in metres").rig.baseline_m()).abs() < 1e-12);
}
