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
    #[arg(long, value_name = "Y", default_value = "all", allow_negative_numbers = true)]
    pub row: String,
    /// The folder for the files
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

pub fn run(args: &DumpArgs) -> Result<(), Failure> {
    let mut pair = Pair::open(&args.pair.left, &args.pair.right)?;
    let config = input::config(&args.range, &args.method, pair.width, pair.height)?;
    let height = usize::from(config.height);
    let rows = match args.row.as_str() {
        "all" => 0..height,
        text => {
            let row = text.parse().ok().filter(|&row| row < height);
            let row = row.ok_or_else(|| {
                Failure::new(format!("--row {text}: a row from 0 to {} or all is needed", height - 1))
            })?;
            row..row + 1
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
