//! Each target on its seeds, on seeds that are spoiled, and on bytes by chance: the short form of a campaign.

use arbitrary::Unstructured;
use std::fs;
use std::path::PathBuf;
use stereopsis_fuzz::{TARGETS, Target};
use stereopsis_model::scene::Random;

/// The folder of a target's seeds: what it begins with, and what was once found.
fn seeds(target: &Target) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("seeds").join(target.name)
}

fn bytes(random: &mut Random, most: usize) -> Vec<u8> {
    let length = random.below(most);
    // Small numbers as often as any: the first byte of a choice is mostly small.
    let is_small = random.below(2) == 0;
    (0..length).map(|_| if is_small { random.byte() % 16 } else { random.byte() }).collect()
}

/// A byte is another, some are gone, some are there twice.
fn spoiled(seed: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..1 + random.below(4) {
        let at = random.below(bytes.len() + 1);
        let end = (at + random.below(20)).min(bytes.len());
        match random.below(4) {
            0 => drop(bytes.drain(at..end)),
            1 => bytes.extend_from_within(at..end),
            2 => bytes.truncate(at),
            _ => bytes[at..end].iter_mut().take(1).for_each(|byte| *byte = random.byte()),
        }
    }
    bytes
}

/// Runs a case; whether the bytes held one.
fn holds(target: &Target, bytes: &[u8]) -> bool {
    let caught = std::panic::catch_unwind(|| (target.run)(&mut Unstructured::new(bytes)));
    let Ok(outcome) = caught else { panic!("{}: these bytes break it: {bytes:02x?}", target.name) };
    outcome.is_ok()
}

fn short(name: &str, cases: u64) {
    let target = stereopsis_fuzz::target(name).expect("a target");
    // An interpreter that looks at every access takes a thousand times as long.
    let cases = if cfg!(miri) { cases / 50 } else { cases };
    let mut held = 0;
    for entry in fs::read_dir(seeds(target)).into_iter().flatten() {
        let seed = fs::read(entry.expect("an entry").path()).expect("a seed");
        held += u64::from(holds(target, &seed));
        let random = &mut Random::new(1);
        for _ in 0..cases / 4 {
            holds(target, &spoiled(&seed, random));
        }
    }
    let random = &mut Random::new(2026);
    for _ in 0..cases {
        held += u64::from(holds(target, &bytes(random, 900)));
    }
    assert!(held * 4 >= cases, "{held} of {cases} inputs held a case");
}

macro_rules! short {
    ($($name:ident: $cases:literal,)*) => {
        $(#[test]
        fn $name() {
            short(stringify!($name), $cases);
        })*

        #[test]
        fn every_target_has_a_test() {
            let names: Vec<_> = TARGETS.iter().map(|target| target.name).collect();
            assert_eq!(names, [$(stringify!($name)),*]);
        }
    };
}

short! {
    matching: 150,
    guarded: 400,
    remap: 400,
    records: 1000,
    geometry: 20_000,
    features: 300,
    templates: 4000,
    focus: 300,
    control: 4000,
    odometry: 200,
    sensors: 4000,
    calibrations: 400,
    images: 400,
    tables: 400,
    problems: 400,
    recordings: 2000,
    lines: 4000,
    calls: 2000,
}
