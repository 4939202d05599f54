//! A frame in bands, each in a thread of its own, is that of one thread.

use stereopsis::matching::{Block, Checks, Config};
use stereopsis::units::Disparity;
use stereopsis_host::map::DisparityMap;
use stereopsis_host::run::{MemoryPair, MethodName, RunOptions, run};
use stereopsis_host::scene::Scene;

/// The map of `threads` threads.
fn map(method: MethodName, config: &Config, pair: &MemoryPair, threads: u16) -> DisparityMap {
    let options = RunOptions { threads, ..method.into() };
    run(options, config, &mut pair.clone(), |_| ()).expect("a source that cannot fail").map
}

/// Not a number is no number's equal: the uncertainties are compared bit by bit.
fn assert_same(one: &DisparityMap, bands: &DisparityMap, what: &str) {
    assert_eq!((one.width, one.height), (bands.width, bands.height), "{what}");
    assert!(one.disparity == bands.disparity, "{what}: disparities");
    assert!(one.flags == bands.flags, "{what}: flags");
    assert!(one.confidence == bands.confidence, "{what}: confidences");
    assert!(
        one.sigma_px.iter().map(|s| s.to_bits()).eq(bands.sigma_px.iter().map(|s| s.to_bits())),
        "{what}: sigma"
    );
}

/// A path from above begins anew in each band, and so do the costs of the rows above.
#[test]
fn bands_differ_little_along_paths() {
    let (left, right) = Scene::small(200, 240).render();
    let pair = MemoryPair::new(200, left.into_raw(), right.into_raw()).expect("one size");
    for method in MethodName::ALL.into_iter().filter(|method| !method.is_exact_in_bands()) {
        let config = method.config(200, 240, 32);
        let (one, bands) = (map(method, &config, &pair, 1), map(method, &config, &pair, 4));
        let differ = |(a, b): (&Disparity, &Disparity)| match a.distance(*b) {
            Some(steps) => steps > Disparity::ONE,
            None => a.is_some() || b.is_some(),
        };
        let count = one.disparity.iter().zip(&bands.disparity).filter(|&pair| differ(pair)).count();
        let share = count as f64 / one.disparity.len() as f64;
        println!("{method}: {:.2} % of the pixels by over 1 px or in having an answer", 100.0 * share);
        assert!(share < 0.01, "{method}: {share}");
        // The first band is that of the whole frame, as far as nothing below it is looked at.
        assert_eq!(one.disparity[..200 * 40], bands.disparity[..200 * 40], "{method}");
    }
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
        for method in MethodName::ALL.into_iter().filter(|method| method.is_exact_in_bands()) {
            for checks in [Checks::DENSE, Checks::DEFAULT, Checks::STRICT, narrow, median, filled] {
                let config =
                    Config { checks, confidence: true, ..Config::for_method::<Block>(width, height, 32) };
                let one = map(method, &config, &pair, 1);
                for threads in [2, 3, 4, 7] {
                    let what = format!("{width}x{height}, {}, {threads} threads, {checks:?}", method.name());
                    assert_same(&one, &map(method, &config, &pair, threads), &what);
                }
            }
        }
    }
}
