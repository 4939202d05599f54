//! The real roots of a cubic, by Newton's method.

use crate::geometry::Real;

/// Steps to the root of largest size, at most. The bound they begin at is rarely ten times the root, and
/// where the root is double they are halved with each.
const MOST_STEPS: usize = 60;

/// The real roots x of `c0 + c1 x + c2 x^2 + c3 x^3`, one or three. None where c3 is zero or a root is not a
/// finite number.
///
/// Without its square term the cubic is `t^3 - 3 q t + 2 r` (Press et al. 2007, 5.6). Its root of largest
/// size has the sign of -r, and from a bound beyond it Newton's method falls to it without a turn, for the
/// cubic is convex there; what remains is a quadratic. So roots need no angles, which on cores without `f64`
/// are the dearest part of them. Each is then corrected by two steps on the cubic as given.
pub(crate) fn cubic_roots<T: Real>([c0, c1, c2, c3]: [T; 4]) -> ([T; 3], usize) {
    let none = ([T::ZERO; 3], 0);
    if c3 == T::ZERO {
        return none;
    }
    let by = T::ONE / c3;
    let (a, b, c) = (c2 * by, c1 * by, c0 * by);
    let shift = a * T::of(1.0 / 3.0);
    let half = T::of(0.5);
    // 3 q, and 2 r.
    let q3 = a * shift - b;
    let r2 = (shift * shift * T::of(2.0) - b) * shift + c;
    let largest = largest_root(q3, r2.abs());
    let largest = if r2 > T::ZERO { -largest } else { largest };
    // (t - largest)(t^2 + largest t + largest^2 - 3 q).
    let discriminant = q3 * T::of(4.0) - largest * largest * T::of(3.0);
    let (mut roots, count) = if discriminant >= T::ZERO {
        let root = discriminant.sqrt();
        ([largest - shift, (root - largest) * half - shift, (-root - largest) * half - shift], 3)
    } else {
        ([largest - shift, T::ZERO, T::ZERO], 1)
    };
    for x in roots.iter_mut().take(count) {
        for _ in 0..2 {
            let value = ((*x + a) * *x + b) * *x + c;
            let derivative = (T::of(3.0) * *x + a + a) * *x + b;
            let step = value / derivative;
            // At a double root both are next to zero, and the root is what it is.
            if step.is_finite() && step.abs() <= x.abs().max(T::ONE) * T::of(1e-2) {
                *x -= step;
            }
        }
        if !x.is_finite() {
            return none;
        }
    }
    (roots, count)
}

/// The root that is not negative of `t^3 - q t - r`, r not negative.
fn largest_root<T: Real>(q: T, r: T) -> T {
    // Above it (Fujiwara 1916), with a root that is easier than the cubic one and larger on both sides of
    // one.
    let root = r.sqrt();
    let mut t = T::of(2.0) * q.abs().sqrt().max(if r > T::ONE { root } else { root.sqrt() });
    for _ in 0..MOST_STEPS {
        let square = t * t;
        let next = t - ((square - q) * t - r) / (square * T::of(3.0) - q);
        // It falls until rounding stops it; what is not a number stops it too.
        if !(next < t) {
            break;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::cubic_roots;

    #[test]
    fn three_roots() {
        // (x - 1)(x - 2)(x + 4) = x^3 + x^2 - 10 x + 8, times 2.
        let (mut roots, count) = cubic_roots([16.0, -20.0, 2.0, 2.0_f64]);
        assert_eq!(count, 3);
        roots.sort_by(f64::total_cmp);
        assert!(roots.iter().zip([-4.0, 1.0, 2.0]).all(|(a, b)| (a - b).abs() < 1e-14), "{roots:?}");
    }

    #[test]
    fn one_root() {
        // (x - 3)(x^2 + 1) and (x + 3)(x^2 + 1).
        for root in [3.0, -3.0_f64] {
            let (roots, count) = cubic_roots([-root, 1.0, -root, 1.0]);
            assert!(count == 1 && (roots[0] - root).abs() < 1e-14, "{roots:?}");
        }
        // x^3: three times zero.
        let (roots, count) = cubic_roots([0.0, 0.0, 0.0, 2.0_f32]);
        assert_eq!((roots, count), ([0.0; 3], 3));
        assert_eq!(cubic_roots([1.0, 1.0, 1.0, 0.0_f64]).1, 0);
    }
}
