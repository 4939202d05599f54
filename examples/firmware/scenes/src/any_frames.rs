//! Frames of any size, with any checks and penalties that there can be: a checksum of each method's answers
//! to each.
//!
//! It knows no hardware: the same runs on the host, whose kernels are held to their naive twins, and every
//! checksum is compared.

use stereopsis::imaging::Noise;
use stereopsis::matching::{
    Block, Checks, Config, ConfigError, Fast, Filter, MatchError, Matcher, Method, Penalties, Row, Sgm,
    SgmEdge, SgmLean,
};

/// Most pixels in a line.
pub const WIDTH: usize = 168;
/// Most lines of a frame.
const HEIGHT: u32 = 14;
/// Frames of each method and capacity.
const FRAMES: u32 = 80;

/// The matchers of a method: with room for one, two and four vectors of candidates, and for any number.
struct Matchers<S: Method> {
    of_16: Matcher<S, WIDTH, 16>,
    of_32: Matcher<S, WIDTH, 32>,
    of_64: Matcher<S, WIDTH, 64>,
    of_any: Matcher<S, WIDTH, 112>,
}

impl<S: Method> Matchers<S> {
    const fn new() -> Self {
        Self { of_16: Matcher::new(), of_32: Matcher::new(), of_64: Matcher::new(), of_any: Matcher::new() }
    }

    fn run(&mut self, lines: &mut Lines, put: &mut impl FnMut(u32)) -> Result<(), Broken> {
        for number in 0..FRAMES {
            put(frame(&mut self.of_16, lines, number)?);
            put(frame(&mut self.of_32, lines, number)?);
            put(frame(&mut self.of_64, lines, number)?);
            put(frame(&mut self.of_any, lines, number)?);
        }
        Ok(())
    }
}

/// All methods' matchers.
pub struct AnyFrames {
    fast: Matchers<Fast>,
    block: Matchers<Block>,
    lean: Matchers<SgmLean>,
    sgm: Matchers<Sgm>,
    edge: Matchers<SgmEdge>,
    lines: Lines,
}

/// Five lines of both cameras.
type Lines = [[[u8; WIDTH]; 5]; 2];

/// Why there is no frame; which there is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Broken {
    /// The matcher cannot do what is asked.
    Config(ConfigError),
    /// A line was not due.
    Line(MatchError),
}

impl AnyFrames {
    /// Nothing was matched yet.
    pub const fn new() -> Self {
        Self {
            fast: Matchers::new(),
            block: Matchers::new(),
            lean: Matchers::new(),
            sgm: Matchers::new(),
            edge: Matchers::new(),
            lines: [[[0; WIDTH]; 5]; 2],
        }
    }

    /// Matches all frames and gives the checksums one after another.
    ///
    /// # Errors
    /// When a matcher cannot do what is asked; which it can.
    pub fn run(&mut self, mut put: impl FnMut(u32)) -> Result<(), Broken> {
        self.fast.run(&mut self.lines, &mut put)?;
        self.block.run(&mut self.lines, &mut put)?;
        self.lean.run(&mut self.lines, &mut put)?;
        self.sgm.run(&mut self.lines, &mut put)?;
        self.edge.run(&mut self.lines, &mut put)
    }
}

impl Default for AnyFrames {
    fn default() -> Self {
        Self::new()
    }
}

/// A frame's checksum.
fn frame<S: Method, const D: usize>(
    matcher: &mut Matcher<S, WIDTH, D>,
    lines: &mut Lines,
    number: u32,
) -> Result<u32, Broken> {
    let mut chance = Chance(number.wrapping_mul(0x9E37_79B9) ^ D as u32);
    let config = config::<S>(&mut chance, D as u32);
    let picture = Picture { seed: chance.next(), grain: 1 + chance.below(3), kind: chance.below(4) };
    matcher.start(&config).map_err(Broken::Config)?;
    matcher.begin_frame();
    let mut sum = 0xffff;
    let (width, height) = (usize::from(config.width), u32::from(config.height));
    for y in 0..height + 32 {
        if y < height {
            for (right, lines) in lines.iter_mut().enumerate() {
                for (line, v) in lines.iter_mut().zip(y..) {
                    let v = v.saturating_sub(2).min(height - 1);
                    for (pixel, u) in line.iter_mut().zip(0..).take(width) {
                        *pixel = picture.pixel(u, v, right as u32);
                    }
                }
            }
            let [left, right] = lines
                .each_ref()
                .map(|lines| lines.each_ref().map(|line| line.get(..width).unwrap_or_default()));
            matcher.push(&left, &right).map_err(Broken::Line)?;
        } else if matcher.flush().is_err() {
            break;
        }
        if let Some(row) = matcher.row() {
            sum = summed(sum, &row);
        }
    }
    Ok(sum)
}

/// A checksum (FNV-1a) with a row.
fn summed(sum: u32, row: &Row<'_>) -> u32 {
    let add = |sum: u32, byte: u8| (sum ^ u32::from(byte)).wrapping_mul(0x0100_0193);
    let answers = row.disparities().iter().flat_map(|d| d.raw().to_le_bytes());
    let flags = row.flags().iter().map(|flags| flags.bits());
    answers.chain(flags).chain(row.confidences().iter().copied()).fold(sum, add)
}

/// What is asked of a frame, by chance, for a matcher with room for `most` disparities.
fn config<S: Method>(chance: &mut Chance, most: u32) -> Config {
    let narrow = if chance.below(3) == 0 { 24 } else { WIDTH as u32 };
    let width = (1 + chance.below(narrow)) as u16;
    let disparities = if chance.below(2) == 0 { most } else { 16 + chance.below(most - 15) } as u16;
    let config = Config {
        min_disparity: [0, 0, 0, 1, 7, 40, 200].get(chance.below(7) as usize).copied().unwrap_or(0),
        confidence: chance.below(2) == 0,
        noise: [Noise::None, Noise::None, Noise::Low, Noise::High]
            .get(chance.below(4) as usize)
            .copied()
            .unwrap_or(Noise::None),
        ..Config::for_method::<Block>(width, (1 + chance.below(HEIGHT)) as u16, disparities)
    };
    let filter = [Filter::Default, Filter::Strict].get(chance.below(2) as usize).copied();
    let config = config.with_filter::<S>(filter.unwrap_or(Filter::Default));
    let checks = if chance.below(3) == 0 { Checks::DENSE } else { config.checks };
    let penalties = if chance.below(4) == 0 { config.penalties } else { penalties(chance) };
    Config { checks, penalties, ..config }
}

/// Penalties by chance, of those that there can be: often as large as they may be.
fn penalties(chance: &mut Chance) -> Penalties {
    let cost = 1 + chance.below(40);
    let step = 1 + chance.below((126 - cost) / 2);
    // Cost, step and jump are at most 127, three costs and two jumps at most 254.
    let most = (127 - cost - step).min((254 - 3 * cost) / 2).max(step);
    let step = step.min(most);
    let small_step = if chance.below(2) == 0 { step } else { 1 + chance.below(step) };
    let is_extreme = chance.below(2) == 0;
    let mut jump = |least: u32| {
        let jump = least + chance.below(most - least + 1);
        if is_extreme { most as u8 } else { jump as u8 }
    };
    let jump = [jump(step), jump(small_step), jump(small_step)];
    let edge = chance.below(40) as u8;
    Penalties {
        gradient: (1 + chance.below(u32::from(Penalties::MOST_GRADIENT))) as u8,
        cost: cost as u8,
        step: [step as u8, small_step as u8],
        jump,
        edges: [edge, edge + chance.below(60) as u8],
    }
}

/// What the cameras see.
struct Picture {
    seed: u32,
    grain: u32,
    kind: u32,
}

impl Picture {
    fn pixel(&self, u: u32, v: u32, right: u32) -> u8 {
        let disparity = if u / 24 % 3 == 1 { 21 } else { 4 + v / 5 };
        let seen = (u + right * disparity) / self.grain;
        let texture =
            mixed(seen.wrapping_mul(0x9E37_79B1) ^ (v / self.grain).wrapping_mul(0x85EB_CA77) ^ self.seed);
        let noise = mixed(u.wrapping_mul(0xC2B2_AE3D) ^ v.wrapping_mul(0x27D4_EB2F) ^ right ^ self.seed);
        match self.kind {
            0 => ((texture & 0xff) * 3 / 4 + noise % 5) as u8,
            // Faint, with much noise.
            1 => (100 + texture % 6 + noise % 9) as u8,
            // Black and white: what differs does so as much as it can.
            2 => 0u8.wrapping_sub((texture & 1) as u8),
            _ => noise as u8,
        }
    }
}

/// Numbers by chance.
struct Chance(u32);

impl Chance {
    fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9E37_79B9);
        mixed(self.0)
    }

    /// One below `count`; 0 where there is none.
    fn below(&mut self, count: u32) -> u32 {
        self.next().checked_rem(count).unwrap_or(0)
    }
}

/// All bits depend on all bits.
fn mixed(n: u32) -> u32 {
    let n = (n ^ (n >> 16)).wrapping_mul(0x2C1B_3C6D);
    let n = (n ^ (n >> 15)).wrapping_mul(0x297A_2D39);
    n ^ (n >> 16)
}
