//! Two views of known geometry: what the types keep, what the estimates reach, what is refused by name.

mod cameras;
mod chain;
mod estimates;
mod landmarks;
mod lecture;
mod matrices;
mod planes;
mod points;
mod poses;
mod rectify;
mod resection;
mod robust;
mod twin;
mod views;
