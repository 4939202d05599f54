//! Where the search for a camera begins.

use super::bundle::{Inner, Outer};
use super::lens::INNER;
use nalgebra::{Matrix2, Matrix3, Point2, Point3, Vector2, Vector3};
use stereopsis::geometry::two_view::{Correspondence, Homography};

/// The homography from the board's plane to the picture, of places on the board and where they are seen.
pub(super) fn homography<'a>(
    pairs: impl Iterator<Item = (&'a Point3<f64>, Point2<f64>)>,
) -> Option<Matrix3<f64>> {
    let pairs: Vec<_> = pairs.map(|(board, first)| Correspondence { first, second: board.xy() }).collect();
    Homography::from_correspondences(&pairs).ok().map(|h| *h.matrix())
}

/// A camera without a lens whose principal point is `middle`.
pub(super) fn camera(focal: Vector2<f64>, middle: Vector2<f64>) -> Inner {
    let mut inner = [0.0; INNER];
    (inner[0], inner[1], inner[2], inner[3]) = (focal.x, focal.y, middle.x, middle.y);
    inner
}

/// Where a camera without a lens sees what one sees at `p` whose lens puts equal angles at equal ways, of the
/// same focal length: `r = tan(theta)`, up to 80 degrees.
pub(super) fn flat(p: &Point2<f64>, focal: f64, middle: Vector2<f64>) -> Point2<f64> {
    let way = (p.coords - middle) / focal;
    let theta = way.norm();
    let longer = if theta < 1e-9 { 1.0 } else { theta.min(1.4).tan() / theta };
    Point2::from(middle + way * (focal * longer))
}

/// Focal lengths from views of a plane (Zhang 2000, 3.1), where the principal point is in the middle: both
/// axes of the board are of one length and square, so `h1^T w h2 = 0` and `h1^T w h1 = h2^T w h2` with `w =
/// diag(1 / fx^2, 1 / fy^2, 1)`.
pub(super) fn focal_lengths(homographies: &[Matrix3<f64>], middle: Vector2<f64>) -> Option<Vector2<f64>> {
    let (mut a, mut b) = (Matrix2::zeros(), Vector2::zeros());
    for h in homographies {
        let mut h = *h;
        for i in 0..3 {
            for axis in 0..2 {
                h[(axis, i)] -= middle[axis] * h[(2, i)];
            }
        }
        let (h1, h2): (Vector3<f64>, Vector3<f64>) = (h.column(0).into(), h.column(1).into());
        let size = (h1.norm() * h2.norm()).max(f64::MIN_POSITIVE);
        let rows = [
            (Vector2::new(h1.x * h2.x, h1.y * h2.y), -h1.z * h2.z),
            (Vector2::new(h1.x * h1.x - h2.x * h2.x, h1.y * h1.y - h2.y * h2.y), h2.z * h2.z - h1.z * h1.z),
        ];
        for (row, value) in rows {
            let (row, value) = (row / size, value / size);
            a += row * row.transpose();
            b += row * value;
        }
    }
    let w = a.try_inverse()? * b;
    (w.x > 0.0 && w.y > 0.0)
        .then(|| Vector2::new(1.0 / w.x.sqrt(), 1.0 / w.y.sqrt()))
        .filter(|f| f.amax() < 1e6)
}

/// From the board to a camera, by the homography `K [r1 r2 t]`.
pub(super) fn pose(inner: &Inner, homography: &Matrix3<f64>) -> Option<Outer> {
    let k = Matrix3::new(inner[0], 0.0, inner[2], 0.0, inner[1], inner[3], 0.0, 0.0, 1.0);
    let m = k.try_inverse()? * homography;
    let scale = 2.0 / (m.column(0).norm() + m.column(1).norm());
    // The board is in front of the camera.
    let scale = if m[(2, 2)] < 0.0 { -scale } else { scale };
    let (r1, r2, t): (Vector3<f64>, Vector3<f64>, Vector3<f64>) =
        ((m.column(0) * scale), (m.column(1) * scale), (m.column(2) * scale));
    let near = Matrix3::from_columns(&[r1, r2, r1.cross(&r2)]);
    let svd = near.try_svd(true, true, f64::EPSILON, 100)?;
    let (u, v_t) = (svd.u?, svd.v_t?);
    let sign = (u * v_t).determinant().signum();
    let r = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * v_t;
    Some(Outer::new(r, t))
}
