//! Obstacles and decisions: the functions for C give what the finder and the rule in Rust do.

use super::*;
use stereopsis::depth::DepthScale;
use stereopsis::ffi::{
    CDriveConfig, CGround, CObstacleConfig, CScan, CSector, CStixel, CVerdict, STEREOPSIS_BLIND_NOT,
    STEREOPSIS_DECISION_BLIND, STEREOPSIS_DECISION_CLEAR, STEREOPSIS_DECISION_SLOW, STEREOPSIS_DECISION_STOP,
    STEREOPSIS_DRIVE_BYTES, STEREOPSIS_FREE_SPACE_BYTES, STEREOPSIS_GROUND_ABSENT, STEREOPSIS_GROUND_GIVEN,
    STEREOPSIS_NO_CONTACT, STEREOPSIS_PAIR_MONITOR_BYTES, obstacles_bytes,
};
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::imaging::PairMonitor;
use stereopsis::obstacles::{
    Decision, DriveConfig, DriveRule, FreeSpace, GroundSource, Hysteresis, ObstacleConfig, Obstacles, Sector,
    speed_mm_s,
};
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::scene::Random;

const SIZE: [u16; 2] = [96, 80];
const COLUMNS: usize = 24;
const ROWS: usize = 16;
const SPEED: u16 = 700;
static RIG: CRig = CRig { focal_px: 90.0, baseline_m: 0.1, cx: 47.5, cy: 39.5, cx_right: 46.5 };

/// Memory of so many bytes that holds anything but zeros.
fn memory_of(bytes: usize) -> Vec<u64> {
    vec![0xA5A5_A5A5_A5A5_A5A5; bytes.div_ceil(8)]
}

/// Rows of a frame.
struct Frame {
    disparities: Vec<u16>,
    flags: Vec<u8>,
    confidences: Option<Vec<u8>>,
    lost: Vec<usize>,
}

/// A floor 0.3 m below, a box that comes nearer from frame to frame, noise, and every fourth frame a fault.
fn frame(random: &mut Random, number: usize) -> Frame {
    let [width, height] = SIZE.map(usize::from);
    let near = 4.0 + 2.0 * number as f64;
    let mut disparities = Vec::new();
    for v in 0..height {
        for u in 0..width {
            let floor = (v as f64 - 25.0) / 3.0;
            let boxed = (40..60).contains(&u) && (20..60).contains(&v) && near > floor;
            let parallax = if boxed { near } else { floor };
            let steps = (32.0 * (parallax - 1.0) + 2.0 * random.gauss()).round();
            let answered = parallax > 0.5 && random.unit() > 0.1;
            disparities.push(if answered { steps.clamp(0.0, 1023.0) as u16 } else { u16::MAX });
        }
    }
    let damaged = if number % 4 == 3 { 30 } else { 2 };
    let flag = |i: usize| match i / width {
        row if row < damaged => PixelFlags::DAMAGED.bits(),
        row if row % 9 == 0 => PixelFlags::FILLED.bits(),
        _ => 0,
    };
    let flags = (0..width * height).map(flag).collect();
    let confidences = (number % 2 == 1).then(|| (0..width * height).map(|_| random.byte()).collect());
    Frame { disparities, flags, confidences, lost: (0..height).filter(|_| random.unit() < 0.03).collect() }
}

fn c_sector(sector: &Sector) -> CSector {
    let Sector { state, bearing_mrad, depth_mm, sigma_mm, range_mm, pixels, height_mm, seen_mm } = *sector;
    CSector { pixels, bearing_mrad, depth_mm, sigma_mm, range_mm, height_mm, seen_mm, state: state as u8 }
}

/// What a decision is in C: its number, its distance, its reason.
fn c_decision(decision: Decision) -> (u8, u16, u8) {
    match decision {
        Decision::Clear => (STEREOPSIS_DECISION_CLEAR, 0, STEREOPSIS_BLIND_NOT),
        Decision::Slow(mm) => (STEREOPSIS_DECISION_SLOW, mm, STEREOPSIS_BLIND_NOT),
        Decision::Stop(mm) => (STEREOPSIS_DECISION_STOP, mm, STEREOPSIS_BLIND_NOT),
        Decision::Blind(reason) => (STEREOPSIS_DECISION_BLIND, 0, reason as u8),
    }
}

/// Runs frames through both, and returns the decisions.
fn frames_are_equal(config: ObstacleConfig, change: impl Fn(&mut CObstacleConfig)) -> Vec<u8> {
    let rig =
        RectifiedRig::with_offset(RIG.focal_px, RIG.baseline_m, RIG.cx, RIG.cy, RIG.cx_right).expect("a rig");
    let (scale, largest) = (DepthScale::new(&rig).expect("a scale"), Disparity::from_pixels(32));
    let mut twin = Box::new(Obstacles::<COLUMNS, ROWS>::new());
    twin.start(&config, &scale, SIZE, largest).expect("room for it");
    let (mut rule, mut space) =
        (DriveRule::new(DriveConfig::default()), FreeSpace::new(Hysteresis { confirm: 2, release: 1 }));
    let mut twin_monitor = PairMonitor::new(20);
    let mut memories = [
        obstacles_bytes(COLUMNS, ROWS),
        STEREOPSIS_DRIVE_BYTES,
        STEREOPSIS_FREE_SPACE_BYTES,
        STEREOPSIS_PAIR_MONITOR_BYTES,
    ]
    .map(memory_of);
    let lengths = memories.each_ref().map(|memory| size_of_val(&memory[..]));
    let [first, second, third, fourth] = memories.each_mut().map(|memory| memory.as_mut_ptr().cast());
    let (mut handle, mut drive, mut free, mut monitor) = (null_mut(), null_mut(), null_mut(), null_mut());
    let mut c_config = MaybeUninit::uninit();
    let mut drive_config = MaybeUninit::<CDriveConfig>::uninit();
    // SAFETY: the memory outlives the handles, and configurations are filled before they are read.
    unsafe {
        let (columns, rows) = (COLUMNS as u16, ROWS as u16);
        assert_eq!(stereopsis_obstacles_init(first, lengths[0], columns, rows, &raw mut handle), Status::Ok);
        assert_eq!(stereopsis_drive_init(second, lengths[1], &raw mut drive), Status::Ok);
        assert_eq!(stereopsis_free_space_init(third, lengths[2], 2, 1, &raw mut free), Status::Ok);
        assert_eq!(stereopsis_pair_monitor_init(fourth, lengths[3], 20, &raw mut monitor), Status::Ok);
        assert_eq!(stereopsis_obstacles_default(c_config.as_mut_ptr()), Status::Ok);
        let mut c_config = c_config.assume_init();
        change(&mut c_config);
        let start =
            stereopsis_obstacles_start(handle, &raw const c_config, &raw const RIG, SIZE[0], SIZE[1], 32);
        assert_eq!(start, Status::Ok);
        assert_eq!(stereopsis_drive_default(drive_config.as_mut_ptr()), Status::Ok);
        assert_eq!(stereopsis_drive_start(drive, drive_config.as_ptr()), Status::Ok);
    }
    let mut random = Random::new(27);
    let mut decisions = Vec::new();
    for number in 0..12 {
        let Frame { mut disparities, mut flags, mut confidences, lost } = frame(&mut random, number);
        twin.begin();
        // SAFETY: the handles are alive, and rows have their width.
        assert_eq!(unsafe { stereopsis_obstacles_begin_frame(handle) }, Status::Ok);
        if number == 6 {
            // The cameras are swapped.
            let (left, right) = Pattern::Shifted { most: 12, noise_grey: 0.0 }.pair(96, 80, 5);
            twin_monitor.begin();
            // SAFETY: as above.
            unsafe {
                assert_eq!(stereopsis_pair_monitor_begin_frame(monitor), Status::Ok);
                for (left, right) in left.as_raw().chunks(96).zip(right.as_raw().chunks(96)) {
                    twin_monitor.lines(right, left);
                    let (l, r) = (left.as_ptr(), right.as_ptr());
                    assert_eq!(stereopsis_pair_monitor_push(monitor, r, l, 96), Status::Ok);
                }
                let mut found = [9; 3];
                let [left, right, swapped] = found.each_mut().map(|byte| &raw mut *byte);
                assert_eq!(stereopsis_pair_monitor_health(monitor, left, right, swapped), Status::Ok);
                assert_eq!(found, [0, 0, 1]);
                assert!(twin_monitor.are_swapped());
                assert_eq!(stereopsis_obstacles_cameras(handle, monitor), Status::Ok);
            }
            twin.as_mut_view().cameras(&twin_monitor);
        }
        if number == 8 && config.ground != ObstacleConfig::default().ground {
            twin.as_mut_view().set_pose(120, 30, 310).expect("a pose");
            // SAFETY: as above.
            assert_eq!(unsafe { stereopsis_obstacles_set_pose(handle, 120, 30, 310) }, Status::Ok);
        }
        let all = disparities.chunks_mut(96).zip(flags.chunks_mut(96)).enumerate();
        for (y, (disparities, flags)) in all.filter(|(y, _)| !lost.contains(y)) {
            let sure = confidences.as_mut().map(|all| &mut all[96 * y..][..96]);
            let row = CRow {
                index: y as u16,
                width: 96,
                disparities: disparities.as_ptr(),
                flags: flags.as_ptr(),
                confidences: sure.as_ref().map_or(null(), |sure| sure.as_ptr()),
            };
            // SAFETY: as above.
            assert_eq!(unsafe { stereopsis_obstacles_push(handle, &raw const row) }, Status::Ok);
            let disparities: Vec<_> = disparities.iter().map(|&d| Disparity::from_raw(d)).collect();
            let flags: Vec<_> = flags.iter().map(|&bits| PixelFlags::from_bits(bits)).collect();
            twin.push(y, &disparities, &flags, sure.as_deref().unwrap_or(&[]));
        }
        let mut blind = 99;
        // SAFETY: as above.
        assert_eq!(unsafe { stereopsis_obstacles_finish(handle, &raw mut blind) }, Status::Ok);
        assert_eq!(blind, twin.finish().err().map_or(STEREOPSIS_BLIND_NOT, |reason| reason as u8));
        let view = twin.as_mut_view();
        let mut stixels = [MaybeUninit::<CStixel>::uninit(); COLUMNS + 1];
        let mut sectors = [MaybeUninit::<CSector>::uninit(); 17];
        let mut held = sectors;
        let (mut ranges, mut scan) = ([7.0_f32; 20], MaybeUninit::<CScan>::uninit());
        let (mut ground, mut verdict) = (MaybeUninit::<CGround>::uninit(), MaybeUninit::<CVerdict>::uninit());
        let mut cells = [[0; COLUMNS + 1]; ROWS + 1];
        // SAFETY: as many findings are there, and all of them are written.
        let (ground, scan, verdict) = unsafe {
            let ok = |status| assert_eq!(status, Status::Ok);
            ok(stereopsis_obstacles_ground(handle, ground.as_mut_ptr()));
            ok(stereopsis_obstacles_stixels(handle, stixels.as_mut_ptr().cast(), COLUMNS + 1));
            ok(stereopsis_obstacles_sectors(handle, sectors.as_mut_ptr().cast(), 17));
            ok(stereopsis_obstacles_scan(handle, ranges.as_mut_ptr(), 20, scan.as_mut_ptr()));
            for (row, cells) in (0..).zip(&mut cells) {
                ok(stereopsis_obstacles_cells(handle, row, cells.as_mut_ptr(), COLUMNS + 1));
            }
            ok(stereopsis_free_space_update(free, handle));
            ok(stereopsis_free_space_sectors(free, held.as_mut_ptr().cast(), 17));
            ok(stereopsis_drive_decide(drive, handle, SPEED, verdict.as_mut_ptr()));
            (ground.assume_init(), scan.assume_init(), verdict.assume_init())
        };
        let known = view.plane().map(|g| {
            let angles = [g.pitch_rad(), g.roll_rad(), g.pitch_sigma_rad()];
            (g.level, g.slope, g.lean, g.variance, g.height_mm, angles)
        });
        let angles = [ground.pitch_rad, ground.roll_rad, ground.pitch_sigma_rad];
        let of_c = (ground.level, ground.slope, ground.lean, ground.variance, ground.height_mm, angles);
        assert_eq!((ground.height_mm > 0).then_some(of_c), known, "frame {number}");
        assert_eq!(ground.is_known == 1, view.ground().is_some(), "frame {number}");
        for (column, stixel) in stixels.iter().enumerate() {
            // SAFETY: as above.
            let found = unsafe { stixel.assume_init() };
            let twin = view.stixel(column);
            let rows = [twin.top_row, twin.base_row, twin.seen_row];
            assert_eq!([found.top_row, found.base_row, found.seen_row], rows, "frame {number}, {column}");
            assert_eq!((found.kind, found.disparity), (twin.kind as u8, twin.disparity.raw()));
            assert_eq!((found.sigma_steps, found.depth_mm), (twin.sigma_steps, twin.depth_mm));
        }
        space.update(&view);
        for (index, (sector, held)) in sectors.iter().zip(&held).enumerate() {
            // SAFETY: as above.
            let found = unsafe { [sector.assume_init(), held.assume_init()] };
            let twins = [view.sector(index), space.sector(index)];
            assert_eq!(found, twins.map(|sector| c_sector(&sector)), "frame {number}, sector {index}");
        }
        for (row, cells) in cells.iter().enumerate() {
            let twins: Vec<_> = (0..=COLUMNS).map(|column| view.cell(column, row).raw()).collect();
            assert_eq!(cells[..], twins, "frame {number}, row {row}");
        }
        let mut twins = [0.0; 20];
        let twin_scan = view.laser_scan(&mut twins);
        assert_eq!(ranges.map(f32::to_bits), twins.map(f32::to_bits), "frame {number}");
        let angles = [scan.angle_min, scan.angle_max, scan.angle_increment, scan.range_min, scan.range_max];
        let (min, max) = (twin_scan.angle_min, twin_scan.angle_max);
        assert_eq!(angles, [min, max, twin_scan.angle_increment, twin_scan.range_min, twin_scan.range_max]);
        assert_eq!((scan.count, twin_scan.count), (16, 16));
        let decided = rule.decide(&view, SPEED);
        assert_eq!((verdict.decision, verdict.distance_mm, verdict.blind), c_decision(decided.decision));
        assert_eq!(verdict.contact_ms, decided.contact_ms.unwrap_or(STEREOPSIS_NO_CONTACT));
        assert_eq!((verdict.stopping_mm, verdict.nearest), (decided.stopping_mm, decided.nearest as u8));
        decisions.push(verdict.decision);
    }
    // SAFETY: the handles are alive.
    unsafe {
        let mut stopping = 0;
        assert_eq!(stereopsis_drive_stopping_mm(drive, SPEED, &raw mut stopping), Status::Ok);
        assert_eq!(stopping, rule.stopping_mm(SPEED));
        assert_eq!(stereopsis_speed_mm_s(20, 40_000), speed_mm_s(20, 40_000));
        assert_eq!(stereopsis_obstacles_deinit(handle), Status::Ok);
        assert_eq!(stereopsis_drive_deinit(drive), Status::Ok);
        assert_eq!(stereopsis_free_space_deinit(free), Status::Ok);
        assert_eq!(stereopsis_pair_monitor_deinit(monitor), Status::Ok);
    }
    decisions
}

#[test]
fn frames_are_those_of_the_finder() {
    let searched = frames_are_equal(ObstacleConfig::default(), |_| ());
    for decision in [STEREOPSIS_DECISION_BLIND, STEREOPSIS_DECISION_SLOW, STEREOPSIS_DECISION_STOP] {
        assert!(searched.contains(&decision), "{searched:?}");
    }
    let ground = GroundSource::Given { pitch_mrad: 160, roll_mrad: -20, height_mm: 300 };
    let given = ObstacleConfig { ground, sectors: 16, min_confidence: 40, ..ObstacleConfig::default() };
    frames_are_equal(given, |c| {
        (c.ground, c.pitch_mrad, c.height_mm, c.min_confidence) = (STEREOPSIS_GROUND_GIVEN, 160, 300, 40);
        c.roll_mrad = -20;
    });
    let flying = ObstacleConfig { ground: GroundSource::Absent, ..ObstacleConfig::default() };
    let absent = frames_are_equal(flying, |c| c.ground = STEREOPSIS_GROUND_ABSENT);
    assert!(absent.contains(&STEREOPSIS_DECISION_STOP), "{absent:?}");
}

/// An obstacle map is no matcher, and has the same statuses.
#[test]
fn texts_of_statuses_are_true_of_every_handle() {
    assert_eq!(Status::MinDisparity.text(), c"the search must end at 2046 px at most");
    for status in [Status::AlreadyInitialised, Status::NotInitialised, Status::Overlap, Status::NotStarted] {
        let text = status.text().to_str().expect("plain text");
        assert!(!text.contains("matcher") && !text.contains("rectifier"), "{text}");
    }
}
