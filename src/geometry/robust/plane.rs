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

/// The homography of a plane from the second image to the first, px, and its adjugate for the way back.
#[derive(Clone, Copy)]
pub(super) struct PlaneHomography<T: Real> {
    pub(super) matrix: Matrix3<T>,
    adjugate: Matrix3<T>,
}

impl<T: Real> PlaneHomography<T> {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A homography, and the epipole in the first image that completes it to an F.
    fn wall() -> (Matrix3<f64>, Vector3<f64>) {
        (Matrix3::new(1.1, 0.02, 12.0, -0.03, 0.95, -7.0, 1e-4, -2e-4, 1.0), Vector3::new(0.9, 0.3, 2e-3))
    }

    fn fundamental() -> Matrix3<f64> {
        let (h, epipole) = wall();
        product(&skew(&epipole), &h)
    }

    /// A match that is off the wall by `parallax` along its epipolar line.
    fn seen(i: usize, parallax: f64) -> Correspondence<f64> {
        let (h, epipole) = wall();
        let (x, y) = ((i * 37 % 11) as f64 * 20.0, ((7 * i + 3) * i % 13) as f64 * 15.0);
        let there = h * Vector3::new(x, y, 1.0) + epipole * parallax;
        Correspondence::new(there.x / there.z, there.y / there.z, x, y)
    }

    #[test]
    fn the_distance_is_the_larger_one_of_both_images() {
        let to = |matrix: &Matrix3<f64>, from: Point2<f64>, to: Point2<f64>| {
            let there = matrix * from.to_homogeneous();
            (there.xy() / there.z - to.coords).norm_squared()
        };
        let mut larger = [0; 2];
        // The first image as it is, and half as large.
        for (scale, i) in [1.0, 0.5].into_iter().flat_map(|scale| (0..9).map(move |i| (scale, i))) {
            let h = Matrix3::from_diagonal(&Vector3::new(scale, scale, 1.0)) * wall().0;
            let (plane, back) = (PlaneHomography::new(h), h.try_inverse().expect("of rank three"));
            let mut s = seen(i, (i as f64 - 4.5) * 3.0);
            s.first.coords *= scale;
            let both = [to(&h, s.second, s.first), to(&back, s.first, s.second)];
            larger[usize::from(both[1] > both[0])] += 1;
            let (expected, found) = (both[0].max(both[1]), plane.distance_squared_px2(&s));
            assert!((found - expected).abs() < 1e-9, "{i}: {found} {expected}");
            assert!(plane.holds(&s, found * 1.001) && !plane.holds(&s, found * 0.999), "{i}");
        }
        assert!(larger.iter().all(|&count| count > 0), "{larger:?}");
    }

    #[test]
    fn what_is_off_by_the_limit_is_not_on_the_plane() {
        // Cameras side by side and a plane far away, which both show at the same places.
        let at = |x: f64, y: f64| Correspondence::new(x, y, x, y);
        let three = [at(0.0, 0.0), at(10.0, 0.0), at(0.0, 10.0)];
        let plane = PlaneHomography::through(&skew(&Vector3::x()), three).expect("an epipole");
        for (x, y) in [(2.0, 0.0), (0.0, -2.0)] {
            let s = Correspondence::new(5.0 + x, 3.0 + y, 5.0, 3.0);
            assert_eq!(plane.distance_squared_px2(&s), 4.0);
            assert_eq!([3.9, 4.0, 4.1].map(|px2| plane.holds(&s, px2)), [false, false, true]);
        }
    }

    #[test]
    fn three_matches_and_f_have_their_plane() {
        let plane =
            PlaneHomography::through(&fundamental(), [0, 1, 2].map(|i| seen(i, 0.0))).expect("an epipole");
        for i in 0..11 {
            let squared = plane.distance_squared_px2(&seen(i, 0.0));
            assert!(squared < 1e-12, "{i}: {squared}");
        }
        assert!(PlaneHomography::through(&Matrix3::zeros(), [0, 1, 2].map(|i| seen(i, 0.0))).is_none());
    }

    #[test]
    fn any_five_of_seven_have_their_plane_and_four_have_none() {
        for (one, two) in (0..7).flat_map(|one| (one + 1..7).map(move |two| (one, two))) {
            let off = |places: &[usize]| {
                core::array::from_fn(|i| {
                    seen(i, if places.contains(&i) { 20.0 + 9.0 * i as f64 } else { 0.0 })
                })
            };
            let plane = |places: &[usize]| PlaneHomography::of_sample(&fundamental(), &off(places), 0.01);
            let found = plane(&[one, two]).expect("five are on it");
            assert!(found.distance_squared_px2(&seen(9, 0.0)) < 1e-9, "{one} {two}");
            let three = (0..7).find(|i| ![one, two].contains(i)).expect("another");
            assert!(plane(&[one, two, three]).is_none(), "{one} {two} {three}");
        }
    }

    #[test]
    fn what_is_on_the_plane_fits_it() {
        // Nine on the wall by up to a pixel, from which the plane of three of them is off, and three off it.
        let near = |i: usize| {
            let mut s = seen(i, 0.0);
            s.first.x += (i * 7 % 5) as f64 * 0.4 - 0.8;
            s.first.y += (i * 4 % 7) as f64 * 0.3 - 0.9;
            s
        };
        let all: [_; 12] = core::array::from_fn(|i| if i < 9 { near(i) } else { seen(i, 90.0) });
        let frames = Frame::of_points(&all).expect("points that are apart");
        let (h, _) = wall();
        let plane = PlaneHomography::new(h);
        let (fitted, count) = plane.fitted(&all, &frames, 4.0);
        assert_eq!([plane.count(&all, 1, 4.0), plane.count(&all, 5, 4.0), count], [9, 2, 9]);
        let squares = |plane: &PlaneHomography<f64>| {
            all[..9].iter().map(|s| plane.distance_squared_px2(s)).sum::<f64>()
        };
        assert!(squares(&fitted) < 0.9 * squares(&plane), "{} {}", squares(&fitted), squares(&plane));
        // Four are no more than determine it: it stays.
        let (same, count) = plane.fitted(&all[5..], &frames, 4.0);
        assert!(count == 4 && same.matrix == plane.matrix);
        let (other, count) = plane.fitted(&all[4..], &frames, 4.0);
        assert!(count == 5 && other.matrix != plane.matrix);
    }

    #[test]
    fn points_before_both_cameras_have_one_sense() {
        let f = fundamental();
        let before = core::array::from_fn(|i| seen(i, 10.0 * i as f64));
        assert!(one_sense(&f, &before));
        // Behind the first camera: the third coordinate has the other sign.
        for behind in 0..7 {
            let mut sample = before;
            sample[behind] = seen(behind, -2000.0);
            assert!(!one_sense(&f, &sample), "{behind}");
        }
        assert!(!one_sense(&Matrix3::zeros(), &before));
    }

    #[test]
    fn the_epipole_is_orthogonal_to_all_columns() {
        // Each two of the columns may be parallel, and so those that are left must do.
        let (a, b) = (Vector3::new(1.0_f64, 2.0, -1.0), Vector3::new(0.5, -1.0, 3.0));
        for columns in [[a, b, a], [a, a, b], [b, a, a], [a, b, a + b]] {
            let epipole = left_null(&Matrix3::from_columns(&columns)).expect("of rank two");
            assert!((epipole.norm() - 1.0).abs() < 1e-12);
            assert!(columns.iter().all(|column| column.dot(&epipole).abs() < 1e-12));
        }
        assert!(left_null(&Matrix3::from_columns(&[a, a, a])).is_none());
    }
}
