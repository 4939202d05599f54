//! Obstacles, ground and free space: the core beside its naive twin (`twins`), worked geometry (`geometry`),
//! rendered scenes (`scenes`) and faulty frames (`faults`).

mod faults;
mod geometry;
mod scenes;
mod support;
mod truth;
mod twins;
