//! Disparities of any program beside a known truth, in the measures of the public benchmarks.
//!
//! In: files of disparities or of depths, a truth, and a mask of what is scored. Out: [`Measures`] of each
//! scene and their mean.
//!
//! * [`DisparityFile`], [`Truth`], [`mask`], [`confidence`]: the files.
//! * [`Scene`]: folders of Middlebury 2014, KITTI, ETH3D and of this repository, told apart by what is in
//!   them; [`Results`]: folders of results.
//! * [`OpenCv`]: the matchers of OpenCV, to be beside.

mod files;
mod layout;
mod measures;
mod opencv;
mod results;

pub use files::{DisparityFile, Truth, confidence, mask};
pub use layout::Scene;
pub use measures::Measures;
pub use opencv::{OpenCv, OpenCvScene};
pub use results::Results;

use std::path::{Path, PathBuf};

/// Why there is nothing to compare: one line that names the file and what would be right.
#[derive(Debug, thiserror::Error)]
#[error("{}: {what}", path.display())]
pub struct EvalError {
    /// The file or folder.
    path: PathBuf,
    /// What is wrong, and what would be right.
    what: String,
}

impl EvalError {
    fn new(path: &Path, what: impl Into<String>) -> Self {
        Self { path: path.into(), what: what.into() }
    }
}
