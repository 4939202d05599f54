//! `stereo structure`: pictures of one camera from several places into where it stood, and points.

mod images;

use crate::failure::Failure;
use crate::input::fits;
use crate::place::json;
use crate::progress::Progress;
use crate::shared::{print, remark, rows};
use clap::Args;
use images::{Images, given};
use serde::Serialize;
use std::path::{Path, PathBuf};
use stereopsis::geometry::camera::Camera;
use stereopsis::motion::structure::ViewState;
use stereopsis_host::calibration::{Calibration, Cameras, Fault, RawCalibration};
use stereopsis_host::command_line::one_line;
use stereopsis_host::correspond::Plan;
use stereopsis_host::odometry::picture::svg_of;
use stereopsis_host::odometry::poses;
use stereopsis_host::output::Staging;
use stereopsis_host::ply::{self, ColouredPoint};
use stereopsis_host::views::colmap::Model;
use stereopsis_host::views::{Found, Length, Links, SolveError, link, look_again, solve};

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo structure --images 'statue/*.jpg' --calib camera.yml --baseline 0.25 --out statue-out

The images are of one camera, in the order of their names, each with something in common with those before \
                           it. Written are structure.json, poses.txt (KITTI's form: a line for each image \
                           that stands somewhere, the rows of [R | t], which carries a point of that camera \
                           into the first one's), cloud.ply, views.svg from above and from the side, and \
                           cameras.txt, images.txt and points3D.txt, which are a model in COLMAP's text form.

Images alone do not say how large things are: without --baseline lengths are in units of the distance of the \
                           two views that it began with, and the files say so.";

#[derive(Debug, Args)]
pub struct StructureArgs {
    /// The images, a folder, a pattern, or several: 2 to 60
    #[arg(long, value_name = "GLOB", required = true, num_args = 1..)]
    pub images: Vec<String>,
    /// The camera's calibration: any file that other commands read; of a pair's the first camera
    #[arg(long, value_name = "FILE", required = true)]
    pub calib: Vec<PathBuf>,
    /// The distance of the first two images' cameras in truth, m: gives the scale
    #[arg(long, value_name = "M", value_parser = baseline, allow_negative_numbers = true)]
    pub baseline: Option<f64>,
    /// Residual up to which an observation counts as right, px, 0.1 to 20
    #[arg(long, value_name = "PX", default_value_t = 1.5, value_parser = threshold, allow_negative_numbers =
        true)]
    pub threshold: f64,
    /// Folder for the results; made when it is missing
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

fn baseline(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (1e-4..=1e4).contains(value));
    value.ok_or("a number from 0.0001 to 10000 is needed")
}

fn threshold(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (0.1..=20.0).contains(value));
    value.ok_or("a number from 0.1 to 20 is needed")
}

/// A view that has fewer sights than that part of what the middle one has may have been placed by chance.
const FEW: usize = 10;

/// What is written. Names are a contract with programs that read them.
#[derive(Serialize)]
struct Answer {
    /// What a length of one is.
    unit: String,
    views: Vec<ViewAnswer>,
    began_with: [String; 2],
    plane: bool,
    points: usize,
    sights: usize,
    rms_px: f64,
}

#[derive(Serialize)]
struct ViewAnswer {
    image: String,
    state: &'static str,
    rotation: Option<[[f64; 3]; 3]>,
    translation: Option<[f64; 3]>,
}

/// Views whose distance tells lengths differ by so much in what they see, px.
const APART_PX: f64 = 2.0;

pub fn run(args: &StructureArgs) -> Result<(), Failure> {
    let images = Images::read(&args.images)?;
    let camera = camera(args, &images)?;
    let mut staging = Staging::new(&args.out)?;
    let count = images.grey.len();
    let progress = Progress::over_frames(count);
    let plan = Plan { levels: 3, ..Plan::default() };
    let links = link(&plan, &images.grey, || progress.one_more())?;
    drop(progress);
    let length = args.baseline.map(|metres| Length { views: (0, 1), metres });
    let failed = |why| match why {
        SolveError::Unplaced(view) => Failure::new(format!(
            "--baseline: {} stands nowhere, and so the distance of {} and {} tells no length; begin with two \
             images that show the same",
            images.names[view], images.names[0], images.names[1]
        )),
        why => Failure::new(format!("--images {}: {why}", given(&args.images))),
    };
    let first = solve(&camera, count, &links, args.threshold, length).map_err(failed)?;
    let (links, found) = again(&camera, &images, links, first, (args.threshold, length));
    let beside = found.beside_first();
    let unit = match (args.baseline, found.report.pair) {
        (Some(_), _) => "m".to_owned(),
        (None, (a, b)) => {
            let name = |at: u16| &images.names[usize::from(at)];
            format!("the distance of {} and {}, which is not known", name(a), name(b))
        }
    };
    let apart_px = args.baseline.and_then(|metres| found.parallax_px(&camera, metres));
    if apart_px.is_some_and(|px| px < APART_PX) {
        let why = "stand in one place, which tells no length; begin with two that stand apart";
        return Err(Failure::new(format!("--baseline: {} and {} {why}", images.names[0], images.names[1])));
    }
    let answer = answer(&found, &images, &unit);
    let standing: Vec<_> = beside.iter().flatten().copied().collect();
    staging.write("structure.json", |out| json(out, &answer))?;
    staging.write("poses.txt", |out| poses::write(out, &standing))?;
    let colours = colours(&images, &links);
    staging.write("cloud.ply", |out| ply::write_in(out, &cloud(&found, &colours), &unit))?;
    let model = Model::new((&camera, images.size()), &images.names, &links, &found, args.threshold);
    staging.write("cameras.txt", |out| model.cameras(out))?;
    staging.write("images.txt", |out| model.images(out))?;
    staging.write("points3D.txt", |out| model.points(out, |number| colours(number).unwrap_or_default()))?;
    let places: Vec<_> = found.known().iter().map(|(_, point)| point.coords).collect();
    staging.write("views.svg", |out| out.write_all(svg_of(&standing, &places, &unit).as_bytes()))?;
    staging.commit(&[])?;
    let names = |wanted: bool| answer.views.iter().filter(move |view| (view.state == "placed") == wanted);
    let mut text = format!(
        "{} of {count} views stand somewhere, {} points, {} sights, {:.3} px RMS\n",
        names(true).count(),
        answer.points,
        answer.sights,
        answer.rms_px
    );
    for view in names(false) {
        remark(&format!("note: {} stands nowhere: {}", view.image, view.state));
    }
    warn_of_few(&images.names, &model.sights());
    text += &format!("unit         {}\n", one_line(&unit));
    if answer.plane {
        remark("note: what it began with is on a plane");
    }
    print(&format!("{text}results are in {}\n", one_line(&args.out.display().to_string())))
}

/// Warns of views that see hardly any of the points: a few may agree by chance.
fn warn_of_few(names: &[String], sights: &[Option<usize>]) {
    let mut sorted: Vec<_> = sights.iter().flatten().copied().collect();
    sorted.sort_unstable();
    let Some(&middle) = sorted.get(sorted.len() / 2) else { return };
    for (name, &count) in names.iter().zip(sights) {
        if let Some(count) = count.filter(|count| FEW * count < middle) {
            remark(&format!(
                "warning: {name}: sees {count} points where they are, and the middle one of the views \
                 {middle}: it may stand elsewhere; turn it as the others are, or leave it out"
            ));
        }
    }
}

/// The structure of what its points look like in all views, where that places as many views as the first.
fn again(
    camera: &Camera<f64>,
    images: &Images,
    links: Links,
    first: Found,
    (threshold_px, length): (f64, Option<Length>),
) -> (Links, Found) {
    let looked = look_again(camera, &images.grey, &links, &first);
    match solve(camera, images.grey.len(), &looked, threshold_px, length) {
        Ok(found) if found.report.views >= first.report.views => (looked, found),
        _ => (links, first),
    }
}

/// The camera of the images, which the calibration must be of.
fn camera(args: &StructureArgs, images: &Images) -> Result<Camera<f64>, Failure> {
    let camera = Cameras::open_first(&args.calib)?;
    let size = images.size();
    if let Ok(rectified) = Calibration::open_all(&args.calib, Path::new(""), None) {
        rectified.check_size(size.width, size.height)?;
    }
    // Only of a rig do files say the size.
    match RawCalibration::open(&args.calib, Some(size), None) {
        Err(e) if matches!(e.fault, Fault::Size { .. }) => Err(e.into()),
        _ => fits(args.calib.first().map_or(Path::new(""), PathBuf::as_path), camera.principal_point(), size)
            .map(|()| camera),
    }
}

fn answer(found: &Found, images: &Images, unit: &str) -> Answer {
    let view = |((name, place), pose): ((&String, &Result<_, ViewState>), &Option<_>)| {
        let pose: &Option<stereopsis::geometry::camera::Pose<f64>> = pose;
        ViewAnswer {
            image: name.clone(),
            state: match place {
                Ok(_) => "placed",
                Err(ViewState::TooFew) => "too few points in common with the others",
                Err(ViewState::NoAgreement) => "what it sees agrees on no pose",
                Err(_) => "unknown",
            },
            rotation: pose.map(|pose| rows(pose.rotation())),
            translation: pose.map(|pose| (*pose.translation()).into()),
        }
    };
    let beside = found.beside_first();
    let (a, b) = found.report.pair;
    let name = |at: u16| images.names[usize::from(at)].clone();
    Answer {
        unit: unit.to_owned(),
        views: images.names.iter().zip(&found.poses).zip(&beside).map(view).collect(),
        began_with: [name(a), name(b)],
        plane: found.report.plane,
        points: found.report.points,
        sights: found.report.observations,
        rms_px: found.rms_px,
    }
}

/// The colours of points, by their numbers, in the first image that shows them.
fn colours<'a>(images: &'a Images, links: &'a Links) -> impl Fn(u32) -> Option<[u8; 3]> + 'a {
    |number| {
        let at = links.observations.partition_point(|observation| observation.point < number);
        let observation = links.observations.get(at)?;
        let colours = &images.colours[usize::from(observation.view)];
        let pixel = observation.pixel.map(|x| x.round() as u32);
        Some(colours.get_pixel_checked(pixel.x, pixel.y)?.0)
    }
}

/// The points with their colours.
fn cloud(found: &Found, colour: impl Fn(u32) -> Option<[u8; 3]>) -> Vec<ColouredPoint> {
    let coloured = found.known().into_iter().filter_map(|(number, point)| {
        let position_m = [point.x, point.y, point.z].map(|x| x as f32);
        Some(ColouredPoint { position_m, colour: colour(number)? })
    });
    coloured.collect()
}
