//! What is seen of a recording's first frames before it is played.

use super::ReplayArgs;
use crate::failure::Failure;
use crate::look::{self, Disparities, Look, Looked};
use crate::scale::camera;
use crate::shared::MethodArgs;
use image::GrayImage;
use stereopsis::depth::DepthScale;
use stereopsis::matching::Config;
use stereopsis_host::pair::PairMatches;
use stereopsis_host::recording::Header;

/// The search in frames without noise, and what is seen of the pair that has the most features of those.
pub fn look(
    args: &ReplayArgs,
    Header { width, height, .. }: Header,
    pairs: Vec<[GrayImage; 2]>,
    scale: Option<&DepthScale>,
) -> Result<Look, Failure> {
    let options = MethodArgs {
        method: args.method,
        filter: args.filter,
        noise: args.noise,
        min_confidence: 0,
        kernel: None,
        threads: 1,
    };
    args.search.check(&options, width, height)?;
    let features =
        |pair: &[GrayImage; 2]| PairMatches::find(pair.each_ref(), None).map_or(0, |found| found.count());
    let black = [(); 2].map(|()| GrayImage::new(width.into(), height.into()));
    let came = !pairs.is_empty();
    let pair = pairs.into_iter().max_by_key(features).unwrap_or(black);
    let camera = scale.and_then(|scale| camera(scale.rig()));
    if !came && args.search.disparities == Disparities::Auto {
        return Err(Failure::new(
            "--disparities auto: the first frames show nothing, or none of their lines came; give a number",
        ));
    }
    let offset_px = scale.map_or(0.0, |scale| scale.rig().disparity_offset_px().into());
    let looked = Looked { camera: camera.as_ref(), offset_px, ..Looked::of(pair.each_ref()) };
    let look = look::look(&args.search, &options, &looked, || None)?;
    // In the sky obstacles are asked to be sure.
    let config = Config { confidence: args.watch.obstacles, ..look.config };
    // What never came says nothing of the cameras.
    Ok(Look { config, check: look.check.filter(|_| came), rows: look.rows.filter(|_| came) })
}
