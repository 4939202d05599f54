//! `stereo dump`: rows of a stage, for those who build it in hardware.

use crate::failure::Failure;
use crate::input::{self, Pair};
use crate::place::json;
use crate::shared::{MethodArgs, PairArgs, RangeArgs};
use clap::Args;
use std::path::PathBuf;
use stereopsis_host::dump::{Dump, Stage};
use stereopsis_host::output::Staging;
use stereopsis_host::run::MemoryPair;
use stereopsis_host::twin::stages::Stages;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo dump --left left.png --right right.png --disparities 64 --method block --stage winner --row 100 \
                           --out vectors

Written are winner.bin, winner.mem (for Verilog's $readmemh) and winner.json (sizes, CRC-32 of each row, \
                           version). docs/bits.md has the equations of each stage and the bytes of its rows.";

#[derive(Debug, Args)]
pub struct DumpArgs {
    #[command(flatten)]
    pub pair: PairArgs,
    #[command(flatten)]
    pub range: RangeArgs,
    #[command(flatten)]
    pub method: MethodArgs,
    /// The stage: census, cost, aggregated, winner, left-right, subpixel, smoothed, checked or final
    #[arg(long, value_name = "STAGE")]
    pub stage: Stage,
    /// The row, from 0, or all
    #[arg(long, value_name = "Y", default_value = "all", value_parser = rows, allow_negative_numbers = true)]
    pub row: Rows,
    /// The folder for the files
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Which rows are written.
#[derive(Clone, Copy, Debug)]
pub enum Rows {
    All,
    One(usize),
}

fn rows(text: &str) -> Result<Rows, &'static str> {
    if text == "all" {
        return Ok(Rows::All);
    }
    text.parse().map(Rows::One).map_err(|_| "a row from 0 or all is needed")
}

pub fn run(args: &DumpArgs) -> Result<(), Failure> {
    let mut pair = Pair::open(&args.pair.left, &args.pair.right)?;
    let config = input::config(&args.range, &args.method, pair.width, pair.height)?;
    let height = usize::from(config.height);
    let rows = match args.row {
        Rows::All => 0..height,
        Rows::One(row) if row < height => row..row + 1,
        Rows::One(row) => {
            let last = height - 1;
            return Err(Failure::new(format!("--row {row}: a row from 0 to {last} or all is needed")));
        }
    };
    let mut staging = Staging::new(&args.out)?;
    let mut camera = MemoryPair::record(&mut pair.camera)?;
    let (config, _) = input::with_noise(&args.method, config, &mut camera)?;
    let [left, right] = camera.pictures();
    let method = args.method.method;
    let stages = Stages::of(&method.twin(), &config, &left, &right);
    let dump = Dump::new(args.stage, &stages, rows);
    let name = args.stage.name();
    staging.write(&format!("{name}.bin"), |out| dump.write(out))?;
    staging.write(&format!("{name}.mem"), |out| dump.write_mem(out))?;
    staging.write(&format!("{name}.json"), |out| json(out, &dump.manifest(&config, method.name())))?;
    Ok(staging.commit(&[])?)
}
