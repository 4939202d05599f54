//! Grey levels of the right camera as those of the left one.

use image::GrayImage;
use stereopsis::imaging::Balance;

/// The balance of a pair of pictures.
pub fn balance([left, right]: [&GrayImage; 2]) -> Balance {
    let [left, right] = [left, right].map(levels);
    let inside = |level: f64| (8.0..=248.0).contains(&level);
    let both: Vec<_> =
        left.into_iter().zip(right).filter(|(left, right)| inside(*left) && inside(*right)).collect();
    if both.len() < 3 {
        return Balance::NONE;
    }
    let mean = |number: &dyn Fn(&(f64, f64)) -> f64| both.iter().map(number).sum::<f64>() / both.len() as f64;
    if mean(&|(left, right)| (left - right).abs()) < f64::from(Balance::LEAST) {
        return Balance::NONE;
    }
    let means = [mean(&|both| both.0), mean(&|both| both.1)];
    let spreads = [mean(&|both| (both.0 - means[0]).abs()), mean(&|both| (both.1 - means[1]).abs())];
    let has_contrast = spreads.iter().all(|spread| *spread >= 3.0);
    let gain =
        if has_contrast { (256.0 * spreads[0] / spreads[1]).round().clamp(128.0, 512.0) } else { 256.0 };
    Balance { gain_256ths: gain as u16, offset_256ths: (256.0 * means[0] - gain * means[1]).floor() as i32 }
}

/// The levels under which 1/16 to 15/16 of the pixels that are counted are: of every row one of eight
/// columns. In a bin of 16 levels pixels lie evenly; to a 16th of a level.
fn levels(picture: &GrayImage) -> Vec<f64> {
    let counted =
        picture.enumerate_pixels().filter(|(x, y, _)| x % 8 == y % 8).map(|(_, _, pixel)| pixel.0[0]);
    let counted: Vec<u8> = counted.collect();
    let under = |level: f64| {
        let bin = (level / 16.0).floor();
        let below = counted.iter().filter(|grey| f64::from(**grey) < 16.0 * bin).count() as f64;
        let within = counted.iter().filter(|grey| (f64::from(**grey) / 16.0).floor() == bin).count() as f64;
        below + within * (level / 16.0 - bin)
    };
    let all: Vec<(f64, f64)> =
        (0..=4096).map(|step| f64::from(step) / 16.0).map(|level| (level, under(level))).collect();
    let first = |share: f64| {
        all.iter().find(|(_, under)| *under >= share * counted.len() as f64).map(|(level, _)| *level)
    };
    (1..16).filter_map(|k| first(f64::from(k) / 16.0)).collect()
}
