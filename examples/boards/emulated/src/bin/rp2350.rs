//! The bands of both cores of an RP2350, one after the other.
#![no_std]
#![no_main]

use board_matchers::two_cores::{Matching, Memory, bands, start};
use board_matchers::{HEIGHT, WIDTH};
use embassy_futures::{block_on, join::join};
use emulated_boards::{Checksum, capture, entry, matched};
use static_cell::ConstStaticCell;

static MEMORIES: [ConstStaticCell<Memory>; 2] = [const { ConstStaticCell::new(Memory::new()) }; 2];

#[entry]
fn main() -> ! {
    let mut checksum = Checksum::new();
    for (half, memory) in bands().zip(&MEMORIES) {
        let (matching, mut destination) = start(half, memory.take());
        let Matching { band, rows, mut cameras, mut lines, .. } = matching;
        let captured = capture(WIDTH, HEIGHT, |frame, start, (left, right)| {
            destination.hand_on(frame, start, |bytes| {
                bytes[..left.len()].copy_from_slice(left);
                bytes[left.len()..].copy_from_slice(right);
            });
        });
        // The rows of the overlap are the other core's.
        let is_taken = |row| band.row(row).is_some();
        let matched = matched(rows, &mut cameras, &mut lines, is_taken, &mut checksum);
        block_on(join(captured, matched));
    }
    checksum.end()
}
