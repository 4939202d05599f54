//! The ground over frames, by averaging.

use super::{Line, Scene};

/// Averages what a frame measured into what was carried.
pub fn carry(scene: &Scene<'_>, carried: &mut (Option<Line>, u32), measured: Option<Line>) {
    let rows = scene.size()[1];
    let old = carried.0.map(|line| {
        let nod = line.pitch_sigma(scene, 64 * 256);
        let pitch_sigma = (line.pitch_sigma.pow(2) + nod.pow(2)).isqrt().min(65_535);
        Line { variance: line.variance + 64, pitch_sigma, ..line }
    });
    carried.1 = if measured.is_some() { 0 } else { carried.1 + 1 };
    carried.0 = match (old, measured) {
        (None, measured) => measured,
        (Some(old), None) => (carried.1 <= 8).then_some(old),
        (Some(old), Some(new)) => {
            let both = old.variance + new.variance;
            let agree = [rows / 2, rows - 1].iter().all(|&row| {
                [0, scene.size()[0] - 1].iter().all(|&column| {
                    let at = |line: &Line| line.at(scene.halves(row), scene.right(column));
                    (at(&new) - at(&old)).pow(2) <= 9 * both
                })
            });
            let gain = 256 * old.variance / both;
            let mix = |old: i128, new: i128| old + ((new - old) * gain).div_euclid(256);
            let variance = (old.variance * (256 - gain) / 256).max(1);
            let plane = [mix(old.level, new.level), mix(old.slope, new.slope), mix(old.lean, new.lean)];
            let pitch_sigma = mix(old.pitch_sigma, new.pitch_sigma);
            let mixed = Line::new(scene, plane, variance).map(|line| Line { pitch_sigma, ..line });
            if agree { mixed.or(Some(new)) } else { Some(new) }
        }
    };
}
