//! The block behind registers in memory and a ring that channels fill: the rows are the method's own, and a
//! row that is lost or spoiled costs no other.

use super::winners::{D, Failed, HEIGHT, Rows, W, WIDTH, config, frame, own, pictures};
use std::convert::Infallible;
use std::sync::atomic::{AtomicU32, Ordering};
use stereopsis::matching::{Block, WinnerRecord};
use stereopsis::pipeline::winners::{
    BlockDma, MappedBlock, Register, RegisterBus, WinnerError, WinnerPipeline, WinnerRegisters, status,
};
use stereopsis::units::PixelFlags;
use stereopsis_host::twin;
use stereopsis_host::winners::{MockBlock, WinnerFault};

/// The model behind registers in memory and channels that fill a ring.
struct Channels<'a> {
    block: MockBlock,
    registers: &'a [AtomicU32; 9],
    ring: &'a [[AtomicU32; 2]],
    place: usize,
    /// A row whose last record is written so many times more.
    surplus: Option<(u8, usize)>,
}

impl BlockDma for Channels<'_> {
    type Error = Infallible;

    fn position(&mut self) -> Result<usize, Infallible> {
        let mut row = [WinnerRecord::ZERO; WIDTH];
        let given = self.block.receive(&mut row)?;
        let more = match (self.surplus, given) {
            (Some((of, more)), 1..) if row[given - 1].row() == of => more,
            _ => 0,
        };
        for record in row[..given].iter().chain(std::iter::repeat_n(&row[WIDTH - 1], more)) {
            let words = u64::from_le_bytes(record.bytes());
            for (to, word) in self.ring[self.place].iter().zip([words as u32, (words >> 32) as u32]) {
                to.store(word, Ordering::Relaxed);
            }
            self.place = (self.place + 1) % self.ring.len();
        }
        self.registers[Register::Status as usize / 4]
            .store(self.block.read(Register::Status)?, Ordering::Relaxed);
        Ok(self.place)
    }

    fn send_line(&mut self, is_first: bool, left: &[u8], right: &[u8]) -> Result<(), Infallible> {
        if is_first {
            // What the core wrote to the registers.
            self.block.write(Register::Control, 2)?;
            self.block.write(Register::Status, status::ALL)?;
            for register in [Register::Size, Register::Search, Register::Control] {
                let value = self.registers[register as usize / 4].load(Ordering::Relaxed);
                self.block.write(register, value)?;
            }
        }
        self.block.send_line(is_first, left, right)
    }
}

#[test]
fn registers_in_the_address_space_and_a_ring_give_the_same_rows() {
    let (config, pictures) = (config::<Block>(), pictures(6));
    let mut block = MockBlock::new(&twin::Method::BLOCK, &config, &pictures.0, &pictures.1);
    let registers = [0; 9].map(AtomicU32::new);
    for register in [Register::Id, Register::Method] {
        let value = block.read(register).expect("a register");
        registers[register as usize / 4].store(value, Ordering::Relaxed);
    }
    // Rows lie over its end.
    let ring = [const { [const { AtomicU32::new(0) }; 2] }; 2 * WIDTH + 7];
    let channels = Channels { block, registers: &registers, ring: &ring, place: 11, surplus: None };
    let mut device = WinnerRegisters::new(MappedBlock::new(&registers, &ring, channels, 3));
    let mut pipeline = Box::new(WinnerPipeline::<Block, W, D>::new());
    pipeline.start(&config, &mut device).expect("a search that the block does");
    pipeline.set_most_lost(1);
    let expected = own::<Block>(&config, &pictures);
    let flipped = |column, bit| WinnerFault::Flipped { column, bit };
    for (row, fault) in [
        (20, WinnerFault::Lost),
        (30, WinnerFault::Short),
        (31, flipped(0, 24)),
        // The row's number.
        (40, flipped(0, 48)),
        (40, flipped(50, 48)),
        (HEIGHT - 1, flipped(WIDTH - 1, 63)),
    ] {
        assert!(frame(&mut pipeline, &mut device, &pictures).expect("rows") == expected, "{fault:?}");
        device.bus().dma().block.faults = [(row, fault)].into();
        let rows = frame(&mut pipeline, &mut device, &pictures).expect("one row may be lost");
        assert_eq!(pipeline.lost(), 1, "{row} {fault:?}");
        for (y, (found, own)) in rows.iter().zip(&expected).enumerate() {
            let is_flagged = found.1.iter().all(|flags| flags.contains(PixelFlags::DAMAGED));
            assert_eq!(is_flagged, (row.saturating_sub(4)..=row + 10).contains(&y), "{row} {fault:?} {y}");
            assert!(is_flagged || found == own, "{row} {fault:?} {y}");
        }
        device.bus().dma().block.faults = [(9, WinnerFault::CutOff)].into();
        let cut_off: Result<Rows, Failed> = Err(WinnerError::FrameCutOff.into());
        assert!(frame(&mut pipeline, &mut device, &pictures) == cut_off, "{fault:?}");
        device.bus().dma().block.faults.clear();
    }
    // A row of too many records is counted whole, and costs no other.
    for (row, more) in [(20, 1), (30, 5), (HEIGHT - 1, 2)] {
        device.bus().dma().surplus = Some((row as u8, more));
        pipeline.set_most_lost(1);
        let rows = frame(&mut pipeline, &mut device, &pictures).expect("one row may be lost");
        assert_eq!(pipeline.lost(), 1, "{row}: {more} more");
        for (y, (found, own)) in rows.iter().zip(&expected).enumerate() {
            let is_flagged = found.1.iter().all(|flags| flags.contains(PixelFlags::DAMAGED));
            assert_eq!(is_flagged, (row.saturating_sub(4)..=row + 10).contains(&y), "{row}: {y}");
            assert!(is_flagged || found == own, "{row}: {y}");
        }
        pipeline.set_most_lost(0);
        let counted: Result<Rows, Failed> =
            Err(WinnerError::Count { row: row as u16, given: WIDTH + more }.into());
        assert!(frame(&mut pipeline, &mut device, &pictures) == counted, "{row}: {more} more");
        device.bus().dma().surplus = None;
        assert!(
            frame(&mut pipeline, &mut device, &pictures).expect("rows") == expected,
            "{row}: {more} more"
        );
    }
}
