//! What is said of places that say little themselves: a sky, a white wall, a glossy box, thin poles.

use stereopsis::matching::Filter;
use stereopsis_host::run::{MemoryPair, MethodName, run};
use stereopsis_host::scene::{HardScene, Part, Shares};

/// The shares of a part in a scene, at another noise and with other textures of the sensors than those of the
/// table in docs/performance.md.
fn shares(hard: &HardScene, method: MethodName, filter: Filter, parts: &[Part]) -> Vec<Shares> {
    let (left, right) = hard.scene.render();
    let (width, height) = (hard.scene.width(), hard.scene.height());
    let mut camera = MemoryPair::new(width, left.to_vec(), right.to_vec()).expect("two pictures of one size");
    let config = method.with_filter(filter, method.config(width, height, hard.scene.disparities()));
    let map = run(method, &config, &mut camera, |_| ()).expect("a frame").map;
    let truth = hard.scene.truth();
    let of = |&part: &Part| Shares::of(hard, &truth, &map.disparity, part).expect("the scene shows the part");
    let shares: Vec<_> = parts.iter().map(of).collect();
    println!("{} {method} {}: {parts:?} {shares:?}", hard.name, filter.name());
    shares
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
