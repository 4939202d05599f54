//! Properties that hold for any bytes: each target reads a case from them, and panics where a promise of
//! `docs/assurance.md` is broken.
//!
//! * [`TARGETS`] is the list. `campaign`, a package of its own, has libFuzzer look for bytes that break one;
//!   the test of this package runs each target on its seeds and on bytes by chance.
//! * [`case`] makes configurations and pictures of bytes.

mod calls;
pub mod case;
mod control;
mod features;
mod files;
mod focus;
mod geometry;
mod guarded;
mod lines;
mod matching;
mod odometry;
mod records;
mod remap;
mod sensors;
mod templates;

use arbitrary::{Result, Unstructured};

/// A property of bytes. It panics where it is broken; an error says that the bytes hold no case.
pub struct Target {
    /// Its name, also that of the folder of its seeds.
    pub name: &'static str,
    /// Runs the case that the bytes hold.
    pub run: fn(&mut Unstructured<'_>) -> Result<()>,
}

/// Every target.
pub const TARGETS: &[Target] = &[
    Target { name: "matching", run: matching::equals_its_twin },
    Target { name: "guarded", run: guarded::flags_what_a_fault_touches },
    Target { name: "remap", run: remap::equals_its_twin },
    Target { name: "records", run: records::come_back },
    Target { name: "geometry", run: geometry::is_finite },
    Target { name: "features", run: features::equal_their_twins },
    Target { name: "templates", run: templates::stay_in_the_picture },
    Target { name: "focus", run: focus::equals_its_twin },
    Target { name: "control", run: control::stays_in_its_limits },
    Target { name: "odometry", run: odometry::survives },
    Target { name: "sensors", run: sensors::survive_their_bus },
    Target { name: "calibrations", run: files::calibration },
    Target { name: "images", run: files::image },
    Target { name: "tables", run: files::tables },
    Target { name: "problems", run: files::problem },
    Target { name: "recordings", run: files::recording },
    Target { name: "lines", run: lines::come_once_or_are_counted },
    Target { name: "calls", run: calls::keep_to_their_memory },
];

/// The target of that name.
pub fn target(name: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.name == name)
}
