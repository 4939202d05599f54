//! What may follow the pipeline: answers over frames, smaller rows, rows on a display; against naive twins.

use embedded_graphics_core::Pixel;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{OriginDimensions, Point, Size};
use embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::depth::{
    Decimator, DecimatorView, DisparityColours, Provenance, TemporalConfig, TemporalFilter,
    TemporalFilterView, TemporalMemoryError,
};
use stereopsis::units::Disparity;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(12),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// A disparity of a few steps, often none.
fn disparity() -> impl Strategy<Value = Disparity> {
    prop_oneof![
        Just(Disparity::NONE),
        (300u16..400).prop_map(Disparity::from_raw),
        (0u16..2000).prop_map(Disparity::from_raw)
    ]
}

proptest! {
    #![proptest_config(config(300))]

    /// Each pixel for itself, with the whole history at hand.
    #[test]
    fn the_filter_is_the_average_of_its_history(
        frames in proptest::collection::vec(proptest::collection::vec(disparity(), 3), 1..12),
        most_step in 0u16..80,
        shift in 0u8..5,
        most_held in 0u8..4,
    ) {
        let mut filter = TemporalFilter::<3, 1>::new(TemporalConfig { most_step, shift, most_held });
        let mut told = Vec::new();
        for frame in &frames {
            let (mut out, mut provenance) = ([Disparity::ZERO; 3], [Provenance::New; 3]);
            filter.row(0, frame, &mut out, &mut provenance);
            told.push((out, provenance));
        }
        for x in 0..3 {
            let (mut average, mut missing) = (None::<f64>, 0);
            for (frame, (out, provenance)) in frames.iter().zip(&told) {
                let expected = match (frame[x].is_some().then(|| f64::from(frame[x].raw())), average) {
                    (Some(new), Some(old)) if (new - old).abs() <= f64::from(most_step) => {
                        missing = 0;
                        let part = (new - old).abs() / f64::from(1 << shift);
                        // Halves are rounded away from the average.
                        average = Some(old + (part + 0.5).floor() * (new - old).signum());
                        Provenance::Averaged
                    }
                    (Some(new), _) => {
                        (average, missing) = (Some(new), 0);
                        Provenance::New
                    }
                    (None, Some(_)) if missing < most_held => {
                        missing += 1;
                        Provenance::Held
                    }
                    (None, _) => {
                        average = None;
                        Provenance::Nothing
                    }
                };
                prop_assert_eq!(provenance[x], expected);
                prop_assert_eq!(out[x].is_some().then(|| f64::from(out[x].raw())), average);
            }
        }
    }

    /// A block's median by sorting all of it.
    #[test]
    fn smaller_rows_are_medians_of_blocks(
        rows in proptest::collection::vec(proptest::collection::vec(disparity(), 11), 7)) {
        blocks::<2>(&rows)?;
        blocks::<3>(&rows)?;
        blocks::<5>(&rows)?;
    }
}

fn blocks<const N: usize>(rows: &[Vec<Disparity>]) -> Result<(), TestCaseError> {
    let mut small = Decimator::<11, N>::new();
    for _ in 0..2 {
        small.begin();
        for (y, row) in rows.iter().enumerate() {
            let mut out = [Disparity::ZERO; 11];
            let told = small.push(row, &mut out);
            prop_assert_eq!(told, ((y + 1) % N == 0).then_some(y / N));
            let Some(v) = told else { continue };
            for (u, &out) in out.iter().enumerate().take(11 / N) {
                let block = rows[v * N..(v + 1) * N].iter().flat_map(|row| &row[u * N..(u + 1) * N]);
                let mut answers: Vec<u16> = block.filter(|d| d.is_some()).map(|d| d.raw()).collect();
                answers.sort_unstable();
                let enough = 2 * answers.len() >= N * N;
                let expected = if enough { answers[answers.len() / 2] } else { Disparity::NONE.raw() };
                prop_assert_eq!(out.raw(), expected);
            }
            prop_assert!(
                out[11 / N..].iter().all(|d| *d == Disparity::ZERO),
                "what fills no block is left alone"
            );
        }
    }
    Ok(())
}

#[test]
fn vectors_serve_as_memory_and_other_lengths_are_named() {
    let row = |y: u16| [3 + y, 7, 2, 9].map(|pixels| Disparity::from_raw(32 * pixels));
    let config = TemporalConfig::default();
    let mut owned = TemporalFilter::<4, 2>::new(config);
    let (mut average, mut age) = (vec![Disparity::NONE; 8], vec![0; 8]);
    for y in [0, 1, 0, 1, 2] {
        let mut both = [[Disparity::ZERO; 4]; 2];
        let mut provenance = [Provenance::Nothing; 4];
        owned.row(y, &row(y as u16), &mut both[0], &mut provenance);
        // A view made anew goes on where the last one was.
        let mut view = TemporalFilterView::new(config, 4, &mut average, &mut age).expect("as long");
        view.row(y, &row(y as u16), &mut both[1], &mut provenance);
        assert_eq!(both[0], both[1]);
        assert_eq!(both[0] == [Disparity::NONE; 4], y == 2, "there is no row 2");
    }
    for (pixels, ages, width, needed) in [(8, 7, 4, 8), (7, 8, 4, 8), (8, 8, 3, 9)] {
        let refused = TemporalFilterView::new(config, width, &mut average[..pixels], &mut age[..ages]);
        assert_eq!(refused.err(), Some(TemporalMemoryError { needed }));
    }
    let (mut rows, mut taken) = (vec![Disparity::ZERO; 9], 0);
    let mut smaller = [Disparity::ZERO; 2];
    for (y, told) in [None, Some(0), None, Some(1)].into_iter().enumerate() {
        let found = DecimatorView::<2>::new(&mut rows, &mut taken).push(&row(y as u16), &mut smaller);
        assert_eq!(found, told);
    }
    assert_eq!(smaller, [7, 9].map(Disparity::from_pixels));
}

#[test]
fn noise_falls_by_what_the_filter_says() {
    let mut filter = TemporalFilter::<64, 1>::new(TemporalConfig { most_step: 200, shift: 2, most_held: 0 });
    let mut seed = 1u64;
    let mut noise = || {
        // The sum of twelve uniform numbers is nearly normal, with deviation 1.
        let mut uniform = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 40) as f64 / (1 << 24) as f64
        };
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    };
    let (mut of_input, mut of_output) = (0.0, 0.0);
    for frame in 0..400 {
        let answers: Vec<_> =
            (0..64).map(|_| Disparity::from_raw((3200.0 + 20.0 * noise()) as u16)).collect();
        let (mut out, mut provenance) = ([Disparity::NONE; 64], [Provenance::Nothing; 64]);
        filter.row(0, &answers, &mut out, &mut provenance);
        if frame >= 50 {
            let square = |d: &Disparity| (f64::from(d.raw()) - 3200.0).powi(2);
            of_input += answers.iter().map(square).sum::<f64>();
            of_output += out.iter().map(square).sum::<f64>();
        }
    }
    let ratio = (of_output / of_input).sqrt();
    assert!((ratio - (1.0_f64 / 7.0).sqrt()).abs() < 0.03, "{ratio}");
}

/// A display of 16 x 4 pixels.
struct Display([[Rgb565; 16]; 4]);

impl OriginDimensions for Display {
    fn size(&self) -> Size {
        Size::new(16, 4)
    }
}

impl DrawTarget for Display {
    type Color = Rgb565;
    type Error = core::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        for Pixel(Point { x, y }, colour) in pixels {
            if (0..16).contains(&x) && (0..4).contains(&y) {
                self.0[y as usize][x as usize] = colour;
            }
        }
        Ok(())
    }
}

#[test]
fn rows_are_drawn_where_they_belong_near_is_bright() {
    let pixels = |n| Disparity::from_pixels(n);
    let colours = DisparityColours::new(pixels(4), pixels(20));
    let row: Vec<_> = (0..14).map(|n| if n == 5 { Disparity::NONE } else { pixels(2 * n) }).collect();
    let mut display = Display([[Rgb565::RED; 16]; 4]);
    colours.draw_row(&mut display, Point::new(1, 2), &row).expect("it cannot fail");
    assert!(display.0.iter().enumerate().all(|(y, line)| (y == 2) != (line == &[Rgb565::RED; 16])));
    let drawn = &display.0[2];
    assert_eq!((drawn[0], drawn[15], drawn[6]), (Rgb565::RED, Rgb565::RED, Rgb565::BLACK));
    assert_eq!(drawn[1], drawn[3], "what is farther has the farthest colour");
    assert_eq!(drawn[11], drawn[14], "what is nearer has the nearest");
    let light = |d: Disparity| {
        let c = colours.colour(d);
        299 * u32::from(c.r()) + 587 * u32::from(c.g()) + 114 * u32::from(c.b())
    };
    // By a rounding less from one step to the next.
    assert!(
        (128..=640).step_by(16).map(|raw| light(Disparity::from_raw(raw))).is_sorted(),
        "nearer is brighter"
    );
    assert_eq!(colours.colour(pixels(4)), Rgb888::new(0x44, 0x01, 0x54));
    assert_eq!(colours.colour(pixels(30)), Rgb888::new(0xfd, 0xe7, 0x25));
    // A range of nothing.
    assert_ne!(DisparityColours::new(pixels(9), pixels(9)).colour(pixels(9)), Rgb888::BLACK);
}

/// The longest holding ends, too.
#[test]
fn an_answer_is_held_for_as_many_frames_as_is_said() {
    for most_held in [0, 1, 254, 255] {
        let mut filter = TemporalFilter::<1, 1>::new(TemporalConfig { most_held, ..Default::default() });
        let mut row = |answer| {
            let (mut out, mut provenance) = ([Disparity::ZERO], [Provenance::New]);
            filter.row(0, &[answer], &mut out, &mut provenance);
            provenance[0]
        };
        assert_eq!(row(Disparity::from_raw(70)), Provenance::New);
        for _ in 0..most_held {
            assert_eq!(row(Disparity::NONE), Provenance::Held, "{most_held}");
        }
        for _ in 0..300 {
            assert_eq!(row(Disparity::NONE), Provenance::Nothing, "{most_held}");
        }
    }
}
