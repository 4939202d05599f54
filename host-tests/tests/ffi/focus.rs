//! Depth from focus: the functions for C give the peaks of the map in Rust.

use super::*;
use stereopsis::ffi::{CFocusConfig, CFocusPeak, STEREOPSIS_FOCUS_FEW, STEREOPSIS_FOCUS_FOUND, focus_bytes};
use stereopsis::focus::{Breathing, FocusConfig, FocusMap};
use stereopsis_host::scene::Random;

const COLUMNS: usize = 60;
const ROWS: usize = 40;
const CELLS: usize = COLUMNS * ROWS;
const FRAMES: usize = 9;

/// The lines of a frame of texture, sharpest in the fifth on the left and in the third on the right.
fn frame(texture: &[u8], number: usize) -> Vec<Vec<u8>> {
    let at = |x: usize, y: usize| u32::from(texture[y * (COLUMNS + 8) + x]);
    let pixel = |x: usize, y: usize| {
        let radius = number.abs_diff(if x < COLUMNS / 2 { 5 } else { 3 });
        let sum: u32 = (4 - radius.min(4)..=4 + radius.min(4)).map(|dx| at(x + dx, y)).sum();
        (sum / (2 * radius.min(4) as u32 + 1)) as u8
    };
    (0..ROWS).map(|y| (0..COLUMNS).map(|x| pixel(x, y)).collect()).collect()
}

/// Compares a map of this kind.
fn peaks_are_equal(config: FocusConfig, scale: f32) {
    let mut random = Random::new(21);
    let texture: Vec<u8> = (0..(COLUMNS + 8) * ROWS).map(|_| random.byte()).collect();
    let mut twin = Box::new(FocusMap::<COLUMNS, COLUMNS, CELLS>::new());
    twin.start(&config).expect("a map of this kind");
    let FocusConfig { width, height, cell_px, radius, exposure_varies } = config;
    let in_c = CFocusConfig { width, height, cell_px, radius, exposure_varies: exposure_varies.into() };
    let (columns, rows) = (config.columns(), config.rows());
    let length = focus_bytes(COLUMNS, columns, config.cells());
    let (mut memory, mut handle) = (vec![0xA5A5_A5A5_A5A5_A5A5_u64; length.div_ceil(8)], null_mut());
    // SAFETY: as many bytes are there.
    unsafe {
        let (cells, memory) = (config.cells() as u32, memory.as_mut_ptr().cast());
        let status = stereopsis_focus_init(memory, length, width, columns as u16, cells, &raw mut handle);
        assert_eq!(status, Status::Ok);
        assert_eq!(stereopsis_focus_start(handle, &raw const in_c), Status::Ok);
    }
    for number in 0..FRAMES {
        let scale = if number % 2 == 0 { 1.0 } else { scale };
        twin.begin_frame(Breathing::new(scale).expect("a scale")).expect("a frame");
        // SAFETY: the map is there, and lines have their length.
        unsafe {
            assert_eq!(stereopsis_focus_begin_frame(handle, scale), Status::Ok);
            for line in frame(&texture, number) {
                assert_eq!(stereopsis_focus_push(handle, line.as_ptr(), COLUMNS), Status::Ok);
                twin.push(&line, |_| ()).expect("a line");
            }
        }
    }
    twin.finish().expect("a whole stack");
    // SAFETY: as above.
    assert_eq!(unsafe { stereopsis_focus_finish(handle) }, Status::Ok);
    let mut found = 0;
    for row in 0..rows {
        let mut peaks =
            vec![CFocusPeak { position_q8: 7, sigma_q8: 7, confidence: 7, found: 7 }; columns + 1];
        // SAFETY: as many peaks are there.
        let status = unsafe { stereopsis_focus_row(handle, row as u16, peaks.as_mut_ptr(), columns + 1) };
        assert_eq!(status, Status::Ok);
        assert_eq!(peaks[columns].found, STEREOPSIS_FOCUS_FEW, "beside the frame");
        for (column, peak) in peaks[..columns].iter().enumerate() {
            match twin.peak(column, row) {
                Ok(expected) => {
                    let numbers = (expected.position_q8, expected.sigma_q8, expected.confidence);
                    assert_eq!((peak.position_q8, peak.sigma_q8, peak.confidence), numbers);
                    assert_eq!(peak.found, STEREOPSIS_FOCUS_FOUND);
                    found += 1;
                }
                Err(_) => assert!(peak.found != STEREOPSIS_FOCUS_FOUND && peak.position_q8 == 0),
            }
        }
    }
    assert!(found * 2 > columns * rows, "{found} peaks of {} cells", columns * rows);
}

#[test]
fn peaks_are_those_of_rust() {
    let size = (COLUMNS as u16, ROWS as u16);
    peaks_are_equal(FocusConfig::pixels(size.0, size.1), 1.0);
    peaks_are_equal(FocusConfig::tiles(size.0, size.1), 1.0);
    peaks_are_equal(FocusConfig { cell_px: 3, radius: 1, ..FocusConfig::pixels(size.0, size.1) }, 1.02);
}

#[test]
fn the_default_is_that_of_rust() {
    let mut config = CFocusConfig { width: 0, height: 0, cell_px: 0, radius: 0, exposure_varies: 9 };
    // SAFETY: the pointer is to a configuration.
    assert_eq!(unsafe { stereopsis_focus_default(60, 40, &raw mut config) }, Status::Ok);
    let CFocusConfig { width, height, cell_px, radius, exposure_varies } = config;
    let found = FocusConfig { width, height, cell_px, radius, exposure_varies: exposure_varies != 0 };
    assert_eq!((found, exposure_varies), (FocusConfig::pixels(60, 40), 1));
}
