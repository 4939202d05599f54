//! Two views as properties need them.

use nalgebra::{Matrix3, Rotation3, Vector3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::geometry::camera::Pose;
pub use stereopsis_host::two_view::*;

/// Poses with a baseline, turned up to half a turn about any axis.
pub fn any_pose() -> impl Strategy<Value = Pose<f64>> {
    let numbers =
        || (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y, z)| Vector3::new(x, y, z));
    (numbers(), numbers())
        .prop_filter("a baseline", |(_, t)| t.norm() > 0.05)
        .prop_map(|(r, t)| Pose::new(*Rotation3::new(r * 3.0).matrix(), t).expect("a rotation"))
}

/// The same cases in every run.
pub fn seeded() -> ProptestConfig {
    ProptestConfig {
        cases: 100,
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// The rotation by a vector's length, radians, about it.
pub fn rotation(axis: [f64; 3]) -> Matrix3<f64> {
    Rotation3::new(Vector3::from(axis)).into_inner()
}
