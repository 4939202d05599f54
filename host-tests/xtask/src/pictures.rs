//! Pairs of PGM pictures, and what the host's pipeline finds in them.

use crate::steps::{Failure, Outcome};
use std::fmt::Display;
use std::fs;
use std::path::Path;
use stereopsis::camera::{LineFormat, LineSource, PixelFormat};
use stereopsis::matching::Config;
use stereopsis_host::mock::MockCamera;
use stereopsis_host::run::{MemoryPair, Method, run};
use stereopsis_host::scene::Scene;

fn wrong(path: &Path) -> impl Fn(&dyn Display) -> Failure {
    move |what| Failure::new(format!("{}: {what}", path.display()))
}

/// Writes what the two cameras of a scene see.
pub fn write(scene: &Scene, left: &Path, right: &Path) -> Outcome {
    let (left_picture, right_picture) = scene.render();
    for (path, picture) in [(left, left_picture), (right, right_picture)] {
        let mut bytes = format!("P5\n{} {}\n255\n", picture.width(), picture.height()).into_bytes();
        bytes.extend_from_slice(picture.as_raw());
        fs::write(path, bytes).map_err(|e| wrong(path)(&e))?;
    }
    Ok(())
}

/// Pixels in a line of a picture.
pub fn width(path: &Path) -> Outcome<u16> {
    read(path).map(|(format, _)| format.width)
}

/// The CRC-32 of all disparities and flags, as the example in C works it out, from the host's pipeline.
pub fn crc(left: &Path, right: &Path, method: Method, disparities: u16) -> Outcome<u32> {
    let ((format, left_bytes), (_, right_bytes)) = (read(left)?, read(right)?);
    let pair = MemoryPair::new(format.width, left_bytes, right_bytes);
    let mut camera = pair.ok_or_else(|| wrong(right)(&"is not of the left picture's size"))?;
    let config = Config::new(format.width, format.height, disparities);
    let map = run(method, &config, &mut camera, |_| ()).map_err(|e| wrong(left)(&e))?.map;
    let mut crc = crc32fast::Hasher::new();
    for (disparity, flags) in map.disparity.iter().zip(&map.flags) {
        crc.update(&disparity.raw().to_le_bytes());
        crc.update(&[flags.bits()]);
    }
    Ok(crc.finalize())
}

/// An 8-bit grey picture's format and bytes.
fn read(path: &Path) -> Outcome<(LineFormat, Vec<u8>)> {
    let mut camera = MockCamera::open(path).map_err(|e| Failure::new(e.to_string()))?;
    let format = camera.format();
    if format.pixel != PixelFormat::Grey8 {
        return Err(wrong(path)(&"is not an 8-bit grey picture"));
    }
    let mut bytes = vec![0; format.line_bytes() * usize::from(format.height)];
    camera.start_frame().map_err(|e| wrong(path)(&e))?;
    for line in bytes.chunks_exact_mut(format.line_bytes()) {
        camera.next_line(line).map_err(|e| wrong(path)(&e))?;
    }
    Ok((format, bytes))
}
