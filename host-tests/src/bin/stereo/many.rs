//! Many pairs, a numbered folder for each. What is finished is not done again, unless its images or the
//! settings differ.

use crate::failure::Failure;
use crate::finished::{FINISHED, Mark};
use crate::match_args::MatchArgs;
use crate::resume;
use crate::shared::{print, remark};
use crate::solve::{check_obstacles, solve};
use crate::sources::Input;
use crate::watch::{OVER_TIME, Watch};
use serde::Serialize;
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use stereopsis_host::calibration::{self, CalibrationError};
use stereopsis_host::command_line::one_line;
use stereopsis_host::limits;
use stereopsis_host::output::Staging;

/// The table of all pairs.
const TABLE: &str = "frames.csv";

/// A line of the table. Names are those of the table and of `--json`.
#[derive(Serialize)]
pub struct Line {
    /// The pair's number, or the name of its settings.
    frame: String,
    /// Its files.
    input: String,
    density: Option<f64>,
    median_px: Option<f64>,
    time_ms: Option<f64>,
    state_bytes: Option<u64>,
    /// What is wrong with the pair, as in its summary.json: its fault, or else its warnings; or why it has no
    /// results.
    fault: Option<String>,
}

impl Line {
    /// What a folder's summary says.
    pub fn of(folder: &Path, frame: String, input: String) -> Result<Self, Failure> {
        let path = folder.join("summary.json");
        let failed = |e: &dyn std::fmt::Display| Failure::new(format!("{}: {e}", path.display()));
        let text = fs::read(&path).map_err(|e| failed(&e))?;
        let summary: Value = serde_json::from_slice(&text).map_err(|e| failed(&e))?;
        Ok(Self {
            frame,
            input,
            density: summary["density"].as_f64(),
            median_px: summary["disparity_px"]["median"].as_f64(),
            time_ms: summary["time_ms"].as_f64(),
            state_bytes: summary["state_bytes"].as_u64(),
            fault: wrong(&summary["pair"]),
        })
    }

    /// Of a pair without results.
    fn failed(frame: String, input: String, error: &Failure) -> Self {
        let (density, median_px, time_ms, state_bytes) = (None, None, None, None);
        Self { frame, input, density, median_px, time_ms, state_bytes, fault: Some(error.to_string()) }
    }
}

/// What a summary says is wrong with its pair.
fn wrong(pair: &Value) -> Option<String> {
    let fault = pair["fault"].as_str().map(str::to_owned);
    fault.or_else(|| {
        let warnings: Vec<_> = pair["warnings"].as_array()?.iter().filter_map(Value::as_str).collect();
        (!warnings.is_empty()).then(|| warnings.join("; "))
    })
}

/// Matches all of them. A pair that cannot be is named, and the others are matched.
pub fn run(
    args: &MatchArgs,
    inputs: impl Iterator<Item = Result<Input, Failure>>,
    count: Option<usize>,
) -> Result<(), Failure> {
    Staging::probe(&args.out)?;
    let settings = args.settings_text();
    let mut beside = Vec::new();
    for path in &args.calib {
        let failed = |fault| CalibrationError { path: path.clone(), fault };
        beside.extend(calibration::bytes(path).map_err(failed)?);
    }
    for path in args.masks() {
        let failed = |e| Failure::new(format!("{}: cannot be read ({e})", path.display()));
        beside.extend(limits::read(&path, limits::IMAGE_BYTES).map_err(failed)?);
    }
    check_obstacles(args)?;
    let mut watch = args.watch.watch();
    let of = count.map_or(String::new(), |count| format!(" of {count}"));
    let (mut lines, mut failed, mut cut) = (Vec::new(), Vec::new(), None);
    for (number, input) in (1..).zip(inputs) {
        let input = match input {
            Ok(input) => input,
            // What came before has its tables.
            Err(error) if !lines.is_empty() => {
                cut = Some(error);
                break;
            }
            Err(error) => return Err(error),
        };
        let frame = format!("{number:06}");
        let one = MatchArgs { out: args.out.join(&frame), ..args.clone() };
        let mark = input.bytes().map(|bytes| Mark::new(bytes.iter().chain(&beside), &settings));
        let is_done = mark.as_ref().is_ok_and(|mark| mark.is_in(&one.out));
        let what = if is_done { "is there already" } else { "is being matched" };
        if !args.quiet {
            remark(&format!("{frame}{of} {what}: {}", input.name()));
        }
        let todo = mark.map(|mark| Some(mark).filter(|_| !is_done));
        match todo.and_then(|mark| do_one(&one, &input, &frame, mark.as_ref(), watch.as_mut())) {
            Ok(()) => lines.push(Line::of(&one.out, frame, input.name())?),
            // What the first pair fails of the others are likely to fail of, too.
            Err(error) if error.is_usage() || lines.is_empty() => return Err(error.of(&frame)),
            Err(error) => {
                remark(&format!("{frame}: {error}"));
                if one.out.join(FINISHED).is_file() {
                    remark(&format!("note: {}: is of an earlier run, not in {TABLE}", one.out.display()));
                }
                lines.push(Line::failed(frame.clone(), input.name(), &error));
                failed.push(frame);
            }
        }
    }
    write_table(&args.out, TABLE, &lines, None, watch.as_ref())?;
    note_earlier_runs(&args.out, lines.len());
    tell(args, &lines, watch.as_ref())?;
    if let Some(cut) = cut {
        return Err(cut);
    }
    if failed.is_empty() {
        return Ok(());
    }
    Err(Failure::new(format!(
        "{} of {} pairs have no results: {}",
        failed.len(),
        lines.len(),
        failed.join(", ")
    )))
}

/// Matches a pair with its mark, or looks at one that is finished again.
fn do_one(
    args: &MatchArgs,
    input: &Input,
    frame: &str,
    mark: Option<&Mark>,
    watch: Option<&mut Watch>,
) -> Result<(), Failure> {
    match (mark, watch) {
        (Some(_), watch) => solve(args, input.open()?, mark, &format!("{frame}: "), watch).map(drop),
        (None, Some(watch)) => resume::look_again(args, input, frame, watch),
        (None, None) => resume::forget(&args.out),
    }
}

/// Says which finished folders stand behind those of a run of so many pairs.
fn note_earlier_runs(out: &Path, pairs: usize) {
    let is_finished = |next: &usize| out.join(format!("{:06}", next + 1)).join(FINISHED).is_file();
    let (first, last) = (pairs + 1, pairs + (pairs..).take_while(is_finished).count());
    let which = match last.checked_sub(first) {
        None => return,
        Some(0) => format!("{last:06} is"),
        Some(_) => format!("{first:06} to {last:06} are"),
    };
    remark(&format!("note: {}: {which} of an earlier run, not in {TABLE}", out.display()));
}

/// Writes the table of a run, a picture where there is one, and what a watch saw.
pub fn write_table(
    out: &Path,
    name: &str,
    lines: &[Line],
    picture: Option<(&str, &image::RgbImage)>,
    watch: Option<&Watch>,
) -> Result<(), Failure> {
    let mut table = csv::Writer::from_writer(Vec::new());
    for line in lines {
        table.serialize(line)?;
    }
    let bytes = table.into_inner().map_err(|e| Failure::new(e.to_string()))?;
    let mut staging = Staging::new(out)?;
    staging.write(name, |out| out.write_all(&bytes))?;
    if let Some((name, picture)) = picture {
        staging.write(name, |out| crate::place::png(out, picture))?;
    }
    if let Some(watch) = watch {
        watch.write(&mut staging)?;
    }
    Ok(staging.commit(&OVER_TIME)?)
}

/// Prints the lines as the options ask for.
pub fn tell(args: &MatchArgs, lines: &[Line], watch: Option<&Watch>) -> Result<(), Failure> {
    if args.quiet {
        return Ok(());
    }
    if args.json {
        return print(&(serde_json::to_string_pretty(lines)? + "\n"));
    }
    let longest = lines.iter().map(|line| line.frame.chars().count()).max().unwrap_or(0).max(6);
    let mut text = format!("{:<longest$} answered, % median, px  time, ms  state, bytes  images\n", "frame");
    for line in lines {
        let number = |value: Option<f64>, digits: usize| {
            value.map_or("-".to_owned(), |value| format!("{value:.digits$}"))
        };
        let _ = writeln!(
            text,
            "{:<longest$} {:>11} {:>10} {:>9} {:>13}  {}",
            line.frame,
            number(line.density.map(|share| 100.0 * share), 1),
            number(line.median_px, 2),
            number(line.time_ms, 1),
            line.state_bytes.map_or("-".to_owned(), |bytes| bytes.to_string()),
            one_line(&line.input)
        );
    }
    if let Some(watch) = watch {
        let _ = writeln!(text, "obstacles: {}", watch.timeline.line());
    }
    let _ = writeln!(text, "results are in {}", one_line(&args.out.display().to_string()));
    print(&text)
}

impl MatchArgs {
    /// All that results depend on but the images, as text.
    fn settings_text(&self) -> String {
        let Self { search, method, balance, calib, rectify, masks, options, depth, .. } = self;
        let rig = (&self.typed, self.colour_range);
        format!("{:?}", (search, method, balance, calib, rectify, masks, options, depth, rig))
    }

    /// The files of masks that all pairs share.
    fn masks(&self) -> impl Iterator<Item = PathBuf> {
        let masks = if self.rectify { None } else { self.masks.files(&self.calib) };
        masks.into_iter().flatten()
    }
}
