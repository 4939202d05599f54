//! What is said of places that say little themselves: a sky, a white wall, a glossy box, thin poles,
//! chessboards.

use stereopsis::matching::{Config, Filter};
use stereopsis::units::PixelFlags;
use stereopsis_host::map::DisparityMap;
use stereopsis_host::run::{MemoryPair, MethodName, run};
use stereopsis_host::scene::{HardScene, Part, Shares};

/// The shares of a part in a scene, at another noise and with other textures of the sensors than those of the
/// table in docs/performance.md.
fn shares(hard: &HardScene, method: MethodName, filter: Filter, parts: &[Part]) -> Vec<Shares> {
    let map = matched(hard, method, filter);
    let truth = hard.scene.truth();
    let of = |&part: &Part| Shares::of(hard, &truth, &map.disparity, part).expect("the scene shows the part");
    let shares: Vec<_> = parts.iter().map(of).collect();
    println!("{} {method} {}: {parts:?} {shares:?}", hard.name, filter.name());
    shares
}

/// What a method says of a scene.
fn matched(hard: &HardScene, method: MethodName, filter: Filter) -> DisparityMap {
    let (left, right) = hard.scene.render();
    let (width, height) = (hard.scene.width(), hard.scene.height());
    let mut camera = MemoryPair::new(width, left.to_vec(), right.to_vec()).expect("two pictures of one size");
    let search = Config { confidence: true, ..method.config(width, height, hard.scene.disparities()) };
    let config = method.with_filter(filter, search);
    run(method, &config, &mut camera, |_| ()).expect("a frame").map
}

#[test]
fn a_sky_is_no_surface() {
    for (filter, most_near) in [(Filter::Default, 0.33), (Filter::Strict, 0.13)] {
        for method in [MethodName::SgmLean, MethodName::Sgm, MethodName::SgmEdge] {
            let hard = HardScene::street(1.3, 7);
            let parts = [Part::Sky, Part::Textured, Part::Glossy];
            let [sky, textured, glossy] = shares(&hard, method, filter, &parts)[..] else { unreachable!() };
            assert!(sky.false_near <= most_near, "{method}, {}: {sky:?}", filter.name());
            assert!(textured.answered >= 0.97 && textured.false_near <= 0.01, "{method}: {textured:?}");
            assert!(glossy.false_near + glossy.false_far <= 0.1, "{method}: {glossy:?}");
        }
    }
}

#[test]
fn wrong_answers_of_a_sky_are_among_the_least_sure() {
    for filter in [Filter::Default, Filter::Strict] {
        for (noise_grey, seed) in [(0.7, 5), (1.3, 7)] {
            let hard = HardScene::street(noise_grey, seed);
            let (truth, map) = (hard.scene.truth(), matched(&hard, MethodName::Sgm, filter));
            let sure = |is_meant: &dyn Fn(usize, bool) -> bool| {
                let of = |i: usize| Some((map.disparity[i].to_f32()? - truth.disparity[i]).abs() <= 2.0);
                let meant =
                    (0..map.disparity.len()).filter(|&i| of(i).is_some_and(|right| is_meant(i, right)));
                let mut sure: Vec<_> = meant.map(|i| map.confidence[i]).collect();
                sure.sort_unstable();
                sure
            };
            let is_sky = |i: usize| hard.part(truth.objects[i]) == Part::Sky;
            let wrong_sky = sure(&|i, right| !right && is_sky(i));
            let right = sure(&|_, right| right);
            let (median, tenth) = (wrong_sky[wrong_sky.len() / 2], right[right.len() / 10]);
            println!("{}, noise {noise_grey}: {median} of wrong sky, {tenth} of right", filter.name());
            assert!(median < tenth, "{}, noise {noise_grey}: {median}, {tenth}", filter.name());
        }
    }
}

#[test]
fn a_white_wall_is_not_nearer_than_it_is() {
    for (filter, most_near) in [(Filter::Default, 0.1), (Filter::Strict, 0.045)] {
        for method in [MethodName::SgmLean, MethodName::Sgm, MethodName::SgmEdge] {
            let hard = HardScene::white_room(1.3, 7);
            let [wall, pole] = shares(&hard, method, filter, &[Part::Wall, Part::Pole])[..] else {
                unreachable!()
            };
            assert!(wall.false_near <= most_near, "{method}, {}: {wall:?}", filter.name());
            assert!(pole.answered - pole.false_far >= 0.5, "{method}: {pole:?}");
        }
    }
}

#[test]
fn a_pattern_that_repeats_is_ambiguous() {
    let hard = HardScene::boards(1.3, 7);
    let truth = hard.scene.truth();
    for (filter, most_wrong) in [(Filter::Default, 0.02), (Filter::Strict, 0.01)] {
        for method in [MethodName::SgmLean, MethodName::Sgm, MethodName::SgmEdge] {
            let parts = [Part::Board, Part::Textured];
            let [board, textured] = shares(&hard, method, filter, &parts)[..] else { unreachable!() };
            assert!(board.false_near + board.false_far <= most_wrong, "{method}: {board:?}");
            assert!(textured.answered >= 0.9, "{method}: {textured:?}");
            let map = matched(&hard, method, filter);
            let seen = (0..truth.disparity.len())
                .filter(|&i| !truth.occluded[i] && hard.part(truth.objects[i]) == Part::Board);
            let flagged: Vec<_> = seen.map(|i| map.flags[i].contains(PixelFlags::AMBIGUOUS)).collect();
            let share = flagged.iter().filter(|&&flagged| flagged).count() as f64 / flagged.len() as f64;
            println!("{method}, {}: {share:.3} ambiguous", filter.name());
            assert!(share >= 0.7, "{method}, {}: {share}", filter.name());
        }
    }
}
