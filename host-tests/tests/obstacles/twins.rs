//! The core beside its naive twin, to the bit: cells, ground over frames, stixels, sectors and their scan, of
//! frames that come whole or in parts.

use super::given::{compare_pose, in_whole_numbers, pose};
use super::support::{Map, floor};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::obstacles::{
    GroundSource, ObstacleConfig, ObstaclesView, Sector as CoreSector, SectorState, StixelKind,
};
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::scene::Random;
use stereopsis_host::twin::obstacles::{Found, Kind, Scene, Sector, find, sectors};

/// A floor with walls, holes, drops, specks and noise.
pub fn map(random: &mut Random, rig: RectifiedRig, size: [u16; 2]) -> Map {
    let height_m = 0.15 + random.unit();
    let pitch = 0.4 * random.unit() - 0.05;
    let rolled = *random.pick(&[0.0, 0.0, 0.03, -0.08]);
    let (f, b) = (f64::from(rig.focal_px()), f64::from(rig.baseline_m()));
    let [noise_px, holes, specks] =
        [*random.pick(&[0.0, 0.1, 0.5]), 0.5 * random.unit(), *random.pick(&[0.0, 0.01, 0.1])];
    let body = |random: &mut Random| {
        let side = |random: &mut Random, most: u16| {
            let ends = [(); 2].map(|()| f64::from(most) * random.unit());
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        };
        (side(random, size[0]), side(random, size[1]), f * b / (0.4 + 5.0 * random.unit()))
    };
    let bodies: Vec<_> = (0..random.below(6)).map(|_| body(random)).collect();
    let drop_from = f64::from(size[0]) * 2.0 * random.unit();
    let mut noise = random.clone();
    random.bits();
    let mut map = Map::of(rig, size, |u, v| {
        let lower = if u > drop_from { 1.5 } else { 1.0 };
        let standing =
            bodies.iter().filter(|(x, y, _)| (x[0]..x[1]).contains(&u) && (y[0]..y[1]).contains(&v));
        let nearest = standing.map(|(.., parallax)| *parallax).fold(0.0, f64::max);
        let beside = rolled * b / height_m * (u - f64::from(rig.principal_point().0));
        let seen = floor(&rig, height_m * lower, pitch, v).unwrap_or(0.0) + beside;
        Some(seen.max(nearest))
    });
    let width = usize::from(size[0]);
    let damaged: Vec<_> = (0..size[1]).map(|_| noise.unit() < 0.03).collect();
    for (i, (d, flags)) in map.disparities.iter_mut().zip(&mut map.flags).enumerate() {
        let moved = f64::from(d.raw()) + 32.0 * noise_px * noise.gauss();
        *d = Disparity::from_raw(moved.round().clamp(0.0, 2000.0) as u16);
        if noise.unit() < specks {
            *d = Disparity::from_raw(noise.below(2000) as u16);
        }
        if noise.unit() < holes {
            *d = Disparity::NONE;
        }
        *flags = PixelFlags::from_bits(if noise.unit() < 0.05 { noise.byte() } else { 0 });
        if !damaged[i / width] {
            *flags = flags.without(PixelFlags::DAMAGED);
        }
    }
    map
}

/// Which rows of a frame come: all of them, or but for some here and there, more than are allowed among them.
pub fn rows_that_come(random: &mut Random, height: u16) -> Vec<bool> {
    let lost = *random.pick(&[0.0, 0.0, 0.03, 0.1]);
    (0..height).map(|_| random.unit() >= lost).collect()
}

/// A map as the twin sees it, of which some rows come.
pub fn scene<'a>(map: &'a Map, config: ObstacleConfig, came: &'a [bool]) -> Scene<'a> {
    let rig = &map.rig;
    let whole = |x: f32| x.round() as i128;
    Scene {
        config,
        focal_16ths: whole(16.0 * rig.focal_px()),
        cx_16ths: whole(16.0 * rig.principal_point().0),
        cy_halves: whole(2.0 * rig.principal_point().1),
        baseline_16ths: whole(16_000.0 * rig.baseline_m()),
        millimetre_steps: whole(rig.focal_px() * rig.baseline_m() * 1000.0 * 32.0),
        offset: whole(32.0 * rig.disparity_offset_px()),
        width: map.size[0].into(),
        height: map.size[1].into(),
        largest: map.largest.raw(),
        disparities: &map.disparities,
        flags: &map.flags,
        confidences: &map.confidences,
        came,
        cameras: None,
        given: None,
    }
}

/// Whether a bearing is within a thousandth of a half: the twin rounds them by other arithmetic.
pub fn has_tie(scene: &Scene<'_>) -> bool {
    let is_tie = |bearing: f64| (bearing.rem_euclid(1.0) - 0.5).abs() < 1e-3;
    let [columns, _] = scene.size();
    let last = columns * usize::from(scene.config.cell_width) - 1;
    let ends = [0.0, last as f64].map(|pixel| scene.bearing(pixel));
    let all = (0..columns).map(|x| scene.column_bearing(x));
    ends.into_iter().chain(all).any(is_tie)
}

/// A sector of the core in the words of the twin.
pub fn in_words(core: CoreSector) -> Sector {
    Sector {
        state: core.state,
        bearing_mrad: core.bearing_mrad.into(),
        depth_mm: core.depth_mm.into(),
        sigma_mm: core.sigma_mm.into(),
        range_mm: core.range_mm.into(),
        pixels: core.pixels.into(),
        height_mm: core.height_mm.into(),
        seen_mm: core.seen_mm.into(),
    }
}

/// Compares the sectors and the ranges of a scan, but of a rig with a tie.
fn compare_sectors(scene: &Scene<'_>, view: &ObstaclesView<'_>, found: &Found) -> Result<(), TestCaseError> {
    if has_tie(scene) {
        return Ok(());
    }
    let expected = sectors(scene, found);
    prop_assert_eq!(view.sectors(), expected.len());
    let mut ranges = [0.0; ObstacleConfig::MOST_SECTORS];
    prop_assert_eq!(view.laser_scan(&mut ranges).count, expected.len());
    for (i, expected) in expected.iter().enumerate() {
        prop_assert_eq!(&in_words(view.sector(i)), expected, "sector {}", i);
        let range = ranges[view.sectors() - 1 - i];
        match expected.state {
            SectorState::Blind => prop_assert!(range.is_nan()),
            SectorState::Free => prop_assert!(range == f32::INFINITY),
            _ => prop_assert_eq!(range, expected.range_mm as f32 / 1000.0),
        }
    }
    Ok(())
}

/// Compares all that core and twin say of a frame; returns how many stixels there are.
fn compare(scene: &Scene<'_>, view: &ObstaclesView<'_>, found: &Found) -> Result<usize, TestCaseError> {
    let config = &scene.config;
    prop_assert_eq!(view.blind(), found.blind);
    let columns = view.columns();
    prop_assert_eq!(columns, found.columns.len());
    for (place, cell) in found.cells.iter().enumerate() {
        let core = view.cell(place % columns, place / columns);
        prop_assert_eq!(core.is_some().then(|| i128::from(core.raw())), *cell, "cell {}", place);
    }
    let line = view.plane().map(in_whole_numbers);
    prop_assert_eq!(line, found.ground);
    let cell = usize::from(config.cell_height);
    for (x, standing) in found.columns.iter().enumerate() {
        let stixel = view.stixel(x);
        prop_assert_eq!(usize::from(stixel.seen_row), standing.seen * cell, "column {}", x);
        let Some(segment) = &standing.found else {
            prop_assert_eq!(stixel.kind, StixelKind::Nothing, "column {}", x);
            continue;
        };
        let kind = if segment.kind == Kind::Drop { StixelKind::Drop } else { StixelKind::Obstacle };
        let steps = (segment.parallax - scene.offset).clamp(0, 65_534);
        let core = (
            stixel.kind,
            usize::from(stixel.top_row),
            usize::from(stixel.base_row),
            i128::from(stixel.disparity.raw()),
            i128::from(stixel.sigma_steps),
        );
        prop_assert_eq!(
            core,
            (kind, segment.top * cell, segment.base * cell + cell - 1, steps, segment.sigma),
            "column {}",
            x
        );
    }
    compare_sectors(scene, view, found)?;
    Ok(found.columns.iter().filter(|standing| standing.found.is_some()).count())
}

/// Where a ground comes from.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Source {
    Absent,
    Given,
    Searched,
}

impl Source {
    /// How often each is tried.
    const SHARES: [Self; 5] = [Self::Absent, Self::Given, Self::Searched, Self::Searched, Self::Searched];
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 250,
        rng_seed: RngSeed::Fixed(27),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn frames_are_those_of_the_twin_to_the_bit(
        seed in any::<u64>(),
        width in 20u16..170,
        height in 30u16..130,
        cell in (1u8..9, 1u8..9),
        offset in prop_oneof![Just(0.0f32), -3.0f32..3.0],
        sigma_steps in 1u16..12,
        limits in (10u16..200, 10u16..200, 1u16..400),
        confidences in (0u8..200, 0u8..250),
        heights_mm in prop_oneof![Just([100u16, 3000]), (150u16..1200).prop_map(|h| [h, h + h / 50])],
        source in prop::sample::select(&Source::SHARES[..]),
        headroom_mm in prop_oneof![Just(u16::MAX), 100u16..2000],
        sectors in 1u8..33,
        searched in prop_oneof![Just(32u16), Just(64), Just(160)],
    ) {
        let mut random = Random::new(seed);
        let (cx, cy) = (f32::from(width) / 2.0 - 0.5, f32::from(height) / 2.0 - 0.5);
        let rig = RectifiedRig::with_offset(0.8 * f32::from(width), 0.1, cx, cy, cx + offset).expect("a rig");
        let default = ObstacleConfig::default();
        let searched_ground = GroundSource::Searched {
            least_height_mm: heights_mm[0],
            most_height_mm: heights_mm[1],
            most_pitch: 500,
            most_roll: 120,
        };
        let config = ObstacleConfig {
            cell_width: cell.0,
            cell_height: cell.1,
            sigma_steps,
            min_confidence: confidences.0,
            sky_confidence: confidences.1,
            ground: if source == Source::Searched { searched_ground } else { GroundSource::Absent },
            obstacle_mm: limits.0,
            drop_mm: limits.1,
            min_pixels: limits.2,
            headroom_mm,
            sectors,
            ..default
        };
        let (mut carried, mut finder) = ((None, 0), None);
        for _ in 0..3 {
            let mut map = map(&mut random, rig, [width, height]);
            map.largest = Disparity::from_pixels(searched);
            if random.byte() & 1 == 1 {
                map.confidences = map.disparities.iter().map(|_| random.byte()).collect();
            }
            let finder = finder.get_or_insert_with(|| map.finder(&config));
            let came = rows_that_come(&mut random, height);
            let mut scene = scene(&map, config, &came);
            if source == Source::Given {
                let (pitch_mrad, roll_mrad, height_mm) = pose(&mut random);
                scene.config.ground = GroundSource::Given { pitch_mrad, roll_mrad, height_mm };
                prop_assert_eq!(finder.as_mut_view().set_pose(pitch_mrad, roll_mrad, height_mm), Ok(()));
            }
            map.rows(finder, |y| scene.came[y]);
            let blind = finder.finish().err();
            let view = finder.as_mut_view();
            prop_assert_eq!(view.blind(), blind);
            if source == Source::Given {
                scene.given = view.plane().map(in_whole_numbers);
                compare_pose(&scene)?;
            }
            let found = find(&scene, &mut carried);
            compare(&scene, &view, &found)?;
        }
    }
}

/// What the property is tried on does show obstacles, drops and grounds.
#[test]
fn the_maps_show_what_is_to_be_found() {
    let rig = super::support::rig();
    let mut random = Random::new(5);
    let (mut grounds, mut standing, mut drops) = (0, 0, 0);
    for _ in 0..60 {
        let map = map(&mut random, rig, [160, 120]);
        let found = find(&scene(&map, ObstacleConfig::default(), &[true; 120]), &mut (None, 0));
        grounds += usize::from(found.ground.is_some());
        standing += found.columns.iter().filter(|c| c.found.is_some()).count();
        drops +=
            found.columns.iter().filter_map(|c| c.found.as_ref()).filter(|s| s.kind == Kind::Drop).count();
    }
    assert!(
        grounds > 20 && standing > 400 && drops > 40,
        "{grounds} grounds, {standing} stixels, {drops} drops"
    );
}
