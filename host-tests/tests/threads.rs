//! A frame in bands, each in a thread of its own, is that of one thread.

use stereopsis::matching::{Checks, Config};
use stereopsis::units::Disparity;
use stereopsis_host::map::DisparityMap;
use stereopsis_host::run::{MemoryPair, Method, Way, run};
use stereopsis_host::scene::Scene;

/// The map of `threads` threads.
fn map(method: Method, config: &Config, pair: &MemoryPair, threads: u16) -> DisparityMap {
    let way = Way { threads, ..method.into() };
    run(way, config, &mut pair.clone(), |_| ()).expect("a source that cannot fail").map
}

/// Not a number is no number's equal: the uncertainties are compared bit by bit.
fn assert_same(one: &DisparityMap, bands: &DisparityMap, what: &str) {
    assert_eq!((one.width, one.height), (bands.width, bands.height), "{what}");
    assert!(one.disparity == bands.disparity, "{what}: disparities");
    assert!(one.flags == bands.flags, "{what}: flags");
    assert!(one.sigma_px.iter().map(|s| s.to_bits()).eq(bands.sigma_px.iter().map(|s| s.to_bits())), "{what}: sigma");
}

#[test]
fn bands_give_the_same_rows() {
    // The filter that counts farthest, on surfaces of one answer a row.
    let narrow = Checks { speckle_pixels: u8::MAX, surface_step: Disparity::ZERO, ..Checks::DEFAULT };
    // What looks at other rows and pixels, with and without what looks farther.
    let median = Checks { median: true, ..Checks::DENSE };
    let filled = Checks { median: true, fill_pixels: 16, ..Checks::STRICT };
    for (width, height) in [(160, 240), (96, 61), (64, 3), (48, 1)] {
        let (left, right) = Scene::small(width, height).render();
        let pair = MemoryPair::new(width, left.into_raw(), right.into_raw()).expect("one size");
        for method in Method::ALL {
            for checks in [Checks::DENSE, Checks::DEFAULT, Checks::STRICT, narrow, median, filled] {
                let config = Config { checks, ..Config::new(width, height, 32) };
                let one = map(method, &config, &pair, 1);
                for threads in [2, 3, 4, 7] {
                    let what = format!("{width}x{height}, {}, {threads} threads, {checks:?}", method.name());
                    assert_same(&one, &map(method, &config, &pair, threads), &what);
                }
            }
        }
    }
}
