//! A robot that drives towards a board on the floor: rows of disparity, obstacles, a decision, and what it
//! means to two motors.
//!
//! It knows no hardware: the same runs on the host, which compares. In a product the lines are those of a
//! camera, and [`Motors`] are duty cycles.

use crate::scene::{hash, texture};
use stereopsis::depth::{DepthError, DepthScale};
use stereopsis::geometry::camera::{RectifiedRig, RigError};
use stereopsis::matching::{Block, Config, ConfigError, Row};
use stereopsis::obstacles::{
    Decision, DriveConfig, DriveRule, Hysteresis, ObstacleConfig, ObstacleError, Obstacles, ObstaclesView,
    SectorState,
};
use stereopsis::pipeline::{Pipeline, PushError};
use stereopsis::units::Disparity;

/// Pixels in a line.
pub const WIDTH: usize = 160;
/// Lines in a frame.
pub const HEIGHT: usize = 120;
/// Disparities that are searched.
pub const DISPARITIES: usize = 32;
/// Disparity of the board in each frame, px: 3.25 m to 0.52 m away.
pub const BOARD: [i32; 7] = [4, 6, 8, 11, 15, 20, 25];

/// The finder of a camera of 160x120 px: 40 x 24 cells.
pub type Finder = Obstacles<40, 24>;
/// The matcher before it.
pub type Matcher = Pipeline<Block, WIDTH, DISPARITIES>;

/// Focal length, px, and baseline, m.
const RIG: (f32, f32) = (130.0, 0.1);
/// Speed of the robot, mm/s.
const SPEED_MM_S: u16 = 800;
/// How the robot drives: 0.3 m wide, and all else as a small robot by default.
const DRIVE: DriveConfig = DriveConfig {
    corridor_mm: 300,
    margin_mm: 200,
    reaction_ms: 100,
    brake_mm_s2: 1000,
    slow_ms: 2000,
    hysteresis: Hysteresis { confirm: 1, release: 2 },
};
/// The row of the horizon.
const HORIZON: i32 = 42;

/// What two motors are given, thousandths of their full speed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Motors {
    /// The left one.
    pub left: i16,
    /// The right one.
    pub right: i16,
}

/// What came of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Step {
    /// The decision.
    pub decision: Decision,
    /// What the motors are given.
    pub motors: Motors,
}

/// What the stages took, by the clock.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Ticks {
    /// Lines to rows of disparity.
    pub matching: u64,
    /// Rows of disparity to cells.
    pub rows: u64,
    /// Cells to a decision.
    pub decisions: u64,
}

/// The robot without its cameras: all the memory that it takes, zeros before it is started.
pub struct Robot {
    /// Lines to rows.
    pub matcher: Matcher,
    /// Rows to obstacles.
    pub finder: Finder,
    lines: [[u8; WIDTH]; 2],
}

/// Why a drive broke off; which it does not.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Broken {
    /// The numbers of the rig are no rig.
    Rig(RigError),
    /// The depths of the rig fit no integers.
    Depth(DepthError),
    /// The matcher cannot do what is asked.
    Config(ConfigError),
    /// The finder cannot do what is asked.
    Obstacles(ObstacleError),
    /// A line was not due.
    Line(PushError),
}

impl Robot {
    /// The robot has not moved yet.
    pub const fn new() -> Self {
        Self { matcher: Matcher::new(), finder: Finder::new(), lines: [[0; WIDTH]; 2] }
    }

    /// Sets all up.
    ///
    /// # Errors
    /// When the memory is too small for the frames; which it is not.
    pub fn start(&mut self) -> Result<(), Broken> {
        let size = [WIDTH as u16, HEIGHT as u16];
        let config = Config::for_method::<Block>(size[0], size[1], DISPARITIES as u16);
        self.matcher.start(&config).map_err(Broken::Config)?;
        let rig = RectifiedRig::new(RIG.0, RIG.1, 79.5, 59.5).map_err(Broken::Rig)?;
        let scale = DepthScale::new(&rig).map_err(Broken::Depth)?;
        let largest = Disparity::from_pixels(DISPARITIES as u16);
        let limits = ObstacleConfig::default();
        self.finder.start(&limits, &scale, size, largest).map_err(Broken::Obstacles)
    }

    /// The rule that turns obstacles into decisions, without history.
    pub const fn rule() -> DriveRule {
        DriveRule::new(DRIVE)
    }

    /// One frame with a board of a disparity ahead; what the stages took is added to `ticks`.
    ///
    /// # Errors
    /// When a line is not due; which it is.
    pub fn frame(
        &mut self,
        rule: &mut DriveRule,
        board: i32,
        clock: impl Fn() -> u64,
        ticks: &mut Ticks,
    ) -> Result<Step, Broken> {
        let Self { matcher, finder, lines: [left, right] } = self;
        let start = clock();
        matcher.begin().map_err(|_| Broken::Line(PushError::NoLineLeft))?;
        ticks.matching += clock() - start;
        let start = clock();
        finder.begin();
        ticks.rows += clock() - start;
        for line in 0..HEIGHT + Matcher::LATENCY {
            let is_seen = line < HEIGHT;
            if is_seen {
                see(line as i32, board, left, right);
            }
            let start = clock();
            let row = if is_seen { matcher.push(left, right) } else { matcher.flush() };
            let row = row.map_err(Broken::Line)?;
            let middle = clock();
            ticks.matching += middle - start;
            if let Some(row) = row {
                take(finder, &row);
                ticks.rows += clock() - middle;
            }
        }
        let start = clock();
        let step = decide(finder, rule);
        ticks.decisions += clock() - start;
        Ok(step)
    }
}

impl Default for Robot {
    fn default() -> Self {
        Self::new()
    }
}

impl Step {
    /// The decision as a byte and a distance, and the motors, the low byte first.
    pub fn bytes(&self) -> [u8; 7] {
        let (decision, mm) = match self.decision {
            Decision::Clear => (0, 0),
            Decision::Slow(mm) => (1, mm),
            Decision::Stop(mm) => (2, mm),
            Decision::Blind(_) => (3, 0),
        };
        let ([a, b], [c, d]) = (mm.to_le_bytes(), self.motors.left.to_le_bytes());
        let [e, f] = self.motors.right.to_le_bytes();
        [decision, a, b, c, d, e, f]
    }
}

/// Gives a row to the finder.
// Not inlined, so that it is told from the rest of the program.
#[inline(never)]
fn take(finder: &mut Finder, row: &Row<'_>) {
    finder.push(row.index().into(), row.disparities(), row.flags(), row.confidences());
}

/// Ends a frame.
#[inline(never)]
fn decide(finder: &mut Finder, rule: &mut DriveRule) -> Step {
    // A frame that is not to be trusted is blind to the rule as well.
    let _ = finder.finish();
    let frame = finder.as_mut_view();
    let decision = rule.decide(&frame, SPEED_MM_S).decision;
    Step { decision, motors: motors(&decision, &frame) }
}

/// Full speed where it is clear; half of it, and away from what is nearer, where it is not; else nothing.
fn motors(decision: &Decision, frame: &ObstaclesView<'_>) -> Motors {
    match decision {
        Decision::Clear => Motors { left: 1000, right: 1000 },
        Decision::Slow(_) => {
            let half = frame.sectors() / 2;
            let free = |mut sectors: core::ops::Range<usize>| {
                sectors.any(|i| frame.sector(i).state == SectorState::Free)
            };
            match (free(0..half), free(half..frame.sectors())) {
                (true, false) => Motors { left: 300, right: 500 },
                (false, true) => Motors { left: 500, right: 300 },
                _ => Motors { left: 500, right: 500 },
            }
        }
        Decision::Stop(_) | Decision::Blind(_) => Motors { left: 0, right: 0 },
    }
}

/// A line of both cameras: a floor that begins 0.3 m below them, a wall 13 m away, and a board 0.2 m wide and
/// high that stands on the floor.
fn see(v: i32, board: i32, left: &mut [u8; WIDTH], right: &mut [u8; WIDTH]) {
    // Sixteenths of a px; the floor's parallax grows by a third of a px from row to row.
    let behind = ((v - HORIZON) * 16 / 3).max(16);
    let stands = HORIZON + 3 * board;
    let is_board_row = (stands - 2 * board..stands).contains(&v);
    let on_board = |u: i32| is_board_row && (80 - board..80 + board).contains(&u);
    for ((u, l), r) in (0..).zip(left).zip(right) {
        *l = noisy(texture(u << 4, v, if on_board(u) { 7 } else { 3 }), u, v, 1);
        let seen = if on_board(u + board) {
            texture((u + board) << 4, v, 7)
        } else {
            texture((u << 4) + behind, v, 3)
        };
        *r = noisy(seen, u, v, 2);
    }
}

/// Noise of up to 2 grey levels either way, different in the two cameras.
fn noisy(pixel: u8, u: i32, v: i32, camera: u32) -> u8 {
    // A pixel is between 32 and 223, so this cannot wrap.
    pixel + (hash(u, v, 0xD21E_0000 + camera) % 5) as u8 - 2
}
