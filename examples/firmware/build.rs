//! Turns what is asked for into constants, and hands the linker the board's memory.
//!
//! | variable | what it chooses | default |
//! | --- | --- | --- |
//! | `STEREO_METHOD` | `fast`, `block`, `sgm-lean`, `sgm` or `sgm-edge` | `block` |
//! | `STEREO_WIDTH`, `STEREO_HEIGHT` | capacity in pixels; size of the built-in scene | 160, 120 |
//! | `STEREO_DISPARITIES` | disparities that are searched, 16 to 256 | 32 |
//! | `STEREO_NOISE` | how noisy the cameras are: `none`, `low` or `high` | `none` |
//! | `STEREO_CORE` | the board's core, where the target leaves a choice | the target's first |
//! | `STEREO_MEMORY` | `budget` of memory.x, or all that the `board` has | `budget` |

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use firmware_boards::{self as board, Board};

/// The memory map, beside the crate's manifest; a copy of this folder has its own.
const MEMORY: &str = "../../memory.x";
/// What memory.x gives when nobody asks for more, bytes.
const BUDGET: u32 = 64 * 1024;

/// The methods and their types.
const METHODS: [(&str, &str); 5] = [
    ("fast", "stereopsis::matching::Fast"),
    ("block", "stereopsis::matching::Block"),
    ("sgm-lean", "stereopsis::matching::SgmLean"),
    ("sgm", "stereopsis::matching::Sgm"),
    ("sgm-edge", "stereopsis::matching::SgmEdge"),
];

/// The names that riscv-rt's linker script uses for the two memories.
const RISCV_REGIONS: &str = "\
REGION_ALIAS(\"REGION_TEXT\", FLASH);
REGION_ALIAS(\"REGION_RODATA\", FLASH);
REGION_ALIAS(\"REGION_DATA\", RAM);
REGION_ALIAS(\"REGION_BSS\", RAM);
REGION_ALIAS(\"REGION_HEAP\", RAM);
REGION_ALIAS(\"REGION_STACK\", RAM);
";

/// A stack that is too small for the pipeline does not link.
const STACK: &str = "ASSERT(_stack_start - __euninit >= 2048, \"ERROR: less than 2048 bytes of RAM are left \
                     to the stack\");\n";

fn main() -> Result<(), Box<dyn Error>> {
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("OUT_DIR is not set")?);
    let board = board()?;
    fs::write(out.join("choice.rs"), choice(&board)?)?;
    fs::copy(MEMORY, out.join("memory.x"))?;
    fs::write(out.join("regions.x"), RISCV_REGIONS)?;
    fs::write(out.join("stack.x"), STACK)?;
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rerun-if-changed={MEMORY}");
    println!("cargo:rerun-if-changed=build.rs");

    let all = match variable("STEREO_MEMORY", "budget").as_str() {
        "budget" => false,
        "board" => true,
        other => return Err(format!("STEREO_MEMORY={other}: budget or board").into()),
    };
    for (name, (origin, bytes)) in [("flash", board.flash), ("ram", board.ram)] {
        let length = if all { bytes } else { bytes.min(BUDGET) };
        link(&format!("--defsym=_{name}_origin={origin:#x}"));
        link(&format!("--defsym=_{name}_length={length:#x}"));
    }
    if board.target.starts_with("riscv") {
        link("-Tmemory.x");
        link("-Tregions.x");
    }
    link("-Tlink.x");
    link("-Tdefmt.x");
    link("-Tstack.x");
    // The vector table's and the sections' alignment is the script's business, not the page size's.
    link("--nmagic");
    Ok(())
}

/// An argument for the linker.
fn link(argument: &str) {
    println!("cargo:rustc-link-arg-bins={argument}");
}

/// The board that is built for: that of the core named, else the first of the target.
fn board() -> Result<Board, Box<dyn Error>> {
    let target = env::var("TARGET")?;
    let core = variable("STEREO_CORE", "");
    let fits = |board: &&Board| board.target == target && (core.is_empty() || board.core == core);
    let found = board::ALL.iter().find(fits);
    found
        .copied()
        .ok_or_else(|| format!("boards/src/lib.rs has no board with STEREO_CORE={core} for {target}").into())
}

/// The constants and types of `src/choice.rs`.
fn choice(board: &Board) -> Result<String, Box<dyn Error>> {
    let method = variable("STEREO_METHOD", "block");
    let names = METHODS.map(|(name, _)| name).join(", ");
    let (_, scheme) = METHODS
        .into_iter()
        .find(|(name, _)| *name == method)
        .ok_or_else(|| format!("STEREO_METHOD={method}: one of {names}"))?;
    let width = number("STEREO_WIDTH", 160, 16, 4096)?;
    let height = number("STEREO_HEIGHT", 120, 1, 4096)?;
    let disparities = number("STEREO_DISPARITIES", 32, 16, 256)?;
    let noise = match variable("STEREO_NOISE", "none").as_str() {
        "none" => "None",
        "low" => "Low",
        "high" => "High",
        other => return Err(format!("STEREO_NOISE={other}: none, low or high").into()),
    };
    let lanes = disparities.next_multiple_of(16);
    let room = width.max(lanes);
    Ok(format!(
        "/// The matching method.\npub type Method = {scheme};\n/// The matching method's name.\npub const \
         METHOD: &str = {method:?};\n/// Columns of the built-in scene, px.\npub const WIDTH: u16 = \
         {width};\n/// Rows of the built-in scene, px.\npub const HEIGHT: u16 = {height};\n/// Disparities \
         that are searched, px.\npub const DISPARITIES: u16 = {disparities};\n/// How noisy the cameras \
         are.\npub const NOISE: stereopsis::imaging::Noise = stereopsis::imaging::Noise::{noise};\n/// The \
         pipeline that has room for them.\npub type BoardPipeline = stereopsis::pipeline::Pipeline<Method, \
         {room}, {lanes}>;\n/// Columns that it has room for.\npub const ROOM: usize = {room};\n/// The \
         matcher in \
         it.\npub type BoardMatcher = stereopsis::matching::Matcher<Method, {room}, {lanes}>;\n/// The \
         pipeline behind winners from elsewhere that has \
         room for them.\npub type BoardWinners = \
         stereopsis::pipeline::winners::WinnerPipeline<Method, {room}, {lanes}>;\n/// The \
         board.\npub const BOARD: crate::board::Board = crate::board::{};\n",
        board.core.to_uppercase(),
    ))
}

/// A variable's number, refused outside of the limits.
fn number(name: &str, default: u16, least: u16, most: u16) -> Result<u16, Box<dyn Error>> {
    let text = variable(name, &default.to_string());
    let value = text.parse().ok().filter(|value| (least..=most).contains(value));
    value.ok_or_else(|| format!("{name}={text}: a whole number from {least} to {most} is needed").into())
}

/// A variable of the environment; a change of it builds anew.
fn variable(name: &str, default: &str) -> String {
    println!("cargo:rerun-if-env-changed={name}");
    env::var(name).unwrap_or_else(|_| default.to_owned())
}
