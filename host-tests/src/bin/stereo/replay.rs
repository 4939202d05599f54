//! `stereo replay`: recorded lines through the code that runs on the device.

mod answers;
mod looking;
mod summary;
mod watching;

use crate::failure::Failure;
use crate::look::{Look, SearchArgs};
use crate::place::{json, png};
use crate::progress::Progress;
use crate::shared::{BalanceArgs, Unit, any_u16, filter, method, noise, print, rate, remark, whole};
use crate::typed_rig::TypedRig;
use crate::watch::{self, OVER_TIME, ObstacleArgs, Watch};
use answers::Answers;
use clap::{Args, ValueEnum};
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::{fs, io};
use stereopsis::depth::DepthScale;
use stereopsis::imaging::Noise;
use stereopsis::matching::{Config, Filter};
use stereopsis_host::colour::flags_raw;
use stereopsis_host::command_line::{one_line, words};
use stereopsis_host::output::Staging;
use stereopsis_host::pfm;
use stereopsis_host::recording::{
    Ahead, FromStart, Header, Pictures, Playback, Recording, Seen, first_pairs,
};
use stereopsis_host::rows::Rows;
use stereopsis_host::run::{GuardedFrame, MethodName, NoiseChoice, run_guarded};
use summary::Summary;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo replay --from field.lines --disparities 64 --out replayed

Written are, for each frame, 000001-disparity.pfm (px, infinity for no answer) and 000001-flags.png (the \
                           bits of `stereo match`, and 128 where a lost line was rested on); frames.csv, a \
                           line for each frame; summary.json with every fault counted by name. Images of a \
                           folder's left and right belong together by the last number in their names, or, \
                           without one, by order. With --obstacles: for each frame 000001-obstacles.json and \
                           .png; obstacles.csv, a line for each; and obstacles.png, the sectors over time.";

#[derive(Debug, Args)]
pub struct ReplayArgs {
    /// A recording by `stereo record` or by firmware, or a folder with left and right in it
    #[arg(long, value_name = "FILE|DIR")]
    pub from: PathBuf,
    #[command(flatten)]
    pub search: SearchArgs,
    /// fast, block, sgm-lean, sgm or sgm-edge
    #[arg(long, value_name = "METHOD", default_value = "sgm", value_parser = method)]
    pub method: MethodName,
    /// dense, default or strict
    #[arg(long, value_name = "FILTER", default_value = "default", value_parser = filter)]
    pub filter: Filter,
    /// How noisy the images are: none, low (a deviation of about 2 grey levels), high (3 and more), or auto,
    /// which measures each frame
    #[arg(long, value_name = "NOISE", default_value = "auto", value_parser = noise)]
    pub noise: NoiseChoice,
    #[command(flatten)]
    pub balance: BalanceArgs,
    /// As fast as possible, or as fast as it was recorded
    #[arg(long, value_name = "TIMING", default_value = "fast")]
    pub timing: Timing,
    /// Frames per second, for a folder
    #[arg(long, value_name = "F", default_value_t = 30.0, value_parser = rate, allow_negative_numbers = true)]
    pub fps: f64,
    /// How many lines of a frame may be lost before it is given up; by default all
    #[arg(long, value_name = "N", value_parser = any_u16, allow_negative_numbers = true)]
    pub most_lost: Option<u16>,
    /// How many frames are played; by default all
    #[arg(long, value_name = "K", value_parser = |n: &str| whole(n, 1, u32::MAX), allow_negative_numbers =
        true)]
    pub frames: Option<u32>,
    #[command(flatten)]
    pub watch: ObstacleArgs,
    /// Calibration of the cameras, for --obstacles, as for the command match
    #[arg(long, value_name = "FILE", requires = "obstacles")]
    pub calib: Vec<PathBuf>,
    /// The unit of lengths in OpenCV's files, which do not say it: m where none is given
    #[arg(long, value_name = "UNIT", requires = "calib")]
    pub unit: Option<Unit>,
    #[command(flatten)]
    pub typed: TypedRig,
    /// Print summary.json in place of the figures
    #[arg(long, conflicts_with = "quiet")]
    pub json: bool,
    /// Print no figures; warnings are on standard error
    #[arg(long)]
    pub quiet: bool,
    /// Folder for the results; made when it is missing
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum Timing {
    /// As fast as possible
    Fast,
    /// By the time stamps
    Recorded,
}

pub fn run(args: &ReplayArgs) -> Result<(), Failure> {
    let recording = if args.from.is_dir() { of_folder(args)? } else { Recording::open(&args.from)? };
    let header = recording.header();
    let seen = if args.watch.obstacles { Seen::with_pictures() } else { Seen::default() };
    check_width(args, header)?;
    let watch = watching::watch(args, header)?;
    let (pairs, records) = first_pairs(recording, LOOKED_AT);
    let scale = watch.as_ref().map(|(_, scale)| scale);
    let look = looking::look(args, header, pairs, scale)?;
    let ahead = Ahead::new(records, header, args.balance.is_for(args.method), &seen);
    play(args, look, &mut Playback::new(ahead, header, args.timing == Timing::Recorded), &seen, watch)
}

/// How many frames are looked at before the first is played: a camera may begin in the dark.
const LOOKED_AT: usize = 8;

/// A folder's pictures, with those of each side in a folder, as a recording.
fn of_folder(args: &ReplayArgs) -> Result<Recording, Failure> {
    let side = |name: &str| args.from.join(name);
    for name in ["left", "right"] {
        if !side(name).is_dir() {
            let from = args.from.display();
            return Err(Failure::new(format!("--from {from}: the folder has no folder '{name}' in it")));
        }
    }
    let mut pictures = Pictures::open(&side("left"), &side("right"), args.fps)?;
    let (mut bytes, frames) = (Vec::new(), pictures.frames() as u32);
    stereopsis_host::recording::record(&mut pictures, frames, &mut bytes)?;
    if let Some(e) = pictures.failed() {
        return Err(e.into());
    }
    Ok(Recording::read(Path::new("the folder"), Box::new(io::Cursor::new(bytes)))?)
}

fn check_width(args: &ReplayArgs, header: Header) -> Result<(), Failure> {
    let (width, least) = (header.width, Config::FEWEST_DISPARITIES);
    if width >= least {
        return Ok(());
    }
    let from = args.from.display();
    Err(Failure::new(format!("{from}: lines of {width} pixels; at least {least} are needed")))
}

fn play(
    args: &ReplayArgs,
    Look { config, check, rows }: Look,
    source: &mut Playback<Ahead<'_, FromStart>>,
    seen: &Seen,
    mut watch: Option<(Watch, DepthScale)>,
) -> Result<(), Failure> {
    let mut staging = Staging::new(&args.out)?;
    let (mut written, mut table, mut names) = (Ok::<(), Failure>(()), TABLE.to_owned(), Vec::new());
    let mut left = args.frames.unwrap_or(u32::MAX);
    let (mut noisy_frames, mut answers) = (0, Answers::default());
    let next = |source: &mut Playback<_>| {
        left = left.checked_sub(1).filter(|_| source.has_frame())?;
        let noise = match args.noise {
            NoiseChoice::Given(noise) => noise,
            NoiseChoice::Auto => seen.noise(),
        };
        noisy_frames += u32::from(noise != Noise::None);
        Some(args.method.with_filter(args.filter, Config { noise, ..config }))
    };
    let progress = Progress::over_played();
    let keep = |frame: GuardedFrame| {
        progress.one_more();
        let number = names.len() + 1;
        table += &line(number, &frame);
        answers.add(&frame);
        let [disparity, flags, obstacles @ ..] = KINDS.map(|kind| format!("{number:06}{kind}"));
        if written.is_ok() && frame.rows > 0 {
            written = staging
                .write(&disparity, |out| pfm::write(out, frame.map.width, &frame.map.pixels()))
                .and_then(|()| staging.write(&flags, |out| png(out, &flags_raw(&frame.map))))
                .map_err(Failure::from);
        }
        if let Some((watch, scale)) = watch.as_mut().filter(|_| written.is_ok()) {
            let pictures = frame.start.and_then(|start| seen.take_pictures(start));
            written = watching::look(watch, scale, &config, (number, &frame), pictures).and_then(|found| {
                let names = obstacles.each_ref().map(String::as_str);
                Ok(watch::write(&mut staging, names, &found)?)
            });
        }
        names.push(());
    };
    let counters = run_guarded(args.method, &config, args.most_lost, source, next, keep)
        .map_err(|e| Failure::new(format!("--disparities: {e}")))?;
    drop(progress);
    written?;
    if let Some(e) = source.failed() {
        return Err(e.into());
    }
    if names.is_empty() {
        return Err(Failure::new(format!("{}: a recording without a frame", args.from.display())));
    }
    let pair = check.map(|check| {
        let few = answers.few(&check);
        check.with_warning(rows.as_ref().and_then(Rows::warning)).with_warning(few)
    });
    let summary = Summary {
        version: env!("CARGO_PKG_VERSION"),
        command: words(),
        inputs: [&args.from].into_iter().chain(&args.calib).map(|path| path.display().to_string()).collect(),
        width: config.width,
        height: config.height,
        method: args.method.name(),
        disparities: config.disparities,
        min_disparity: config.min_disparity,
        frames: names.len() as u32,
        whole_frames: counters.frames_whole,
        damaged_frames: counters.frames_damaged,
        broken_frames: counters.frames_broken,
        failed_frames: counters.frames_failed + counters.frames_stale,
        noisy_frames,
        balanced_frames: seen.balanced_frames(),
        recording_was_cut: source.was_cut(),
        time_went_back_at: source.went_back(),
        counters: counters.into(),
        rows,
        pair,
    };
    if let Some((watch, _)) = &watch {
        watch.write(&mut staging)?;
    }
    staging.write("frames.csv", |out| out.write_all(table.as_bytes()))?;
    staging.write("summary.json", |out| json(out, &summary))?;
    let stale = earlier_results(&args.out)?;
    staging.commit(&stale.iter().map(String::as_str).chain(OVER_TIME).collect::<Vec<_>>())?;
    summary.remarks().for_each(|line| remark(&line));
    if args.quiet {
        return Ok(());
    }
    if args.json {
        return print(&(serde_json::to_string_pretty(&summary)? + "\n"));
    }
    let decisions = watch.map(|(watch, _)| format!("obstacles: {}\n", watch.timeline.line()));
    print(&(decisions.unwrap_or_default() + &summary.figures(&args.out)))
}

/// The endings of a frame's files.
const KINDS: [&str; 4] = ["-disparity.pfm", "-flags.png", "-obstacles.json", "-obstacles.png"];
const TABLE: &str = "frame,sequence,timestamp_us,rows,damaged_rows,lost_lines,answers,error\n";

fn line(number: usize, frame: &GuardedFrame) -> String {
    fn or_empty<T: Display>(value: Option<T>) -> String {
        value.map_or_else(String::new, |value| value.to_string())
    }
    let sequence = or_empty(frame.start.map(|start| start.sequence));
    let timestamp_us = or_empty(frame.start.map(|start| start.timestamp_us));
    let error = frame.error.as_deref().unwrap_or_default().replace(',', ";");
    let (rows, damaged, lost, answers) =
        (frame.rows, frame.damaged_rows, frame.lost_lines, frame.map.answers());
    format!("{number},{sequence},{timestamp_us},{rows},{damaged},{lost},{answers},{}\n", one_line(&error))
}

/// The files of frames that stand in the folder already.
fn earlier_results(out: &Path) -> Result<Vec<String>, Failure> {
    let is_result = |name: &String| {
        KINDS
            .iter()
            .filter_map(|kind| name.strip_suffix(kind))
            .any(|n| n.len() == 6 && n.bytes().all(|b| b.is_ascii_digit()))
    };
    let entries = fs::read_dir(out).map_err(|e| Failure::new(format!("--out {}: {e}", out.display())))?;
    Ok(entries.flatten().filter_map(|entry| entry.file_name().into_string().ok()).filter(is_result).collect())
}
