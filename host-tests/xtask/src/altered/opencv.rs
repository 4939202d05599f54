//! OpenCV beside ours: a Python that has it, and a script that runs its matchers.

use crate::steps::{Failure, Outcome, command, output_of, run as run_command, target_dir};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::Command;
use stereopsis_host::pfm;

/// The matchers, by the names that the script gives their files.
pub const MATCHERS: [&str; 2] = ["StereoBM", "StereoSGBM"];

/// The matchers' parameters, in words.
pub const PARAMETERS: &str = "StereoBM with windows of 9x9 pixels and otherwise its defaults; StereoSGBM in \
                              its 3-way mode with windows of 3x3, P1 = 8 x 9, P2 = 32 x 9, disp12MaxDiff 1, \
                              uniquenessRatio 10, speckleWindowSize 100, speckleRange 2";

const SCRIPT: &str = include_str!("opencv.py");
/// What pip installs.
const PACKAGES: [&str; 2] = ["numpy", "opencv-contrib-python-headless"];

/// A Python that has OpenCV.
pub struct OpenCv {
    python: PathBuf,
    /// OpenCV's version.
    pub version: String,
}

impl OpenCv {
    /// That of the Python that is named, else of one of our own in the folder of build products, made when it
    /// is missing.
    pub fn find(python: Option<&Path>) -> Outcome<Self> {
        let python = match python {
            Some(python) => python.to_owned(),
            None => own()?,
        };
        let version = output_of(command(&python, &["-c"]).arg("import cv2, numpy; print(cv2.__version__)"));
        let advice = "give --python a Python that has numpy and OpenCV, or --without-opencv";
        let version = version.map_err(|e| Failure::new(format!("{e}; {advice}")))?.trim().to_owned();
        Ok(Self { python, version })
    }

    /// Runs both matchers on the scenes, by name and number of disparities, whose images are in a folder.
    pub fn run(&self, folder: &Path, scenes: &[(&str, u16)]) -> Outcome {
        let mut python = Command::new(&self.python);
        python.args(["-c", SCRIPT]).arg(folder);
        for (name, disparities) in scenes {
            python.arg(name).arg(disparities.to_string());
        }
        output_of(&mut python).map(drop)
    }
}

/// What a matcher found in a scene, px; infinite where there is no answer.
pub fn answers(folder: &Path, scene: &str, matcher: &str) -> Outcome<Vec<f32>> {
    let path = folder.join(format!("{scene}-{matcher}.pfm"));
    let failed = |what: String| Failure::new(format!("{}: {what}", path.display()));
    let file = File::open(&path).map_err(|e| failed(e.to_string()))?;
    let map = pfm::read(&mut BufReader::new(file)).map_err(|e| failed(e.to_string()))?;
    Ok(map.values)
}

/// Our own Python: an environment of its own with the packages.
fn own() -> Outcome<PathBuf> {
    let folder = target_dir().join("opencv");
    let python = folder.join("bin/python");
    if output_of(command(&python, &["-c"]).arg("import cv2, numpy")).is_ok() {
        return Ok(python);
    }
    let missing = |e: Failure| {
        let advice =
            "install Python with venv and pip, give --python a Python that has OpenCV, or --without-opencv";
        Failure::new(format!("OpenCV is not to be had: {e}; {advice}"))
    };
    run_command(command("python3", &["-m", "venv"]).arg(&folder)).map_err(missing)?;
    run_command(&mut command(&python, &[&["-m", "pip", "install", "--quiet"], PACKAGES.as_slice()].concat()))
        .map_err(missing)?;
    Ok(python)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_python_that_is_none_is_named_with_advice() {
        let Err(failure) = OpenCv::find(Some(Path::new("no-such-python"))) else {
            panic!("there is such a Python")
        };
        let told = failure.to_string();
        assert!(told.starts_with("no-such-python -c ") && told.ends_with("or --without-opencv"), "{told}");
    }

    #[test]
    fn the_script_writes_what_is_read() {
        for matcher in MATCHERS {
            assert!(SCRIPT.contains(&format!("(\"{matcher}\", ")), "the script knows no {matcher}");
        }
        // What PARAMETERS says.
        for given in ["StereoBM_create(disparities, 9)", "window = 3", "P1=8 * window**2, P2=32 * window**2"]
        {
            assert!(SCRIPT.contains(given), "the script has no {given}");
        }
        assert!(
            SCRIPT.contains(
                "disp12MaxDiff=1, uniquenessRatio=10,\n        speckleWindowSize=100, speckleRange=2"
            )
        );
    }
}
