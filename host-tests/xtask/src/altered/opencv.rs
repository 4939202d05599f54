//! OpenCV beside ours: the Python that is named, or one of our own.

use crate::steps::{Failure, Outcome, command, output_of, run as run_command, target_dir};
use std::path::{Path, PathBuf};
use stereopsis_host::eval::OpenCv;

/// What pip installs.
const PACKAGES: [&str; 2] = ["numpy", "opencv-contrib-python-headless"];

/// The OpenCV of the Python that is named, else of one of our own in the folder of build products, made when
/// it is missing.
pub fn find(python: Option<&Path>) -> Outcome<OpenCv> {
    let python = match python {
        Some(python) => python.to_owned(),
        None => own()?,
    };
    let advice = "give --python a Python that has numpy and OpenCV, or --without-opencv";
    OpenCv::of(&python).map_err(|e| Failure::new(format!("{e}; {advice}")))
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
        let Err(failure) = find(Some(Path::new("no-such-python"))) else { panic!("there is such a Python") };
        let told = failure.to_string();
        assert!(told.starts_with("no-such-python: ") && told.ends_with("or --without-opencv"), "{told}");
    }
}
