//! The search for the sharpest position, with ends and motors of any kind; and cells that there are not.

use stereopsis::focus::{FocusConfig, FocusMap, FocusSearch, FocusSearchStep, NoFocus};
use stereopsis_host::scene::Random;

#[test]
fn a_motor_that_reports_another_range_is_searched_within_its_own() {
    let mut search = FocusSearch::new(100, 200);
    for frame in 0..u32::from(FocusSearch::MOST_FRAMES) + 3 {
        match search.next() {
            FocusSearchStep::Measure(position) => assert!((100..=200).contains(&position), "{position}"),
            FocusSearchStep::Best(position) => assert_eq!(position, 200),
            FocusSearchStep::Flat => {}
        }
        search.measured(500, 100 + 90 * frame);
    }
    assert_eq!(search.next(), FocusSearchStep::Best(200));
}

#[test]
fn contradictory_ends_are_put_in_order() {
    let mut searches = [FocusSearch::new(200, 100), FocusSearch::new(100, 200)];
    loop {
        let [backward, forward] = searches.each_ref().map(FocusSearch::next);
        assert_eq!(backward, forward);
        let FocusSearchStep::Measure(position) = forward else { break };
        let sharpness = 2000 - 25 * u32::from(position.abs_diff(140));
        searches.iter_mut().for_each(|search| search.measured(position, sharpness));
    }
    let FocusSearchStep::Best(best) = searches[0].next() else { panic!("a peak") };
    assert!(best.abs_diff(140) <= 2, "{best}");
}

/// Any ends, positions and sharpness: every step is in the range.
#[test]
fn steps_are_in_the_range() {
    for seed in 0..20_000 {
        let random = &mut Random::new(seed);
        let number = |random: &mut Random| {
            let any = random.bits() as u16;
            *random.pick(&[0, 1, 2, 63, 64, 65, 1023, u16::MAX - 1, u16::MAX, any, any])
        };
        let (a, b) = (number(random), number(random));
        let mut search = FocusSearch::new(a, b);
        for _ in 0..=FocusSearch::MOST_FRAMES {
            let position = match search.next() {
                FocusSearchStep::Measure(position) | FocusSearchStep::Best(position) => position,
                FocusSearchStep::Flat => a,
            };
            assert!((a.min(b)..=a.max(b)).contains(&position), "seed {seed}: {position} of {a} to {b}");
            let reported = if random.below(3) == 0 { number(random) } else { position };
            let any = random.bits() as u32;
            search.measured(reported, *random.pick(&[0, 1, any, any >> 16, u32::MAX]));
        }
    }
}

#[test]
fn there_is_no_cell_outside_of_the_picture() {
    let mut map = FocusMap::<32, 8, 64>::new();
    let none = Err(NoFocus::TooFewFrames { needed: 3 });
    map.start(&FocusConfig::tiles(32, 32)).expect("there is room");
    for far in [8, usize::MAX / 8 + 1, usize::MAX - 1, usize::MAX] {
        assert_eq!((map.peak(0, far), map.peak(far, 0), map.peak(far, far)), (none, none, none), "{far}");
    }
}
