//! The C interface, called from Rust: the pipeline's rows, and a status for every misuse of memory.
//!
//! `ffi/misuse.c` and those beside it go through every status from C, under sanitizers
//! (`cargo xtask test --step "C interface"`).
#![allow(unsafe_code, reason = "functions with a C ABI are called as C calls them")]

mod after;
mod confidence;
mod features;
mod focus;
mod line_queue;
mod lost;
mod noise;
mod obstacles;
mod raw;
mod statuses;
mod two_view;
mod winners;

use std::ffi::c_void;
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};
use std::slice;
use stereopsis::ffi::{
    CConfig, CRig, CRow, Handle, Instance, STEREOPSIS_ALIGN, STEREOPSIS_NOISE_LOW, STEREOPSIS_PRESET_DEFAULT,
    Status, memory_bytes,
};
use stereopsis::imaging::Noise;
use stereopsis::matching::{self, Block, Checks, Method};
use stereopsis::pipeline::Pipeline;
use stereopsis_host::scene::pattern::Pattern;

const WIDTH: usize = 96;
const DISPARITIES: usize = 32;
stereopsis::instantiate_c_api!(Block, width = WIDTH, disparities = DISPARITIES);
use stereopsis_c::*;

/// Memory that is aligned as the header says, with one word more than needed, and holds anything but zeros.
fn memory() -> Vec<u64> {
    vec![0xA5A5_A5A5_A5A5_A5A5; stereopsis_size().div_ceil(8) + 1]
}

/// `stereopsis_init` on a part of `memory`: the status and the handle.
fn init(memory: &mut [u64], offset: usize, length: usize) -> (Status, *mut Handle) {
    assert!(offset + length <= size_of_val(memory), "the part is inside");
    let mut handle = null_mut();
    // SAFETY: the part's bytes are inside of the memory, which outlives the handle in these tests.
    let status = unsafe {
        let part = memory.as_mut_ptr().cast::<u8>().add(offset).cast::<c_void>();
        stereopsis_init(part, length, &raw mut handle)
    };
    (status, handle)
}

/// A configuration of the default preset.
fn config(width: u16, height: u16, disparities: u16) -> CConfig {
    let mut config = MaybeUninit::uninit();
    let filled = config.as_mut_ptr();
    // SAFETY: the pointer is to memory for a configuration, all of which is filled.
    unsafe {
        let status = stereopsis_config_default(width, height, disparities, STEREOPSIS_PRESET_DEFAULT, filled);
        assert_eq!(status, Status::Ok);
        config.assume_init()
    }
}

const NO_ROW: CRow = CRow { index: 0, width: 0, disparities: null(), flags: null(), confidences: null() };

/// The lines of both cameras.
type Lines = [Vec<Vec<u8>>; 2];

/// Both cameras' lines of a scene with noise, with as many rows as asked for.
fn lines(width: u16, height: u16) -> Lines {
    let (left, right) = Pattern::Shifted { most: 12, noise_grey: 4.0 }.pair(width.into(), height.into(), 5);
    [left, right].map(|picture| picture.as_raw().chunks(usize::from(width)).map(<[u8]>::to_vec).collect())
}

/// A row that came out.
#[derive(PartialEq)]
struct Found {
    index: u16,
    disparities: Vec<u16>,
    flags: Vec<u8>,
    sigma_px: Vec<f32>,
    confidences: Option<Vec<u8>>,
}

impl Found {
    /// Copies a row of the functions for C.
    ///
    /// # Safety
    ///
    /// The row came from the last call, so that its pointers hold its width.
    unsafe fn of(row: &CRow, sigma_px: Vec<f32>) -> Self {
        let width = usize::from(row.width);
        // SAFETY: as the caller promises.
        unsafe {
            Self {
                index: row.index,
                disparities: slice::from_raw_parts(row.disparities, width).to_vec(),
                flags: slice::from_raw_parts(row.flags, width).to_vec(),
                sigma_px,
                confidences: (!row.confidences.is_null())
                    .then(|| slice::from_raw_parts(row.confidences, width).to_vec()),
            }
        }
    }
}

/// The rows of a pipeline in Rust.
fn rows<S: Method>(config: &matching::Config, [left, right]: &Lines) -> Vec<Found> {
    let mut pipeline = Box::new(Pipeline::<S, WIDTH, DISPARITIES>::new());
    pipeline.start(config).expect("the configuration is valid");
    pipeline.begin().expect("it is started");
    let mut found = Vec::new();
    let mut keep = |row: matching::Row<'_>| {
        found.push(Found {
            index: row.index(),
            disparities: row.disparities().iter().map(|d| d.raw()).collect(),
            flags: row.flags().iter().map(|f| f.bits()).collect(),
            sigma_px: (0..config.width.into()).map(|x| row.sigma_px(x).unwrap_or(f32::INFINITY)).collect(),
            confidences: (config.confidence || config.min_confidence > 0).then(|| row.confidences().to_vec()),
        });
    };
    for (left, right) in left.iter().zip(right) {
        pipeline.push(left, right).expect("a line").map(&mut keep);
    }
    while let Some(row) = pipeline.flush().expect("all lines are in") {
        keep(row);
    }
    found
}

/// The rows of the functions for C.
fn c_rows<S: Method>(config: &CConfig, [left, right]: &Lines) -> Vec<Found> {
    type C<S> = Instance<S, WIDTH, DISPARITIES>;
    let mut memory = vec![0xA5A5_A5A5_A5A5_A5A5_u64; C::<S>::size().div_ceil(8)];
    let mut handle = null_mut();
    let mut found = Vec::new();
    // SAFETY: the memory outlives the handle, lines have their length, and rows are read before the next
    // call.
    unsafe {
        let length = size_of_val(&memory[..]);
        let status = C::<S>::init(memory.as_mut_ptr().cast(), length, false, &raw mut handle);
        assert_eq!(status, Status::Ok);
        assert_eq!(C::<S>::start(handle, config, false), Status::Ok);
        assert_eq!(C::<S>::begin_frame(handle), Status::Ok);
        let mut row = NO_ROW;
        let mut lines = left.iter().zip(right);
        let mut taken = 0;
        loop {
            let status = match lines.next() {
                Some((l, r)) => C::<S>::push(handle, l.as_ptr(), r.as_ptr(), l.len(), &raw mut row),
                None => C::<S>::flush(handle, &raw mut row),
            };
            taken += 1;
            match status {
                Status::Ok => {}
                Status::NoRowYet => {
                    assert!(taken <= C::<S>::latency() && row == NO_ROW);
                    continue;
                }
                Status::FrameDone => break,
                wrong => panic!("{wrong:?}"),
            }
            let width = usize::from(row.width);
            let mut sigma_px = vec![0.0; width];
            assert_eq!(C::<S>::sigma_px(handle, sigma_px.as_mut_ptr(), width), Status::Ok);
            found.push(Found::of(&row, sigma_px));
        }
        assert_eq!(C::<S>::deinit(handle), Status::Ok);
    }
    found
}

#[test]
fn rows_are_those_of_the_pipeline() {
    for (width, height) in [(96, 30), (37, 1), (1, 9), (50, 12)] {
        let lines = lines(width, height);
        let checks = Checks { median: true, fill_pixels: 3, ..Checks::DEFAULT };
        // With and without.
        let confidence = width > 37;
        let asked = matching::Config {
            checks,
            confidence,
            ..matching::Config::for_method::<Block>(width, height, 32)
        };
        let asked = matching::Config { noise: Noise::Low, ..asked };
        let config =
            CConfig { median: 1, fill_pixels: 3, confidence: confidence.into(), ..config(width, height, 32) };
        let config = CConfig { noise: STEREOPSIS_NOISE_LOW, ..config };
        let found = c_rows::<Block>(&config, &lines);
        assert_eq!(found.len(), usize::from(height));
        assert!(found == rows::<Block>(&asked, &lines), "{width}x{height}");
    }
}

#[test]
fn memory_that_will_not_do_is_refused_and_left_alone() {
    let size = stereopsis_size();
    let mut memory = memory();
    let before = memory.clone();
    let mut handle = null_mut();
    // SAFETY: null pointers are answered; the memory is not read.
    unsafe {
        assert_eq!(stereopsis_init(null_mut(), size, &raw mut handle), Status::Null);
        assert_eq!(stereopsis_init(memory.as_mut_ptr().cast(), size, null_mut()), Status::Null);
    }
    for length in [0, 1, size - 1] {
        assert_eq!(init(&mut memory, 0, length), (Status::MemoryTooShort, null_mut()));
    }
    for offset in 1..stereopsis_align() {
        assert_eq!(init(&mut memory, offset, size), (Status::Misaligned, null_mut()));
    }
    assert!(memory == before);
}

#[test]
fn memory_holds_one_matcher_until_it_is_given_up() {
    let size = stereopsis_size();
    let mut memory = memory();
    let end = *memory.last().expect("a word");
    let (status, handle) = init(&mut memory, 0, size);
    assert_eq!(status, Status::Ok);
    assert_eq!(init(&mut memory, 0, size), (Status::AlreadyInitialised, null_mut()));
    // A copy at another address is no matcher.
    let mut copy = memory.clone();
    // SAFETY: the handles are memory of a matcher's size.
    unsafe {
        assert_eq!(stereopsis_begin_frame(copy.as_mut_ptr().cast()), Status::NotInitialised);
        assert_eq!(stereopsis_begin_frame(handle), Status::NotStarted);
        assert_eq!(stereopsis_deinit(handle), Status::Ok);
        assert_eq!(stereopsis_deinit(handle), Status::NotInitialised);
        assert_eq!(stereopsis_deinit(null_mut()), Status::Null);
    }
    let (status, handle) = init(&mut memory, 0, size);
    assert_eq!(status, Status::Ok);
    // SAFETY: the handle is from `init`.
    assert_eq!(unsafe { stereopsis_deinit(handle) }, Status::Ok);
    assert_eq!(memory.last(), Some(&end), "nothing is written behind the size");
}

#[test]
fn a_frame_before_the_start_changes_nothing() {
    let mut memory = memory();
    let (status, handle) = init(&mut memory, 0, stereopsis_size());
    assert_eq!(status, Status::Ok);
    let before = memory.clone();
    // SAFETY: the handle is from `init`.
    assert_eq!(unsafe { stereopsis_begin_frame(handle) }, Status::NotStarted);
    assert!(memory == before);
}

#[test]
fn sizes_are_as_stated() {
    assert_eq!(stereopsis_max_width(), WIDTH);
    assert_eq!(stereopsis_max_disparities(), DISPARITIES);
    assert_eq!(stereopsis_latency(), Pipeline::<Block, WIDTH, DISPARITIES>::LATENCY);
    assert!(stereopsis_size() <= memory_bytes::<Block>(WIDTH, DISPARITIES));
    assert!(STEREOPSIS_ALIGN.is_multiple_of(stereopsis_align()));
}

#[test]
fn depths_are_the_scales() {
    let rig = CRig { focal_px: 500.0, baseline_m: 0.1, cx: 160.0, cy: 120.0, cx_right: 160.0 };
    let disparities = [25 * 32, 50 * 32, 0, u16::MAX];
    let mut millimetres = [1; 4];
    // SAFETY: both arrays have the length that is said.
    let status =
        unsafe { stereopsis_millimetres(&raw const rig, disparities.as_ptr(), millimetres.as_mut_ptr(), 4) };
    assert_eq!((status, millimetres), (Status::Ok, [2000, 1000, 0, 0]));
}
