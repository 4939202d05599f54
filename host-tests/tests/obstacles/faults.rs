//! Faulty frames: lost lines, a covered lens, swapped cameras. All of them are blind.

use super::support::{Cameras, noisy};
use image::{GrayImage, Luma};
use stereopsis::matching::Block;
use stereopsis::obstacles::{BlindReason, Decision, DriveConfig, DriveRule};
use stereopsis_host::scene::{Random, RobotScene};

/// A fault of a frame.
#[derive(Clone, Copy, Debug)]
enum Fault {
    /// More than a tenth of the rows do not come, here and there or from one on.
    LostHereAndThere,
    LostFromOneOn,
    /// One camera, or both, see nothing but the noise of their sensors.
    Covered,
    /// The right picture comes as the left one.
    Swapped,
}

const FAULTS: [Fault; 4] = [Fault::LostHereAndThere, Fault::LostFromOneOn, Fault::Covered, Fault::Swapped];

/// A lens cap: all but black.
fn covered(random: &mut Random) -> GrayImage {
    let black = GrayImage::from_pixel(160, 120, Luma([random.below(8) as u8]));
    noisy(&black, 2.0 * random.unit(), 1.0, random.bits())
}

/// Tries so many faulty frames between sound ones, and counts those of each reason.
fn try_frames(count: usize) -> Vec<(BlindReason, usize)> {
    let scenes = [RobotScene::Corridor, RobotScene::Street, RobotScene::BoxAt(800)];
    let mut random = Random::new(77);
    let mut reasons: Vec<(BlindReason, usize)> = Vec::new();
    for scene in scenes {
        let scene_of = scene.scene(4);
        let (left, right) = scene_of.render();
        let (mut cameras, mut rule) =
            (Cameras::<Block>::new(&scene_of), DriveRule::new(DriveConfig::default()));
        for n in 0..count / scenes.len() {
            let noise = 3.0 * random.unit();
            let [l, r] = [&left, &right]
                .map(|picture| noisy(picture, noise, 0.7 + 0.6 * random.unit(), random.bits()));
            if n % 8 == 0 {
                let sound = cameras.frame(&l, &r).finder.as_mut_view();
                assert_eq!(sound.blind(), None, "{scene:?}, frame {n}");
            }
            let fault = *random.pick(&FAULTS);
            let lost: Vec<_> = match fault {
                Fault::LostHereAndThere => {
                    let mut rows: Vec<_> = (0..120).collect();
                    (0..120).for_each(|i| rows.swap(i, random.below(120)));
                    rows[..13 + random.below(107)].to_vec()
                }
                Fault::LostFromOneOn => (random.below(108)..120).collect(),
                _ => Vec::new(),
            };
            let (l, r) = match fault {
                Fault::Covered => match random.below(3) {
                    0 => (covered(&mut random), r),
                    1 => (l, covered(&mut random)),
                    _ => (covered(&mut random), covered(&mut random)),
                },
                Fault::Swapped => (r, l),
                _ => (l, r),
            };
            let view = cameras.frame_of(&l, &r, |y| !lost.contains(&y)).finder.as_mut_view();
            let decision = rule.decide(&view, 300).decision;
            let Decision::Blind(reason) = decision else {
                panic!("{scene:?}, frame {n}, {fault:?}: {decision:?}");
            };
            match reasons.iter_mut().find(|(known, _)| *known == reason) {
                Some((_, frames)) => *frames += 1,
                None => reasons.push((reason, 1)),
            }
        }
    }
    reasons
}

#[test]
fn faulty_frames_are_blind() {
    let reasons = try_frames(300);
    let of = |reason| reasons.iter().filter(|(known, _)| *known == reason).map(|(_, n)| n).sum::<usize>();
    assert_eq!(reasons.iter().map(|(_, n)| n).sum::<usize>(), 300);
    let seen = [BlindReason::RowsLost, BlindReason::Camera, BlindReason::Swapped].map(of);
    assert!(seen.iter().all(|&n| n >= 30), "{reasons:?}");
}

#[test]
#[ignore = "takes minutes"]
fn ten_thousand_faulty_frames_are_blind() {
    println!("{:?}", try_frames(10_002));
}
