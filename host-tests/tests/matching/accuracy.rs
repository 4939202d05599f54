//! The core's answers against the scenes' true values.
//!
//! The figures that the tests hold bounds to are printed: `cargo test --test matching accuracy --
//! --nocapture`.

use image::GrayImage;
use std::sync::OnceLock;
use stereopsis::depth::DepthScale;
use stereopsis::matching::{Block, Checks, Config, Fast, Method, Sgm, SgmEdge, SgmLean};
use stereopsis::pipeline::Pipeline;
use stereopsis::units::PixelFlags;
use stereopsis_host::scene::{Scene, SceneCamera, Truth};

type Pair = (GrayImage, GrayImage);

fn rms(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count() as f64;
    (values.map(|v| v * v).sum::<f64>() / count).sqrt()
}

/// A share in percent.
fn percent(part: usize, whole: usize) -> f64 {
    100.0 * part as f64 / whole as f64
}

/// The true and the found disparities of a scene, and how sure the core is of them.
struct Found {
    truth: Truth,
    disparity: Vec<Option<f32>>,
    sigma_px: Vec<Option<f32>>,
    flags: Vec<PixelFlags>,
    /// |Z - Z_true| / sigma_Z of the answers for points that both cameras see.
    depth_errors_in_sigma: Vec<f32>,
}

/// The demo and what its cameras see, rendered once.
fn demo_pair() -> &'static (Scene, Pair) {
    static PAIR: OnceLock<(Scene, Pair)> = OnceLock::new();
    PAIR.get_or_init(|| {
        let scene = Scene::demo();
        let pair = scene.render();
        (scene, pair)
    })
}

fn find<S: Method>(scene: &Scene, pair: &Pair, checks: Checks) -> Found {
    let search = Config::for_method::<Block>(scene.width(), scene.height(), scene.disparities());
    let config = Config { checks, penalties: S::PENALTIES, ..search };
    let mut pipeline = Box::new(Pipeline::<S, 640, 64>::new());
    pipeline.start(&config).expect("the scene fits");
    let mut camera = SceneCamera::new(pair.0.clone(), pair.1.clone());
    pipeline.begin_frame(&mut camera).expect("the camera works");
    let depth = DepthScale::new(&scene.rig()).expect("the rig has depths");
    let mut found = Found {
        truth: scene.truth(),
        disparity: Vec::new(),
        sigma_px: Vec::new(),
        flags: Vec::new(),
        depth_errors_in_sigma: Vec::new(),
    };
    while let Some(row) = pipeline.next_row(&mut camera).expect("the camera works") {
        for (x, d) in row.disparities().iter().enumerate() {
            let i = found.disparity.len();
            let sigma_px = row.sigma_px(x);
            if let (Some(z), Some(sigma_px), false) = (depth.metres(*d), sigma_px, found.truth.occluded[i]) {
                let sigma = depth.sigma(*d, sigma_px).expect("a depth has a deviation");
                found.depth_errors_in_sigma.push((z.0 - found.truth.depth_m[i]).abs() / sigma.0);
            }
            found.disparity.push(d.to_f32());
            found.sigma_px.push(sigma_px);
        }
        found.flags.extend_from_slice(row.flags());
    }
    assert_eq!(found.disparity.len(), found.truth.disparity.len());
    found
}

impl Found {
    /// True disparity and answer of the points that both cameras see.
    fn visible(&self) -> impl Iterator<Item = (f32, Option<f32>)> + '_ {
        let all = self.truth.disparity.iter().zip(&self.disparity).zip(&self.truth.occluded);
        all.filter(|(_, occluded)| !**occluded).map(|((t, d), _)| (*t, *d))
    }

    /// Error and true disparity of the answers for them, px.
    fn errors(&self) -> impl Iterator<Item = (f64, f64)> + Clone + '_ {
        let all = self.truth.disparity.iter().zip(&self.disparity).zip(&self.truth.occluded);
        all.filter(|(_, occluded)| !**occluded)
            .filter_map(|((t, d), _)| d.map(|d| (f64::from(d - t), f64::from(*t))))
    }
}

/// Mean error in each sixteenth of a pixel of the true disparity: pixel locking pulls answers towards whole
/// pixels, so the mean is positive in one half of the bins and negative in the other.
fn mean_error_by_fraction(found: &Found) -> [f64; 16] {
    let mut sums = [(0.0, 0); 16];
    for (error, truth) in found.errors() {
        let bin = &mut sums[(truth.rem_euclid(1.0) * 16.0) as usize % 16];
        bin.0 += error;
        bin.1 += 1;
    }
    sums.map(|(sum, count)| {
        assert!(count > 500, "every fraction occurs");
        sum / f64::from(count)
    })
}

/// Answers whose fraction lies in each sixteenth of a pixel, over what an even spread would have.
fn share_by_fraction(found: &Found) -> [f64; 16] {
    let mut shares = [0.0; 16];
    let answers: Vec<f64> = found.disparity.iter().flatten().map(|&d| f64::from(d)).collect();
    for d in &answers {
        // Bins are centred on their steps of 1/16 px, so that whole pixels lie in the middle of bin 0.
        shares[((d * 16.0).round() as usize) % 16] += 16.0 / answers.len() as f64;
    }
    shares
}

/// Most RMS and most mean error in a bin of fractions, px; the share that the fullest bin may have.
fn sub_pixel<S: Method>(rms_bound: f64, locking_bound: f64, share_bound: f64) {
    let scene = Scene::slanted_plane();
    let found = find::<S>(&scene, &scene.render(), S::DEFAULT);
    let error = rms(found.errors().map(|(e, _)| e));
    let mean = found.errors().map(|(e, _)| e).sum::<f64>() / found.errors().count() as f64;
    let by_fraction = mean_error_by_fraction(&found);
    let locking = by_fraction.iter().fold(0.0, |most: f64, e| most.max((e - mean).abs()));
    let shares = share_by_fraction(&found);
    let (least, fullest) =
        shares.iter().fold((f64::MAX, 0.0), |(l, f): (f64, f64), s| (l.min(*s), f.max(*s)));
    let answered = percent(found.visible().filter(|(_, d)| d.is_some()).count(), found.visible().count());
    println!(
        "slanted plane, {}: RMS {error:.4} px, mean {mean:+.4} px, {answered:.2} % answered; pixel locking: \
         mean error by fraction up to {locking:.4} px, answers by fraction {least:.2} to {fullest:.2} of an \
         even share",
        S::NAME
    );
    println!("  mean error by sixteenths, 1/1000 px: {:?}", by_fraction.map(|e| (e * 1000.0).round() as i32));
    println!("  share by sixteenths, percent: {:?}", shares.map(|s| (s * 100.0).round() as i32));
    assert!(answered > 99.0);
    assert!(error <= rms_bound, "RMS {error}");
    assert!(mean.abs() <= 0.015, "mean {mean}");
    assert!(locking <= locking_bound, "locking {locking}");
    assert!(fullest <= share_bound && least >= 2.0 - share_bound, "shares {shares:?}");
}

#[test]
fn fast_is_accurate_to_a_fraction_of_a_pixel() {
    sub_pixel::<Fast>(0.08, 0.015, 1.15);
}

#[test]
fn block_is_accurate_to_a_fraction_of_a_pixel() {
    sub_pixel::<Block>(0.06, 0.01, 1.1);
}

#[test]
fn sgm_is_accurate_to_a_fraction_of_a_pixel() {
    sub_pixel::<SgmLean>(0.05, 0.01, 1.1);
    sub_pixel::<Sgm>(0.05, 0.01, 1.1);
    sub_pixel::<SgmEdge>(0.05, 0.01, 1.1);
}

/// Bounds in percent: answers within three sigma in depth, answers over 2 px off, visible points without a
/// right answer.
fn demo<S: Method>(within_bound: f64, bad2_bound: f64, missed_bound: f64) {
    let (scene, pair) = demo_pair();
    let found = find::<S>(scene, pair, S::DEFAULT);
    let within = |sigmas: f32| {
        percent(
            found.depth_errors_in_sigma.iter().filter(|e| **e <= sigmas).count(),
            found.depth_errors_in_sigma.len(),
        )
    };
    let answers = found.errors().count();
    let bad2 = percent(found.errors().filter(|(e, _)| e.abs() > 2.0).count(), answers);
    let missed_pixels = found.visible().filter(|(t, d)| d.is_none_or(|d| (d - t).abs() > 2.0)).count();
    let missed = percent(missed_pixels, found.visible().count());
    println!(
        "demo, {}: {:.2} % of the answers within 1 sigma in depth, {:.2} % within 2, {:.2} % within 3; \
         {bad2:.2} % over 2 px off, {missed:.2} % of the visible points missed",
        S::NAME,
        within(1.0),
        within(2.0),
        within(3.0)
    );
    assert!(within(3.0) >= within_bound);
    assert!(bad2 <= bad2_bound);
    assert!(missed <= missed_bound);
    // Sigma is no blank cheque: half of the answers have hardly more than the method's own.
    let mut sigmas: Vec<f32> = found.sigma_px.iter().flatten().copied().collect();
    sigmas.sort_by(f32::total_cmp);
    let (median, ninth) = (sigmas[sigmas.len() / 2], sigmas[sigmas.len() * 9 / 10]);
    println!("  sigma: median {median:.3} px, 90th percentile {ninth:.3} px");
    assert!(median <= 1.5 * S::SIGMA_PX && ninth <= 3.0 * S::SIGMA_PX);
    // What the right camera does not see is mostly refused.
    let hidden = found.truth.occluded.iter().zip(&found.disparity).filter(|(occluded, _)| **occluded);
    let claimed = hidden.clone().filter(|(_, d)| d.is_some()).count();
    println!("  {:.1} % of the hidden points have an answer", percent(claimed, hidden.clone().count()));
    assert!(percent(claimed, hidden.count()) < 25.0);
}

#[test]
fn fast_is_within_three_sigma_of_the_true_depth() {
    demo::<Fast>(99.0, 0.7, 6.0);
}

#[test]
fn block_is_within_three_sigma_of_the_true_depth() {
    demo::<Block>(99.0, 0.8, 6.0);
}

#[test]
fn sgm_is_within_three_sigma_of_the_true_depth() {
    demo::<SgmLean>(99.0, 0.7, 6.0);
    demo::<Sgm>(99.0, 0.7, 6.0);
    demo::<SgmEdge>(99.0, 0.7, 6.0);
}

#[test]
fn the_blank_board_is_refused_and_the_wall_beside_it_is_not() {
    let (scene, pair) = demo_pair();
    let part = |found: &Found, columns: core::ops::Range<usize>, what: fn(&Found, usize) -> bool| {
        let pixels: Vec<usize> = (35..80).flat_map(|y| columns.clone().map(move |x| y * 640 + x)).collect();
        percent(pixels.iter().filter(|&&i| what(found, i)).count(), pixels.len())
    };
    let (board, wall) = (170..230, 60..120);
    let refused = |found: &Found, i: usize| found.disparity[i].is_none();
    let untextured = |found: &Found, i: usize| found.flags[i].contains(PixelFlags::UNTEXTURED);

    let found = find::<Block>(scene, pair, Checks::DEFAULT);
    let (on_board, on_wall) = (part(&found, board.clone(), refused), part(&found, wall.clone(), refused));
    println!("default checks refuse {on_board:.1} % of the board and {on_wall:.1} % of the wall");
    assert!(on_board > 85.0 && on_wall < 2.0);

    // Gradients above the sensors' noise tell the two apart by themselves.
    let checks = Checks { texture_gradient: 6, texture_pixels: 12, ..Checks::DENSE };
    let found = find::<Block>(scene, pair, checks);
    let (on_board, on_wall) = (part(&found, board, untextured), part(&found, wall, untextured));
    println!(
        "a gradient of 6 in 12 pixels refuses {on_board:.1} % of the board and {on_wall:.1} % of the wall"
    );
    assert!(on_board > 99.0 && on_wall < 1.0);
}
