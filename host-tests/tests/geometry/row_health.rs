//! A rig that was knocked: told by its rows, and corrected.

use crate::views::rotation;
use image::{GrayImage, Luma, imageops};
use nalgebra::{Matrix3, Point2, Vector3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::features::Orientation;
use stereopsis::geometry::{
    camera::{Camera, ImageSize, Pose, StereoRig},
    rectify::{Crop, Rectification, RowAlignment, RowHealth, RowMeter, RowMeterError},
    two_view::Correspondence,
};
use stereopsis_host::correspond::{Plan, correspond};
use stereopsis_host::pair::PairMatches;
use stereopsis_host::rectify::{rectify, with_rectified};
use stereopsis_host::rows::Rows;
use stereopsis_host::run::{MemoryPair, MethodName, run};
use stereopsis_host::scene::{Random, Scene};

const SIZE: ImageSize = ImageSize { width: 320, height: 240 };

fn camera() -> Camera<f64> {
    Camera::new(300.0, 300.0, 161.0, 118.0).expect("a camera")
}

/// Points of two rectified cameras of which the second was turned: `sigma` px off, and one of `wrong`
/// anywhere.
fn points(
    turned: [f64; 3],
    count: usize,
    sigma: f64,
    wrong: usize,
    random: &mut Random,
) -> Vec<Correspondence<f64>> {
    let rotation = rotation(turned);
    let point = |i: usize| {
        let first = Point2::new(random.unit() * 319.0, random.unit() * 239.0);
        let depth = 0.5 + 4.0 * random.unit();
        let there = camera().unproject(&first).expect("a sight") * depth - Vector3::new(0.06, 0.0, 0.0);
        let exact = camera().project(&(rotation * there).into()).expect("in front");
        let second = if i.is_multiple_of(wrong) {
            Point2::new(random.unit() * 319.0, first.y + 40.0 * random.unit() - 20.0)
        } else {
            exact + sigma * nalgebra::Vector2::new(random.gauss(), random.gauss())
        };
        Correspondence { first, second }
    };
    (0..count).map(point).collect()
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 48,
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Up to a degree about any axis, a quarter of the matches wrong, in both precisions: within five of its
    /// own deviations, which are small.
    #[test]
    fn a_turn_is_reported_with_its_uncertainty(
        turned in [-0.017..0.017_f64, -0.017..0.017, -0.017..0.017], seed in any::<u64>(),
    ) {
        let mut random = Random::new(seed);
        let (mut meter, mut single) = (RowMeter::new(), RowMeter::<f32>::new());
        for _ in 0..5 {
            let seen = points(turned, 80, 0.3, 4, &mut random);
            meter.add(&camera(), &seen).expect("enough");
            let seen: Vec<_> = seen
                .iter()
                .map(|s| Correspondence { first: s.first.cast::<f32>(), second: s.second.cast::<f32>() })
                .collect();
            single.add(&Camera::new(300.0, 300.0, 161.0, 118.0).expect("a camera"), &seen).expect("enough");
        }
        let found = meter.alignment().expect("five frames");
        let other = single.alignment().expect("five frames");
        for (axis, truth) in turned.into_iter().enumerate() {
            let (off, sigma) = ((found.rotation_rad[axis] - truth).abs(), found.sigma_rad[axis]);
            // A hundredth of the angle is what a small one leaves out.
            prop_assert!(off < 5.0 * sigma + 3e-4, "{axis}: {off} {sigma}");
            prop_assert!((f64::from(other.rotation_rad[axis]) - found.rotation_rad[axis])
                .abs() < 0.1 * sigma + 1e-5);
        }
        prop_assert!(found.sigma_rad[0] < 4e-4 && found.sigma_rad[2] < 8e-4, "{:?}", found.sigma_rad);
        prop_assert!(found.sigma_rad[1] > 2.0 * found.sigma_rad[0], "a turn about Y is seen least: {:?}",
            found.sigma_rad);
    }
}

#[test]
fn what_determines_nothing_is_refused() {
    let mut random = Random::new(1);
    let mut meter = RowMeter::new();
    assert_eq!(meter.alignment(), Err(RowMeterError::Empty));
    let seen = points([0.0; 3], 12, 0.1, 1000, &mut random);
    assert_eq!(meter.add(&camera(), &seen[..11]), Err(RowMeterError::TooFew { needed: 12 }));
    let mut broken = seen.clone();
    broken[3].second.y = f64::NAN;
    assert_eq!(meter.add(&camera(), &broken), Err(RowMeterError::NotFinite));
    let anywhere = seen.iter().map(|s| Correspondence { second: Point2::new(1.0, 239.0 - s.first.y), ..*s });
    let anywhere: Vec<_> = anywhere.filter(|s| (s.first.y - s.second.y).abs() > 60.0).collect();
    let many: Vec<_> = anywhere.iter().cycle().take(24).copied().collect();
    assert_eq!(meter.add(&camera(), &many), Err(RowMeterError::TooFew { needed: 12 }));
    // What was refused has left nothing.
    assert_eq!(meter.alignment(), Err(RowMeterError::Empty));
    meter.add(&camera(), &seen).expect("enough");
    let found = meter.alignment().expect("a frame");
    assert_eq!(found.health(&camera(), SIZE), RowHealth::Good);
    let told = |pitch_deg: f64| RowAlignment {
        rotation_rad: [pitch_deg.to_radians(), 0.0, 0.0],
        sigma_rad: [0.0; 3],
    };
    // 300 px by a tenth of a degree is half a pixel.
    assert_eq!(told(0.07).health(&camera(), SIZE), RowHealth::Worn);
    assert_eq!(told(0.1).health(&camera(), SIZE), RowHealth::Bad);
    assert_eq!(told(f64::NAN).health(&camera(), SIZE), RowHealth::Bad);
}

/// What a camera sees that was turned: what it should see at P it sees at `R P`.
fn knocked(picture: &GrayImage, camera: &Camera<f64>, rotation: &Matrix3<f64>) -> GrayImage {
    GrayImage::from_fn(picture.width(), picture.height(), |x, y| {
        let there = camera.unproject(&Point2::new(x.into(), y.into())).expect("a sight");
        let before = camera.project(&(rotation.transpose() * there).into()).expect("in front");
        image::imageops::interpolate_bilinear(picture, before.x as f32, before.y as f32).unwrap_or(Luma([0]))
    })
}

fn noisy(picture: &GrayImage, random: &mut Random) -> Vec<u8> {
    picture.iter().map(|&p| (f64::from(p) + 1.5 * random.gauss()).round().clamp(0.0, 255.0) as u8).collect()
}

#[test]
fn a_knock_is_reported_and_taken_back() {
    let scene = Scene::small(SIZE.width, SIZE.height);
    let (left, right) = scene.render();
    let rig = scene.rig();
    let (f, (cx, cy)) = (f64::from(rig.focal_px()), rig.principal_point());
    let camera = Camera::new(f, f, cx.into(), cy.into()).expect("a camera");
    let beside =
        Pose::new(Matrix3::identity(), Vector3::new(rig.baseline_m().into(), 0.0, 0.0)).expect("a pose");
    let rig = StereoRig::new([camera; 2], beside, [SIZE; 2]).expect("a rig");
    let calibrated = Rectification::new(&rig, Crop::Natural, SIZE).expect("rectified");
    let config = MethodName::Block.config(SIZE.width, SIZE.height, 64);
    let density = |rectification: &Rectification<f64>, right: &GrayImage| {
        let pair = MemoryPair::new(SIZE.width, left.to_vec(), right.to_vec()).expect("a pair");
        let map = with_rectified(rectification, pair, |source| {
            run(MethodName::Block, &config, source, |_| ()).expect("a map")
        });
        map.expect("a remap").map.density()
    };
    let whole = density(&calibrated, &right);
    let plan = Plan { corners: 400, levels: 1, orientation: Some(Orientation::Upright), ..Plan::default() };
    let mut random = Random::new(2);
    let signs = [[0.3, 0.0, 0.0], [-0.3, 0.0, 0.0], [0.0, 0.0, 0.3], [0.0, 0.0, -0.3]];
    for degrees in signs.into_iter().chain([[0.3, 0.1, 0.2]]) {
        let turned: [f64; 3] = degrees.map(f64::to_radians);
        let bad = knocked(&right, &camera, &rotation(turned));
        let mut meter = RowMeter::new();
        for _ in 0..10 {
            let pair = MemoryPair::new(SIZE.width, noisy(&left, &mut random), noisy(&bad, &mut random))
                .expect("a pair");
            let [left, right] = rectify(&calibrated, pair).expect("rectified").pictures;
            let found = correspond(&plan, &left, &right).expect("matches");
            let seen = found.points().map(|[x1, y1, x2, y2]| Correspondence {
                first: Point2::new(x1, y1).cast::<f64>(),
                second: Point2::new(x2, y2).cast(),
            });
            let seen: Vec<_> = seen.filter(|s| (s.first.y - s.second.y).abs() < 12.0).collect();
            meter.add(calibrated.camera(), &seen).expect("a frame's matches");
        }
        let found = meter.alignment().expect("ten frames");
        for axis in [0, 2] {
            let off = (found.rotation_rad[axis] - turned[axis]).to_degrees();
            assert!(
                off.abs() < 0.05,
                "{degrees:?}, axis {axis}: {off} {:?}",
                found.rotation_rad.map(f64::to_degrees)
            );
        }
        assert_eq!(found.health(calibrated.camera(), SIZE), RowHealth::Bad, "{degrees:?}");
        let (hurt, healed) = (density(&calibrated, &bad), density(&calibrated.corrected(&found), &bad));
        assert!(hurt < whole - 0.004, "{degrees:?}: {hurt} of {whole}");
        assert!(healed > whole - 0.02, "{degrees:?}: {healed} of {whole}, {hurt} before");
    }
}

/// What the program says of one pair.
#[test]
fn rows_of_a_pair_are_reported_with_their_uncertainty() {
    let scene = Scene::small(SIZE.width, SIZE.height);
    let (left, right) = scene.render();
    let rig = scene.rig();
    let (f, (cx, cy)) = (f64::from(rig.focal_px()), rig.principal_point());
    let camera = Camera::new(f, f, cx.into(), cy.into()).expect("a camera");
    let good = measured([&left, &right], None, Some(&camera)).expect("features");
    assert!(good.error_px < 0.15 && good.health == "good" && good.warning().is_none(), "{good:?}");
    for degrees in [[0.3, 0.0, 0.0], [-0.3, 0.0, 0.0], [0.0, 0.0, 0.5], [0.0, 0.0, -0.5]] {
        let bad = knocked(&right, &camera, &rotation(degrees.map(f64::to_radians)));
        let told = measured([&left, &bad], None, Some(&camera)).expect("features");
        let (pitch, sigma) = (told.pitch_deg.expect("calibrated"), told.pitch_sigma_deg.expect("calibrated"));
        assert!((pitch - degrees[0]).abs() < 0.05 + 4.0 * sigma, "{degrees:?}: {told:?}");
        assert!(
            (told.roll_deg - degrees[2]).abs() < 0.05 + 4.0 * told.roll_sigma_deg,
            "{degrees:?}: {told:?}"
        );
        assert!(told.sigma_px < 0.2 && told.health != "good", "{degrees:?}: {told:?}");
        assert!(told.warning().is_some_and(|line| line.contains("0.25 px")), "{degrees:?}: {told:?}");
        assert!((told.lower_px + f * degrees[0].to_radians()).abs() < 0.2, "{degrees:?}: {told:?}");
        // Without a focal length rows and the roll are told, and no pitch.
        let other = measured([&left, &bad], None, None).expect("features");
        assert!((other.error_px - told.error_px).abs() < 0.2 && other.pitch_deg.is_none(), "{other:?}");
        assert!((other.lower_px - told.lower_px).abs() < 0.2, "{other:?}");
        let side = if other.lower_px < 0.0 { "px higher" } else { "px lower" };
        let line = other.warning().expect("rows are off");
        assert!(line.contains(side) && !line.contains("stands -"), "{line}");
        // Where nothing is shown nothing is measured.
        let nothing = GrayImage::new(SIZE.width.into(), SIZE.height.into());
        assert_eq!(measured([&left, &bad], Some([&nothing, &nothing]), None), None);
    }
}

/// Moving the right image up by what is told puts its rows where the left one has them.
#[test]
fn a_picture_that_stands_lower_is_told_by_how_much() {
    let (left, right) = Scene::small(SIZE.width, SIZE.height).render();
    for lower in [1, 3, 6] {
        let size = (u32::from(SIZE.width), u32::from(SIZE.height) - lower);
        let part =
            |picture: &GrayImage, from| imageops::crop_imm(picture, 0, from, size.0, size.1).to_image();
        let told = measured([&part(&left, lower), &part(&right, 0)], None, None).expect("features");
        let off = told.lower_px - f64::from(lower);
        assert!(off.abs() < 0.05 + 0.03 * f64::from(lower), "{lower}: {told:?}");
    }
}

/// Rows by the features of two pictures.
fn measured(
    pictures: [&GrayImage; 2],
    valid: Option<[&GrayImage; 2]>,
    camera: Option<&Camera<f64>>,
) -> Option<Rows> {
    let matches = PairMatches::find(pictures, valid).expect("features");
    let (width, height) = pictures[0].dimensions();
    Rows::measure(&matches, ImageSize { width: width as u16, height: height as u16 }, camera)
}
