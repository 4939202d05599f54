//! The matcher of an STM32H743.
#![no_std]
#![no_main]

use board_matchers::one_core::{Matching, Memory, start};
use board_matchers::{HEIGHT, WIDTH};
use embassy_futures::{block_on, join::join};
use emulated_boards::{Checksum, capture, entry, matched};
use static_cell::ConstStaticCell;

static MEMORY: ConstStaticCell<Memory> = ConstStaticCell::new(Memory::new());

#[entry]
fn main() -> ! {
    let mut checksum = Checksum::new();
    let (matching, mut destination) = start(MEMORY.take());
    let Matching { rows, mut cameras, mut lines, .. } = matching;
    let captured = capture(WIDTH, HEIGHT, |frame, start, (left, right)| {
        let mut line = destination.producer.begin().expect("a slot, for each line is matched at once");
        let bytes = line.bytes();
        bytes[..left.len()].copy_from_slice(left);
        bytes[left.len()..].copy_from_slice(right);
        destination.producer.finish(line, frame, start);
        destination.notifier.notify();
    });
    let matched = matched(rows, &mut cameras, &mut lines, |_| true, &mut checksum);
    block_on(join(captured, matched));
    checksum.end()
}
