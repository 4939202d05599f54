//! Focus stacks of the folder in `STEREO_DATA`, of which shapes are known but no depths.
//!
//! `cargo xtask test` runs them when `STEREO_DATA` is set.

use std::path::PathBuf;
use stereopsis_host::focus::run::{FocusResult, run};
use stereopsis_host::focus::stack::Stack;

fn answer(name: &str) -> FocusResult {
    let data = std::env::var_os("STEREO_DATA").expect("set STEREO_DATA to the folder that holds focus/");
    let stack = Stack::open(&PathBuf::from(data).join("focus").join(name)).expect("a stack");
    let (width, height) = stack.size();
    run((width as u16, height as u16), (0..stack.len()).map(|i| stack.frame(i)), None, false).expect("a map")
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn a_coin_is_smooth_and_convex() {
    let found = answer("coin115_100");
    let index = found.index();
    let at = |x: usize, y: usize| index[y * found.width + x];
    // Along rows and columns through the dome, 40 px about its middle, second differences over 8 px.
    let mut convex = 0;
    let mut all = 0;
    let mut roughest = 0.0_f32;
    for line in 40..75 {
        for place in 25..90 {
            for far in [
                [(place - 8, line), (place, line), (place + 8, line)],
                [(line, place - 8), (line, place), (line, place + 8)],
            ] {
                let [a, b, c] = far.map(|(x, y)| at(x, y));
                all += 1;
                convex += usize::from(a + c <= 2.0 * b + 0.5);
            }
            roughest = roughest.max((at(place, line) - at(place - 1, line)).abs());
        }
    }
    let share = convex as f64 / all as f64;
    let unanswered = index.iter().filter(|i| !i.is_finite()).count();
    println!(
        "{share:.3} convex, neighbours at most {roughest} frames apart, {unanswered} of {} unanswered",
        index.len()
    );
    assert!(index.iter().all(|i| i.is_finite()));
    assert!(share >= 0.9 && roughest <= 6.0, "{share} {roughest}");
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn a_radial_scene_is_symmetric() {
    let found = answer("radial256_30");
    let index = found.index();
    let middle = (found.width - 1) as f32 / 2.0;
    // Within the largest circle, and out to the corners, where the blur hardly changes from frame to frame.
    for (radii, half, one, answered) in [(120, 0.95, 0.98, 0.95), (180, 0.92, 0.97, 0.85)] {
        let mut rings = vec![Vec::new(); radii];
        let mut all = 0.0;
        for (i, &frame) in index.iter().enumerate() {
            let (x, y) = ((i % found.width) as f32 - middle, (i / found.width) as f32 - middle);
            if let Some(ring) = rings.get_mut(x.hypot(y) as usize) {
                all += 1.0;
                ring.extend(frame.is_finite().then_some(frame));
            }
        }
        let mut off = Vec::new();
        for ring in rings[2..].iter_mut().filter(|ring| !ring.is_empty()) {
            ring.sort_by(f32::total_cmp);
            let median = ring[ring.len() / 2];
            off.extend(ring.iter().map(|frame| (frame - median).abs()));
        }
        let within = |most: f32| off.iter().filter(|&&e| e <= most).count() as f64 / off.len() as f64;
        let share = off.len() as f64 / all;
        println!(
            "to {radii} px: {share:.3} answered, of these {:.3} and {:.3} within 0.5 and 1 frame",
            within(0.5),
            within(1.0)
        );
        assert!(within(0.5) >= half && within(1.0) >= one && share > answered, "{radii} {share}");
    }
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn a_webcam_that_breathes_is_answered() {
    let found = answer("webcam_320x240");
    let share = found.answers() as f64 / found.peaks.len() as f64;
    assert!(share > 0.8, "{share} answered");
    // The sponge in front is nearer, in focus later, than the paper behind it.
    let median = |left: usize, top: usize| {
        let mut all: Vec<_> =
            (0..900).map(|i| found.index()[(top + i / 30) * found.width + left + i % 30]).collect();
        all.sort_by(f32::total_cmp);
        all[450]
    };
    let (sponge, paper) = (median(260, 80), median(60, 120));
    println!("sponge {sponge}, paper {paper}, {share:.3} answered");
    assert!(sponge > paper + 2.0, "{sponge} {paper}");
}
