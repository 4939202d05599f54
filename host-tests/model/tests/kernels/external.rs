//! Winners from outside: the rows that follow are those of the method itself, to the bit.

use super::any::{any_config, any_pattern};
use super::{D, Twin, W, difference, emulated};
use image::GrayImage;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::imaging::LineWindow;
use stereopsis::matching::{
    Block, Checks, Config, External, Fast, MatchError, Matcher, Method, Row, Sgm, SgmEdge, SgmLean,
    WinnerRecord,
};
use stereopsis_model::scene::pattern::Pattern;
use stereopsis_model::twin::Answers;
use stereopsis_model::twin::stages::Stages;

type Rest<S> = Matcher<External<S>, W, D>;

/// Takes a row that came out.
fn take(map: &mut Answers, row: Option<Row<'_>>) {
    if let Some(row) = row {
        map.disparity.extend_from_slice(row.disparities());
        map.flags.extend_from_slice(row.flags());
        map.confidence.extend_from_slice(row.confidences());
        map.sigma_px.extend((0..map.width).map(|x| row.sigma_px(x)));
    }
}

/// The rows that a matcher makes of winners; without the left picture where its checks do not look at it.
fn rows<S: Method>(matcher: &mut Rest<S>, winners: &[WinnerRecord], left: &GrayImage) -> Answers
where
    External<S>: Method,
{
    let (width, height) = (usize::from(matcher.config().width), usize::from(matcher.config().height));
    let (disparity, flags, sigma_px, confidence) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut map = Answers { width, height, disparity, flags, sigma_px, confidence };
    matcher.begin_frame();
    let mut window = LineWindow::<W>::new();
    window.begin(width);
    for y in 0..height + Rest::<S>::DELAY {
        let due = matcher.winners_due().map_or(&[][..], |row| &winners[usize::from(row) * width..][..width]);
        while window.count() < height.min(y + 3) {
            let line = &left.as_raw()[window.count() * width..][..width];
            window.next_line().copy_from_slice(line);
            window.accept();
        }
        if y < height {
            let lines = window.around(y);
            let lines = matcher.needs_lines().then_some(&lines);
            matcher.push_winners(lines, due).expect("a row");
        } else {
            matcher.flush_winners(due).expect("a row");
        }
        take(&mut map, matcher.row());
    }
    assert_eq!(matcher.flush_winners(&[]), Err(MatchError::FrameDone));
    map
}

fn compare<S: Twin>(config: &Config, pair: &(GrayImage, GrayImage)) -> Option<String>
where
    External<S>: Method,
{
    let stages = Stages::of(&S::TWIN, config, &pair.0, &pair.1);
    let mut matcher = Box::new(Rest::<S>::new());
    matcher.start(config).expect("a configuration that the method takes");
    // Twice: nothing is left of the frame before.
    for _ in 0..2 {
        let map = rows(&mut matcher, &stages.winners, &pair.0);
        if let Some(where_first) = difference(&map, &stages.answers) {
            return Some(format!("{}: {where_first}; {config:?}", S::NAME));
        }
    }
    None
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: if emulated() { 4 } else { 40 },
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_winners_from_outside_give_the_methods_rows(
        config in any_config(), pattern in any_pattern(), seed: u64
    ) {
        let pair = pattern.pair(u32::from(config.width), u32::from(config.height), seed);
        for differs in [
            compare::<Fast>(&config, &pair),
            compare::<Block>(&config, &pair),
            compare::<SgmLean>(&config, &pair),
            compare::<Sgm>(&config, &pair),
            compare::<SgmEdge>(&config, &pair),
        ] {
            prop_assert!(differs.is_none(), "{pattern:?}: {}", differs.unwrap_or_default());
        }
    }
}

#[test]
fn patterns_that_repeat_are_looked_for_in_the_left_image() {
    let checks = Checks { refuse_repeats: true, ..Checks::DENSE };
    let squares =
        GrayImage::from_fn(120, 30, |x, y| image::Luma([if (x / 6 + y / 6) % 2 == 1 { 180 } else { 60 }]));
    let config = Config { checks, ..Config::for_method::<Sgm>(120, 30, 32) };
    assert_eq!(compare::<Sgm>(&config, &(squares.clone(), squares)), None);
    let mut matcher = Box::new(Rest::<Sgm>::new());
    matcher.start(&config).expect("a configuration that fits");
    assert!(matcher.needs_lines());
    assert_eq!(matcher.push_winners(None, &[]), Err(MatchError::LineTooShort { needed: 120 }));
    // The methods over a window do not look for them.
    let mut matcher = Box::new(Rest::<Block>::new());
    matcher.start(&Config { checks, ..Config::for_method::<Block>(120, 30, 32) }).expect("it fits");
    assert!(!matcher.needs_lines());
}

#[test]
fn what_no_search_gives_is_refused_and_changes_nothing() {
    let config = Config::for_method::<Fast>(40, 12, 16);
    let (left, right) = Pattern::Noise.pair(40, 12, 3);
    let stages = Stages::of(&Fast::TWIN, &config, &left, &right);
    let mut matcher = Box::new(Rest::<Fast>::new());
    assert_eq!(matcher.push_winners(None, &[]), Err(MatchError::NotStarted));
    matcher.start(&config).expect("a configuration that fits");
    assert_eq!(matcher.push(&[&[0; 40]; 5], &[&[0; 40]; 5]), Err(MatchError::Winners { needed: 40 }));
    for _ in 0..Rest::<Fast>::WINNERS_ABOVE {
        assert_eq!(matcher.winners_due(), None);
        matcher.push_winners(None, &[]).expect("no winners are due");
    }
    assert_eq!(matcher.winners_due(), Some(0));
    let right_ones = &stages.winners[..40];
    assert_eq!(matcher.push_winners(None, &right_ones[..39]), Err(MatchError::Winners { needed: 40 }));
    let cost = right_ones[5].cost();
    for wrong in [
        WinnerRecord::new(6, 10, [20, 20]),
        WinnerRecord::new(255, 10, [20, 20]),
        WinnerRecord::new(2, 10, [9, 20]),
        WinnerRecord::new(2, 10, [20, 9]),
        WinnerRecord::new(2, 10, [20, 20]).with_second(9),
    ] {
        let mut winners = right_ones.to_vec();
        winners[5] = wrong;
        let refused = Err(MatchError::WinnerRefused { column: 5 });
        assert_eq!(matcher.push_winners(None, &winners), refused, "{cost} {wrong:?}");
    }
    assert_eq!(matcher.flush_winners(right_ones), Err(MatchError::FrameDone));
    let map = rows(&mut matcher, &stages.winners, &left);
    assert_eq!(difference(&map, &stages.answers), None);
}
