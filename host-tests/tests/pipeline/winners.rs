//! Rows of winners from a model of the block: the rows are the method's own, and faults cost what they must.

use image::GrayImage;
use stereopsis::camera::StereoSource;
use stereopsis::imaging::Noise;
use stereopsis::matching::{
    Block, Checks, Config, External, Fast, Filter, Method, Penalties, Sgm, WinnerRecord,
};
use stereopsis::pipeline::winners::{
    Register, WinnerError, WinnerPipeline, WinnerPipelineError, WinnerRegisters, WinnerSource,
};
use stereopsis::pipeline::{Pipeline, PushError};
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::run::MemoryPair;
use stereopsis_host::scene::pattern::Pattern;
use stereopsis_host::twin;
use stereopsis_host::winners::{MockBlock, WinnerFault};

pub const W: usize = 96;
pub const D: usize = 32;
pub const WIDTH: usize = 90;
pub const HEIGHT: usize = 60;

pub type Rows = Vec<(Vec<Disparity>, Vec<PixelFlags>)>;
pub type Failed = WinnerPipelineError<core::convert::Infallible>;

pub fn pictures(seed: u64) -> (GrayImage, GrayImage) {
    Pattern::Shifted { most: 14, noise_grey: 1.0 }.pair(WIDTH as u32, HEIGHT as u32, seed)
}

pub fn config<S: Method>() -> Config {
    // Few pixels of support, so that a lost row reaches few others.
    let config = Config::for_method::<S>(WIDTH as u16, HEIGHT as u16, D as u16);
    Config { checks: Checks { speckle_pixels: 6, ..config.checks }, ..config }
}

/// The method's own rows.
pub fn own<S: Method>(config: &Config, (left, right): &(GrayImage, GrayImage)) -> Rows {
    let mut pipeline = Box::new(Pipeline::<S, W, D>::new());
    let mut camera =
        MemoryPair::new(WIDTH as u16, left.as_raw().clone(), right.as_raw().clone()).expect("a pair");
    assert_eq!(camera.format().height, HEIGHT as u16);
    pipeline.start(config).expect("a configuration that fits");
    pipeline.begin_frame(&mut camera).expect("a frame");
    let mut rows = Vec::new();
    while let Some(row) = pipeline.next_row(&mut camera).expect("a row") {
        rows.push((row.disparities().to_vec(), row.flags().to_vec()));
    }
    rows
}

/// A frame's rows through a device.
pub fn frame<S: Method, R: WinnerSource>(
    pipeline: &mut WinnerPipeline<S, W, D>,
    device: &mut R,
    (left, right): &(GrayImage, GrayImage),
) -> Result<Rows, WinnerPipelineError<R::Error>>
where
    External<S>: Method,
{
    pipeline.begin_frame(device)?;
    let mut rows: Rows = Vec::new();
    for y in 0..HEIGHT {
        let line = y * WIDTH..(y + 1) * WIDTH;
        if let Some(row) = pipeline.push(&left.as_raw()[line.clone()], &right.as_raw()[line], device)? {
            assert_eq!(usize::from(row.index()), rows.len());
            assert_eq!(y, rows.len() + WinnerPipeline::<S, W, D>::LATENCY);
            rows.push((row.disparities().to_vec(), row.flags().to_vec()));
        }
    }
    while let Some(row) = pipeline.flush(device)? {
        rows.push((row.disparities().to_vec(), row.flags().to_vec()));
    }
    assert_eq!(rows.len(), HEIGHT);
    Ok(rows)
}

fn whole<S: Method>(twin: &twin::Method, config: &Config)
where
    External<S>: Method,
{
    let pictures = pictures(3);
    let mut device = WinnerRegisters::new(MockBlock::new(twin, config, &pictures.0, &pictures.1));
    let mut pipeline = Box::new(WinnerPipeline::<S, W, D>::new());
    pipeline.start(config, &mut device).expect("a search that the block does");
    for _ in 0..2 {
        assert!(frame(&mut pipeline, &mut device, &pictures).expect("rows") == own::<S>(config, &pictures));
    }
}

#[test]
fn the_rows_are_the_methods_own() {
    whole::<Fast>(&twin::Method::FAST, &config::<Fast>());
    whole::<Block>(&twin::Method::BLOCK, &config::<Block>());
    whole::<Fast>(&twin::Method::FAST, &Config { noise: Noise::High, ..config::<Fast>() });
    whole::<Sgm>(&twin::Method::SGM, &config::<Sgm>());
    whole::<Block>(&twin::Method::BLOCK, &Config { min_disparity: 9, ..config::<Block>() });
    // Checks that look at the left camera's lines, and at three rows.
    let checks = Checks {
        texture_gradient: 4,
        texture_pixels: 10,
        fattening_slope: Disparity::from_raw(24),
        median: true,
        fill_pixels: 8,
        ..Checks::DEFAULT
    };
    whole::<Block>(&twin::Method::BLOCK, &Config { checks, ..config::<Block>() });
}

#[test]
fn an_error_says_what_happened_and_where() {
    for (error, text) in [
        (WinnerError::Device("the bus is stuck"), "the bus is stuck"),
        (WinnerError::Search, "the device cannot do this search"),
        (WinnerError::Late { row: 3 }, "the winners of row 3 are late"),
        (WinnerError::Count { row: 3, given: 70 }, "row 3 has 70 winners"),
        (WinnerError::Damaged { row: 3, column: 8 }, "the winner in column 8 of row 3 is damaged"),
        (WinnerError::LineLength, "a line of the device had a wrong length"),
        (WinnerError::FrameCutOff, "the device's frame was cut off by the next one"),
    ] {
        assert_eq!([error.to_string(), WinnerPipelineError::from(error).to_string()], [text; 2]);
        // After what is said of a row the frame goes on.
        assert_eq!(error.is_of_one_row(), text.contains("row 3"), "{text}");
    }
}

#[test]
fn a_borrowed_device_gives_the_same_rows() {
    let (config, pictures) = (config::<Fast>(), pictures(3));
    let mut owned =
        WinnerRegisters::new(MockBlock::new(&twin::Method::FAST, &config, &pictures.0, &pictures.1));
    let mut device = &mut owned;
    let mut pipeline = Box::new(WinnerPipeline::<Fast, W, D>::new());
    pipeline.start(&config, &mut device).expect("a search that the block does");
    for _ in 0..2 {
        assert!(
            frame(&mut pipeline, &mut device, &pictures).expect("rows") == own::<Fast>(&config, &pictures)
        );
    }
    // Its refusals are the device's, too.
    let refused: Result<(), Failed> = Err(WinnerError::Search.into());
    assert_eq!(pipeline.start(&Config { min_disparity: 256, ..config }, &mut device), refused);
}

#[test]
fn a_lost_row_costs_its_answers_and_flags_what_rests_on_it() {
    let (config, pictures) = (config::<Block>(), pictures(4));
    let block = MockBlock::new(&twin::Method::BLOCK, &config, &pictures.0, &pictures.1);
    let mut device = WinnerRegisters::new(block);
    let mut pipeline = Box::new(WinnerPipeline::<Block, W, D>::new());
    pipeline.start(&config, &mut device).expect("a search that the block does");
    pipeline.set_most_lost(1);
    let expected = own::<Block>(&config, &pictures);
    let flipped = |column, bit| WinnerFault::Flipped { column, bit };
    for (row, fault) in [
        (0, WinnerFault::Lost),
        (7, WinnerFault::Late),
        (20, WinnerFault::Lost),
        (30, WinnerFault::Short),
        (31, flipped(0, 24)),
        (40, flipped(WIDTH - 1, 63)),
        (HEIGHT - 1, flipped(40, 5)),
        (HEIGHT - 1, WinnerFault::Late),
    ] {
        device.bus().faults = [(row, fault)].into();
        let rows = frame(&mut pipeline, &mut device, &pictures).expect("one row may be lost");
        assert_eq!(pipeline.lost(), 1, "{row} {fault:?}");
        for (y, (found, own)) in rows.iter().zip(&expected).enumerate() {
            let is_flagged = found.1.iter().all(|flags| flags.contains(PixelFlags::DAMAGED));
            assert_eq!(is_flagged, (row.saturating_sub(4)..=row + 10).contains(&y), "{row} {fault:?} {y}");
            assert!(is_flagged || found == own, "{row} {fault:?} {y}");
            let has_answers = found.0.iter().any(|answer| answer.is_some());
            assert_eq!(has_answers, y != row, "{row} {fault:?} {y}");
        }
        // One more is too many.
        device.bus().faults.insert(10, WinnerFault::Lost);
        assert!(matches!(frame(&mut pipeline, &mut device, &pictures), Err(WinnerPipelineError::Source(_))));
        device.bus().faults.clear();
        assert!(frame(&mut pipeline, &mut device, &pictures).expect("rows") == expected, "the next frame");
        assert_eq!(pipeline.lost(), 0);
    }
}

#[test]
fn what_ends_a_frame_is_named_and_the_next_one_is_whole() {
    let (config, pictures) = (config::<Fast>(), pictures(5));
    let block = MockBlock::new(&twin::Method::FAST, &config, &pictures.0, &pictures.1);
    let mut device = WinnerRegisters::new(block);
    let mut pipeline = Box::new(WinnerPipeline::<Fast, W, D>::new());
    let push =
        |pipeline: &mut WinnerPipeline<Fast, W, D>, device: &mut WinnerRegisters<MockBlock>, length| {
            pipeline.push(&[0; W][..length], &[0; W][..length], device).map(|_| ())
        };
    assert!(matches!(push(&mut pipeline, &mut device, WIDTH), Err(WinnerPipelineError::Push(_))));
    pipeline.start(&config, &mut device).expect("a search that the block does");
    let not_begun: Result<(), Failed> = Err(PushError::NotBegun.into());
    assert_eq!(push(&mut pipeline, &mut device, WIDTH), not_begun);
    let expected = own::<Fast>(&config, &pictures);
    for (fault, error) in [
        (WinnerFault::Late, WinnerError::Late { row: 9 }),
        (WinnerFault::Short, WinnerError::Count { row: 9, given: WIDTH - 1 }),
        (WinnerFault::Flipped { column: 33, bit: 50 }, WinnerError::Damaged { row: 9, column: 33 }),
        (WinnerFault::LineLength, WinnerError::LineLength),
        (WinnerFault::CutOff, WinnerError::FrameCutOff),
    ] {
        device.bus().faults = [(9, fault)].into();
        let failed: Result<Rows, Failed> = Err(error.into());
        assert!(frame(&mut pipeline, &mut device, &pictures) == failed, "{fault:?}");
        assert_eq!(push(&mut pipeline, &mut device, WIDTH), not_begun);
        device.bus().faults.clear();
        assert!(frame(&mut pipeline, &mut device, &pictures).expect("rows") == expected, "{fault:?}");
    }
    pipeline.begin_frame(&mut device).expect("a frame");
    let length: Result<(), Failed> = Err(PushError::LineLength { needed: WIDTH }.into());
    assert_eq!(push(&mut pipeline, &mut device, WIDTH - 1), length);
}

#[test]
fn what_the_block_cannot_do_is_refused() {
    let (fast, pictures) = (config::<Fast>(), pictures(6));
    let mut device =
        WinnerRegisters::new(MockBlock::new(&twin::Method::FAST, &fast, &pictures.0, &pictures.1));
    let refused: Result<(), Failed> = Err(WinnerError::Search.into());
    let mut pipeline = Box::new(WinnerPipeline::<Fast, W, D>::new());
    for config in [
        Config { min_disparity: 256, ..fast },
        Config { confidence: true, ..fast },
        Config { width: 31, ..fast },
        fast.with_filter::<Fast>(Filter::Strict),
    ] {
        assert_eq!(pipeline.start(&config, &mut device), refused, "{config:?}");
    }
    pipeline.start(&fast, &mut device).expect("a search that the block does");
    let mut block = Box::new(WinnerPipeline::<Block, W, D>::new());
    assert_eq!(block.start(&fast, &mut device), refused);
    let mut paths = Box::new(WinnerPipeline::<Sgm, W, D>::new());
    let sgm = config::<Sgm>();
    assert_eq!(paths.start(&sgm, &mut device), refused);
    // Penalties are built in.
    let mut device = WinnerRegisters::new(MockBlock::new(&twin::Method::SGM, &sgm, &pictures.0, &pictures.1));
    paths.start(&sgm, &mut device).expect("a search that the block does");
    let penalties = Penalties { step: [17, 9], ..sgm.penalties };
    assert_eq!(paths.start(&Config { penalties, ..sgm }, &mut device), refused);
}

/// Offsets and bits stand in two languages: above the gates' own file, and here.
#[test]
fn the_registers_are_those_of_the_gates() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/fpga/rtl/stereo_registers.v");
    let gates = std::fs::read_to_string(path).expect("the file of the gates' registers");
    let lines: Vec<_> = gates.lines().filter_map(|line| line.strip_prefix("//   ")).collect();
    for (register, name) in [
        (Register::Id, "ID"),
        (Register::Control, "CONTROL"),
        (Register::Status, "STATUS"),
        (Register::Size, "SIZE"),
        (Register::Search, "SEARCH"),
        (Register::Capacity, "CAPACITY"),
        (Register::Method, "METHOD"),
        (Register::Clocks, "CLOCKS"),
        (Register::Rows, "ROWS"),
    ] {
        let begins = format!("{:02x} {name} ", register as u8);
        assert!(lines.iter().any(|line| line.starts_with(&begins)), "{begins}");
    }
}

#[test]
fn every_bit_of_a_record_is_held_by_its_check_byte() {
    let record = WinnerRecord::new(3, 40, [50, 60]).with_kept(2).with_second(70).sealed(700);
    assert!(record.is_intact(700));
    for bit in 0..64 {
        let bits = u64::from_le_bytes(record.bytes()) ^ 1 << bit;
        assert!(!WinnerRecord::from_bytes(bits.to_le_bytes()).is_intact(700), "bit {bit}");
    }
}
