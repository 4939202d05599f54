//! The stack that a linked program for a Cortex-M can take, from its instructions: what each function pushes,
//! and whom it calls.
//!
//! A function's frame is all that its instructions take off the stack pointer, in whatever order: at least
//! what it takes in any run. A call to what a register says may go to every function whose address stands
//! among the constants. A cycle of calls, a jump to what memory says and a stack pointer set otherwise are
//! failures, so that a number is a bound. Instructions and their fields: ARM DDI 0403, "ARMv7-M Architecture
//! Reference Manual", chapter A7.

use crate::steps::{Failure, Outcome};
use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};
use rustc_demangle::demangle;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// A function: what it takes of the stack, and the addresses that it calls or jumps to.
#[derive(Default, Debug, PartialEq)]
struct Function {
    name: String,
    frame: u64,
    calls: BTreeSet<u64>,
    /// Whether it calls what a register says.
    calls_any: bool,
    /// Words among its constants, and those that two instructions make.
    constants: Vec<u64>,
    /// Lower halves that `movw` has put into registers.
    lower: [u32; 16],
    /// What makes it no bound.
    unknown: Option<String>,
}

/// The functions of a program by their addresses, and those whose addresses stand among its constants.
pub struct CallGraph {
    functions: BTreeMap<u64, Function>,
    named: BTreeSet<u64>,
}

/// The most that a chain of calls takes, and the chain.
#[derive(Clone, Default)]
pub struct Chain {
    /// Bytes of stack.
    pub bytes: u64,
    /// Names and frames, the caller first.
    pub frames: Vec<(String, u64)>,
}

impl Chain {
    /// The functions, each with its frame.
    pub fn names(&self) -> String {
        let one = |(name, frame): &(String, u64)| format!("{name} {frame}");
        self.frames.iter().map(one).collect::<Vec<_>>().join(", ")
    }
}

impl CallGraph {
    /// Reads a linked program.
    pub fn of(path: &Path) -> Outcome<Self> {
        let failed = |what: String| Failure::new(format!("{}: {what}", path.display()));
        let bytes = fs::read(path).map_err(|e| failed(e.to_string()))?;
        let file = object::File::parse(bytes.as_slice()).map_err(|e| failed(e.to_string()))?;
        let (mut functions, mut data) = (BTreeMap::new(), BTreeSet::new());
        // `$d` and `$t` say where constants among the instructions begin and end.
        let marks: BTreeMap<u64, bool> = file
            .symbols()
            .filter_map(|symbol| match symbol.name().ok()?.get(..2)? {
                "$d" => Some((symbol.address(), true)),
                "$t" => Some((symbol.address(), false)),
                _ => None,
            })
            .collect();
        for (&start, _) in marks.iter().filter(|(_, is_data)| **is_data) {
            let end = marks.range(start + 1..).next().map_or(u64::MAX, |(end, _)| *end);
            data.insert((start, end));
        }
        for symbol in file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text && symbol.size() > 0) {
            let start = symbol.address() & !1;
            let Some(index) = symbol.section_index() else { continue };
            let section = file.section_by_index(index).map_err(|e| failed(e.to_string()))?;
            let code = section.data_range(start, symbol.size()).map_err(|e| failed(e.to_string()))?;
            let name = format!("{:#}", demangle(symbol.name().map_err(|e| failed(e.to_string()))?));
            let is_data =
                |at: u64| data.range(..=(at, u64::MAX)).next_back().is_some_and(|(_, end)| at < *end);
            functions.insert(start, Function::of(name, start, code.unwrap_or_default(), is_data));
        }
        let words = |name: &str| -> Outcome<Vec<u64>> {
            let Some(section) = file.section_by_name(name) else { return Ok(Vec::new()) };
            let words = section.data().map_err(|e| failed(e.to_string()))?.as_chunks().0;
            Ok(words.iter().map(|word| u64::from(u32::from_le_bytes(*word))).collect())
        };
        let own = functions.values().flat_map(|function: &Function| function.constants.iter().copied());
        let constants = [own.collect(), words(".rodata")?, words(".data")?].concat();
        // What the vector table names the core alone enters.
        let entered = words(".vector_table")?;
        // The lowest bit of an address in Thumb code says that it is.
        let odd = constants.into_iter().filter(|word| word & 1 == 1 && !entered.contains(word));
        let named = odd.map(|word| word - 1).filter(|address| functions.contains_key(address)).collect();
        Ok(Self { functions, named })
    }

    /// The deepest chain of calls from the function whose path ends so.
    pub fn deepest(&self, root: &str) -> Outcome<Chain> {
        let of_name = |(_, function): &(&u64, &Function)| function.name.ends_with(root);
        let mut roots = self.functions.iter().filter(of_name);
        let (Some((address, _)), None) = (roots.next(), roots.next()) else {
            return Err(Failure::new(format!("{root} is the name of no function, or of several")));
        };
        self.from(*address, &mut Vec::new(), &mut BTreeMap::new())
    }

    /// The deepest chain from an address; `open` are the callers, `done` what is known.
    fn from(&self, address: u64, open: &mut Vec<u64>, done: &mut BTreeMap<u64, Chain>) -> Outcome<Chain> {
        if let Some(chain) = done.get(&address) {
            return Ok(chain.clone());
        }
        let Some(function) = self.functions.get(&address) else {
            return Err(Failure::new(format!("a call goes to {address:#x}, which is no function")));
        };
        let name = &function.name;
        if let Some(unknown) = &function.unknown {
            return Err(Failure::new(format!("{name}: {unknown}")));
        }
        if open.contains(&address) {
            return Err(Failure::new(format!("{name} calls itself")));
        }
        open.push(address);
        let mut deepest = Chain::default();
        let any = self.named.iter().filter(|_| function.calls_any);
        for callee in function.calls.iter().chain(any) {
            let chain = self.from(*callee, open, done)?;
            if chain.bytes >= deepest.bytes {
                deepest = chain;
            }
        }
        open.pop();
        deepest.bytes += function.frame;
        deepest.frames.insert(0, (name.clone(), function.frame));
        done.insert(address, deepest.clone());
        Ok(deepest)
    }
}

impl Function {
    /// Reads the instructions of a function that starts there.
    fn of(name: String, start: u64, code: &[u8], is_data: impl Fn(u64) -> bool) -> Self {
        let mut function = Self { name, ..Self::default() };
        let end = start + code.len() as u64;
        let half = |at: u64| {
            let at = (at - start) as usize;
            code.get(at..at + 2).map_or(0, |two| u32::from(u16::from_le_bytes([two[0], two[1]])))
        };
        let mut at = start;
        while at < end {
            let first = half(at);
            let here = at;
            if is_data(here) {
                function
                    .constants
                    .extend(here.is_multiple_of(4).then(|| u64::from(half(here + 2) << 16 | first)));
                at += 2;
                continue;
            }
            let is_long = first >> 11 >= 0b11101;
            at += if is_long { 4 } else { 2 };
            let target = if is_long { function.long(first, half(here + 2)) } else { function.short(first) };
            // Relative to what is read four bytes on.
            let target = target.map(|offset| (here + 4).wrapping_add_signed(offset));
            function.calls.extend(target.filter(|target| !(start..end).contains(target) || *target == start));
        }
        // A jump back to the first instruction is a loop unless it pushes what it would push again.
        if function.frame == 0 {
            function.calls.remove(&start);
        }
        function
    }

    /// An instruction of 16 bits; how far it jumps.
    fn short(&mut self, code: u32) -> Option<i64> {
        let listed = u64::from((code & 0x1ff).count_ones());
        match code {
            // push
            _ if code & 0xfe00 == 0xb400 => self.frame += 4 * listed,
            // sub sp, #
            _ if code & 0xff80 == 0xb080 => self.frame += 4 * u64::from(code & 0x7f),
            // mov sp, register; add sp, register
            _ if code & 0xff87 == 0x4685 || code & 0xff87 == 0x4485 => {
                self.unknown("the stack pointer is set")
            }
            // blx register; bx of another than lr
            _ if code & 0xff87 == 0x4780 || code & 0xff87 == 0x4700 && code != 0x4770 => {
                self.calls_any = true
            }
            // mov pc, register
            _ if code & 0xff87 == 0x4687 => self.unknown("it jumps where a register says"),
            // b, b with a condition
            _ if code & 0xf800 == 0xe000 => return Some(signed(code << 1, 12)),
            _ if code & 0xf000 == 0xd000 && code & 0x0e00 != 0x0e00 => return Some(signed(code << 1, 9)),
            _ => {}
        }
        None
    }

    /// An instruction of 32 bits; how far it jumps.
    fn long(&mut self, first: u32, second: u32) -> Option<i64> {
        let immediate = (first >> 10 & 1) << 11 | (second >> 12 & 7) << 8 | second & 0xff;
        let register = (second >> 8 & 0xf) as usize;
        match first {
            // stmdb sp!
            0xe92d => self.frame += 4 * u64::from(second.count_ones()),
            // strd [sp, #-]!, str [sp, #-]!, vpush
            0xe96d => self.frame += 4 * u64::from(second & 0xff),
            0xf84d if second & 0x0f00 == 0x0d00 => self.frame += u64::from(second & 0xff),
            _ if first & 0xffbf == 0xed2d => self.frame += 4 * u64::from(second & 0xff),
            // sub.w sp, sp, #; subw sp, sp, #
            _ if first & 0xfbef == 0xf1ad && register == 13 => match expanded(immediate) {
                Some(bytes) => self.frame += u64::from(bytes),
                None => self.unknown("the stack pointer is set"),
            },
            _ if first & 0xfbff == 0xf2ad && register == 13 => self.frame += u64::from(immediate),
            // sub or mov sp of registers
            _ if (first & 0xffe0 == 0xeba0 || first & 0xffef == 0xea4f) && register == 13 => {
                self.unknown("the stack pointer is set");
            }
            // movw, movt
            _ if first & 0xfbf0 == 0xf240 => self.lower[register] = (first & 0xf) << 12 | immediate,
            _ if first & 0xfbf0 == 0xf2c0 => {
                let upper = (first & 0xf) << 12 | immediate;
                self.constants.push(u64::from(upper << 16 | self.lower[register]));
            }
            // ldr pc, [..]
            _ if first & 0xff70 == 0xf850 && second >> 12 == 15 => self.unknown("it jumps where memory says"),
            // bl, b.w, b.w with a condition
            _ if first & 0xf800 == 0xf000 && matches!(second & 0xd000, 0xd000 | 0x9000) => {
                let sign = first >> 10 & 1;
                let [one, two] = [second >> 13 & 1, second >> 11 & 1].map(|bit| 1 ^ bit ^ sign);
                let offset =
                    sign << 24 | one << 23 | two << 22 | (first & 0x3ff) << 12 | (second & 0x7ff) << 1;
                return Some(signed(offset, 25));
            }
            _ if first & 0xf800 == 0xf000 && second & 0xd000 == 0x8000 && first & 0x0380 != 0x0380 => {
                let (sign, one, two) = (first >> 10 & 1, second >> 13 & 1, second >> 11 & 1);
                let offset =
                    sign << 20 | two << 19 | one << 18 | (first & 0x3f) << 12 | (second & 0x7ff) << 1;
                return Some(signed(offset, 21));
            }
            _ => {}
        }
        None
    }

    fn unknown(&mut self, what: &str) {
        self.unknown = Some(what.to_owned());
    }
}

/// A number of so many bits with its sign.
fn signed(number: u32, bits: u32) -> i64 {
    i64::from((number << (32 - bits)) as i32 >> (32 - bits))
}

/// A modified immediate constant; none of those that fill words with bytes.
fn expanded(immediate: u32) -> Option<u32> {
    match immediate >> 8 {
        0 => Some(immediate),
        1..=3 => None,
        _ => Some((0x80 | immediate & 0x7f).rotate_right(immediate >> 7)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A function of these half-words at 0x1000.
    fn function(code: &[u16]) -> Function {
        let bytes: Vec<_> = code.iter().flat_map(|half| half.to_le_bytes()).collect();
        Function::of(String::new(), 0x1000, &bytes, |_| false)
    }

    #[test]
    fn frames_are_what_is_pushed() {
        // push {r4, r5, lr}; sub sp, #12; vpush {d8, d9}; push.w {r4, r8}; sub.w sp, sp, #1024; pop.
        let code = [0xb530, 0xb083, 0xed2d, 0x8b04, 0xe92d, 0x0110, 0xf5ad, 0x6d80, 0xbd30];
        assert_eq!(function(&code).frame, 12 + 12 + 16 + 8 + 1024);
        // subw sp, sp, #4095; str r4, [sp, #-8]!; strd r4, r5, [sp, #-8]!
        let code = [0xf6ad, 0x7dff, 0xf84d, 0x4d08, 0xe96d, 0x4502];
        assert_eq!(function(&code).frame, 4095 + 8 + 8);
        assert!(function(&[0x46a5]).unknown.is_some(), "mov sp, r4");
    }

    #[test]
    fn calls_are_to_where_they_lead() {
        // bl to itself + 4 + 0x100; b.w back by 0x10; a jump within.
        let called = function(&[0xf000, 0xf880, 0xf7ff, 0xbff8, 0xe7fa]);
        assert_eq!(called.calls, BTreeSet::from([0x1104, 0xff8]));
        // movw r3, #0x1235; movt r3, #0x2000
        assert_eq!(function(&[0xf241, 0x2335, 0xf2c2, 0x0300]).constants, [0x2000_1235]);
        assert!(function(&[0x4788]).calls_any && !function(&[0x4770]).calls_any);
    }

    #[test]
    fn the_deepest_chain_counts_and_a_cycle_is_none() {
        let of = |name: &str, frame, calls: &[u64]| Function {
            name: name.to_owned(),
            frame,
            calls: calls.iter().copied().collect(),
            ..Function::default()
        };
        let functions = BTreeMap::from([
            (0, of("a", 8, &[2, 4])),
            (2, of("b", 100, &[])),
            (4, of("c", 40, &[6])),
            (6, of("d", 64, &[])),
        ]);
        let mut graph = CallGraph { functions, named: BTreeSet::from([2]) };
        let deepest = graph.deepest("a").expect("no cycle");
        assert_eq!((deepest.bytes, deepest.frames.len()), (112, 3));
        // What is called by a register may be any that is named.
        graph.functions.insert(6, Function { calls_any: true, ..of("d", 64, &[]) });
        assert_eq!(graph.deepest("a").expect("no cycle").bytes, 8 + 40 + 64 + 100);
        graph.functions.insert(6, of("d", 64, &[4]));
        assert!(graph.deepest("a").is_err());
        assert!(graph.deepest("e").is_err());
    }
}
