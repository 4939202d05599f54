//! What the block takes in an FPGA, by Yosys: the table of docs/performance.md.

use super::block::{Block, sources};
use crate::firmware::tables::{self, Part};
use crate::steps::{Failure, Outcome, command, ended_within, output_of, root, target_dir};
use std::fs;
use std::path::PathBuf;
use std::time::Duration;
use stereopsis_host::run::MethodName;

/// The table.
const SYNTHESIS: Part = Part { name: "synthesis", command: "cargo xtask rtl --synthesis" };

/// A family of FPGAs.
struct Family {
    name: &'static str,
    /// What Yosys makes for it.
    pass: &'static str,
    /// Cells, as Yosys counts them: look-up tables, carries (with two look-up tables in one), look-up tables
    /// as memory (with as many in one), registers, block RAM.
    luts: &'static str,
    carries: (&'static str, u32),
    memory: (&'static str, u32),
    registers: &'static str,
    ram: &'static str,
}

const ECP5: Family = Family {
    name: "ECP5",
    pass: "synth_ecp5",
    luts: "LUT4",
    carries: ("CCU2C", 2),
    memory: ("TRELLIS_DPR16X4", 4),
    registers: "TRELLIS_FF",
    ram: "DP16KD",
};

/// Carries have no look-up table of their own there: those beside them are counted as such.
const ICE40: Family = Family {
    name: "iCE40",
    pass: "synth_ice40",
    luts: "SB_LUT4",
    carries: ("SB_CARRY", 0),
    memory: ("-", 0),
    registers: "SB_DFF",
    ram: "SB_RAM40_4K",
};

/// A block for a family; with a clock where place and route of the family can be had.
struct Made {
    family: &'static Family,
    block: Block,
    is_placed: bool,
}

const fn made(
    family: &'static Family,
    method: MethodName,
    width: u16,
    disparities: u16,
    parallel: u16,
) -> Made {
    let block = Block { width, disparities, parallel, method, second_best: false };
    Made { family, block, is_placed: false }
}

/// The lines of the table.
const ALL: [Made; 7] = [
    made(&ECP5, MethodName::Block, 640, 64, 64),
    made(&ECP5, MethodName::Block, 640, 64, 8),
    made(&ECP5, MethodName::Fast, 640, 64, 64),
    made(&ECP5, MethodName::Fast, 640, 64, 8),
    made(&ECP5, MethodName::Block, 1280, 128, 16),
    made(&ECP5, MethodName::Sgm, 640, 64, 8),
    Made { is_placed: true, ..made(&ICE40, MethodName::Fast, 160, 32, 8) },
];

/// Makes the table and writes it.
pub fn run() -> Outcome {
    let mut table =
        "| method | pixels in a line | disparities | in a clock | family | LUT4 | registers | block \
                     RAM | clock, MHz |\n| --- | ---: | ---: | ---: | --- | ---: | ---: | ---: | ---: |\n"
            .to_owned();
    for made in ALL {
        let line = made.line()?;
        print!("{line}");
        table += &line;
    }
    let version = output_of(&mut command("yosys", &["-V"]))?;
    let version = version.split_whitespace().take(2).collect::<Vec<_>>().join(" ");
    tables::splice(&SYNTHESIS, &format!("{table}\nSynthesis: {version}.\n"))
}

impl Made {
    fn line(&self) -> Outcome<String> {
        let Self { family, block, .. } = self;
        let folder = root().join(target_dir()).join("rtl");
        fs::create_dir_all(&folder).map_err(|e| Failure::new(format!("{}: {e}", folder.display())))?;
        let netlist = folder.join(format!("{}-{}.json", block.name(), family.name));
        let cells = self.synthesise(&netlist)?;
        let count = |name: &str| cells.iter().filter(|cell| cell.0 == name).map(|cell| cell.1).sum::<u32>();
        let begins =
            |name: &str| cells.iter().filter(|cell| cell.0.starts_with(name)).map(|cell| cell.1).sum();
        let registers: u32 = begins(family.registers);
        let luts = count(family.luts)
            + count(family.carries.0) * family.carries.1
            + count(family.memory.0) * family.memory.1;
        let clock = if self.is_placed { format!("{:.0}", clock_mhz(&netlist)?) } else { "-".into() };
        Ok(format!(
            "| `{}` | {} | {} | {} | {} | {luts} | {registers} | {} | {clock} |\n",
            block.method,
            block.width,
            block.disparities,
            block.parallel,
            family.name,
            count(family.ram)
        ))
    }

    /// Writes the netlist, and returns the cells that it has, by name.
    fn synthesise(&self, netlist: &std::path::Path) -> Outcome<Vec<(String, u32)>> {
        let Self { family, block, .. } = self;
        let files: Vec<_> = sources()?.iter().map(|path| path.display().to_string()).collect();
        let set: Vec<_> =
            block.parameters().iter().map(|(name, value)| format!("-set {name} {value}")).collect();
        let top = block.top();
        let script = format!(
            "read_verilog {}; chparam {} {top}; {} -top {top} -json {}; stat",
            files.join(" "),
            set.join(" "),
            family.pass,
            netlist.display()
        );
        let text = output_of(&mut command("yosys", &["-p", &script]))?;
        let stat = text.rsplit("Number of cells:").next().unwrap_or_default();
        let cell = |line: &str| {
            let mut words = line.split_whitespace();
            Some((words.next()?.to_owned(), words.next()?.parse().ok()?))
        };
        let cells: Vec<_> = stat.lines().skip(1).map_while(cell).collect();
        if cells.is_empty() { Err(Failure::new("yosys counted no cells")) } else { Ok(cells) }
    }
}

/// The clock that place and route reaches on an HX8K.
fn clock_mhz(netlist: &PathBuf) -> Outcome<f64> {
    let mut place = command("nextpnr-ice40", &["--hx8k", "--package", "ct256", "--seed", "1"]);
    place.args(["--pcf-allow-unconstrained", "--json"]).arg(netlist);
    let log = netlist.with_extension("log");
    let ended = ended_within(place.arg("--log").arg(&log).arg("--quiet"), Duration::from_secs(900))?;
    let text = fs::read_to_string(&log).map_err(|e| Failure::new(format!("{}: {e}", log.display())))?;
    if !ended.status.success() {
        let last = text.lines().rev().find(|line| line.contains("ERROR")).unwrap_or("no error is told");
        return Err(Failure::new(format!("nextpnr-ice40: {last}")));
    }
    // The last one is that after routing.
    let told = text.lines().rev().find(|line| line.contains("Max frequency for clock"));
    let mhz = told.and_then(|line| line.split("': ").nth(1)?.split_whitespace().next()?.parse().ok());
    mhz.ok_or_else(|| Failure::new("nextpnr-ice40 tells no clock"))
}
