//! Files of any bytes: each is read, or refused in one line that names it.

use arbitrary::{Result, Unstructured};
use std::fmt::Display;
use std::io::{Cursor, Write};
use std::path::Path;
use stereopsis::motion::bundle::{BundleConfig, Gauge};
use stereopsis_host::bal::read_problem;
use stereopsis_host::calibration::{Calibration, RawCalibration};
use stereopsis_host::command_line::one_line;
use stereopsis_host::matches::read_matches;
use stereopsis_host::mock::MockCamera;
use stereopsis_host::odometry::poses::read as read_poses;
use stereopsis_host::recording::Recording;

/// All bytes that are left in a file, and what becomes of it.
fn file<T>(u: &mut Unstructured<'_>, of: impl FnOnce(&Path) -> T) -> Result<T> {
    let bytes = u.bytes(u.len())?;
    let mut file = tempfile::NamedTempFile::new().expect("a temporary file");
    file.write_all(bytes).expect("room for it");
    Ok(of(file.path()))
}

/// A refusal is one line and names the file.
#[track_caller]
fn named(path: &Path, error: &impl Display) {
    let line = one_line(&error.to_string());
    assert!(!line.contains('\n') && line.len() < 2000, "{line}");
    assert!(line.contains(&*path.to_string_lossy()), "{line}");
}

/// A calibration in any format.
pub fn calibration(u: &mut Unstructured<'_>) -> Result<()> {
    file(u, |path| {
        match Calibration::open(path, Path::new("image_0/left.png")) {
            Ok(read) => assert!(read.rig.focal_px() > 0.0 && read.rig.baseline_m() > 0.0, "{:?}", read.rig),
            Err(error) => named(path, &error),
        }
        match RawCalibration::open(&[path.into()], None, None) {
            Ok(read) => assert!(read.rig.baseline_m() > 0.0, "{:?}", read.rig),
            Err(error) => named(path, &error),
        }
    })
}

/// A picture in any format.
pub fn image(u: &mut Unstructured<'_>) -> Result<()> {
    file(u, |path| {
        if let Err(error) = MockCamera::open(path) {
            named(path, &error);
        }
    })
}

/// Matches, and poses.
pub fn tables(u: &mut Unstructured<'_>) -> Result<()> {
    file(u, |path| {
        match read_matches(path) {
            Ok(matches) => {
                for seen in matches {
                    let places = [seen.first, seen.second];
                    assert!(places.iter().flat_map(|p| p.iter()).all(|v| v.is_finite()), "{seen:?}");
                }
            }
            Err(error) => named(path, &error),
        }
        if let Err(error) = read_poses(path) {
            named(path, &error);
        }
    })
}

/// A problem of bundle adjustment, and some iterations of it.
pub fn problem(u: &mut Unstructured<'_>) -> Result<()> {
    file(u, |path| match read_problem(path) {
        Ok(problem) => {
            let config = BundleConfig::new(Gauge::Free);
            let Ok(mut running) = problem.start(&config) else { return };
            for _ in 0..4 {
                if running.iterate().is_break() {
                    break;
                }
            }
            let report = running.report();
            assert!(report.cost <= report.initial_cost, "{report:?}");
        }
        Err(error) => named(path, &error),
    })
}

/// A recording, to its end.
pub fn recording(u: &mut Unstructured<'_>) -> Result<()> {
    let bytes = u.bytes(u.len())?.to_vec();
    let (most, path) = (bytes.len() + 1, Path::new("recording"));
    match Recording::read(path, Box::new(Cursor::new(bytes))) {
        Ok(mut recording) => {
            for entry in recording.by_ref().take(most) {
                if let Err(error) = entry {
                    named(path, &error);
                    return Ok(());
                }
            }
            assert!(recording.next().is_none(), "a record takes a byte at least");
        }
        Err(error) => named(path, &error),
    }
    Ok(())
}
