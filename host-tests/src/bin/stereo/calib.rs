//! `stereo calib`: calibration files, checked and converted.

use crate::cli::{CalibArgs, CalibCommand, CheckArgs, ConvertArgs, FileArgs, Format, Unit};
use crate::failure::Failure;
use crate::place::Place;
use crate::print;
use stereopsis_host::calibration::{RawCalibration, describe, write_c, write_opencv, write_rust};
use stereopsis_host::command_line::one_line;

pub fn run(args: &CalibArgs) -> Result<(), Failure> {
    match &args.command {
        CalibCommand::Check(args) => check(args),
        CalibCommand::Convert(args) => convert(args),
    }
}

fn open(args: &FileArgs) -> Result<RawCalibration, Failure> {
    if args.calib.len() > 2 {
        return Err(Failure::new(
            "--calib: is given more than twice; a file of both cameras or one of each is needed",
        ));
    }
    Ok(RawCalibration::open(&args.calib, args.size, args.unit.map(Unit::metres))?)
}

fn check(args: &CheckArgs) -> Result<(), Failure> {
    let calibration = open(&args.file)?;
    let text = describe(&calibration, args.disparities);
    print(&text.map_err(|e| Failure::new(format!("{}: {e}", calibration.path.display())))?)
}

fn convert(args: &ConvertArgs) -> Result<(), Failure> {
    let place = Place::of("--out", &args.out)?;
    let calibration = open(&args.file)?;
    let rig = &calibration.rig;
    let name = calibration.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let notes = [format!(
        "A stereo rig, from {} ({}), by stereo calib convert.",
        one_line(&name),
        calibration.format
    )];
    let bytes = match args.to {
        Format::Record => rig.to_record().to_vec(),
        Format::Rust => write_rust(rig, &notes).into_bytes(),
        Format::C => write_c(rig, &notes).into_bytes(),
        Format::Opencv => write_opencv(rig, &notes).into_bytes(),
    };
    place.write(|out| out.write_all(&bytes), None)?;
    let format = format!("{:?}", args.to).to_lowercase();
    print(&format!(
        "{} calibration, baseline {:.4} m, as {format} in {}\n",
        calibration.format,
        rig.baseline_m(),
        one_line(&args.out.display().to_string())
    ))
}
