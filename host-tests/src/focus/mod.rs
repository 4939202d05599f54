//! Focus stacks on the desktop.
//!
//! * [`stack`]: the frames of a folder. [`positions`]: where the lens stood in each.
//! * [`scene`]: a scene of known depth behind a simulated lens, which renders such frames.
//! * [`run`](mod@run): frames through the core's map, with the picture that is sharp all over.
//! * [`evaluation`]: such stacks, and how far answers for them are from the truth.
//! * [`order`](mod@order): whether frames are a stack, and which are out of order or spoiled.
//! * [`memory`]: the vectors that the map works in. [`breathing`]: whether frames grow as the lens says.

pub mod breathing;
pub mod evaluation;
pub mod memory;
pub mod order;
pub mod positions;
pub mod run;
pub mod scene;
pub mod stack;
