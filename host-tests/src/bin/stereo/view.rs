//! `stereo view`: the live page, written and served on this machine alone.

use crate::failure::Failure;
use crate::input::Pair;
use crate::serve;
use crate::shared::{any_u16, disparities, print};
use clap::Args;
use std::path::{Path, PathBuf};
use stereopsis::matching::Config;
use stereopsis_host::calibration::Calibration;
use stereopsis_host::command_line::one_line;
use stereopsis_host::limits;
use stereopsis_host::live::{Given, MODULE_FILE, is_module, page};
use stereopsis_host::output::Staging;

pub const EXAMPLE: &str = "Examples:
  stereo view
  stereo view --left left.png --right right.png --calib calib.txt --out view

The page is one file, index.html, which also opens by itself. It needs the core as a module for browsers,
which `cargo xtask view` builds.";

/// The page's name in its folder.
const INDEX: &str = "index.html";

#[derive(Debug, Args)]
pub struct ViewArgs {
    /// The left image that the page begins with; a built-in scene where none is given
    #[arg(long, value_name = "FILE", requires = "right")]
    left: Option<PathBuf>,
    /// The right image
    #[arg(long, value_name = "FILE", requires = "left")]
    right: Option<PathBuf>,
    /// Calibration of the rectified pair, for depths
    #[arg(long, value_name = "FILE", requires = "left")]
    calib: Option<PathBuf>,
    /// How many whole disparities are searched at first: 16 to 256
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = disparities, allow_negative_numbers =
        true)]
    disparities: u16,
    /// Folder for the page; made when it is missing
    #[arg(long, value_name = "DIR", default_value = "view")]
    out: PathBuf,
    /// The port of this machine's own address, 127.0.0.1, where the page is served; 0 for any that is free
    #[arg(long, value_name = "PORT", default_value_t = 8017, conflicts_with = "write_only",
        value_parser = any_u16, allow_negative_numbers = true)]
    port: u16,
    /// Write the page and serve nothing
    #[arg(long)]
    write_only: bool,
    /// The module to put into the page, where it is not beside this program
    #[arg(long, value_name = "FILE")]
    module: Option<PathBuf>,
}

pub fn run(args: &ViewArgs) -> Result<(), Failure> {
    let module = module(args.module.as_deref())?;
    let pair = args.left.as_ref().zip(args.right.as_ref());
    let pair = pair.map(|(left, right)| Pair::open(left, right)).transpose()?;
    let calibration = pair.as_ref().zip(args.calib.as_ref());
    let calibration = calibration.map(|(pair, path)| {
        let calibration = Calibration::open(path, &pair.inputs[0])?;
        calibration.check_size(pair.width, pair.height)?;
        Ok::<_, Failure>(calibration)
    });
    let rig = calibration.transpose()?.map(|calibration| calibration.rig);
    if let Some(pair) = &pair
        && pair.width < Config::FEWEST_DISPARITIES
    {
        let least = Config::FEWEST_DISPARITIES;
        return Err(Failure::new(format!(
            "--left: the images have {} columns; {least} are needed",
            pair.width
        )));
    }
    let given = pair.as_ref().map(|pair| Given {
        names: pair.names.each_ref().map(String::as_str),
        pictures: [&pair.left, &pair.right],
        rig,
        disparities: args.disparities.min(pair.width) / 16 * 16,
    });
    let listener = (!args.write_only).then(|| serve::bind(args.port)).transpose()?;
    let page = page(&module, given.as_ref())?;
    let mut staging = Staging::new(&args.out)?;
    staging.write(INDEX, |out| out.write_all(page.as_bytes()))?;
    staging.commit(&[])?;
    let place = one_line(&args.out.join(INDEX).display().to_string());
    print(&format!("the page is {place}, {} KB; it opens in a browser by itself\n", page.len() / 1024))?;
    listener.map_or(Ok(()), |listener| serve::forever(&listener, &page))
}

/// The module's bytes, from the file that is named or the one beside this program.
fn module(named: Option<&Path>) -> Result<Vec<u8>, Failure> {
    let beside = || std::env::current_exe().map(|own| own.with_file_name(MODULE_FILE));
    let path = named.map_or_else(beside, |path| Ok(path.to_owned()))?;
    let bytes = limits::read(&path, limits::MODULE_BYTES).map_err(|e| match named {
        Some(path) => Failure::new(format!("--module {}: {e}", path.display())),
        None => Failure::new(format!(
            "the page's module {MODULE_FILE} is not beside this program: run `cargo xtask view` in the \
             repository, which builds it, or name it by --module"
        )),
    })?;
    if is_module(&bytes) {
        return Ok(bytes);
    }
    Err(Failure::new(format!("{}: is no module of WebAssembly", path.display())))
}
