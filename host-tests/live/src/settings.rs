//! The page's controls as numbers, and the configuration that they stand for.

use stereopsis::imaging::Noise;
use stereopsis::matching::{Checks, Config, Filter, Method, Penalties};
use stereopsis::units::Disparity;

/// The number of settings.
pub const COUNT: usize = 33;

/// Settings as the page has them, in the order of its list of controls: whole numbers; a switch is 0 or 1,
/// and [`OFF`] stands for what is not asked for.
///
/// Method, filter, noise, disparities, least disparity, least confidence, balance; then the fields of
/// [`Checks`]; then those of [`Penalties`].
pub type Settings = [i32; COUNT];

/// A check that is not made, or a step without bound.
pub const OFF: i32 = -1;

const METHOD: usize = 0;
const FILTER: usize = 1;
const NOISE: usize = 2;
const DISPARITIES: usize = 3;
const MIN_DISPARITY: usize = 4;
const MIN_CONFIDENCE: usize = 5;
const BALANCE: usize = 6;
const CHECKS: usize = 7;
const PENALTIES: usize = 24;

/// The method's place in the page's list: `fast`, `block`, `sgm-lean`, `sgm`, `sgm-edge`.
pub fn method(settings: &Settings) -> usize {
    number(settings, METHOD)
}

/// Whether the right picture is brought to the left one's exposure.
pub fn balances(settings: &Settings) -> bool {
    number::<u8>(settings, BALANCE) != 0
}

/// Notes a level of noise.
pub fn set_noise(settings: &mut Settings, noise: Noise) {
    let place = Noise::ALL.iter().position(|level| *level == noise);
    settings[NOISE] = place.unwrap_or(0) as i32;
}

/// Sets checks and penalties to those of the method, the filter and the noise that the settings name.
pub fn preset<S: Method>(settings: &mut Settings) {
    let filter = Filter::ALL.get(number::<usize>(settings, FILTER)).copied().unwrap_or(Filter::Default);
    let config = Config { noise: noise(settings), ..Config::for_method::<S>(1, 1, 16) };
    let Config { checks, penalties, .. } = config.with_filter::<S>(filter);
    let Penalties { gradient, cost, step, jump, edges } = penalties;
    let all = [
        checks.left_right_px.map_or(OFF, i32::from),
        checks.uniqueness_percent.map_or(OFF, i32::from),
        checks.refuse_flat.into(),
        checks.texture_gradient.into(),
        checks.texture_pixels.into(),
        checks.refuse_ceiling.into(),
        steps(checks.surface_step),
        checks.smoothing_radius.into(),
        checks.speckle_pixels.into(),
        checks.speckle_run.into(),
        checks.median.into(),
        checks.fill_pixels.into(),
        steps(checks.fill_step),
        steps(checks.fattening_slope),
        checks.open_run.into(),
        checks.open_margin.into(),
        checks.refuse_repeats.into(),
        gradient.into(),
        cost.into(),
        step[0].into(),
        step[1].into(),
        jump[0].into(),
        jump[1].into(),
        jump[2].into(),
        edges[0].into(),
        edges[1].into(),
    ];
    for (setting, value) in settings.iter_mut().skip(CHECKS).zip(all) {
        *setting = value;
    }
}

/// The configuration for pictures of a size.
pub fn config(settings: &Settings, width: u16, height: u16) -> Config {
    let check = |at: usize| number::<u8>(settings, CHECKS + at);
    let optional = |at: usize| u8::try_from(settings[CHECKS + at]).ok();
    let penalty = |at: usize| number::<u8>(settings, PENALTIES + at);
    Config {
        width,
        height,
        disparities: number(settings, DISPARITIES),
        min_disparity: number(settings, MIN_DISPARITY),
        confidence: true,
        min_confidence: number(settings, MIN_CONFIDENCE),
        noise: noise(settings),
        checks: Checks {
            left_right_px: optional(0),
            uniqueness_percent: optional(1),
            refuse_flat: check(2) != 0,
            texture_gradient: check(3),
            texture_pixels: check(4),
            refuse_ceiling: check(5) != 0,
            surface_step: disparity(settings[CHECKS + 6]),
            smoothing_radius: check(7),
            speckle_pixels: check(8),
            speckle_run: check(9),
            median: check(10) != 0,
            fill_pixels: check(11),
            fill_step: disparity(settings[CHECKS + 12]),
            fattening_slope: disparity(settings[CHECKS + 13]),
            open_run: check(14),
            open_margin: check(15),
            refuse_repeats: check(16) != 0,
        },
        penalties: Penalties {
            gradient: penalty(0),
            cost: penalty(1),
            step: [penalty(2), penalty(3)],
            jump: [penalty(4), penalty(5), penalty(6)],
            edges: [penalty(7), penalty(8)],
        },
    }
}

/// A setting as a number of a type; 0 where it is none of that type.
fn number<T: TryFrom<i32> + Default>(settings: &Settings, at: usize) -> T {
    T::try_from(settings[at]).unwrap_or_default()
}

fn noise(settings: &Settings) -> Noise {
    Noise::ALL.get(number::<usize>(settings, NOISE)).copied().unwrap_or(Noise::None)
}

/// A distance of disparities in steps of 1/32 px.
fn steps(distance: Disparity) -> i32 {
    if distance.is_none() { OFF } else { distance.raw().into() }
}

fn disparity(steps: i32) -> Disparity {
    u16::try_from(steps).map_or(Disparity::NONE, Disparity::from_raw)
}
