//! The report on a rectification: what is left of row errors, and what the warps cost.

use super::rectification::Rectification;
use super::warp::Warp;
use crate::geometry::Real;
use nalgebra::Point2;

/// Columns and rows of the lattice that a report looks at, its ends with it.
const LATTICE: usize = 65;

/// What a rectification costs, and what is left of the pictures. Shares and lengths are those of a lattice of
/// 65 x 65 places.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RectificationReport<T: Real> {
    /// The share of the rectified image that the first and the second camera see, 0 to 1.
    pub seen: [T; 2],
    /// The share that both see: the common field of view, of points far away.
    pub common: T,
    /// The angle between the outermost columns and between the outermost rows with a place that both see,
    /// radians.
    pub field_of_view_rad: [T; 2],
    /// The largest distance between a rectified pixel that is seen and its raw one, px, in both.
    pub largest_warp_px: [T; 2],
    /// Raw rows that a row of the rectified image needs, with all that were needed before it, when lines
    /// come one after the other: about how many have to be held at once.
    pub rows: [u16; 2],
    /// Rectified px for a raw px across the baseline, in the middle.
    pub magnification: [T; 2],
}

impl<T: Real> RectificationReport<T> {
    /// The deviation to expect of the row (horizontal rigs) or the column (vertical ones) of a point in one
    /// image from that in the other, px, where the calibration leaves points `residual_px` from where it
    /// puts them, in the raw images: its re-projection error (RMS, px; half of its square belongs to the
    /// one direction that counts).
    pub fn row_error_px(&self, residual_px: T) -> T {
        let [a, b] = self.magnification;
        residual_px * ((a * a + b * b) * T::of(0.5)).sqrt()
    }
}

impl<T: Real> Rectification<T> {
    /// Looks at the rectification.
    pub fn report(&self) -> RectificationReport<T> {
        let size = self.size();
        let (cx, cy) = self.camera().principal_point();
        let f = self.camera().focal_px().0;
        let warps = self.warps();
        let place =
            |i: usize, side: u16| T::count(i) / T::count(LATTICE - 1) * T::count(usize::from(side) - 1);
        let (mut seen, mut common) = ([T::ZERO; 2], T::ZERO);
        let mut largest = [T::ZERO; 2];
        let (mut least, mut most) = ([T::of(1e9); 2], [T::of(-1e9); 2]);
        for (i, j) in (0..LATTICE).flat_map(|j| (0..LATTICE).map(move |i| (i, j))) {
            let pixel = Point2::new(place(i, size.width), place(j, size.height));
            let mut both = true;
            for (camera, warp) in warps.iter().enumerate() {
                match warp.seen_at(&pixel) {
                    Some(source) => {
                        seen[camera] += T::ONE;
                        largest[camera] = largest[camera].max((source - pixel).norm());
                    }
                    None => both = false,
                }
            }
            if both {
                common += T::ONE;
                for (axis, x) in [pixel.x - cx, pixel.y - cy].into_iter().enumerate() {
                    least[axis] = least[axis].min(x);
                    most[axis] = most[axis].max(x);
                }
            }
        }
        let all = T::count(LATTICE * LATTICE);
        let angle = |axis: usize| {
            if most[axis] > least[axis] { most[axis].atan2(f) - least[axis].atan2(f) } else { T::ZERO }
        };
        RectificationReport {
            seen: seen.map(|n| n / all),
            common: common / all,
            field_of_view_rad: [angle(0), angle(1)],
            largest_warp_px: largest,
            rows: warps.each_ref().map(Warp::rows_at_once),
            magnification: warps.each_ref().map(|warp| {
                let (fx, fy) = warp.camera().focal_px();
                f / if self.axis().is_horizontal() { fy } else { fx }
            }),
        }
    }
}

impl<T: Real> Warp<T> {
    /// The place in the raw image that a rectified pixel is of; `None` where it is of none.
    fn seen_at(&self, pixel: &Point2<T>) -> Option<Point2<T>> {
        let source = self.source(pixel).ok()?;
        (source.is_described && self.is_in_raw(&source.pixel)).then_some(source.pixel)
    }

    /// The most rows of the raw image that lie between the first that a row of the rectified image needs and
    /// the last that it or a row before it needed.
    fn rows_at_once(&self) -> u16 {
        let (mut last, mut most) = (T::ZERO, T::ZERO);
        let width = T::count(usize::from(self.size().width) - 1);
        for v in 0..self.size().height {
            let mut first = T::of(1e9);
            for i in 0..LATTICE {
                let pixel = Point2::new(T::count(i) / T::count(LATTICE - 1) * width, T::count(v.into()));
                if let Some(source) = self.seen_at(&pixel) {
                    let row = source.y.floor();
                    first = first.min(row);
                    last = last.max(row + T::ONE);
                }
            }
            most = most.max(last - first + T::ONE);
        }
        // At most a few thousand: an image's rows.
        most.to_f64() as u16
    }
}
