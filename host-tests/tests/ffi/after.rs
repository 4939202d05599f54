//! Balance, decimation and the filter over frames: the functions for C give what the types in Rust give.

use super::*;
use stereopsis::depth::{Decimator, Provenance, TemporalConfig, TemporalFilter};
use stereopsis::ffi::{CBalance, CHistogram, CTemporal, STEREOPSIS_NONE};
use stereopsis::imaging::{Balance, Histogram};
use stereopsis::units::Disparity;
use stereopsis_host::scene::Random;

/// Rows of answers in steps with gaps.
fn answers(random: &mut Random, width: usize, rows: usize) -> Vec<Vec<u16>> {
    let mut level = 400_i32;
    let mut one = || {
        level = (level + random.below(81) as i32 - 40).clamp(0, 2000);
        if random.below(10) < 3 { STEREOPSIS_NONE } else { level as u16 }
    };
    (0..rows).map(|_| (0..width).map(|_| one()).collect()).collect()
}

fn disparities(row: &[u16]) -> Vec<Disparity> {
    row.iter().map(|&steps| Disparity::from_raw(steps)).collect()
}

#[test]
fn balance_is_that_of_rust() {
    let mut random = Random::new(3);
    let mut balanced = 0;
    for _ in 0..60 {
        let (gain, offset) = (0.3 + 1.5 * random.unit(), 120.0 * random.unit() - 60.0);
        let (mut left, mut right) = (Histogram::new(), Histogram::new());
        let mut in_c = [CHistogram { words: [!0; 10] }; 2];
        // SAFETY: all pointers are to what is asked for, and lines have their length.
        unsafe {
            for histogram in &mut in_c {
                assert_eq!(stereopsis_histogram_clear(histogram), Status::Ok);
            }
            for row in 0..24_u16 {
                let line: [u8; 90] = core::array::from_fn(|x| (x as u8).wrapping_mul(row as u8 | 1));
                let other = line.map(|grey| (f64::from(grey) * gain + offset).clamp(0.0, 255.0) as u8);
                left.line(row.into(), &line);
                right.line(row.into(), &other);
                for (histogram, line) in in_c.iter_mut().zip([&line, &other]) {
                    assert_eq!(stereopsis_histogram_line(histogram, row, line.as_ptr(), 90), Status::Ok);
                }
            }
            let [of_left, of_right] = &in_c;
            let mut found = CBalance { gain_256ths: 0, offset_256ths: 0 };
            assert_eq!(stereopsis_balance_between(of_left, of_right, &raw mut found), Status::Ok);
            let expected = Balance::between(&left, &right);
            assert_eq!(
                (found.gain_256ths, found.offset_256ths),
                (expected.gain_256ths, expected.offset_256ths)
            );
            let mut line: [u8; 256] = core::array::from_fn(|grey| grey as u8);
            let mut twin = line;
            assert_eq!(stereopsis_balance_line(&raw const found, line.as_mut_ptr(), 256), Status::Ok);
            expected.line(&mut twin);
            assert_eq!(line, twin);
            balanced += u32::from(expected != Balance::NONE);
        }
    }
    assert!(balanced > 20, "{balanced} of 60 are balanced");
}

/// Compares blocks of `N` x `N` pixels.
fn decimated<const N: usize>(random: &mut Random) {
    const WIDTH: usize = 53;
    let mut rows = vec![7_u16; N * WIDTH];
    let mut twin = Decimator::<WIDTH, N>::new();
    let mut count = 0;
    for (y, row) in (0..).zip(answers(random, WIDTH, 4 * N + 1)) {
        let (mut found, mut expected) = (vec![1; WIDTH / N], vec![Disparity::NONE; WIDTH / N]);
        // SAFETY: the arrays have the lengths that are asked for.
        let status = unsafe {
            let (rows, out) = (rows.as_mut_ptr(), found.as_mut_ptr());
            stereopsis_decimate(rows, N as u16, y, row.as_ptr(), WIDTH, out)
        };
        let index = twin.push(&disparities(&row), &mut expected);
        assert_eq!(status == Status::Ok, index.is_some(), "row {y}, blocks of {N}");
        if index.is_some() {
            assert_eq!(disparities(&found), expected, "row {y}, blocks of {N}");
            assert_eq!(index, Some(usize::from(y) / N));
            count += found.iter().filter(|d| **d != STEREOPSIS_NONE).count();
        } else {
            assert!(status == Status::NoRowYet && found.iter().all(|d| *d == 1));
        }
    }
    assert!(count > 4, "{count} answers in blocks of {N}");
}

#[test]
fn decimation_is_that_of_rust() {
    let mut random = Random::new(5);
    decimated::<2>(&mut random);
    decimated::<3>(&mut random);
    decimated::<5>(&mut random);
    decimated::<8>(&mut random);
}

#[test]
fn the_filter_over_frames_is_that_of_rust() {
    const WIDTH: usize = 41;
    const HEIGHT: usize = 6;
    let mut random = Random::new(7);
    for shift in 0..=4 {
        let config = TemporalConfig { most_step: 50, shift, most_held: 2 };
        let in_c = CTemporal { most_step: 50, shift, most_held: 2 };
        let mut twin = Box::new(TemporalFilter::<WIDTH, HEIGHT>::new(config));
        let (mut averages, mut ages) = (vec![1_u16; WIDTH * HEIGHT], vec![9_u8; WIDTH * HEIGHT]);
        // SAFETY: both have as many elements.
        let forgotten =
            unsafe { stereopsis_temporal_forget(averages.as_mut_ptr(), ages.as_mut_ptr(), WIDTH * HEIGHT) };
        assert_eq!(forgotten, Status::Ok);
        let mut seen = [0; 4];
        for _frame in 0..6 {
            for (y, row) in answers(&mut random, WIDTH, HEIGHT).into_iter().enumerate() {
                let (mut found, mut origins) = ([1_u16; WIDTH], [9_u8; WIDTH]);
                let (mut expected, mut provenance) = ([Disparity::NONE; WIDTH], [Provenance::New; WIDTH]);
                // SAFETY: the arrays have the lengths that are asked for.
                let status = unsafe {
                    stereopsis_temporal_row(
                        &raw const in_c,
                        averages.as_mut_ptr().add(y * WIDTH),
                        ages.as_mut_ptr().add(y * WIDTH),
                        row.as_ptr(),
                        found.as_mut_ptr(),
                        origins.as_mut_ptr(),
                        WIDTH,
                    )
                };
                twin.row(y, &disparities(&row), &mut expected, &mut provenance);
                assert_eq!(status, Status::Ok);
                assert_eq!(disparities(&found), expected);
                assert_eq!(origins, provenance.map(|one| one as u8));
                origins.iter().for_each(|origin| seen[usize::from(*origin)] += 1);
            }
        }
        assert!(seen.iter().all(|count| *count > 0), "every origin was seen: {seen:?}");
    }
}
