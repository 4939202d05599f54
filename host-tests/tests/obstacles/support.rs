//! Maps of disparity through the core.

use image::GrayImage;
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::imaging::PairMonitor;
use stereopsis::matching::{Block, Config, Method};
use stereopsis::obstacles::{ObstacleConfig, Obstacles};
use stereopsis::pipeline::Pipeline;
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::scene::{Random, Scene, SceneCamera};

/// Room for pictures of 640 x 480 px in cells of 4 x 5 px, and for small ones in cells of a pixel.
pub type Finder = Obstacles<170, 130>;

/// A map of disparities of a rig.
#[derive(Clone)]
pub struct Map {
    pub rig: RectifiedRig,
    pub size: [u16; 2],
    pub largest: Disparity,
    pub disparities: Vec<Disparity>,
    pub flags: Vec<PixelFlags>,
    pub confidences: Vec<u8>,
}

impl Map {
    /// A map without confidences, of what `parallax_px` says of each column and row.
    pub fn of(rig: RectifiedRig, size: [u16; 2], parallax_px: impl Fn(f64, f64) -> Option<f64>) -> Self {
        let [width, height] = size;
        let pixels = (0..height).flat_map(|v| (0..width).map(move |u| (u, v)));
        let offset = f64::from(rig.disparity_offset_px());
        let step = |(u, v)| {
            let d = parallax_px(f64::from(u), f64::from(v)).map(|p| (32.0 * (p - offset)).round());
            d.filter(|d| (0.0..65_535.0).contains(d))
                .map_or(Disparity::NONE, |d| Disparity::from_raw(d as u16))
        };
        let disparities: Vec<_> = pixels.map(step).collect();
        let flags = vec![PixelFlags::CLEAR; disparities.len()];
        Self { rig, size, largest: Disparity::from_pixels(64), disparities, flags, confidences: Vec::new() }
    }

    /// A finder that is started on the map's frames.
    pub fn finder(&self, config: &ObstacleConfig) -> Box<Finder> {
        let mut finder = Box::new(Finder::new());
        let scale = DepthScale::new(&self.rig).expect("a scale");
        finder.start(config, &scale, self.size, self.largest).expect("room for it");
        finder
    }

    /// Gives the rows of a frame that `keep` keeps to a finder, without finishing it.
    pub fn rows(&self, finder: &mut Finder, keep: impl Fn(usize) -> bool) {
        finder.begin();
        self.rows_of_begun(finder, keep);
    }

    /// The same of a frame that is begun.
    pub fn rows_of_begun(&self, finder: &mut Finder, keep: impl Fn(usize) -> bool) {
        let width = usize::from(self.size[0]);
        for y in (0..usize::from(self.size[1])).filter(|&y| keep(y)) {
            let row = y * width..(y + 1) * width;
            let confidences = if self.confidences.is_empty() { &[] } else { &self.confidences[row.clone()] };
            finder.push(y, &self.disparities[row.clone()], &self.flags[row], confidences);
        }
    }
}

/// A small robot's cameras, 160 x 120 px: a focal length of 130 px, a baseline of 0.1 m.
pub fn rig() -> RectifiedRig {
    RectifiedRig::new(130.0, 0.1, 79.5, 59.5).expect("a rig")
}

/// Parallax of the plane below a camera at a height, pitched down, at row `v`, px.
pub fn floor(rig: &RectifiedRig, height_m: f64, pitch_rad: f64, v: f64) -> Option<f64> {
    let (f, b) = (f64::from(rig.focal_px()), f64::from(rig.baseline_m()));
    let y = v - f64::from(rig.principal_point().1);
    let parallax = b / height_m * (y * pitch_rad.cos() + f * pitch_rad.sin());
    (parallax > 0.0).then_some(parallax)
}

/// A pipeline before a finder; that of `block` where no method is named.
pub struct Cameras<M: Method = Block> {
    pipeline: Box<Pipeline<M, 320, 128>>,
    pub finder: Box<Finder>,
    monitor: PairMonitor,
}

impl<M: Method> Cameras<M> {
    /// Cameras that see a scene of at most 320 px and 128 disparities, and default limits.
    pub fn new(scene: &Scene) -> Self {
        Self::of(scene, &ObstacleConfig::default(), false)
    }

    /// Cameras with limits, and with or without confidences.
    pub fn of(scene: &Scene, limits: &ObstacleConfig, confidence: bool) -> Self {
        let (width, height, disparities) = (scene.width(), scene.height(), scene.disparities());
        let mut pipeline = Box::new(Pipeline::new());
        let config = Config::for_method::<M>(width, height, disparities);
        pipeline.start(&Config { confidence, ..config }).expect("room for it");
        let mut finder = Box::new(Finder::new());
        let scale = DepthScale::new(&scene.rig()).expect("a scale");
        let largest = Disparity::from_pixels(disparities);
        finder.start(limits, &scale, [width, height], largest).expect("room for it");
        Self { pipeline, finder, monitor: PairMonitor::new(disparities) }
    }

    /// A frame of two pictures, of which `keep` says which rows of disparities arrive.
    pub fn frame_of(
        &mut self,
        left: &GrayImage,
        right: &GrayImage,
        keep: impl Fn(usize) -> bool,
    ) -> &mut Self {
        self.monitor.begin();
        for (left, right) in left.rows().zip(right.rows()) {
            let line =
                |row: image::buffer::Pixels<'_, image::Luma<u8>>| row.map(|p| p.0[0]).collect::<Vec<_>>();
            self.monitor.lines(&line(left), &line(right));
        }
        let mut camera = SceneCamera::new(left.clone(), right.clone());
        self.pipeline.begin_frame(&mut camera).expect("a frame");
        self.finder.begin();
        self.finder.as_mut_view().cameras(&self.monitor);
        while let Some(row) = self.pipeline.next_row(&mut camera).expect("a row") {
            if keep(row.index().into()) {
                self.finder.push(row.index().into(), row.disparities(), row.flags(), row.confidences());
            }
        }
        // What it says is asked of the view.
        let _ = self.finder.finish();
        self
    }

    /// A whole frame of two pictures.
    pub fn frame(&mut self, left: &GrayImage, right: &GrayImage) -> &mut Self {
        self.frame_of(left, right, |_| true)
    }
}

/// A picture with sensor noise of a deviation in grey levels, of another exposure.
pub fn noisy(picture: &GrayImage, noise_grey: f64, gain: f64, seed: u64) -> GrayImage {
    let mut random = Random::new(seed);
    let mut noisy = picture.clone();
    for pixel in noisy.iter_mut() {
        let noise = if noise_grey > 0.0 { noise_grey * random.gauss() } else { 0.0 };
        *pixel = (f64::from(*pixel) * gain + noise).round().clamp(0.0, 255.0) as u8;
    }
    noisy
}

/// Exposures of the frames, one after the other.
const GAINS: [f64; 4] = [1.0, 0.7, 1.0, 1.3];

/// Frame `n` of a pair of pictures, with noise and steps of exposure.
pub fn frame(pictures: &(GrayImage, GrayImage), noise_grey: f64, n: usize) -> (GrayImage, GrayImage) {
    let gain = GAINS[n % GAINS.len()];
    let seed = 2 * n as u64;
    (noisy(&pictures.0, noise_grey, gain, seed), noisy(&pictures.1, noise_grey, gain, seed + 1))
}
