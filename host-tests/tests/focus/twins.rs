//! Sharpness, peaks and medians equal their naive twins, bit for bit, at every awkward size.

use image::{GrayImage, Luma};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::focus::{
    Breathing, FocusCell, FocusConfig, FocusConfigError, FocusLineError, FocusMap, FocusMapState,
    FocusMapView, FocusPeak, Measure, NoFocus, SharpnessRows, binomial, laplacian, median_row,
    modified_laplacian, plane_row, tenengrad,
};
use stereopsis_host::focus::memory::MapMemory;
use stereopsis_host::scene::Random;
use stereopsis_host::twin::{focus as twin, focus_smoothing as smoothing};

fn noise(width: u32, height: u32, seed: u64, contrast: u8) -> GrayImage {
    let mut random = Random::new(seed);
    GrayImage::from_fn(width, height, |_, _| {
        Luma([(u16::from(random.byte()) * u16::from(contrast) / 255) as u8])
    })
}

/// Every row of a function of three rows, those outside repeated.
fn rows<T: Copy + Default + Into<i64>>(picture: &GrayImage, row: impl Fn([&[u8]; 3], &mut [T])) -> Vec<i64> {
    let width = picture.width() as usize;
    let lines: Vec<_> = picture.chunks_exact(width).collect();
    let last = lines.len() - 1;
    let mut all = Vec::new();
    for y in 0..lines.len() {
        let mut out = vec![T::default(); width];
        row([lines[y.saturating_sub(1)], lines[y], lines[(y + 1).min(last)]], &mut out);
        all.extend(out.into_iter().map(Into::into));
    }
    all
}

pub type Peaks = Vec<Result<FocusPeak, NoFocus>>;

/// The core's peaks of a stack, and which cells each frame was told to be sharper in.
fn map(config: &FocusConfig, frames: &[GrayImage], scales: &[f32]) -> (Peaks, Vec<Vec<bool>>) {
    let mut memory = MapMemory::new(config);
    let mut map = memory.view().expect("of its size");
    map.start(config).expect("within the capacity");
    let mut sharper = Vec::new();
    for (frame, &scale) in frames.iter().zip(scales) {
        map.begin_frame(Breathing::new(scale).expect("a scale")).expect("a frame that is due");
        let mut told = Vec::new();
        for line in frame.chunks_exact(config.width.into()) {
            map.push(line, |row| {
                assert_eq!(row.index * config.columns(), told.len());
                told.extend_from_slice(row.sharper);
            })
            .expect("a line that is due");
        }
        assert_eq!(told.len(), config.cells());
        sharper.push(told);
    }
    map.finish().expect("whole frames");
    let peaks = (0..config.cells()).map(|i| map.peak(i % config.columns(), i / config.columns()));
    (peaks.collect(), sharper)
}

pub fn plain(peak: &Result<FocusPeak, NoFocus>) -> Option<twin::Peak> {
    peak.ok().map(|p| [p.position_q8.into(), p.sigma_q8.into(), p.noise_q8.into(), p.confidence.into()])
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000,
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn rows_are_their_twins(width in 1..20_u32, height in 1..9_u32, seed: u64) {
        let picture = noise(width, height, seed, 255);
        let numbers = twin::numbers(&picture);
        prop_assert_eq!(rows(&picture, binomial), twin::binomial(&numbers).values);
        prop_assert_eq!(rows(&picture, modified_laplacian::<u8>), twin::modified_laplacian(&numbers).values);
        prop_assert_eq!(rows(&picture, tenengrad), twin::tenengrad(&numbers).values);
        prop_assert_eq!(rows(&picture, laplacian), twin::laplacian(&numbers).values);
    }

    #[test]
    fn windows_are_their_twins(width in 1..20_u16, height in 1..12_u16, radius in 0..=3_u8, seed: u64) {
        let picture = noise(width.into(), height.into(), seed, 255);
        for measure in [Measure::Robust, Measure::ModifiedLaplacian, Measure::Tenengrad,
            Measure::LaplacianVariance] {
            let mut core = SharpnessRows::<20>::new();
            core.start(width, height, measure, radius);
            let mut all = Vec::new();
            for line in picture.chunks_exact(width.into()) {
                core.push(line, |y, row| {
                    assert_eq!(y * usize::from(width), all.len());
                    all.extend(row.iter().map(|&v| i64::from(v)));
                })
                .expect("a line that is due");
            }
            prop_assert_eq!(core.push(&vec![0; width.into()], |_, _| {}), Err(FocusLineError::NoLineDue));
            prop_assert_eq!(all, twin::sharpness(&picture, measure, radius.into()).values, "{:?}", measure);
        }
    }

    #[test]
    fn peaks_are_their_twins(
        (width, height) in (1..24_u16, 1..14_u16), cell_px in 1..9_u16, radius in 0..=3_u8,
            count in 3..20_usize,
        exposure_varies: bool, breathing: bool, seed: u64,
    ) {
        let radius = if cell_px > 2 { radius.min(1) } else { radius };
        let config = FocusConfig { width, height, cell_px, radius, exposure_varies };
        let mut random = Random::new(seed);
        let top = random.below(count) as i64;
        let frames: Vec<_> = (0..count as i64)
            .map(|i| noise(width.into(), height.into(), seed ^ i as u64,
                (255 >> (i - top).abs().min(7)) as u8))
            .collect();
        let scales: Vec<f32> = (0..count)
            .map(|_| if breathing { 0.8 + 0.5 * random.unit() as f32 } else { 1.0 }).collect();
        let (peaks, sharper) = map(&config, &frames, &scales);
        let expected = twin::peaks(&config, &frames, &scales);
        prop_assert_eq!(peaks.iter().map(plain).collect::<Vec<_>>(), expected.clone());
        prop_assert!(sharper[0].iter().all(|&s| s));

        let columns = config.columns();
        let lines: Vec<_> = peaks.chunks_exact(columns).collect();
        let at = |y: isize| lines[y.clamp(0, lines.len() as isize - 1) as usize];
        let mut medians = peaks.clone();
        for (y, out) in (0..).zip(medians.chunks_exact_mut(columns)) {
            median_row([at(y - 2), at(y - 1), at(y), at(y + 1), at(y + 2)], out);
        }
        let middle: Vec<_> = medians.iter().map(plain).collect();
        prop_assert_eq!(&middle, &smoothing::median(columns, &expected));

        for (y, out) in medians.chunks_exact_mut(columns).enumerate() {
            plane_row(&peaks, columns, y, out);
        }
        for (found, exact) in medians.iter().zip(smoothing::planes(columns, &expected, &middle)) {
            // Rounding to 1/256, and that of 49 sums of 24 bits in a system whose condition the ridge bounds
            // by 1000; a step that is nearly too long may be taken or not.
            let is_near = match (found.ok(), exact) {
                (Some(found), Some((exact, is_close))) =>
                    is_close || (f64::from(found.position_q8) - exact).abs() <= 1.0,
                (found, exact) => found.is_none() && exact.is_none(),
            };
            prop_assert!(is_near, "{:?} {:?}", found, exact);
        }
    }
}

#[test]
fn the_largest_sums_do_not_overflow() {
    // Checks of black and white squares: the largest that each measure can be, in the widest windows.
    let checks = GrayImage::from_fn(40, 24, |x, y| Luma([if (x + y) % 2 == 0 { 255 } else { 0 }]));
    let stripes = GrayImage::from_fn(40, 24, |x, _| Luma([if x / 2 % 2 == 0 { 255 } else { 0 }]));
    for picture in [&checks, &stripes] {
        for (cell_px, radius) in [(1, 3), (8, 1), (128, 0)] {
            let config = FocusConfig { width: 40, height: 24, cell_px, radius, exposure_varies: true };
            let frames = [picture.clone(), stripes.clone(), checks.clone()];
            let (peaks, _) = map(&config, &frames, &[1.0; 3]);
            assert_eq!(peaks.iter().map(plain).collect::<Vec<_>>(), twin::peaks(&config, &frames, &[1.0; 3]));
        }
        let mut core = SharpnessRows::<40>::new();
        for measure in [Measure::Robust, Measure::Tenengrad, Measure::LaplacianVariance] {
            core.start(40, 24, measure, 3);
            let mut all = Vec::new();
            for line in picture.chunks_exact(40) {
                core.push(line, |_, row| all.extend(row.iter().map(|&v| i64::from(v))))
                    .expect("a line that is due");
            }
            assert_eq!(all, twin::sharpness(picture, measure, 3).values);
        }
    }
}

#[test]
fn memory_that_is_too_short_is_named() {
    let config = FocusConfig::tiles(16, 16);
    let (columns, cells) = (config.columns(), config.cells());
    let refused = |width: usize, columns: usize, cells: usize, started: bool| {
        let mut state = FocusMapState::new();
        let mut whole = (vec![0; 48], vec![0; 80], vec![0; 17 * columns.max(2)], vec![false; columns.max(2)]);
        let mut all = vec![FocusCell::EMPTY; 4];
        let (lines, rows, sums, sharper) = (&mut whole.0, &mut whole.1, &mut whole.2, &mut whole.3);
        if started {
            let mut view =
                FocusMapView::new(&mut state, lines, rows, sums, sharper, &mut all).expect("any size");
            view.start(&config).expect("it fits");
        }
        let (lines, rows) = (&mut lines[..3 * width], &mut rows[..5 * width]);
        let (sums, sharper) = (&mut sums[..17 * columns], &mut sharper[..columns]);
        let view = FocusMapView::new(&mut state, lines, rows, sums, sharper, &mut all[..cells]);
        view.and_then(|mut view| view.start(&config)).err()
    };
    assert_eq!((columns, cells), (2, 4));
    for started in [false, true] {
        assert_eq!(refused(16, 2, 4, started), None);
        assert_eq!(refused(15, 2, 4, started), Some(FocusConfigError::Width { most: 15 }));
        assert_eq!(refused(16, 1, 4, started), Some(FocusConfigError::Columns { needed: 2 }));
        assert_eq!(refused(16, 2, 3, started), Some(FocusConfigError::Cells { needed: 4 }));
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let mut map = FocusMap::<16, 4, 8>::new();
    assert_eq!(map.begin_frame(Breathing::NONE), Err(FocusLineError::NotStarted));
    let config = FocusConfig { width: 16, height: 16, cell_px: 4, radius: 0, exposure_varies: true };
    for (config, error) in [
        (FocusConfig { width: 17, ..config }, FocusConfigError::Width { most: 16 }),
        (FocusConfig { width: 0, ..config }, FocusConfigError::Empty),
        (FocusConfig { height: 0, ..config }, FocusConfigError::Empty),
        (FocusConfig { cell_px: 0, ..config }, FocusConfigError::Window),
        (FocusConfig { radius: 4, ..config }, FocusConfigError::Window),
        (FocusConfig { cell_px: 8, radius: 2, ..config }, FocusConfigError::Window),
        (FocusConfig { cell_px: 3, ..config }, FocusConfigError::Columns { needed: 6 }),
        (config, FocusConfigError::Cells { needed: 16 }),
    ] {
        assert_eq!(map.start(&config), Err(error));
    }
    map.start(&FocusConfig { height: 8, ..config }).expect("it fits");
    assert_eq!(map.push(&[0; 16], |_| {}), Err(FocusLineError::NoLineDue));
    map.begin_frame(Breathing::NONE).expect("a frame is due");
    assert_eq!(map.push(&[0; 15], |_| {}), Err(FocusLineError::Length { needed: 16 }));
    map.push(&[0; 16], |_| {}).expect("a line is due");
    assert_eq!(map.begin_frame(Breathing::NONE), Err(FocusLineError::FrameIncomplete { missing: 7 }));
    assert_eq!(map.finish(), Err(FocusLineError::FrameIncomplete { missing: 7 }));
    for _ in 1..8 {
        map.push(&[0; 16], |_| {}).expect("a line is due");
    }
    assert_eq!(map.push(&[0; 16], |_| {}), Err(FocusLineError::NoLineDue));
    map.finish().expect("a whole frame");
    assert_eq!(map.peak(0, 0), Err(NoFocus::TooFewFrames { needed: 3 }));
    assert_eq!(map.finish(), Err(FocusLineError::NotStarted));
    for scale in [0.49, 2.01, f32::NAN, -1.0] {
        assert_eq!(Breathing::new(scale), Err(FocusLineError::Scale));
    }
}
