//! `examples/c-firmware/raw.c`: raw pictures, the record in `rig.h`, rectified lines, depths and points, held
//! to the same in Rust.

use super::program::{Scope, beside, crc32_of, program};
use crate::pictures::Pictures;
use crate::steps::{Failure, Outcome, root};
use firmware_scenes::scene::Scene;
use std::fmt::Debug;
use std::fs;
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::{ImageSize, StereoRig};
use stereopsis::geometry::rectify::{Crop, Rectification};
use stereopsis::imaging::{RectifiedPair, RemapPair, RemapTable};
use stereopsis::matching::{Block, Config};
use stereopsis::pipeline::Pipeline;
use stereopsis_host::run::MethodName;

/// The record, from the repository's root.
const RIG: &str = "examples/c-firmware/rig.h";
/// The size of raw and rectified pictures, and the search.
const SIZE: ImageSize = ImageSize { width: 160, height: 120 };
const DISPARITIES: u16 = 32;
/// By how many rows the right camera sees all lower.
const LOWER: usize = 2;
/// The least of the pixels that have to have an answer, in 100.
const LEAST_ANSWERS: usize = 40;

/// A program for raw pictures on each core finds what the host's pipeline finds.
pub fn run(scope: Scope) -> Outcome {
    let pictures =
        Pictures::of_scene(Scene { width: SIZE.width, height: SIZE.height })?.with_right_lower(LOWER);
    let expected = expected(&pictures)?;
    for &core in scope.cores() {
        let program = program(core, MethodName::Block, SIZE.width, DISPARITIES)?;
        let found = crc32_of(core, &beside(&program, "raw"), &pictures)?;
        if found != expected {
            let line = format!("raw, {core}: crc32 {found:08x}, the host's pipeline has {expected:08x}");
            return Err(Failure::new(line));
        }
        println!("raw, {core}: crc32 {found:08x}");
    }
    Ok(())
}

fn failed(e: impl Debug) -> Failure {
    Failure::new(format!("{RIG}: {e:?}"))
}

/// The record's bytes in the header.
fn record() -> Outcome<Vec<u8>> {
    let text = fs::read_to_string(root().join(RIG)).map_err(failed)?;
    let bytes = text.split(|c: char| !c.is_ascii_alphanumeric()).filter_map(|word| word.strip_prefix("0x"));
    bytes.map(|digits| u8::from_str_radix(digits, 16).map_err(failed)).collect()
}

/// The checksum of what `raw.c` sums up, by the host's pipeline.
fn expected(pictures: &Pictures) -> Outcome<u32> {
    const SLOTS: usize = RemapTable::<0>::slots(SIZE, 4);
    let rig = StereoRig::<f32>::from_record(&record()?).map_err(failed)?;
    let rectified = Rectification::new(&rig, Crop::Natural, SIZE).map_err(failed)?;
    let scale = DepthScale::new(&rectified.rig().map_err(failed)?).map_err(failed)?;
    let mut remaps = Box::new(RemapPair::<160, 33, SLOTS>::empty());
    remaps.set(&rectified).map_err(failed)?;
    let mut camera = RectifiedPair::new(pictures.camera()?, &mut remaps).map_err(failed)?;
    let mut pipeline = Box::new(Pipeline::<Block, 160, 32>::new());
    pipeline.start(&Config::for_method::<Block>(SIZE.width, SIZE.height, DISPARITIES)).map_err(failed)?;
    pipeline.begin_frame(&mut camera).map_err(failed)?;
    let (mut crc, mut answers) = (crc32fast::Hasher::new(), 0);
    while let Some(row) = pipeline.next_row(&mut camera).map_err(failed)? {
        let columns = 0..SIZE.width;
        let (disparities, y) = (row.disparities(), row.index());
        disparities.iter().for_each(|d| crc.update(&d.raw().to_le_bytes()));
        row.flags().iter().for_each(|flags| crc.update(&[flags.bits()]));
        for d in disparities {
            crc.update(&scale.metres(*d).map_or(0.0, |z| z.0).to_le_bytes());
        }
        for (x, d) in disparities.iter().enumerate() {
            let sigma_px = row.sigma_px(x).unwrap_or(f32::INFINITY);
            crc.update(&scale.sigma(*d, sigma_px).map_or(f32::INFINITY, |sigma| sigma.0).to_le_bytes());
        }
        for (x, d) in columns.zip(disparities) {
            let point = scale.point(x, y, *d).map_or([0.0; 3], |p| [p.x, p.y, p.z]);
            point.iter().for_each(|x| crc.update(&x.to_le_bytes()));
            answers += usize::from(d.is_some());
        }
    }
    let pixels = usize::from(SIZE.width) * usize::from(SIZE.height);
    if answers * 100 < pixels * LEAST_ANSWERS {
        return Err(Failure::new(format!("raw: the host has {answers} answers for {pixels} pixels")));
    }
    Ok(crc.finalize())
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_record_is_whole() {
        assert_eq!(super::record().expect("bytes").len(), 328);
    }
}
