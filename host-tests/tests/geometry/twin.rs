//! The estimates again, in their plainest form: whole matrices, nalgebra's singular values, search by small
//! steps.

use nalgebra::{DMatrix, Matrix3, Matrix3x4, Matrix4x3, Point2, Point3, Vector3, Vector4};
use stereopsis::geometry::two_view::{Correspondence, Fundamental, TwoViews};

/// The similarity that brings points to the origin, at a root mean square distance of root two.
fn similarity(points: &[Point2<f64>]) -> Matrix3<f64> {
    let n = points.len() as f64;
    let centre = points.iter().fold(nalgebra::Vector2::zeros(), |sum, p| sum + p.coords) / n;
    let spread = points.iter().map(|p| (p.coords - centre).norm_squared()).sum::<f64>() / n;
    let s = (2.0 / spread).sqrt();
    Matrix3::new(s, 0.0, -s * centre.x, 0.0, s, -s * centre.y, 0.0, 0.0, 1.0)
}

/// The normalised eight-point algorithm by two singular value decompositions.
pub fn eight_point(seen: &[Correspondence<f64>]) -> Fundamental<f64> {
    let first = similarity(&seen.iter().map(|s| s.first).collect::<Vec<_>>());
    let second = similarity(&seen.iter().map(|s| s.second).collect::<Vec<_>>());
    // At least as many rows as unknowns, so that the decomposition is whole.
    let mut rows = DMatrix::zeros(seen.len().max(9), 9);
    for (i, s) in seen.iter().enumerate() {
        let (p, q) = (first * s.first.to_homogeneous(), second * s.second.to_homogeneous());
        for (j, element) in (p * q.transpose()).transpose().iter().enumerate() {
            rows[(i, j)] = *element;
        }
    }
    let svd = rows.svd(false, true);
    let least = svd.singular_values.imin();
    let v = svd.v_t.expect("asked for").row(least).into_owned();
    let mut svd = Matrix3::from_row_slice(v.as_slice()).svd(true, true);
    let least = svd.singular_values.imin();
    svd.singular_values[least] = 0.0;
    let singular = svd.recompose().expect("both sides were asked for");
    Fundamental::from_matrix(&(first.transpose() * singular * second)).expect("rank 2")
}

/// The sum of squared re-projection errors of a point, px^2, and the errors themselves.
fn errors(cameras: &[Matrix3x4<f64>; 2], seen: &Correspondence<f64>, point: &Point3<f64>) -> Vector4<f64> {
    let [p, q] = cameras.map(|m| Point2::from_homogeneous(m * point.to_homogeneous()).expect("it is finite"));
    Vector4::new(p.x - seen.first.x, p.y - seen.first.y, q.x - seen.second.x, q.y - seen.second.y)
}

/// The point of least re-projection error by Gauss and Newton's steps, with slopes by differences, from
/// `start`.
pub fn least_error(
    views: &TwoViews<f64>,
    k: &Matrix3<f64>,
    seen: &Correspondence<f64>,
    start: Point3<f64>,
) -> Point3<f64> {
    let inverse = views.pose().inverse();
    let outer = |r: &Matrix3<f64>, t: &Vector3<f64>| {
        Matrix3x4::from_columns(&[r.column(0), r.column(1), r.column(2), t.column(0)])
    };
    let cameras = [
        k * outer(&Matrix3::identity(), &Vector3::zeros()),
        k * outer(inverse.rotation(), inverse.translation()),
    ];
    let mut point = start;
    for _ in 0..50 {
        let here = errors(&cameras, seen, &point);
        let mut slope = Matrix4x3::zeros();
        for axis in 0..3 {
            let mut step = Vector3::zeros();
            step[axis] = 1e-6;
            let ahead = errors(&cameras, seen, &(point + step));
            let behind = errors(&cameras, seen, &(point - step));
            slope.set_column(axis, &((ahead - behind) / 2e-6));
        }
        let step = (slope.transpose() * slope).try_inverse().expect("an angle") * slope.transpose() * here;
        point -= step;
    }
    point
}
