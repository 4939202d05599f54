//! `stereo demo`: a scene of known depth, matched and compared with the truth.

use crate::failure::Failure;
use crate::input;
use crate::place::png;
use crate::results::{self, DepthArgs, DepthFiles, figures, place};
use crate::shared::{MethodArgs, RangeArgs, print};
use clap::Args;
use image::{DynamicImage, GrayImage, RgbImage};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use stereopsis::depth::DepthScale;
use stereopsis::matching::Config;
use stereopsis_host::calibration::write_middlebury;
use stereopsis_host::colour::error_picture;
use stereopsis_host::output::Staging;
use stereopsis_host::pfm;
use stereopsis_host::report::{Accuracy, ERROR_LIMIT_PX, Report, Summary};
use stereopsis_host::run::{self, MemoryPair};
use stereopsis_host::scene::Scene;

#[derive(Debug, Args)]
pub struct DemoArgs {
    /// Folder for the results; made when it is missing
    #[arg(long, value_name = "DIR", default_value = "demo-out")]
    pub out: PathBuf,
    #[command(flatten)]
    pub method: MethodArgs,
}

const IMAGES: [&str; 2] = ["left.png", "right.png"];
const TRUE_DEPTH: &str = "true_depth.pfm";

pub fn run(args: &DemoArgs) -> Result<(), Failure> {
    keep_images_of_others(&args.out)?;
    Staging::probe(&args.out)?;
    let scene = Scene::demo();
    let (left, right) = scene.render();
    let truth = scene.truth();
    let range = RangeArgs { disparities: scene.disparities(), min_disparity: 0 };
    let config = input::config(&range, &args.method, scene.width(), scene.height())?;
    let config = Config { confidence: true, ..config };
    let no_pair = || Failure::new("the scene's two pictures differ in size");
    let mut camera = MemoryPair::new(config.width, left.to_vec(), right.to_vec()).ok_or_else(no_pair)?;
    let (config, meter) = input::with_noise(&args.method, config, &mut camera)?;
    let outcome = run::run(args.method.run_options(), &config, &mut camera, |_| {})?;
    let scale = DepthScale::new(&scene.rig())?;

    let accuracy = Accuracy::of(&outcome.map, &truth, &scale);
    let filter = args.method.filter.name();
    let summary = Summary::new(args.method.method, filter, &config, &outcome, Some(&scale), Some(accuracy));
    let mut summary = summary.with_noise(meter.as_ref());
    let (left_rgb, right_rgb) = (colours(&left), colours(&right));
    let depth = DepthFiles::new(&DepthArgs::default(), &outcome.map, &scale, &left_rgb, &mut summary);
    let report = Report {
        left_name: IMAGES[0],
        right_name: IMAGES[1],
        left: &left_rgb,
        right: &right_rgb,
        map: &outcome.map,
        summary: &summary,
        rig: Some(scale.rig()),
        truth: Some(&truth),
        obstacles: None,
        colours: None,
    };
    let mut staging = Staging::new(&args.out)?;
    results::write(&mut staging, &report, Some(&depth))?;
    staging.write(IMAGES[0], |out| png(out, &left))?;
    staging.write(IMAGES[1], |out| png(out, &right))?;
    let calibration = write_middlebury(scale.rig(), config.width, config.height, config.disparities);
    staging.write("calib.txt", |out| out.write_all(calibration.as_bytes()))?;
    staging.write(TRUE_DEPTH, |out| pfm::write(out, truth.width, &truth.depth_m))?;
    staging.write("true_disparity.pfm", |out| {
        pfm::write(out, truth.width, &Accuracy::true_disparity_px(&truth))
    })?;
    let errors = Accuracy::errors_px(&outcome.map, &truth);
    staging.write("error.pfm", |out| pfm::write(out, truth.width, &errors))?;
    staging.write("error.png", |out| png(out, &error_picture(truth.width, &errors, ERROR_LIMIT_PX)))?;
    staging.commit(&[])?;
    print(&(figures(&summary) + &beside_the_truth(&accuracy) + &place(&args.out)))
}

/// The demo's pictures have names that anybody's may have: those that no demo wrote are not replaced.
fn keep_images_of_others(out: &Path) -> Result<(), Failure> {
    if out.join(TRUE_DEPTH).exists() {
        return Ok(());
    }
    match IMAGES.iter().map(|name| out.join(name)).find(|image| image.exists()) {
        Some(image) => Err(Failure::new(format!(
            "--out: {} is there and no demo wrote it; name a folder without it",
            image.display()
        ))),
        None => Ok(()),
    }
}

fn colours(grey: &GrayImage) -> RgbImage {
    DynamicImage::ImageLuma8(grey.clone()).into_rgb8()
}

fn beside_the_truth(a: &Accuracy) -> String {
    let mut text = "beside the truth, where both cameras see the point:\n".to_owned();
    let _ = writeln!(text, "  answered               {:6.2} %", 100.0 * a.density);
    let _ = writeln!(text, "  over 2 px off (bad2)   {:6.2} % of the answers", 100.0 * a.bad2);
    let _ = writeln!(text, "  RMS error of the good  {:6.3} px", a.rms_good_px);
    let _ = writeln!(text, "  within 3 sigma_Z       {:6.2} % of the answers", 100.0 * a.within_3_sigma);
    if let Some(s) = a.sparsification {
        let _ = writeln!(
            text,
            "  confidence             {:6.1} % of the way from the best order to none",
            100.0 * s.from_oracle()
        );
    }
    let (mm, relative) = (1000.0 * a.median_depth_error_m, 100.0 * a.median_depth_error_relative);
    let _ = writeln!(text, "  median depth error     {mm:6.1} mm ({relative:.2} %)");
    text
}
