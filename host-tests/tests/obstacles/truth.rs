//! The tables of docs/performance.md on obstacles: thousands of rendered frames beside their truth.

use super::drives::drives;
use super::support::{Cameras, frame, noisy};
use super::tally::{REACH, Tally, down, nearest};
use nalgebra::{Rotation3, Vector3};
use std::fmt::Write as _;
use std::fs;
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::Pose;
use stereopsis::matching::{Block, Fast, Method, Sgm};
use stereopsis::obstacles::{GroundSource, ObstacleConfig, SectorState};
use stereopsis_host::scene::{Random, RobotScene};

/// Noise of the sensors, grey levels.
const NOISES: [f64; 2] = [0.0, 3.0];
/// All scenes, with whether there is nothing to drive into within reach.
const SCENES: [(RobotScene, bool); 6] = [
    (RobotScene::Corridor, true),
    (RobotScene::Street, true),
    (RobotScene::Sky, true),
    (RobotScene::Table, false),
    (RobotScene::Poles, false),
    (RobotScene::WhiteWall, false),
];

/// What is known beside the answers.
#[derive(Clone, Copy, PartialEq)]
enum Known {
    Nothing,
    /// The height of the cameras.
    Height,
    /// How sure each answer is.
    Confidences,
}

fn percent(n: usize, of: usize) -> f64 {
    100.0 * n as f64 / of.max(1) as f64
}

/// So many frames of a scene, of ten seeds.
fn tally<M: Method>(scene: RobotScene, noise_grey: f64, frames: usize, known: Known) -> Tally {
    let mut limits = ObstacleConfig::default();
    if let (Known::Height, GroundSource::Searched { least_height_mm, most_height_mm, .. }) =
        (known, &mut limits.ground)
    {
        (*least_height_mm, *most_height_mm) = (300, 300);
    }
    let mut tally = Tally::default();
    for seed in 1..=10 {
        let scene = scene.scene(seed);
        let (pictures, nearest) = (scene.render(), nearest(&scene, down(0.0)));
        let mut cameras = Cameras::<M>::of(&scene, &limits, known == Known::Confidences);
        for n in 0..frames / 10 {
            let (left, right) = frame(&pictures, noise_grey, n);
            tally.take(&cameras.frame(&left, &right).finder.as_mut_view(), &nearest);
        }
    }
    tally
}

/// All scenes through a method, as lines of the table.
fn scenes<M: Method>(frames: usize, known: Known) -> String {
    let said = ["", "height", "confidences"][known as usize];
    let mut lines = String::new();
    for (scene, is_empty) in SCENES {
        for noise in NOISES {
            let tally = tally::<M>(scene, noise, frames, known);
            let [clear, slow, stop, blind] = tally.decisions;
            let _ = writeln!(
                lines,
                "| `{}` | {said} | {scene:?} | {noise} | {} | {} | {:.1} % | {} | {:.2} | {:.1} % | \
                 {clear} | {slow} | {stop} | {blind} |",
                M::NAME,
                tally.frames,
                tally.alarms,
                percent(tally.told.len(), tally.frames),
                tally.told.len() - Tally::within(&tally.told),
                tally.most_tilt(),
                percent(Tally::within(&tally.planes), tally.frames),
            );
            let case = format!("{} {scene:?}, noise {noise}, {said}", M::NAME);
            assert!(is_empty || clear == 0, "{case}: {:?}", tally.decisions);
            // `sgm` alone carries wrong matches over a noisy sky.
            let is_sky = M::NAME == Sgm::NAME && known != Known::Confidences && noise > 0.0;
            assert!(is_sky || tally.alarms <= usize::from(noise > 0.0), "{case}: {} alarms", tally.alarms);
            assert!(is_sky || !is_empty || clear == tally.frames, "{case}: {:?}", tally.decisions);
            assert_eq!(tally.planes.len(), tally.frames, "{case}: no plane");
            assert_eq!(Tally::within(&tally.told), tally.told.len(), "{case}: a ground is off");
            // Of the table and before the wall, the ground is seen over 35 rows only.
            let is_short = matches!(scene, RobotScene::Table | RobotScene::WhiteWall);
            let is_told = known == Known::Height || !is_short;
            assert!(!is_told || tally.told.len() == tally.frames, "{case}: a ground is not told");
        }
    }
    lines
}

/// Boxes of 20 x 20 cm at a distance along the ground.
fn boxes(mm: u16, noise_grey: f64, frames: usize) -> [usize; 4] {
    let [mut all, mut found, mut told, mut within] = [0; 4];
    for seed in 1..=10 {
        let scene = RobotScene::BoxAt(mm).scene(seed);
        let (pictures, mut cameras) = (scene.render(), Cameras::<Block>::new(&scene));
        // The middle of the front, 0.1 m above the ground.
        let (sin, cos) = RobotScene::PITCH_RAD.sin_cos();
        let depth_mm = f64::from(mm) * cos + 1000.0 * (RobotScene::HEIGHT_M - 0.1) * sin;
        for n in 0..frames {
            let (left, right) = frame(&pictures, noise_grey, n);
            let view = cameras.frame(&left, &right).finder.as_mut_view();
            // Within a window of its bearing, and a fifth of its distance.
            let most_mrad = 1000.0 * (100.0 / depth_mm + REACH as f64 / 130.0);
            let boxed = (0..view.sectors()).map(|i| view.sector(i)).filter(|s| {
                s.state == SectorState::Obstacle
                    && f64::from(s.bearing_mrad.abs()) <= most_mrad
                    && (f64::from(s.depth_mm) / depth_mm - 1.0).abs() < 0.2
            });
            let off = boxed.map(|s| ((f64::from(s.depth_mm) - depth_mm) / f64::from(s.sigma_mm)).abs());
            let off: Vec<_> = off.collect();
            all += 1;
            found += usize::from(!off.is_empty());
            told += off.len();
            within += off.iter().filter(|off| **off <= 2.0).count();
        }
    }
    [all, found, told, within]
}

/// Distances of boxes, mm: the search ends at 0.42 m.
const DISTANCES: [u16; 12] = [500, 600, 700, 800, 900, 1000, 1100, 1200, 1300, 1500, 1800, 2400];
/// The distance at which the deviation is a tenth of the box's side: `Z^2 / (f b) sigma = 0.02 m`, mm.
const TENTH_MM: u16 = 1310;

fn distances(frames: usize) -> String {
    let scale = DepthScale::new(&RobotScene::rig()).expect("a scale");
    let mut lines = String::new();
    for mm in DISTANCES {
        for noise in NOISES {
            let [all, found, told, within] = boxes(mm, noise, frames);
            let metres = f64::from(mm) / 1000.0;
            let f_b = f64::from(scale.rig().focal_px() * scale.rig().baseline_m());
            let _ = writeln!(
                lines,
                "| {metres:.1} | {noise} | {:.0} | {all} | {:.1} % | {:.1} % |",
                1000.0 * metres * metres / f_b * 0.15,
                percent(found, all),
                percent(within, told),
            );
            // With noise two of a hundred may be missed at the last distance.
            let fewest = if noise > 0.0 { all - all / 50 } else { all };
            let is_good = found >= fewest && 100 * within >= 95 * told;
            assert!(mm > TENTH_MM || is_good, "{mm} mm: {found}, {within} of {told}");
        }
    }
    lines
}

/// Distances of poles, mm.
const POLES: [u16; 7] = [450, 500, 600, 700, 800, 900, 1000];
/// The distance at which a pole of 2 cm is 4 px wide, mm.
const FOUR_PX_MM: u16 = 650;

/// Poles of 2 cm anywhere in the corridor, as far as the robot looks ahead.
fn poles() -> String {
    let mut lines = String::new();
    for mm in POLES {
        for noise in NOISES {
            let mut random = Random::new(mm.into());
            let mut tally = Tally::default();
            for seed in 1..=40 {
                let scene = RobotScene::PoleAt(mm, random.below(341) as i16 - 170).scene(seed);
                let (pictures, nearest) = (scene.render(), nearest(&scene, down(0.0)));
                let mut cameras = Cameras::<Block>::new(&scene);
                for n in 0..3 {
                    let (left, right) = frame(&pictures, noise, n);
                    tally.take(&cameras.frame(&left, &right).finder.as_mut_view(), &nearest);
                }
            }
            let [clear, slow, stop, blind] = tally.decisions;
            let metres = f64::from(mm) / 1000.0;
            let px = 0.02 * 130.0 / metres;
            let _ = writeln!(
                lines,
                "| {metres} | {px:.1} | {noise} | {} | {} | {blind} | {clear} |",
                tally.frames,
                slow + stop
            );
            // A pole of which a frame shows nothing is passed over: at most two frames of a hundred.
            let is_good = 50 * clear <= tally.frames;
            assert!(mm > FOUR_PX_MM || is_good, "a pole at {mm} mm, noise {noise}: {:?}", tally.decisions);
        }
    }
    lines
}

/// A camera that leans to the side, with noise and without.
fn rolls() -> String {
    let mut lines = String::new();
    for roll_deg in [0.0_f64, 0.5, 1.0, 2.0, 3.0, 5.0] {
        let _ = write!(lines, "| {roll_deg} |");
        for scene in [RobotScene::Corridor, RobotScene::Street, RobotScene::Sky] {
            let mut tally = Tally::default();
            for seed in 1..=10 {
                let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), roll_deg.to_radians());
                let pose = Pose::new(*turn.matrix(), Vector3::zeros()).expect("a pose");
                let scene = scene.scene(seed).seen_from(&pose);
                let (left, right) = scene.render();
                let nearest = nearest(&scene, down(roll_deg.to_radians()));
                let mut cameras = Cameras::<Block>::new(&scene);
                for noise in NOISES {
                    let [left, right] = [(&left, 1), (&right, 2)].map(|(p, n)| noisy(p, noise, 1.0, n));
                    tally.take(&cameras.frame(&left, &right).finder.as_mut_view(), &nearest);
                }
            }
            let clear = tally.decisions[0];
            let within = Tally::within(&tally.told);
            let is_good = [within, clear] == [tally.frames; 2] && tally.alarms == 0;
            assert!(is_good, "{scene:?} at {roll_deg} degrees: {tally:?}");
            let _ = write!(lines, " {:.1} | {} | {clear} |", tally.most_tilt(), tally.alarms);
        }
        lines.push('\n');
    }
    lines
}

/// Makes the tables, and compares them with those of the page; writes them where `STEREOPSIS_README` is
/// `write`.
#[test]
#[ignore = "takes minutes"]
fn tables_are_current() {
    let head = |names: &[&str]| {
        let rule = " ---: |".repeat(names.len());
        format!("| {} |\n|{rule}\n", names.join(" | "))
    };
    let of_boxes = head(&["distance, m", "noise", "deviation, mm", "frames", "found", "within 2 deviations"]);
    let ground = [
        "false alarms",
        "ground told",
        "of these over 0.5 degrees off",
        "at most off, degrees",
        "all planes within 0.5 degrees",
    ];
    let decisions = ["clear", "slow", "stop", "blind"];
    let of_scenes =
        head(&[&["method", "known", "scene", "noise", "frames"][..], &ground, &decisions].concat());
    let of_poles = head(&["distance, m", "width, px", "noise", "frames", "slow or stop", "blind", "clear"]);
    let of_rolls = head(&[
        "roll, degrees",
        "corridor: ground off",
        "false alarms",
        "clear",
        "street: ground off",
        "false alarms",
        "clear",
        "sky: ground off",
        "false alarms",
        "clear",
    ]);
    let of_drives = head(&[
        "method",
        "drive",
        "ground",
        "frames",
        "planes within 0.5 degrees",
        "within 1.2",
        "told",
        "of these over 0.5 degrees off",
        "at most off, degrees",
    ]);
    let made = format!(
        "\n{of_boxes}{}\n{of_scenes}{}{}{}{}{}\n{of_poles}{}\n{of_rolls}{}\n{of_drives}{}\n",
        distances(10),
        scenes::<Block>(1000, Known::Nothing),
        scenes::<Block>(200, Known::Height),
        scenes::<Fast>(200, Known::Nothing),
        scenes::<Sgm>(200, Known::Nothing),
        scenes::<Sgm>(1000, Known::Confidences),
        poles(),
        rolls(),
        drives(),
    );
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/performance.md");
    let page = fs::read_to_string(path).expect("the page");
    let (begin, end) = ("<!-- generated: obstacles -->\n", "<!-- end: obstacles -->");
    let first = page.find(begin).expect("a place for the tables") + begin.len();
    let last = first + page[first..].find(end).expect("an end of the tables");
    if std::env::var_os("STEREOPSIS_README").is_some_and(|value| value == "write") {
        let page = [&page[..first], &made, &page[last..]].concat();
        fs::write(path, page).expect("the page can be written");
    } else {
        assert_eq!(&page[first..last], made, "STEREOPSIS_README=write writes the tables");
    }
}
