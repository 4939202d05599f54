//! Random frames and faults through blocks of several sizes.

use super::block::{Block, LEAST_WIDTH};
use super::frame::Halves;
use super::simulation::Spoiled;
use crate::steps::{Failure, Outcome};
use stereopsis::imaging::Noise;
use stereopsis::matching::{Checks, Config, Filter};
use stereopsis::pipeline::winners::{Register, RegisterBus, status};
use stereopsis_host::run::MethodName;
use stereopsis_host::scene::Random;
use stereopsis_host::scene::pattern::Pattern;
use stereopsis_host::twin::stages::Stages;
use stereopsis_host::winners::without_second_best;

/// The pictures: noise, blank, saturated, with many ties, and ones that have answers.
const PATTERNS: [Pattern; 8] = [
    Pattern::Shifted { most: 14, noise_grey: 1.0 },
    Pattern::Noise,
    Pattern::Constant(0),
    Pattern::Constant(255),
    Pattern::Saturated,
    Pattern::FewLevels(3),
    Pattern::HalfBlank,
    Pattern::Checkerboard(3),
];

/// Every kind of picture once, and every fault, through one block of each method.
pub fn sample() -> Outcome {
    for block in [
        Block { width: 72, disparities: 32, parallel: 32, method: MethodName::Fast, second_best: false },
        Block { width: 72, disparities: 32, parallel: 8, method: MethodName::Block, second_best: true },
        Block { width: 72, disparities: 32, parallel: 8, method: MethodName::Sgm, second_best: true },
    ] {
        check(&block, 8)?;
    }
    lint()
}

/// At least 1000 rows of every kind of picture through each of many blocks.
pub fn all() -> Outcome {
    // What takes longest comes first.
    for method in super::block::METHODS.into_iter().rev() {
        for (width, disparities, parallel, second_best) in [
            (64, 16, 16, false),
            (80, 48, 16, true),
            (100, 48, 48, true),
            (140, 128, 64, false),
            (64, 16, 1, true),
        ] {
            check(&Block { width, disparities, parallel, method, second_best }, 1000)?;
        }
    }
    lint()
}

/// Blocks at the ends of their parameters, which nothing is simulated of.
fn lint() -> Outcome {
    for method in super::block::METHODS {
        for (width, disparities, parallel) in [(1280, 128, 128), (1280, 128, 16), (640, 64, 64), (64, 16, 1)]
        {
            for second_best in [false, true] {
                Block { width, disparities, parallel, method, second_best }.lint()?;
            }
        }
    }
    Ok(())
}

/// At least so many rows of every kind of picture through a block, and every fault.
fn check(block: &Block, rows: usize) -> Outcome {
    let mut halves = Halves::new(block)?;
    let mut random = Random::new(u64::from(block.width) + u64::from(block.parallel));
    let (mut frames, mut all) = (0, 0);
    for pattern in PATTERNS {
        let mut taken = 0;
        while taken < rows {
            let height = *pick(&mut random, &[1, 2, 3, 9, 14, 24]);
            frame(block, &mut halves, pattern, height, &mut random)?;
            taken += usize::from(height);
            frames += 1;
        }
        all += taken;
    }
    faults(block, &mut halves, &mut random)?;
    println!("{}: {all} rows in {frames} frames, no bit apart; faults are told", block.name());
    Ok(())
}

fn pick<'a, T>(random: &mut Random, from: &'a [T]) -> &'a T {
    &from[random.below(from.len())]
}

/// One frame of a random size and search, held to the twin: winners and rows.
fn frame(block: &Block, halves: &mut Halves, pattern: Pattern, height: u16, random: &mut Random) -> Outcome {
    let any = |random: &mut Random, least: u16, most: u16| {
        let between = least + random.below(usize::from(most - least) + 1) as u16;
        *pick(random, &[least, most, between])
    };
    let disparities = any(random, 16, block.disparities);
    let width = any(random, disparities.max(LEAST_WIDTH), block.width);
    let noise = *pick(random, &[Noise::None, Noise::None, Noise::Low, Noise::High]);
    let (most, some) = (*pick(random, &[width - 1, 255]), 1 + random.below(40) as u16);
    let min_disparity = *pick(random, &[0, 0, 0, 1, some, most]);
    let search = Config { noise, min_disparity, ..block.method.config(width, height, disparities) };
    let filter = if block.second_best { *pick(random, &Filter::ALL) } else { Filter::Default };
    let confidence = block.second_best && random.below(2) == 1;
    let search = block.method.with_filter(filter, search);
    // Some filters ask for the second best, which a block without it refuses.
    let uniqueness_percent = search.checks.uniqueness_percent.filter(|_| block.second_best);
    let search = Config { confidence, checks: Checks { uniqueness_percent, ..search.checks }, ..search };
    let [gaps, stalls] = [(); 2].map(|()| *pick(random, &[0, 25, 60]));
    let failed = |what: &str| {
        Failure::new(format!("{} with {pattern:?}, {search:?}, pauses {gaps} {stalls}: {what}", block.name()))
    };
    let seed = random.below(1 << 30) as u32;
    halves.simulation().pause(seed, gaps, stalls).map_err(|e| failed(&e.to_string()))?;
    let (left, right) = pattern.pair(width.into(), height.into(), seed.into());
    // A frame alone, or one right behind another.
    let frames = *pick(random, &[1, 2]);
    let map = halves.frames(frames, &search, [&left, &right]).map_err(|e| failed(&e.to_string()))?;
    let stages = Stages::of(&block.method.twin(), &search, &left, &right);
    let winners =
        if block.second_best { stages.winners } else { without_second_best(stages.winners) }.repeat(frames);
    let taken = &halves.simulation().taken;
    // Left of the smallest disparity a record says nothing.
    let differs = |at: usize| {
        let is_empty = at % usize::from(width) < usize::from(min_disparity);
        let row = (at / usize::from(width) % usize::from(height)) as u16;
        if is_empty { !taken[at].is_intact(row) } else { taken[at] != winners[at] }
    };
    let at = (0..taken.len().min(winners.len())).find(|&at| differs(at));
    if taken.len() != winners.len() || at.is_some() {
        return Err(failed(&format!("{} records, the first that differs: {at:?}", taken.len())));
    }
    if map.disparity != stages.answers.disparity || map.flags != stages.answers.flags {
        return Err(failed("the rows differ"));
    }
    if confidence && map.confidence != stages.answers.confidence {
        return Err(failed("the confidences differ"));
    }
    Ok(())
}

/// Lines of a wrong length, a frame cut off, and values that there is no room for: each is told, and the next
/// frame is right.
fn faults(block: &Block, halves: &mut Halves, random: &mut Random) -> Outcome {
    let config = block.method.config(block.width, 14, 16);
    let (left, right) = Pattern::Noise.pair(block.width.into(), 14, 1);
    for (spoiled, bit, said) in [
        (Spoiled::Short(0), status::TOO_SHORT, "wrong length"),
        (Spoiled::Short(11), status::TOO_SHORT, "wrong length"),
        (Spoiled::Long(6), status::TOO_LONG, "wrong length"),
        (Spoiled::CutOff(9), status::CUT_OFF, "cut off"),
    ] {
        let failed = |what: String| Failure::new(format!("{} with {spoiled:?}: {what}", block.name()));
        halves.simulation().spoiled = Some(spoiled);
        match halves.frames(1, &config, [&left, &right]) {
            Err(e) if e.to_string().contains(said) => {}
            Err(e) => return Err(failed(e.to_string())),
            Ok(_) => return Err(failed("nothing is told".into())),
        }
        halves.simulation().spoiled = None;
        let left_over = halves.simulation().read(Register::Status).map_err(|e| failed(e.to_string()))?;
        if left_over & bit != 0 {
            return Err(failed("the status was not cleared".into()));
        }
        frame(block, halves, PATTERNS[0], 12, random)?;
    }
    for config in [
        Config { width: block.width + 1, ..config },
        Config { width: 15, ..config },
        Config { height: 0, ..config },
        Config { disparities: block.disparities + 1, ..config },
        Config { disparities: 15, ..config },
    ] {
        let failed = |what: &str| Failure::new(format!("{} for {config:?}: {what}", block.name()));
        let simulation = halves.simulation();
        let size = u32::from(config.width) | u32::from(config.height) << 16;
        let writes = [
            (Register::Control, 0),
            (Register::Size, size),
            (Register::Search, config.disparities.into()),
            (Register::Control, 1),
        ];
        for (register, value) in writes {
            simulation.write(register, value).map_err(|e| failed(&e.to_string()))?;
        }
        let told = simulation.read(Register::Status).map_err(|e| failed(&e.to_string()))?;
        let enabled = simulation.read(Register::Control).map_err(|e| failed(&e.to_string()))?;
        if told & status::BAD_VALUE == 0 || enabled != 0 {
            return Err(failed("the block takes it"));
        }
    }
    frame(block, halves, PATTERNS[0], 12, random)
}
