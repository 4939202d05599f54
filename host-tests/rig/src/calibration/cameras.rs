//! Two cameras from a calibration file, rectified or not.

use super::{CalibrationError, Fault, kitti, load_all, middlebury, raw};
use std::path::PathBuf;
use stereopsis::geometry::camera::Camera;

/// The two cameras of a calibration file, by themselves: neither where they stand nor whether they are
/// rectified.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Cameras {
    /// The first (left) camera, px.
    pub first: Camera<f64>,
    /// The second (right) camera, px.
    pub second: Camera<f64>,
}

impl Cameras {
    /// Reads one file, or two of ROS: any format that [`RawCalibration`](super::RawCalibration) reads, or the
    /// file of one camera, which is both then. Of KITTI's cameras it is the pair that
    /// [`Calibration::open`](super::Calibration::open) takes for a colour picture.
    pub fn open(paths: &[PathBuf]) -> Result<Self, CalibrationError> {
        let texts = load_all(paths)?;
        raw::check_two(paths, &texts)?;
        let path = paths.first().cloned().unwrap_or_default();
        Self::read(&texts).map_err(|fault| CalibrationError { path, fault })
    }

    /// The first camera of such files, for which a file of one of KITTI's matrices is enough.
    pub fn open_first(paths: &[PathBuf]) -> Result<Camera<f64>, CalibrationError> {
        let texts = load_all(paths)?;
        raw::check_two(paths, &texts)?;
        let path = paths.first().cloned().unwrap_or_default();
        let found = match texts.first().and_then(|text| kitti::alone(text)) {
            Some(found) => found.and_then(|(key, numbers)| camera(key, numbers)),
            None => Self::read(&texts).map(|cameras| cameras.first),
        };
        found.map_err(|fault| CalibrationError { path, fault })
    }

    fn read(texts: &[String]) -> Result<Self, Fault> {
        if let Some([first, second]) = raw::cameras(texts)? {
            return Ok(Self { first, second });
        }
        let text = texts.first().map_or("", String::as_str);
        let [(first_key, first), (second_key, second)] = if middlebury::is_one(text) {
            middlebury::matrices(text)?
        } else if kitti::is_one(text) {
            kitti::matrices(text)?
        } else {
            return Err(Fault::Unknown);
        };
        Ok(Self { first: camera(first_key, first)?, second: camera(second_key, second)? })
    }
}

/// A camera of fx, skew, cx, fy, cy.
fn camera(key: String, [fx, skew, cx, fy, cy]: [f64; 5]) -> Result<Camera<f64>, Fault> {
    let camera = Camera::new(fx, fy, cx, cy).and_then(|camera| camera.with_skew(skew));
    camera.map_err(|error| Fault::Camera { key, error })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<Cameras, String> {
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        std::fs::write(file.path(), text).expect("a file");
        Cameras::open(&[file.path().into()]).map_err(|e| e.to_string())
    }

    #[test]
    fn cameras_need_not_be_rectified() {
        let cameras =
            of("cam0=[500 2 320; 0 510 240; 0 0 1]\ncam1=[600 0 300; 0 600 200; 0 0 1]\n").expect("cameras");
        assert_eq!(cameras.first.focal_px(), (500.0, 510.0));
        assert_eq!(cameras.first.skew_px(), 2.0);
        assert_eq!(cameras.second.principal_point(), (300.0, 200.0));
        let cameras = of("P0: 500 0 320 0 0 510 240 0 0 0 1 0\nP1: 500 0 320 -50 0 510 240 0 0 0 1 0\n");
        assert_eq!(cameras.expect("cameras").second.focal_px(), (500.0, 510.0));
        let one = "%YAML:1.0\n---\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   \
                   data: [ 500., 0., 320., 0., 510., 240., 0., 0., 1. ]\ndistortion_coefficients: [ 0.5, 0, \
                   0, 0, 0 ]\n";
        let cameras = of(one).expect("one camera");
        assert_eq!(cameras.first.focal_px(), (500.0, 510.0));
        assert_eq!(cameras.first, cameras.second);
        assert!(!cameras.first.lens().is_none());
    }

    #[test]
    fn rectified_cameras_are_cameras_too() {
        let p = |number, shift| format!("P{number}: [500, 0, 320, {shift}, 0, 500, 240, 0, 0, 0, 1, 0]\n");
        let q = "[[1, 0, 0, -320], [0, 1, 0, -240], [0, 0, 0, 500], [0, 0, 10, 0]]";
        let json = |key| format!("{{\"focal_px\": 500, \"{key}\": {q}}}");
        let xml = |number, shift| {
            format!(
                "<P{number} type_id=\"opencv-matrix\"><rows>3</rows><cols>4</cols><dt>d</dt><data>500. 0. \
                 320. {shift} 0. 500. 240. 0. 0. 0. 1. 0.</data></P{number}>"
            )
        };
        let xml = format!(
            "<?xml version=\"1.0\"?><opencv_storage>{}{}</opencv_storage>",
            xml(1, "0."),
            xml(2, "-50.")
        );
        for text in [p(1, 0) + &p(2, -50), format!("Q: {q}\n"), json("Q"), json("q"), xml] {
            let cameras = of(&text).expect(&text);
            assert_eq!(cameras.first.focal_px(), (500.0, 500.0), "{text}");
            assert_eq!(cameras.second.principal_point(), (320.0, 240.0), "{text}");
        }
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (text, said) in [
            ("", "empty"),
            ("hello", "neither"),
            ("cam0=[500 0 320; 0 510 240; 0 0 1]\n", "cam1 is missing"),
            ("cam0=[0 0 320; 0 510 240; 0 0 1]\ncam1=[1 0 0; 0 1 0; 0 0 1]\n", "cam0: the focal lengths"),
        ] {
            let error = of(text).expect_err(text);
            assert!(error.contains(said), "{text}: {error}");
        }
    }
}
