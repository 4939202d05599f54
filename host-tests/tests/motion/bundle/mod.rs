//! Bundle adjustment: derivatives against differences, steps against the naive twin, results against the
//! truth; structure from observations alone.

mod covariance;
mod files;
mod refused;
mod scene;
mod slopes;
mod solve;
mod structure;
mod twin;
