//! Obstacles, ground and free space: the core beside its naive twin (`twins`), worked geometry (`geometry`),
//! what counts (`evidence`), a camera that flies (`flight`), rendered scenes (`scenes`) and faulty frames
//! (`faults`).

mod decisions;
mod drives;
mod evidence;
mod faults;
mod flight;
mod geometry;
mod given;
mod ground;
mod scenes;
mod sides;
mod support;
mod tally;
mod truth;
mod twins;
