//! A chessboard as a camera sees it, and where its corners are: pictures for tests.

use super::board::{Markers, Pattern};
use crate::scene::Random;
use image::{GrayImage, Luma};
use nalgebra::{Point2, Point3, Vector3};
use stereopsis::geometry::camera::{Camera, ImageSize, Pose, StereoRig};

/// Samples along a pixel's side.
const SAMPLES: usize = 4;
const BLACK: f64 = 30.0;
const WHITE: f64 = 215.0;
const WALL: f64 = 110.0;
/// White around the squares, in squares.
const MARGIN: f64 = 0.6;

/// A camera and the sights of all its pixels' samples.
#[derive(Clone, Debug)]
pub struct BoardCamera {
    camera: Camera<f64>,
    size: ImageSize,
    sights: Vec<Option<Vector3<f64>>>,
}

impl BoardCamera {
    /// A camera with images of `size`.
    pub fn new(camera: Camera<f64>, size: ImageSize) -> Self {
        let (columns, rows) = (usize::from(size.width) * SAMPLES, usize::from(size.height) * SAMPLES);
        let place = |i: usize| (i as f64 + 0.5) / SAMPLES as f64 - 0.5;
        let sights = (0..rows).flat_map(|y| (0..columns).map(move |x| Point2::new(place(x), place(y))));
        let sights = sights.map(|pixel| camera.unproject(&pixel).ok()).collect();
        Self { camera, size, sights }
    }

    /// Both cameras of a rig.
    pub fn pair(rig: &StereoRig<f64>) -> [Self; 2] {
        [0, 1].map(|i| Self::new(rig.cameras()[i], rig.sizes()[i]))
    }

    /// Where the corners of a board are; `board` carries a point of the board (X along rows, Y down columns,
    /// unit one square) into the camera. `None` when one is outside of the image.
    pub fn corners(&self, pattern: Pattern, board: &Pose<f64>) -> Option<Vec<Point2<f64>>> {
        let (w, h) = (f64::from(self.size.width) - 1.0, f64::from(self.size.height) - 1.0);
        let is_inside = |p: &Point2<f64>| p.x >= 0.0 && p.y >= 0.0 && p.x <= w && p.y <= h;
        let seen = |p: Point2<f64>| self.camera.project(&board.transform(&Point3::new(p.x, p.y, 0.0))).ok();
        pattern.places().map(|place| seen(place).filter(is_inside)).collect()
    }

    /// The picture, with noise of `sigma` grey levels.
    pub fn picture(&self, pattern: Pattern, board: &Pose<f64>, sigma: f64, random: &mut Random) -> GrayImage {
        self.marked_picture(pattern, None, board, sigma, random)
    }

    /// The picture of a board with markers in its white squares, if any, with noise of `sigma` grey levels.
    pub fn marked_picture(
        &self,
        pattern: Pattern,
        markers: Option<&Markers>,
        board: &Pose<f64>,
        sigma: f64,
        random: &mut Random,
    ) -> GrayImage {
        let columns = usize::from(self.size.width) * SAMPLES;
        let (right, bottom) = (pattern.columns() as f64, pattern.rows() as f64);
        let centre = board.inverse_transform(&Point3::origin());
        let brightness = |x: usize, y: usize| {
            let Some(sight) = self.sights[y * columns + x] else { return WALL };
            let way = board.rotation().tr_mul(&sight);
            let far = -centre.z / way.z;
            let at = centre + way * far;
            let is_within = |margin: f64| {
                far > 0.0
                    && (-margin..right - 1.0 + margin).contains(&at.x)
                    && (-margin..bottom - 1.0 + margin).contains(&at.y)
            };
            if is_within(1.0) {
                let is_white = (at.x.floor() + at.y.floor()).rem_euclid(2.0) != 0.0;
                if is_white && !markers.is_some_and(|m| is_marked(m, pattern, &at)) { WHITE } else { BLACK }
            } else if is_within(1.0 + MARGIN) {
                WHITE
            } else {
                WALL
            }
        };
        GrayImage::from_fn(self.size.width.into(), self.size.height.into(), |x, y| {
            let samples = (0..SAMPLES * SAMPLES).map(|i| (i % SAMPLES, i / SAMPLES));
            let sum: f64 =
                samples.map(|(i, j)| brightness(x as usize * SAMPLES + i, y as usize * SAMPLES + j)).sum();
            Luma(
                [(sum / (SAMPLES * SAMPLES) as f64 + sigma * random.gauss()).round().clamp(0.0, 255.0) as u8],
            )
        })
    }
}

/// Whether a place on the board, in squares from its first corner, is in a black part of a marker.
fn is_marked(markers: &Markers, pattern: Pattern, at: &Point3<f64>) -> bool {
    let square = (at.x.floor() as i32 + 1, at.y.floor() as i32 + 1);
    let Some(number) = markers.number(pattern, square) else { return false };
    // In bits from the marker's first one, which is of the border.
    let bits = (markers.dictionary.side() + 2) as f64;
    let bit = |of: f64| ((of - of.floor() - (1.0 - markers.share) / 2.0) / markers.share * bits).floor();
    let (column, row) = (bit(at.x), bit(at.y));
    let is_within = |bit: f64| (0.0..bits).contains(&bit);
    let is_inner = |bit: f64| (1.0..bits - 1.0).contains(&bit);
    if !is_within(column) || !is_within(row) {
        return false;
    }
    let is_white = is_inner(column)
        && is_inner(row)
        && markers.dictionary.is_white(number, column as usize - 1, row as usize - 1);
    !is_white
}
