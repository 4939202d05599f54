//! The PIO program of `examples/boards/rp2350`, an instruction a clock, on the waves of a simulated HM01B0.

use super::source::root;
use std::collections::{HashMap, VecDeque};

/// An instruction, of those that the program uses.
#[derive(Clone, Debug)]
enum Instruction {
    PullBlock,
    /// To x or y, from the OSR.
    Move(usize),
    Set(usize, u32),
    Wait(u8, u8),
    In(u32),
    /// To the instruction, if x or y is not 0, which counts down.
    JumpDown(usize, usize),
}

/// The instructions of a program's text.
fn parse(text: &str) -> Vec<Instruction> {
    let lines = text.lines().map(|line| line.split(';').next().unwrap_or_default().trim());
    let lines: Vec<&str> = lines.filter(|line| !line.is_empty() && !line.starts_with('.')).collect();
    let (mut labels, mut code) = (HashMap::new(), Vec::new());
    for line in lines {
        match line.strip_suffix(':') {
            Some(label) => _ = labels.insert(label, code.len()),
            None => code.push(line),
        }
    }
    let register = |name: &str| ["x", "y"].iter().position(|known| *known == name).expect("x or y");
    let number = |text: &str| text.parse().expect("a number");
    let instruction = |line: &&str| {
        let line = line.replace(',', " ");
        match line.split_whitespace().collect::<Vec<_>>()[..] {
            ["pull", "block"] => Instruction::PullBlock,
            ["mov", to, "osr"] => Instruction::Move(register(to)),
            ["set", to, value] => Instruction::Set(register(to), number(value)),
            ["wait", level, "pin", pin] => Instruction::Wait(number(level) as u8, number(pin) as u8),
            ["in", "pins", bits] => Instruction::In(number(bits)),
            ["jmp", condition, label] => {
                let name = condition.strip_suffix("--").expect("a register that counts down");
                Instruction::JumpDown(register(name), labels[label])
            }
            _ => panic!("{line}"),
        }
    };
    code.iter().map(instruction).collect()
}

/// A state machine that shifts to the right and pushes words by itself; at its end it begins anew.
struct Machine {
    code: Vec<Instruction>,
    at: usize,
    registers: [u32; 2],
    osr: u32,
    isr: u32,
    bits: u32,
    to: VecDeque<u32>,
    from: Vec<u32>,
}

impl Machine {
    /// A clock, with these levels on the pins.
    fn clock(&mut self, pins: u8) {
        let mut next = self.at + 1;
        match self.code[self.at] {
            Instruction::PullBlock => match self.to.pop_front() {
                Some(word) => self.osr = word,
                None => next = self.at,
            },
            Instruction::Move(to) => self.registers[to] = self.osr,
            Instruction::Set(to, value) => self.registers[to] = value,
            Instruction::Wait(level, pin) => {
                if pins >> pin & 1 != level {
                    next = self.at;
                }
            }
            Instruction::In(bits) => {
                let low = u32::from(pins) & ((1 << bits) - 1);
                self.isr = self.isr >> bits | low << (32 - bits);
                self.bits += bits;
                if self.bits == 32 {
                    self.from.push(self.isr);
                    self.bits = 0;
                }
            }
            Instruction::JumpDown(register, to) => {
                let counter = &mut self.registers[register];
                if *counter != 0 {
                    next = to;
                }
                *counter = counter.wrapping_sub(1);
            }
        }
        self.at = if next < self.code.len() { next } else { 0 };
    }
}

const CLOCK: u8 = 1 << 4;
const LINE: u8 = 1 << 5;
const FRAME: u8 = 1 << 6;

/// Levels on the pins of a sensor that gives 122 lines of 162 pixels, `half` clocks for each level of PCLK;
/// which goes on between lines, or does not.
fn waves(frame: usize, half: usize, is_gated: bool) -> Vec<u8> {
    let mut levels = vec![0; 500];
    let pause = |levels: &mut Vec<u8>, others: u8| {
        for _ in 0..20 {
            levels.extend(vec![others; half]);
            levels.extend(vec![if is_gated { others } else { others | CLOCK }; half]);
        }
    };
    pause(&mut levels, FRAME);
    for v in 0..122 {
        for u in 0..162 {
            let grey = grey(frame, u, v);
            for data in [grey & 15, grey >> 4] {
                levels.extend(vec![FRAME | LINE | data; half]);
                levels.extend(vec![FRAME | LINE | CLOCK | data; half]);
            }
        }
        pause(&mut levels, FRAME);
    }
    levels
}

fn grey(frame: usize, u: usize, v: usize) -> u8 {
    (u * 13 + v * 7 + (u * v) % 11 + frame * 29) as u8
}

#[test]
fn a_state_machine_takes_the_pixels_within_the_border() {
    let path = root().join("examples/boards/rp2350/src/camera.pio");
    let code = parse(&std::fs::read_to_string(path).expect("the program"));
    assert!((10..=32).contains(&code.len()), "a PIO block has 32 instructions");
    // 150 MHz are 24 clocks for each level of a PCLK of 3.1 MHz; five are the least that the program takes.
    for (half, is_gated) in [(24, true), (24, false), (5, true)] {
        let to = VecDeque::from([[119, 2 * 160 - 1]; 2].concat());
        let (registers, from) = ([0; 2], Vec::new());
        let mut machine = Machine { code: code.clone(), at: 0, registers, osr: 0, isr: 0, bits: 0, to, from };
        for frame in 0..2 {
            waves(frame, half, is_gated).into_iter().for_each(|pins| machine.clock(pins));
            let bytes: Vec<u8> = machine.from.drain(..).flat_map(u32::to_le_bytes).collect();
            let expected = (1..121).flat_map(|v| (1..161).map(move |u| grey(frame, u, v)));
            assert!(bytes.into_iter().eq(expected), "frame {frame}, {half} clocks, gated: {is_gated}");
        }
        assert_eq!(machine.at, 0, "it waits for the next frame");
    }
}
