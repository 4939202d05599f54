//! Pure maths of cameras: what the types keep, what the estimates reach, what is refused by name.
//!
//! * `cameras`, `chain`, `lecture`, `poses`, `points`: one and two cameras. `matrices`, `estimates`,
//!   `planes`: E, F and homographies, beside the `twin`. `robust`: RANSAC.
//! * `resection`, `landmarks`: a camera before known points.
//! * `rectify`, `uncalibrated`, `row_health`: rows aligned, by cameras or by matches, and rows that no longer
//!   are.
//! * `extremes`: numbers over all exponents. `records`: rigs in flash.

mod cameras;
mod chain;
mod dominant_plane;
mod estimates;
mod extremes;
mod known_cameras;
mod landmarks;
mod lecture;
mod matrices;
mod planes;
mod points;
mod poses;
mod records;
mod rectify;
mod resection;
mod robust;
mod row_health;
mod twin;
mod uncalibrated;
mod views;
