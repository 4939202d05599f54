//! The matcher of an STM32H743.
#![no_std]
#![no_main]

use embassy_futures::{block_on, join::join};
use emulated_boards::{Checksum, capture, entry, matched};
use static_cell::ConstStaticCell;

#[path = "../../../stm32h743/src/rows.rs"]
#[expect(dead_code, reason = "the board's task says depths, this program the rows")]
mod rows;

static MEMORY: ConstStaticCell<rows::Memory> = ConstStaticCell::new(rows::Memory::new());

#[entry]
fn main() -> ! {
    let mut checksum = Checksum::new();
    let (matching, mut destination) = rows::start(MEMORY.take());
    let rows::Matching { rows: pipeline, mut cameras, mut lines, .. } = matching;
    let captured = capture(rows::WIDTH, rows::HEIGHT, |frame, start, (left, right)| {
        let mut line = destination.producer.begin().expect("a slot, for each line is matched at once");
        let bytes = line.bytes();
        bytes[..left.len()].copy_from_slice(left);
        bytes[left.len()..].copy_from_slice(right);
        destination.producer.finish(line, frame, start);
        destination.notifier.notify();
    });
    let matched = matched(pipeline, &mut cameras, &mut lines, |_| true, &mut checksum);
    block_on(join(captured, matched));
    checksum.end()
}
