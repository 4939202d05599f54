//! The row whose winners are due.

use super::winners::{D, HEIGHT, W, WIDTH, config, pictures};
use stereopsis::matching::Block;
use stereopsis::pipeline::PushError;
use stereopsis::pipeline::winners::{WinnerPipeline, WinnerRegisters};
use stereopsis_host::twin;
use stereopsis_host::winners::MockBlock;
#[test]
fn the_row_that_is_due_is_told_before_its_line() {
    let (config, pictures) = (config::<Block>(), pictures(4));
    let block = MockBlock::new(&twin::Method::BLOCK, &config, &pictures.0, &pictures.1);
    let mut device = WinnerRegisters::new(block);
    let mut pipeline = Box::new(WinnerPipeline::<Block, W, D>::new());
    pipeline.start(&config, &mut device).expect("a search that the block does");
    assert_eq!(pipeline.winners_due(), Err(PushError::NotBegun));
    pipeline.begin_frame(&mut device).expect("a frame");
    let mut due = Vec::new();
    for line in pictures.0.as_raw().chunks(WIDTH).zip(pictures.1.as_raw().chunks(WIDTH)) {
        due.push(pipeline.winners_due().expect("a frame"));
        pipeline.push(line.0, line.1, &mut device).expect("a line");
    }
    loop {
        due.push(pipeline.winners_due().expect("a frame"));
        if pipeline.flush(&mut device).expect("a row").is_none() {
            break;
        }
    }
    // Winners need the lines of their window and of the census around it, and come with the line after.
    let first = due.iter().position(Option::is_some).expect("rows");
    assert_eq!(first, 4 + 2 + 1);
    let rows: Vec<_> = due.iter().skip(first).take(HEIGHT).flatten().map(|&row| usize::from(row)).collect();
    assert_eq!(rows, Vec::from_iter(0..HEIGHT));
    assert!(due.iter().skip(first + HEIGHT).all(Option::is_none), "{due:?}");
}
