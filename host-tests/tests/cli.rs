//! The program `stereo` as its users run it: what it writes, and what it says when it cannot.

#[path = "cli/as_match.rs"]
mod as_match;
#[path = "cli/bundle.rs"]
mod bundle;
#[path = "cli/calibrate.rs"]
mod calibrate;
#[path = "cli/features.rs"]
mod features;
#[path = "cli/focus.rs"]
mod focus;
#[path = "cli/odometry.rs"]
mod odometry;
#[path = "cli/output.rs"]
mod output;
#[path = "cli/rectify.rs"]
mod rectify;
#[path = "cli/refused.rs"]
mod refused;
#[path = "cli/replay.rs"]
mod replay;
#[path = "cli/results.rs"]
mod results;
#[path = "cli/support.rs"]
mod support;
#[path = "cli/two_view.rs"]
mod two_view;
