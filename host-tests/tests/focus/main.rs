//! Depth from focus: the lens, sharpness, peaks, lens motors.

mod autofocus;
mod dw9714;
mod edges;
mod fusion;
mod lens;
mod order;
mod search;
mod stacks;
mod twins;
