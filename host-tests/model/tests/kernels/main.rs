//! The pipeline against its naive twin: every disparity, flag, deviation and confidence, to the bit, for
//! every kernel.
//!
//! * `list`: all sizes, ranges, pictures and checks; `pictures`: every kind of picture. `repeats`: patterns
//!   that repeat. `any`: any combination of them. `penalties`: those at the bounds.
//! * `far`: the largest disparities. `frames`: one frame after the other, faults and changes in between.
//!   `moved`: a matcher that changes its place. `external`: rows of winners from outside.
//! * `remap`: rectified lines.

mod any;
mod external;
mod far;
mod frames;
mod list;
mod moved;
mod penalties;
mod pictures;
mod remap;
mod repeats;

use stereopsis::imaging::Noise;
use stereopsis::matching::{Block, Config, Method};
use stereopsis::pipeline::Pipeline;
use stereopsis_model::held::{Twin, compare, compare_with, difference, rows};
use stereopsis_model::scene::pattern::Pattern;
use stereopsis_model::twin::cost::{costs, window_sums, window_sums_plain};
use stereopsis_model::twin::smooth::Seen;
use stereopsis_model::twin::{self, Picture};

/// The capacity of the pipelines here.
const W: usize = 704;
const D: usize = 256;
/// Another number of disparities, no multiple of 32: candidates come in half-words.
const HALVES: usize = 240;
type Any<S> = Pipeline<S, W, D>;

/// Whether an emulator runs the tests, which takes ten times as long: `cargo xtask test` says so.
fn emulated() -> bool {
    std::env::var_os("STEREOPSIS_EMULATED").is_some()
}

/// All of a long list; in an emulator every `nth` of it.
fn long<T>(list: impl IntoIterator<Item = T>, nth: usize) -> impl Iterator<Item = T> {
    list.into_iter().step_by(if emulated() { nth } else { 1 })
}

/// A pipeline of the largest capacity.
// Inlined, each call would have a place for it on its caller's stack, beside the box.
#[inline(never)]
fn pipeline<S: Method>() -> Box<Any<S>> {
    Box::new(Pipeline::new())
}

#[test]
fn the_twins_window_sums_are_the_plain_ones() {
    let (left, right) = Pattern::Noise.pair(23, 17, 3);
    for scheme in [twin::Method::FAST, twin::Method::BLOCK] {
        let twin::Cost::Window { neighbours, unit } = scheme.cost else { panic!("a window") };
        for (config, left, right) in [
            (Config::for_method::<Block>(23, 17, 20), &left, &right),
            (
                Config::for_method::<Block>(3, 2, 16),
                &Pattern::Noise.pair(3, 2, 4).0,
                &Pattern::Noise.pair(3, 2, 5).1,
            ),
        ] {
            let seen = [left, right].map(|picture| Seen::new(Picture::new(picture), Noise::None));
            let costs = costs(neighbours, &config, &seen[0], &seen[1]);
            assert_eq!(window_sums(&scheme, unit, &costs), window_sums_plain(&scheme, unit, &costs));
        }
    }
}
