//! What the core's confidence is worth on rendered scenes.
//!
//! The figures that the tests hold bounds to are printed: `cargo test --test matching confidence --
//! --nocapture`.

use image::GrayImage;
use stereopsis::matching::{Block, Checks, Config, Filter};
use stereopsis::units::PixelFlags;
use stereopsis_host::map::DisparityMap;
use stereopsis_host::report::Accuracy;
use stereopsis_host::run::{MemoryPair, MethodName, run};
use stereopsis_host::scene::Scene;
use stereopsis_host::sparsification::Sparsification;

fn map(method: MethodName, config: &Config, (left, right): &(GrayImage, GrayImage)) -> DisparityMap {
    let mut pair = MemoryPair::new(config.width, left.to_vec(), right.to_vec()).expect("one size");
    run(method, config, &mut pair, |_| ()).expect("a source that cannot fail").map
}

fn config(scene: &Scene) -> Config {
    Config {
        confidence: true,
        ..Config::for_method::<Block>(scene.width(), scene.height(), scene.disparities())
    }
}

#[test]
fn wrong_answers_are_the_least_sure() {
    let scene = Scene::demo();
    let (pair, truth) = (scene.render(), scene.truth());
    for method in MethodName::ALL {
        for filter in [Filter::Dense, Filter::Default] {
            let map = map(method, &method.with_filter(filter, config(&scene)), &pair);
            let judged = Accuracy::judged(&map, &truth);
            let worth = Sparsification::of(&judged).expect("there are answers");
            let from_oracle = worth.from_oracle();
            println!("{method}, {}: {from_oracle:.3} from the oracle, {worth:?}", filter.name());
            assert!(worth.random > 0.0, "there are wrong answers to be told");
            assert!(from_oracle <= 0.02, "{method}, {}: {from_oracle}", filter.name());
        }
    }
}

#[test]
fn what_is_filled_is_the_least_sure_and_what_has_no_answer_has_none() {
    let scene = Scene::small(200, 150);
    let checks = Checks { fill_pixels: 16, median: true, ..Checks::STRICT };
    let map = map(MethodName::Block, &Config { checks, ..config(&scene) }, &scene.render());
    let mut filled = 0;
    for (i, (&confidence, flags)) in map.confidence.iter().zip(&map.flags).enumerate() {
        assert_eq!(confidence > 0, map.disparity[i].is_some());
        if flags.contains(PixelFlags::FILLED) {
            assert_eq!(confidence, 1);
            filled += 1;
        }
    }
    assert!(filled > 20, "{filled} filled");
}

#[test]
fn nothing_else_changes_with_it() {
    let scene = Scene::small(120, 60);
    let pair = scene.render();
    for method in MethodName::ALL {
        for filter in Filter::ALL {
            let with = method.with_filter(filter, config(&scene));
            let (with, without) =
                (map(method, &with, &pair), map(method, &Config { confidence: false, ..with }, &pair));
            assert!(without.confidence.iter().all(|&c| c == 0));
            assert!(with.confidence.iter().any(|&c| c > 0));
            assert_eq!(
                (with.disparity, with.flags),
                (without.disparity, without.flags),
                "{method}, {}",
                filter.name()
            );
        }
    }
}

#[test]
fn the_least_sure_answers_are_refused_and_nothing_else_changes() {
    let scene = Scene::demo();
    let (pair, truth) = (scene.render(), scene.truth());
    for method in [MethodName::Block, MethodName::Sgm] {
        let all = method.with_filter(Filter::Default, config(&scene));
        let sure = map(method, &Config { confidence: false, min_confidence: 60, ..all }, &pair);
        let all = map(method, &all, &pair);
        for (i, &confidence) in all.confidence.iter().enumerate() {
            let refused = (1..60).contains(&confidence);
            let kept = (all.disparity[i], all.flags[i], confidence);
            let flags = all.flags[i].without(PixelFlags::FILLED).union(PixelFlags::AMBIGUOUS);
            let expected = if refused { (Default::default(), flags, 0) } else { kept };
            assert_eq!((sure.disparity[i], sure.flags[i], sure.confidence[i]), expected, "{method}, {i}");
        }
        let wrong = [&all, &sure].map(|map| {
            let judged = Accuracy::judged(map, &truth);
            judged.iter().filter(|answer| answer.loss > 0.0).count()
        });
        println!("{method}: {wrong:?} wrong");
        assert!(2 * wrong[1] < wrong[0], "{method}: {wrong:?}");
    }
}
