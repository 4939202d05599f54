//! A model of the block in `examples/fpga` that plays the twin's winners, with faults where they are wanted.

use crate::twin;
use crate::twin::stages::Stages;
use image::GrayImage;
use std::collections::BTreeMap;
use std::convert::Infallible;
use stereopsis::matching::{Config, WinnerRecord};
use stereopsis::pipeline::winners::{Register, RegisterBus, status};

/// What is wrong with a row of winners.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum WinnerFault {
    /// It comes when the next one is asked for.
    Late,
    /// It never comes.
    Lost,
    /// Its last record is missing.
    Short,
    /// One bit is wrong: a number from 0, eight times the byte and its bit, in the record of a column.
    Flipped {
        /// The column.
        column: usize,
        /// The bit of its record, 0 to 63.
        bit: u32,
    },
    /// The frame ends there: a line that went in had a wrong length.
    LineLength,
    /// The frame ends there: the next one began.
    CutOff,
}

/// A model of the block's registers and its ring of records, for frames of one pair of pictures. Rows come
/// when enough lines are in, and no sooner.
pub struct MockBlock {
    number: u32,
    radius_y: usize,
    capacity: [u32; 2],
    winners: Vec<WinnerRecord>,
    /// Faults by row.
    pub faults: BTreeMap<usize, WinnerFault>,
    size: [usize; 2],
    search: usize,
    enabled: bool,
    status: u32,
    lines: usize,
    row: usize,
    /// A row that is late.
    late: bool,
    is_over: bool,
}

impl MockBlock {
    /// A block of a method, with room for lines of 1280 pixels and 128 disparities, before two cameras that
    /// see one pair of pictures.
    ///
    /// # Panics
    ///
    /// When the method is none of the block's.
    pub fn new(method: &twin::Method, config: &Config, left: &GrayImage, right: &GrayImage) -> Self {
        let number =
            [twin::Method::FAST, twin::Method::BLOCK, twin::Method::SGM].iter().position(|m| m == method);
        Self {
            number: number.expect("a method of the block") as u32,
            radius_y: method.radius_y,
            capacity: [1280, 128],
            winners: without_second_best(Stages::of(method, config, left, right).winners),
            faults: BTreeMap::new(),
            size: [0; 2],
            search: 0,
            enabled: false,
            status: 0,
            lines: 0,
            row: 0,
            late: false,
            is_over: false,
        }
    }

    /// The records of a row.
    fn records(&self, row: usize) -> &[WinnerRecord] {
        let [width, _] = self.size;
        &self.winners[row * width..(row + 1) * width]
    }
}

/// Records as the block gives them, which seeks no second best.
pub fn without_second_best(winners: Vec<WinnerRecord>) -> Vec<WinnerRecord> {
    let without = |winner: WinnerRecord| {
        let [.., row, _] = winner.bytes();
        winner.with_second(u8::MAX).sealed(row.into())
    };
    winners.into_iter().map(without).collect()
}

impl RegisterBus for MockBlock {
    type Error = Infallible;

    fn read(&mut self, register: Register) -> Result<u32, Infallible> {
        Ok(match register {
            Register::Id => 0x5342_0001,
            Register::Control => self.enabled.into(),
            Register::Status => self.status,
            Register::Size => (self.size[0] | self.size[1] << 16) as u32,
            Register::Search => self.search as u32,
            Register::Capacity => self.capacity[0] | self.capacity[1] << 16 | self.capacity[1] << 24,
            Register::Method => self.number | (self.radius_y as u32) << 8,
            Register::Clocks => 0,
            Register::Rows => self.row as u32,
        })
    }

    fn write(&mut self, register: Register, value: u32) -> Result<(), Infallible> {
        let most = self.capacity.map(|most| most as usize);
        let [width, height] = self.size;
        let is_good = (16..=most[0]).contains(&width)
            && height > 0
            && (16..=most[1].min(width)).contains(&(self.search & 0xff));
        match register {
            Register::Control => {
                if value & 2 != 0 {
                    (self.lines, self.row, self.late, self.is_over) = (0, 0, false, false);
                }
                self.enabled = value & 1 != 0 && is_good;
                if value & 1 != 0 && !is_good {
                    self.status |= status::BAD_VALUE;
                }
            }
            Register::Status => self.status &= !(value & status::ALL),
            Register::Size | Register::Search if self.enabled => self.status |= status::BAD_VALUE,
            Register::Size => self.size = [(value & 0xffff) as usize, (value >> 16) as usize],
            Register::Search => self.search = value as usize,
            _ => {}
        }
        Ok(())
    }

    fn send_line(&mut self, is_first: bool, left: &[u8], right: &[u8]) -> Result<(), Infallible> {
        assert_eq!((left.len(), right.len()), (self.size[0], self.size[0]), "a line of the frame");
        if is_first {
            (self.lines, self.row, self.late, self.is_over) = (0, 0, false, false);
        }
        self.lines += 1;
        Ok(())
    }

    fn receive(&mut self, winners: &mut [WinnerRecord]) -> Result<usize, Infallible> {
        let [width, height] = self.size;
        // The row's last winners come while the line below those that it rests on goes in.
        let has_lines = self.lines >= (self.row + self.radius_y + 4).min(height);
        if !self.enabled || self.is_over || self.row >= height || !has_lines {
            return Ok(0);
        }
        let fault = self.faults.get(&self.row).copied();
        if fault == Some(WinnerFault::Late) && !self.late {
            self.late = true;
            return Ok(0);
        }
        self.late = false;
        if let Some(WinnerFault::LineLength | WinnerFault::CutOff) = fault {
            self.is_over = true;
            self.status |=
                if fault == Some(WinnerFault::CutOff) { status::CUT_OFF } else { status::TOO_SHORT };
            return Ok(0);
        }
        let row = self.row;
        self.row += 1;
        if fault == Some(WinnerFault::Lost) {
            return Ok(0);
        }
        winners[..width].copy_from_slice(self.records(row));
        match fault {
            Some(WinnerFault::Short) => return Ok(width - 1),
            Some(WinnerFault::Flipped { column, bit }) => {
                let bits = u64::from_le_bytes(winners[column].bytes()) ^ 1 << bit;
                winners[column] = WinnerRecord::from_bytes(bits.to_le_bytes());
            }
            _ => {}
        }
        if self.row == height {
            self.status |= status::DONE;
        }
        Ok(width)
    }

    fn forget_records(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
