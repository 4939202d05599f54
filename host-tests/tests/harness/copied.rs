//! What the live page copies as Rust, as a user puts it into a program: it compiles, and is the configuration
//! of the page's settings. The test of the page holds its text to [`configuration`].

// Between the braces stands the page's own text, which names what it makes before it returns it.
#[expect(clippy::let_and_return)]
#[rustfmt::skip]
fn configuration() -> stereopsis::matching::Config {
use stereopsis::imaging::Noise;
use stereopsis::matching::{Checks, Config, Filter, Penalties, Sgm};
use stereopsis::units::Disparity;

let config = Config::for_method::<Sgm>(640, 480, 96);
let config = Config {
    min_disparity: 3,
    confidence: true,
    min_confidence: 20,
    noise: Noise::Low,
    ..config
};
let config = config.with_filter::<Sgm>(Filter::Strict);
let config = Config {
    checks: Checks {
        left_right_px: None,
        uniqueness_percent: Some(7),
        texture_gradient: 9,
        surface_step: Disparity::from_raw(12),
        median: false,
        fill_step: Disparity::NONE,
        fattening_slope: Disparity::NONE,
        refuse_repeats: false,
        ..config.checks
    },
    penalties: Penalties {
        cost: 15,
        step: [9, 9],
        edges: [6, 31],
        ..config.penalties
    },
    ..config
};
config
}

use stereopsis::imaging::Noise;
use stereopsis::matching::{Config, Filter, Matcher, Sgm};
use stereopsis::units::Disparity;

#[test]
fn what_the_page_copies_is_its_settings() {
    let found = configuration();
    let mut due = Config { noise: Noise::Low, ..Config::for_method::<Sgm>(640, 480, 96) };
    due = due.with_filter::<Sgm>(Filter::Strict);
    (due.min_disparity, due.confidence, due.min_confidence) = (3, true, 20);
    let checks = &mut due.checks;
    (checks.left_right_px, checks.uniqueness_percent) = (None, Some(7));
    (checks.texture_gradient, checks.surface_step) = (9, Disparity::from_raw(12));
    (checks.fill_step, checks.fattening_slope) = (Disparity::NONE, Disparity::NONE);
    (checks.median, checks.refuse_repeats) = (false, false);
    (due.penalties.cost, due.penalties.step, due.penalties.edges) = (15, [9, 9], [6, 31]);
    assert_eq!(found, due);
    let mut matcher = Box::new(Matcher::<Sgm, 640, 96>::new());
    matcher.start(&found).expect("it is a configuration");
}
