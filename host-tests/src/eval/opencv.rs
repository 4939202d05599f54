//! OpenCV's matchers on pairs of grey images, by a Python that has it and a script that runs them.

use super::EvalError;
use crate::pfm::{self, FloatMap};
use std::ffi::OsStr;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::Command;

const SCRIPT: &str = include_str!("opencv.py");

/// A Python that has OpenCV.
pub struct OpenCv {
    python: PathBuf,
    /// OpenCV's version.
    pub version: String,
}

/// A pair of images and what is searched in it.
pub struct OpenCvScene<'a> {
    /// The stem of its files.
    pub name: &'a str,
    /// The number of disparities, of which a multiple of 16 is searched, and the smallest one, px.
    pub search: [u16; 2],
}

impl OpenCv {
    /// The matchers, by the names that the script gives their files.
    pub const MATCHERS: [&str; 2] = ["StereoBM", "StereoSGBM"];
    /// The matchers' parameters, in words.
    pub const PARAMETERS: &str = "StereoBM with windows of 9x9 pixels and otherwise its defaults; StereoSGBM \
                                  in its 3-way mode with windows of 3x3, P1 = 8 x 9, P2 = 32 x 9, \
                                  disp12MaxDiff 1, uniquenessRatio 10, speckleWindowSize 100, speckleRange 2";

    /// The OpenCV of a Python, which may be a program's name. An error says what that Python says.
    pub fn of(python: &Path) -> Result<Self, EvalError> {
        let print = ["-c", "import cv2, numpy; print(cv2.__version__)"].map(OsStr::new);
        let version = run(python, &print)?.trim().to_owned();
        if version.is_empty() {
            return Err(EvalError::new(python, "is no Python: it prints no version of OpenCV"));
        }
        Ok(Self { python: python.to_owned(), version })
    }

    /// Runs both matchers on scenes, whose images are `NAME-left.pgm` and `NAME-right.pgm` in a folder.
    pub fn run(&self, folder: &Path, scenes: &[OpenCvScene<'_>]) -> Result<(), EvalError> {
        let words = scenes.iter().flat_map(|OpenCvScene { name, search: [count, least] }| {
            [(*name).to_owned(), count.to_string(), least.to_string()]
        });
        let words: Vec<_> = words.collect();
        let mut arguments = vec![OsStr::new("-c"), OsStr::new(SCRIPT), folder.as_os_str()];
        arguments.extend(words.iter().map(OsStr::new));
        run(&self.python, &arguments).map(drop)
    }

    /// What a matcher found in a scene, px; infinite where there is no answer.
    pub fn answers(folder: &Path, scene: &str, matcher: &str) -> Result<FloatMap, EvalError> {
        let path = folder.join(format!("{scene}-{matcher}.pfm"));
        let file = File::open(&path).map_err(|e| EvalError::new(&path, e.to_string()))?;
        pfm::read(&mut BufReader::new(file)).map_err(|e| EvalError::new(&path, e.to_string()))
    }
}

/// What a Python prints; where it fails, the last line of what it complains of.
fn run(python: &Path, arguments: &[&OsStr]) -> Result<String, EvalError> {
    let failed = |what: &str| EvalError::new(python, format!("does not run OpenCV ({what})"));
    let output = Command::new(python).args(arguments).output().map_err(|e| failed(&e.to_string()))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let complaint = String::from_utf8_lossy(&output.stderr);
    Err(failed(complaint.trim_end().lines().last().unwrap_or("it says nothing")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_script_writes_what_is_read() {
        for matcher in OpenCv::MATCHERS {
            assert!(SCRIPT.contains(&format!("(\"{matcher}\", ")), "the script knows no {matcher}");
        }
        // What PARAMETERS says.
        for given in
            ["numDisparities=disparities, blockSize=9", "window = 3", "P1=8 * window**2, P2=32 * window**2"]
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
