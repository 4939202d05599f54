//! The pair of planes in a pencil of two quadratic forms, as P3P needs it (Persson & Nordberg 2018).

use crate::geometry::Real;
use crate::geometry::linear::{columns3, cubic_roots};
use nalgebra::{Matrix3, Vector3};

/// A combination of two symmetric matrices without a determinant: the first plus the second times the root of
/// a cubic.
pub(super) fn singular_combination<T: Real>(a: &Matrix3<T>, b: &Matrix3<T>) -> Option<Matrix3<T>> {
    let mixed = |p: &Matrix3<T>, q: &Matrix3<T>| {
        let ([p0, p1, p2], [q0, q1, q2]) = (columns3(p), columns3(q));
        q0.dot(&p1.cross(&p2)) + q1.dot(&p2.cross(&p0)) + q2.dot(&p0.cross(&p1))
    };
    let cubic = [a.determinant(), mixed(a, b), mixed(b, a), b.determinant()];
    // The matrix whose determinant is larger stands at the cube, so that roots are small numbers.
    let swapped = cubic[0].abs() > cubic[3].abs();
    let [c0, c1, c2, c3] = cubic;
    let (roots, count) = cubic_roots(if swapped { [c3, c2, c1, c0] } else { cubic });
    let combined = |root: T| if swapped { a * root + b } else { a + b * root };
    // Of the roots the one whose matrix is a pair of real planes most clearly.
    let planarity = |m: &Matrix3<T>| second_minor(m) / m.norm_squared();
    let candidates = roots.iter().take(count).map(|&root| combined(root));
    candidates.fold(None, |best: Option<Matrix3<T>>, next| match best {
        Some(best) if planarity(&best) <= planarity(&next) => Some(best),
        _ => Some(next),
    })
}

/// The sum of the principal minors of a symmetric matrix.
fn second_minor<T: Real>(m: &Matrix3<T>) -> T {
    m.m11 * m.m22 - m.m12 * m.m12 + m.m11 * m.m33 - m.m13 * m.m13 + m.m22 * m.m33 - m.m23 * m.m23
}

/// The normals of the two planes of a symmetric matrix with eigenvalues `s > 0 > s'` and zero; `None` where
/// it has none.
pub(super) fn planes<T: Real>(m: &Matrix3<T>) -> Option<[Vector3<T>; 2]> {
    let half = (m.m11 + m.m22 + m.m33) * T::of(0.5);
    let product = second_minor(m);
    if !(product < T::ZERO) {
        return None;
    }
    let root = (half * half - product).sqrt();
    let (high, low) = (half + root, half - root);
    let null = null_vector(m)?;
    let first = null_vector(&(m - Matrix3::identity() * high))?;
    let second = null.cross(&first);
    let slope = (-low / high).sqrt();
    Some([first + second * slope, first - second * slope])
}

/// The direction that a matrix of rank two leaves: the longest cross product of two of its rows.
fn null_vector<T: Real>(m: &Matrix3<T>) -> Option<Vector3<T>> {
    let [a, b, c] = columns3(m);
    let crosses = [a.cross(&b), b.cross(&c), c.cross(&a)];
    let longest =
        crosses.iter().fold(crosses[0], |l, c| if c.norm_squared() > l.norm_squared() { *c } else { l });
    let norm = longest.norm();
    (norm > T::ZERO).then(|| longest / norm)
}

/// Two directions in a plane.
fn basis<T: Real>(normal: &Vector3<T>) -> [Vector3<T>; 2] {
    let [x, y, z] = [normal.x.abs(), normal.y.abs(), normal.z.abs()];
    let least = if x <= y && x <= z {
        Vector3::x()
    } else if y <= z {
        Vector3::y()
    } else {
        Vector3::z()
    };
    let one = normal.cross(&least);
    let one = one / one.norm();
    let other = normal.cross(&one);
    [one, other / other.norm()]
}

/// How large a form is on a plane, as a share of its size.
pub(super) fn on_plane<T: Real>(normal: &Vector3<T>, form: &Matrix3<T>) -> T {
    let [p, q] = basis(normal);
    let (pp, pq, qq) = (p.dot(&(form * p)), p.dot(&(form * q)), q.dot(&(form * q)));
    pp.abs().max(pq.abs()).max(qq.abs()) / form.amax()
}

/// The directions of a plane in which a form vanishes.
pub(super) fn directions<T: Real>(normal: &Vector3<T>, form: &Matrix3<T>) -> [Option<Vector3<T>>; 2] {
    let [p, q] = basis(normal);
    let (a, b, c) = (p.dot(&(form * p)), p.dot(&(form * q)), q.dot(&(form * q)));
    let mut discriminant = b * b - a * c;
    // A double root that rounding has made none.
    if discriminant < T::ZERO && discriminant > -(b * b + a.abs() * c.abs()) * T::EPSILON.sqrt() {
        discriminant = T::ZERO;
    }
    if !(discriminant >= T::ZERO) {
        return [None; 2];
    }
    let root = discriminant.sqrt();
    // u : v of a u^2 + 2 b u v + c v^2, without cancellation: (-h : a) and (c : -h) with h of b's sign.
    let h = if b < T::ZERO { b - root } else { b + root };
    [p * -h + q * a, p * c - q * h].map(|v| (v.norm_squared() > T::ZERO).then(|| v / v.norm()))
}
