//! A pair, rectified or raw, into a folder of results.

use crate::failure::Failure;
use crate::finished::{FINISHED, Mark};
use crate::frame::{Matched, matched};
use crate::input::Pair;
use crate::look::{Look, Looked, are_same, look};
use crate::match_args::MatchArgs;
use crate::place::{json, png};
use crate::rectified::{self, RectifiedCameras};
use crate::results::{self, DepthFiles};
use crate::scale::{camera, off_middle_of, scale};
use crate::shared::remark;
use crate::watch::{self, OBSTACLES, Watch};
use image::RgbImage;
use std::fmt::Display;
use std::path::PathBuf;
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::ImageSize;
use stereopsis_host::masked::MaskedPair;
use stereopsis_host::mock::luma;
use stereopsis_host::output::Staging;
use stereopsis_host::pair::PairCheck;
use stereopsis_host::rectify::{rectify, rectify_colours, with_rectified};
use stereopsis_host::report::{Report, Summary};
use stereopsis_host::rows::Rows;
use stereopsis_host::scene::SceneCamera;

/// What is written only of raw images.
pub const RECTIFIED: [&str; 3] = ["rectified_left.png", "rectified_right.png", "rectified.json"];

/// What is matched, and what its depths are.
struct Scene {
    left: RgbImage,
    right: RgbImage,
    scale: Option<DepthScale>,
    rectified: Option<RectifiedCameras>,
    rows: Option<Rows>,
    check: Option<PairCheck>,
}

/// Matches a pair and writes its results, `mark` where there is one, and what `watch` sees in it; warnings
/// begin with `label`.
pub fn solve(
    args: &MatchArgs,
    mut pair: Pair,
    mark: Option<&Mark>,
    label: &str,
    watch: Option<&mut Watch>,
) -> Result<(Summary, Option<RectifiedCameras>), Failure> {
    args.search.check(&args.method, pair.width, pair.height)?;
    check_obstacles(args)?;
    let (scene, matched) = if args.rectify {
        raw(args, &mut pair)?
    } else {
        let scale = scale(args, &pair)?;
        if let Some(calib) = args.calib.first().filter(|_| scale.is_none()) {
            pair.notes.push(format!("{}: is of matches alone: nothing is in metres", calib.display()));
        }
        Staging::probe(&args.out)?;
        let [left, right] = [&pair.left, &pair.right].map(luma);
        let camera = scale.as_ref().and_then(|scale| camera(scale.rig()));
        let masks = args.masks.read(&args.calib, left.dimensions())?;
        let valid = masks.as_ref().map(|masks| masks.each_ref());
        let offset_px = scale.as_ref().map_or(0.0, |scale| scale.rig().disparity_offset_px().into());
        let looked = Looked { valid, camera: camera.as_ref(), offset_px, ..Looked::of([&left, &right]) };
        let Look { config, check, rows } = look(&args.search, &args.method, &looked, || None)?;
        let size = ImageSize { width: pair.width, height: pair.height };
        let off = scale.as_ref().and_then(|scale| off_middle_of(&args.calib, scale, size));
        pair.notes.extend(off.clone().filter(|_| check.is_none()));
        let check = check.map(|check| check.with_warning(off));
        let matched = match masks {
            Some(masks) => {
                matched(&args.method, &args.balance, config, &mut MaskedPair::new(&mut pair.camera, masks))?
            }
            None => matched(&args.method, &args.balance, config, &mut pair.camera)?,
        };
        (Scene { left: pair.left, right: pair.right, scale, rectified: None, rows, check }, matched)
    };

    let found = match scene.scale.as_ref().zip(watch) {
        Some((scale, watch)) => {
            let map = &matched.outcome.map;
            let (label, largest) = (label.trim_end_matches(": "), watch::largest(&matched.config));
            Some(watch.look(label, scale, (map, map.height), largest, &scene.left, Some(&scene.right))?)
        }
        None => None,
    };
    let Matched { config, meter, balance, outcome } = matched;
    let scale = scene.scale.as_ref();
    let summary = Summary::new(args.method.method, args.method.filter.name(), &config, &outcome, scale, None);
    let summary = summary.with_noise(meter.as_ref()).with_balance(balance).with_pair(scene.check, scene.rows);
    let masks = if args.rectify { None } else { args.masks.files(&args.calib) };
    let inputs = pair.inputs.iter().chain(&args.calib);
    let inputs = inputs.chain(masks.iter().flatten()).map(PathBuf::as_path);
    let mut summary = summary.with_inputs(inputs);
    let depth = scale.map(|s| DepthFiles::new(&args.depth, &outcome.map, s, &scene.left, &mut summary));
    let report = Report {
        left_name: &pair.names[0],
        right_name: &pair.names[1],
        left: &scene.left,
        right: &scene.right,
        map: &outcome.map,
        summary: &summary,
        rig: scale.map(DepthScale::rig),
        truth: None,
        // Of many pairs another run may see them anew, and leaves the page as it is.
        obstacles: found.as_ref().filter(|_| mark.is_none()).map(|(record, picture)| (record, picture)),
        colours: args.colour_range,
    };
    let mut staging = Staging::new(&args.out)?;
    results::write(&mut staging, &report, depth.as_ref())?;
    let [left, right, cameras] = RECTIFIED;
    if let Some(rectified) = &scene.rectified {
        staging.write(left, |out| png(out, &scene.left))?;
        staging.write(right, |out| png(out, &scene.right))?;
        staging.write(cameras, |out| json(out, rectified))?;
    }
    // Without what a watch sees, which another run may see anew.
    if let Some(mark) = mark {
        mark.write(&mut staging)?;
    }
    if let Some(found) = &found {
        watch::write(&mut staging, OBSTACLES, found)?;
    }
    let stale = results::WITH_DEPTH.into_iter().chain(RECTIFIED).chain(OBSTACLES).chain([FINISHED]);
    let stale: Vec<_> = stale.collect();
    staging.commit(&stale)?;

    let notes = pair.notes.iter().map(|note| format!("note: {note}"));
    let warnings = summary.warnings().iter().map(|warning| format!("warning: {warning}"));
    for line in notes.chain(warnings) {
        remark(&format!("{label}{line}"));
    }
    Ok((summary, scene.rectified))
}

/// Whether obstacles, if they are asked for, can be found.
pub fn check_obstacles(args: &MatchArgs) -> Result<(), Failure> {
    if args.watch.obstacles && args.calib.is_empty() && !args.typed.is_given() {
        return Err(Failure::usage(
            "--obstacles: distances need a calibration; give --calib, or --focal-px and --baseline-mm",
        ));
    }
    Ok(())
}

/// Matches a raw pair: remap, census and matching in one loop over the rows.
fn raw(args: &MatchArgs, pair: &mut Pair) -> Result<(Scene, Matched), Failure> {
    if args.calib.is_empty() {
        return Err(Failure::usage("--rectify: --calib is missing; give the calibration of the two cameras"));
    }
    let size = ImageSize { width: pair.width, height: pair.height };
    let (calibration, rectification) = rectified::open(&args.calib, &args.options, size)?;
    let named = |e: &dyn Display| Failure::new(format!("{}: {e}", calibration.path.display()));
    if !rectification.axis().is_horizontal() {
        return Err(named(&"the cameras stand below each other; match takes cameras beside each other"));
    }
    let rig = rectification.rig().map_err(|e| named(&e))?;
    let scale = DepthScale::new(&rig).map_err(|e| named(&e))?;
    Staging::probe(&args.out)?;
    let (left, right) = rectify_colours(&rectification, &pair.left, &pair.right).map_err(|e| named(&e))?;
    let grey = rectify(&rectification, &mut pair.camera).map_err(|e| named(&e))?;
    let (valid, camera) = (grey.valid.each_ref(), rectification.camera());
    let [raw_left, raw_right] = [&pair.left, &pair.right].map(luma);
    let looked = Looked {
        valid: Some(valid),
        camera: Some(camera),
        offset_px: rig.disparity_offset_px().into(),
        is_given_twice: are_same(&raw_left, &raw_right),
        ..Looked::of(grey.pictures.each_ref())
    };
    let exchanged = || rectify(&rectification, SceneCamera::new(raw_right, raw_left)).ok();
    let Look { config, check, rows: aligned } = look(&args.search, &args.method, &looked, exchanged)?;
    let (rows, matched) = with_rectified(&rectification, &mut pair.camera, |source| {
        (
            source.remaps().map(|remap| remap.table().rows()),
            matched(&args.method, &args.balance, config, source),
        )
    })
    .map_err(|e| named(&e))?;
    let cameras = RectifiedCameras::new(calibration.format, &rectification, rows, &rectification.report());
    let scene = Scene { left, right, scale: Some(scale), rectified: Some(cameras), rows: aligned, check };
    Ok((scene, matched?))
}
