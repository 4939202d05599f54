//! The program `stereo` as its users run it: what it writes, and what it says when it cannot.

mod any;
mod as_match;
#[cfg(unix)]
mod bounds;
mod bundle;
mod calibrate;
mod calibrations;
mod calibrate_pairs;
mod calibrate_patterns;
mod demo;
mod dump;
mod eval;
mod eval_scenes;
mod features;
mod focus;
#[cfg(unix)]
mod guarded;
mod many;
mod many_failed;
mod obstacles;
mod odometry;
mod odometry_gaps;
mod odometry_refused;
mod odometry_times;
mod output;
mod pair;
mod partners;
mod plan;
mod program;
mod rectify;
mod rectify_matches;
mod rectify_refused;
mod refused;
mod replay;
mod results;
mod support;
mod two_view;
mod two_view_refused;
mod view;
mod walk;
