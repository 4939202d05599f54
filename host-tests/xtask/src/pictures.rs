//! Pairs of grey pictures that firmware is given, and what the host's own pipeline finds in them.

use crate::steps::{Failure, Outcome};
use firmware_scenes::scene::{Scene, SceneCamera};
use image::GrayImage;
use image::imageops::{FilterType, resize};
use std::fmt;
use std::io::Write;
use std::path::Path;
use stereopsis::camera::{CameraPair, StereoSource};
use stereopsis::imaging::{Balance, GreyLines, Noise};
use stereopsis::matching::{Config, Filter};
use stereopsis_host::limits::IMAGE_SIDE;
use stereopsis_host::map::DisparityMap;
use stereopsis_host::mock::MockCamera;
use stereopsis_host::run::{MemoryPair, MethodName, NoiseChoice, measure_balance, run};

/// Bytes of the longest raw line: RGB with 16 bits.
const RAW: usize = IMAGE_SIDE as usize * 6;

/// The rows that the host's pipeline makes of a source's frame by `block`, as firmware writes them: of every
/// pixel the disparity's steps, the low byte first, and the flags.
pub fn block_rows<C: StereoSource<Error: fmt::Display>>(
    camera: &mut C,
    disparities: u16,
) -> Outcome<Vec<u8>> {
    let format = camera.format();
    let config = MethodName::Block.config(format.width, format.height, disparities);
    let outcome = run(MethodName::Block, &config, camera, |_| ());
    let map = outcome.map_err(|e| Failure::new(format!("the host finds no rows: {e}")))?.map;
    let pixels = map.disparity.iter().zip(&map.flags);
    let bytes = pixels.flat_map(|(disparity, flags)| {
        let [low, high] = disparity.raw().to_le_bytes();
        [low, high, flags.bits()]
    });
    Ok(bytes.collect())
}

/// A pair of pictures of one size, 8-bit grey.
#[derive(Clone)]
pub struct Pictures {
    /// Pixels in a line.
    pub width: u16,
    /// Lines.
    pub height: u16,
    left: Vec<u8>,
    right: Vec<u8>,
}

impl Pictures {
    /// Two image files, made grey as `stereo match` does it.
    pub fn open(left: &Path, right: &Path) -> Outcome<Self> {
        let (left, right) = MockCamera::open_pair(left, right).map_err(|e| Failure::new(e.to_string()))?;
        let grey = |camera| GreyLines::<_, RAW>::new(camera).map_err(|e| Failure::new(e.to_string()));
        let mut pair =
            CameraPair::new(grey(left)?, grey(right)?, 0).map_err(|e| Failure::new(e.to_string()))?;
        Self::record(&mut pair)
    }

    /// The built-in scene.
    pub fn of_scene(scene: Scene) -> Outcome<Self> {
        Self::record(&mut SceneCamera::new(scene))
    }

    /// Every pixel from its row and column in the left camera and in the right one.
    pub fn drawn(width: u16, height: u16, pixel: impl Fn(u32, u32, bool) -> u8) -> Self {
        let at = |right: bool| {
            let rows = (0..u32::from(height)).flat_map(|v| (0..u32::from(width)).map(move |u| (u, v)));
            rows.map(|(u, v)| pixel(u, v, right)).collect()
        };
        Self { width, height, left: at(false), right: at(true) }
    }

    /// The same pictures in another size.
    pub fn scaled(&self, width: u16, height: u16) -> Outcome<Self> {
        let scale = |pixels: &[u8]| {
            let picture = GrayImage::from_raw(self.width.into(), self.height.into(), pixels.to_vec())?;
            Some(resize(&picture, width.into(), height.into(), FilterType::Triangle).into_raw())
        };
        let both = scale(&self.left).zip(scale(&self.right));
        let (left, right) = both.ok_or_else(|| Failure::new("a picture has too few pixels"))?;
        Ok(Self { width, height, left, right })
    }

    /// The same pictures with the right one moved down by some rows, below black ones.
    pub fn with_right_lower(mut self, rows: usize) -> Self {
        let moved = rows * usize::from(self.width);
        self.right.splice(..0, std::iter::repeat_n(0, moved));
        self.right.truncate(self.left.len());
        self
    }

    /// A frame of a camera with 8-bit grey lines.
    fn record<C: StereoSource<Error: fmt::Display>>(camera: &mut C) -> Outcome<Self> {
        let failed = |e| Failure::new(format!("camera: {e}"));
        let format = camera.format();
        let pixels = usize::from(format.width) * usize::from(format.height);
        let (mut left, mut right) = (vec![0; pixels], vec![0; pixels]);
        camera.start_frame().map_err(failed)?;
        let lines = usize::from(format.width).max(1);
        for (left, right) in left.chunks_mut(lines).zip(right.chunks_mut(lines)) {
            camera.next_lines(left, right).map_err(failed)?;
        }
        Ok(Self { width: format.width, height: format.height, left, right })
    }

    /// The pictures as a camera.
    pub fn camera(&self) -> Outcome<MemoryPair> {
        let camera = MemoryPair::new(self.width, self.left.clone(), self.right.clone());
        camera.ok_or_else(|| Failure::new("the pictures are empty"))
    }

    /// Makes the right picture one of the left one's exposure where the two clearly differ, as `stereo match`
    /// does it.
    pub fn balance(&mut self) -> Outcome<Balance> {
        let balance =
            measure_balance(&mut self.camera()?).map_err(|e| Failure::new(format!("camera: {e}")))?;
        balance.line(&mut self.right);
        Ok(balance)
    }

    /// Their noise, told or measured.
    pub fn noise(&self, choice: NoiseChoice) -> Outcome<Noise> {
        let level = choice.level(&mut self.camera()?);
        level.map(|(noise, _)| noise).map_err(|e| Failure::new(format!("camera: {e}")))
    }

    /// What a search with the checks of [`Filter::Default`] finds in them on the host.
    pub fn matched(&self, method: MethodName, disparities: u16, noise: Noise) -> Outcome<DisparityMap> {
        self.matched_by(method, &self.search(method, disparities, noise))
    }

    /// A search of these pictures with the checks of [`Filter::Default`].
    pub fn search(&self, method: MethodName, disparities: u16, noise: Noise) -> Config {
        let search = Config { noise, ..method.config(self.width, self.height, disparities) };
        method.with_filter(Filter::Default, search)
    }

    /// What a search finds in them on the host.
    pub fn matched_by(&self, method: MethodName, search: &Config) -> Outcome<DisparityMap> {
        let outcome = run(method, search, &mut self.camera()?, |_| ());
        outcome.map(|outcome| outcome.map).map_err(|e| Failure::new(format!("{method} on the host: {e}")))
    }

    /// The checksum of what the host's pipeline finds in them, as pictures with little noise, see [`crc32`].
    pub fn crc32(&self, method: MethodName, disparities: u16) -> Outcome<u32> {
        self.matched(method, disparities, Noise::None).map(|map| crc32(&map))
    }

    /// Writes `left.pgm` and `right.pgm`, which firmware reads.
    pub fn write(&self, folder: &Path) -> Outcome {
        for (name, pixels) in [("left.pgm", &self.left), ("right.pgm", &self.right)] {
            let path = folder.join(name);
            let write = || {
                let mut file = std::fs::File::create(&path)?;
                write!(file, "P5\n{} {}\n255\n", self.width, self.height)?;
                file.write_all(pixels)
            };
            write().map_err(|e| Failure::new(format!("{}: {e}", path.display())))?;
        }
        Ok(())
    }
}

/// CRC-32 over disparity (two bytes, low one first) and flags of every pixel, as the examples work it out.
fn crc32(map: &DisparityMap) -> u32 {
    let mut crc = crc32fast::Hasher::new();
    for (disparity, flags) in map.disparity.iter().zip(&map.flags) {
        let [low, high] = disparity.raw().to_le_bytes();
        crc.update(&[low, high, flags.bits()]);
    }
    crc.finalize()
}
