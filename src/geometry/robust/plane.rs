//! Degenerate samples of F: a dominant plane (DEGENSAC; Chum, Werner & Matas 2005).
//!
//! Of seven correspondences five or more may lie on one plane of a scene that has depth besides. F is then
//! one of a family that fits the whole plane and nothing else, and in a scene with a large plane that is a
//! lot. But its plane is known now, and with it two correspondences off the plane give F (Chum, Werner &
//! Matas 2005).

use super::frame::Frame;
use crate::geometry::Real;
use crate::geometry::linear::{columns3, larger, product, skew};
use crate::geometry::two_view::{Correspondence, least_squares};
use nalgebra::{Matrix3, Point2, Vector3};

/// Triplets of a sample of seven: any five of the seven hold one of them.
const TRIPLETS: [[usize; 3]; 5] = [[0, 1, 2], [3, 4, 5], [0, 1, 6], [3, 4, 6], [2, 5, 6]];

/// A homography before its inverse, px.
#[derive(Clone, Copy)]
pub(super) struct Plane<T: Real> {
    pub(super) matrix: Matrix3<T>,
    adjugate: Matrix3<T>,
}

impl<T: Real> Plane<T> {
    fn new(matrix: Matrix3<T>) -> Self {
        let [a, b, c] = columns3(&matrix);
        let rows = [b.cross(&c), c.cross(&a), a.cross(&b)].map(|row| row.transpose());
        Self { matrix, adjugate: Matrix3::from_rows(&rows) }
    }

    /// The plane of five correspondences or more of a sample, to within `px2` px squared, for the F of that
    /// sample.
    pub(super) fn of_sample(f: &Matrix3<T>, sample: &[Correspondence<T>; 7], px2: T) -> Option<Self> {
        TRIPLETS.iter().find_map(|triplet| {
            let [Some(x), Some(y), Some(z)] = triplet.map(|i| sample.get(i).copied()) else { return None };
            let plane = Self::through(f, [x, y, z])?;
            (sample.iter().filter(|s| plane.holds(s, px2)).count() >= 5).then_some(plane)
        })
    }

    /// The plane of three correspondences, for an F that they agree with: of the pencil `H = [e]x F - e v^T`
    /// the one that maps the three (Hartley & Zisserman 2004, 13.6). `None` when F has no epipole.
    pub(super) fn through(f: &Matrix3<T>, three: [Correspondence<T>; 3]) -> Option<Self> {
        let epipole = left_null(f)?;
        let base = product(&skew(&epipole), f);
        let row = |s: &Correspondence<T>| s.second.to_homogeneous();
        let offset = |s: &Correspondence<T>| {
            let p = s.first.to_homogeneous();
            let across = p.cross(&epipole);
            p.cross(&(base * row(s))).dot(&across) / across.norm_squared()
        };
        let [r0, r1, r2] = three.map(|s| row(&s));
        let (c0, c1, c2) = (r1.cross(&r2), r2.cross(&r0), r0.cross(&r1));
        let [b0, b1, b2] = three.map(|s| offset(&s));
        let v = (c0 * b0 + c1 * b1 + c2 * b2) / r0.dot(&c0);
        Some(Self::new(base - epipole * v.transpose()))
    }

    /// The plane by least squares of all that are on this one to within `px2` px squared, and how many those
    /// are.
    pub(super) fn fitted(&self, seen: &[Correspondence<T>], frames: &[Frame<T>; 2], px2: T) -> (Self, usize) {
        let count = self.count(seen, 1, px2);
        // Four are no more than determine it.
        if count <= 4 {
            return (*self, count);
        }
        let on = seen.iter().filter(|s| self.holds(s, px2));
        let [first, second] = frames;
        let (h, _) = least_squares(on.map(|s| (first.apply(s.first), second.apply(s.second))));
        let fitted = Self::new(product(&product(&first.inverse(), &h), &second.matrix()));
        let again = fitted.count(seen, 1, px2);
        if again >= count { (fitted, again) } else { (*self, count) }
    }

    /// How many of every `every`th are on the plane to within `px2` px squared.
    pub(super) fn count(&self, seen: &[Correspondence<T>], every: usize, px2: T) -> usize {
        seen.iter().step_by(every.max(1)).filter(|s| self.holds(s, px2)).count()
    }

    /// Whether [`Self::distance_squared_px2`] is less than `px2`, without a division.
    #[inline]
    fn holds(&self, s: &Correspondence<T>, px2: T) -> bool {
        let near = |there: Vector3<T>, p: &Point2<T>| {
            (there.xy() - p.coords * there.z).norm_squared() < px2 * there.z * there.z
        };
        near(self.matrix * s.second.to_homogeneous(), &s.first)
            && near(self.adjugate * s.first.to_homogeneous(), &s.second)
    }

    /// The larger of the two squared distances to where the plane puts the other image's point, px^2.
    pub(super) fn distance_squared_px2(&self, s: &Correspondence<T>) -> T {
        let there = self.matrix * s.second.to_homogeneous();
        let back = self.adjugate * s.first.to_homogeneous();
        let first = (there.xy() / there.z - s.first.coords).norm_squared();
        let second = (back.xy() / back.z - s.second.coords).norm_squared();
        larger(first, second)
    }
}

/// The epipole e with `F^T e = 0`, at length one: the largest of the cross products of F's columns.
fn left_null<T: Real>(f: &Matrix3<T>) -> Option<Vector3<T>> {
    let (epipole, squared) = largest_cross(f);
    let size = squared.sqrt();
    (size > T::ZERO && size.is_finite()).then(|| epipole / size)
}

/// The largest of the cross products of F's columns, and its squared length.
#[inline(never)]
fn largest_cross<T: Real>(f: &Matrix3<T>) -> (Vector3<T>, T) {
    let [a, b, c] = columns3(f);
    let mut best = (a.cross(&b), T::ZERO);
    best.1 = best.0.norm_squared();
    for other in [a.cross(&c), b.cross(&c)] {
        let squared = other.norm_squared();
        if squared > best.1 {
            best = (other, squared);
        }
    }
    best
}

/// Whether all correspondences of a sample are before both cameras, or can be: the line `F p'` and the one
/// from the epipole to p have the same sense for all of them (Chum, Werner & Matas 2004).
pub(super) fn one_sense<T: Real>(f: &Matrix3<T>, sample: &[Correspondence<T>; 7]) -> bool {
    let (epipole, squared) = largest_cross(f);
    if !(squared > T::ZERO && squared.is_finite()) {
        return false;
    }
    let mut senses = sample.iter().map(|s| {
        let line = f * s.second.to_homogeneous();
        epipole.cross(&s.first.to_homogeneous()).dot(&line) > T::ZERO
    });
    let first = senses.next();
    senses.all(|sense| Some(sense) == first)
}
