//! What has no room is counted, and what makes no sense is refused by name.

use super::{config, detect, rows_aligned};
use stereopsis::features::{
    CornerSlot, Epipolar, FeatureConfig, FeatureConfigError, FeatureDetector, FeatureDetectorState,
    FeatureDetectorView, FeatureLineError, FeatureMatcher, FeatureMatcherView, MatchConfig, MatchConfigError,
    MatchSlot,
};
use stereopsis_host::scene::pattern::Pattern;

#[test]
fn a_full_list_counts_what_it_leaves_out() {
    let image = Pattern::Noise.pair(120, 90, 1).0;
    let config = config(&image);
    let (all, _) = detect(&config, &image);
    let mut detector = FeatureDetector::<120, 20>::new();
    let mut list = heapless::Vec::<_, 7>::new();
    detector.start(&config).expect("within the capacity");
    for line in image.as_raw().chunks_exact(120) {
        detector.push(line, list.as_mut_view()).expect("a line that is due");
    }
    assert_eq!(list, all[..7]);
    assert_eq!(detector.counts().dropped as usize, all.len() - 7);

    let mut matches = heapless::Vec::<_, 3>::new();
    let dropped = FeatureMatcher::<200>::new().run(&all, &all, &MatchConfig::new(), matches.as_mut_view());
    assert_eq!((matches.len(), dropped), (3, Ok(all.len() as u32 - 3)));
    assert!(matches.iter().all(|m| m.left == m.right && m.different == 0));
}

#[test]
fn a_detector_says_what_would_have_been_enough() {
    let mut detector = FeatureDetector::<64, 10>::new();
    let good = FeatureConfig::new(64, 64);
    assert_eq!(
        detector.start(&FeatureConfig { width: 65, ..good }),
        Err(FeatureConfigError::Width { most: 64 })
    );
    assert_eq!(
        detector.start(&FeatureConfig { per_cell: 6, ..good }),
        Err(FeatureConfigError::Slots { needed: 12 })
    );
    for bad in [FeatureConfig { cell_px: 15, ..good }, FeatureConfig { cell_px: 0, ..good }] {
        assert_eq!(detector.start(&bad), Err(FeatureConfigError::Cells));
    }
    assert_eq!(detector.start(&FeatureConfig { per_cell: 0, ..good }), Err(FeatureConfigError::Cells));
    assert!(detector.start(&FeatureConfig { per_cell: 65535, cell_px: 16, ..good }).is_err());
}

#[test]
fn lines_are_due_between_start_and_the_last() {
    let mut detector = FeatureDetector::<64, 10>::new();
    let mut list = heapless::Vec::<_, 8>::new();
    let mut push = |detector: &mut FeatureDetector<64, 10>, width: usize| {
        detector.push(&[7; 64][..width], list.as_mut_view())
    };
    assert_eq!(push(&mut detector, 64), Err(FeatureLineError::NoLineDue));
    detector.start(&FeatureConfig::new(64, 2)).expect("within the capacity");
    assert_eq!(push(&mut detector, 63), Err(FeatureLineError::Length { needed: 64 }));
    assert_eq!(
        [64, 64, 64].map(|width| push(&mut detector, width)),
        [Ok(()), Ok(()), Err(FeatureLineError::NoLineDue)]
    );
}

#[test]
fn a_frame_that_was_cut_off_leaves_nothing() {
    let (image, other) = Pattern::Noise.pair(120, 90, 2);
    let mut detector = FeatureDetector::<120, 20>::new();
    let mut list = heapless::Vec::<_, 400>::new();
    let config = config(&image);
    detector.start(&config).expect("within the capacity");
    for line in other.as_raw().chunks_exact(120).take(60) {
        detector.push(line, list.as_mut_view()).expect("a line that is due");
    }
    list.clear();
    detector.start(&config).expect("within the capacity");
    for line in image.as_raw().chunks_exact(120) {
        detector.push(line, list.as_mut_view()).expect("a line that is due");
    }
    let (expected, counts) = detect(&config, &image);
    assert_eq!((&list[..], detector.counts()), (&expected[..], counts));
}

#[test]
fn a_search_that_makes_no_sense() {
    let run = |search: MatchConfig| {
        FeatureMatcher::<4>::new().run(&[], &[], &search, heapless::Vec::<_, 1>::new().as_mut_view())
    };
    let every = MatchConfig::new();
    assert_eq!(run(every), Ok(0));
    for ratio_percent in [0, 101] {
        assert_eq!(run(MatchConfig { ratio_percent, ..every }), Err(MatchConfigError::Ratio));
    }
    for bad in [f32::NAN, -1.0] {
        assert_eq!(run(MatchConfig { along_px: bad, ..every }), Err(MatchConfigError::Range));
        assert_eq!(run(MatchConfig { across_px: bad, ..every }), Err(MatchConfigError::Range));
        assert_eq!(run(MatchConfig { apart_px: bad, ..every }), Err(MatchConfigError::Range));
        let epipolar = Some(Epipolar { fundamental: rows_aligned(), tolerance_px: bad });
        assert_eq!(run(MatchConfig { epipolar, ..every }), Err(MatchConfigError::Epipolar));
    }
    let image = Pattern::Noise.pair(120, 90, 1).0;
    let (all, _) = detect(&config(&image), &image);
    let mut matches = heapless::Vec::<_, 3>::new();
    let refused = FeatureMatcher::<4>::new().run(&all[..2], &all[..5], &every, matches.as_mut_view());
    assert_eq!(refused, Err(MatchConfigError::TooMany { needed: 5 }));
}

#[test]
fn vectors_serve_as_memory_and_short_ones_are_named() {
    let image = Pattern::Noise.pair(120, 90, 1).0;
    let config = config(&image);
    let (features, counts) = detect(&config, &image);
    let mut state = FeatureDetectorState::new();
    let mut lines = vec![7; 120 * FeatureDetectorView::LINE_BYTES];
    let mut slots = vec![CornerSlot::EMPTY; 2 * config.slots()];
    let mut list = heapless::Vec::<_, 400>::new();
    FeatureDetectorView::new(&mut state, &mut lines, &mut slots)
        .and_then(|mut view| view.start(&config))
        .expect("as long as it takes");
    for line in image.as_raw().chunks_exact(120) {
        // A view made anew goes on where the last one was.
        let mut view = FeatureDetectorView::new(&mut state, &mut lines, &mut slots).expect("as before");
        view.push(line, list.as_mut_view()).expect("a line that is due");
    }
    assert_eq!((&list[..], state.counts()), (&features[..], counts));
    // Both for a frame under way and for one that begins.
    for mut state in [state, FeatureDetectorState::new()] {
        let mut refused = |pixels: usize, slots: &mut [CornerSlot]| {
            let lines = &mut lines[..pixels * FeatureDetectorView::LINE_BYTES];
            FeatureDetectorView::new(&mut state, lines, slots).and_then(|mut view| view.start(&config)).err()
        };
        assert_eq!(refused(119, &mut slots), Some(FeatureConfigError::Width { most: 119 }));
        let needed = config.slots();
        let short = &mut slots[..2 * needed - 1];
        assert_eq!(refused(120, short), Some(FeatureConfigError::Slots { needed }));
    }
    let search = MatchConfig::new();
    let run = |slots: &mut [MatchSlot]| {
        let mut matches = heapless::Vec::<_, 400>::new();
        let dropped = FeatureMatcherView::new(slots).run(&list, &list, &search, matches.as_mut_view());
        (dropped, matches.len())
    };
    let mut slots = vec![MatchSlot::EMPTY; list.len()];
    assert_eq!(run(&mut slots), (Ok(0), list.len()));
    let needed = list.len();
    assert_eq!(run(&mut slots[1..]), (Err(MatchConfigError::TooMany { needed }), 0));
}
