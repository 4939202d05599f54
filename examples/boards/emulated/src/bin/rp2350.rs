//! The bands of both cores of an RP2350, one after the other.
#![no_std]
#![no_main]

use embassy_futures::{block_on, join::join};
use emulated_boards::{Checksum, capture, entry, matched};
use static_cell::ConstStaticCell;

#[path = "../../../rp2350/src/band.rs"]
#[expect(dead_code, reason = "the board's task says depths, this program the rows")]
mod band;

static MEMORIES: [ConstStaticCell<band::Memory>; 2] =
    [const { ConstStaticCell::new(band::Memory::new()) }; 2];

#[entry]
fn main() -> ! {
    let mut checksum = Checksum::new();
    for (half, memory) in band::bands().zip(&MEMORIES) {
        let (matching, mut destination) = band::start(half, memory.take());
        let band::Matching { band, pipeline, mut cameras, mut lines, .. } = matching;
        let captured = capture(band::WIDTH, band::HEIGHT, |frame, start, (left, right)| {
            destination.hand_on(frame, start, |bytes| {
                bytes[..left.len()].copy_from_slice(left);
                bytes[left.len()..].copy_from_slice(right);
            });
        });
        // The rows of the overlap are the other core's.
        let is_taken = |row| band.row(row).is_some();
        let rows = matched(pipeline, &mut cameras, &mut lines, is_taken, &mut checksum);
        block_on(join(captured, rows));
    }
    checksum.end()
}
