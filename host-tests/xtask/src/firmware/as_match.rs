//! Noisy cameras that are exposed unequally: the firmware's disparities are the file that `stereo match`
//! writes of the same pair, to the bit.

use super::arguments::One;
use super::one_frame;
use crate::pictures::Pictures;
use crate::steps::{Failure, Outcome, command, output_of};
use firmware_boards::M4;
use std::fs;
use std::path::Path;
use stereopsis_host::run::{MethodName, NoiseChoice};
use stereopsis_host::scene::Scene;

/// Disparities that are searched.
const DISPARITIES: u16 = 32;

/// One frame on one core, and by the program `stereo` at that path.
pub fn check(stereo: &Path) -> Outcome {
    let folder = tempfile::tempdir().map_err(|e| Failure::new(format!("a temporary folder: {e}")))?;
    let at = |name: &str| folder.path().join(name);
    let scene = Scene::boxes(160).with_noise(4.0, 7);
    pair(&scene).write(folder.path())?;

    let mut matching =
        command(stereo, &["match", "--method", "sgm", "--disparities", &DISPARITIES.to_string()]);
    for (option, name) in [("--left", "left.pgm"), ("--right", "right.pgm"), ("--out", "match")] {
        matching.arg(option).arg(at(name));
    }
    output_of(&mut matching)?;
    let pair = Some((at("left.pgm"), at("right.pgm")));
    let (method, noise, out) = (MethodName::Sgm, NoiseChoice::Auto, at("firmware"));
    one_frame::run(&One { board: M4, pair, disparities: DISPARITIES, method, noise, out })?;

    let read = |name: &str| fs::read(at(name)).map_err(|e| Failure::new(format!("{name}: {e}")));
    let summary: serde_json::Value = serde_json::from_slice(&read("match/summary.json")?)
        .map_err(|e| Failure::new(format!("match/summary.json: {e}")))?;
    if summary["noise"] != "high" || summary["balance"].is_null() {
        let (noise, balance) = (&summary["noise"], &summary["balance"]);
        return Err(Failure::new(format!(
            "`stereo match` takes the pair for one of noise {noise}, balance {balance}"
        )));
    }
    if read("match/disparity.pfm")? != read("firmware/disparity.pfm")? {
        return Err(Failure::new(
            "the firmware's disparities of a noisy, unequal pair are not those of `stereo match`",
        ));
    }
    println!("of a noisy, unequal pair the firmware and `stereo match` have one disparity.pfm");
    Ok(())
}

/// The scene with the right camera brighter.
fn pair(scene: &Scene) -> Pictures {
    let (left, right) = scene.render();
    Pictures::drawn(scene.width(), scene.height(), |u, v, is_right| match is_right {
        false => left.get_pixel(u, v).0[0],
        true => (f32::from(right.get_pixel(u, v).0[0]) * 1.2 + 15.0) as u8,
    })
}
