//! The real roots of a cubic.

use crate::geometry::Real;

/// The real roots x of `c0 + c1 x + c2 x^2 + c3 x^3`, up to three, in closed form (Press et al. 2007, 5.6) and then by
/// two of Newton's steps. None where c3 is zero or a root is not a finite number.
pub(crate) fn cubic_roots<T: Real>([c0, c1, c2, c3]: [T; 4]) -> ([T; 3], usize) {
    let none = ([T::ZERO; 3], 0);
    if c3 == T::ZERO {
        return none;
    }
    let (a, b, c) = (c2 / c3, c1 / c3, c0 / c3);
    let third = T::ONE / T::of(3.0);
    let shift = a * third;
    let q = (a * a - T::of(3.0) * b) / T::of(9.0);
    let r = (T::of(2.0) * a * a * a - T::of(9.0) * a * b + T::of(27.0) * c) / T::of(54.0);
    let (q3, r2) = (q * q * q, r * r);
    let (mut roots, count) = if r2 < q3 {
        let root = q.sqrt();
        let angle = (r / q3.sqrt()).max(-T::ONE).min(T::ONE).acos() * third;
        let size = -T::of(2.0) * root;
        let turn = T::of(core::f64::consts::TAU / 3.0);
        ([angle, angle + turn, angle - turn].map(|angle| size * angle.cos() - shift), 3)
    } else {
        let size = (r.abs() + (r2 - q3).sqrt()).cbrt();
        let first = if r < T::ZERO { size } else { -size };
        let second = if first == T::ZERO { T::ZERO } else { q / first };
        ([first + second - shift, T::ZERO, T::ZERO], 1)
    };
    for x in roots.iter_mut().take(count) {
        for _ in 0..2 {
            let value = ((*x + a) * *x + b) * *x + c;
            let slope = (T::of(3.0) * *x + a + a) * *x + b;
            let step = value / slope;
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
        let (roots, count) = cubic_roots([0.0, 0.0, 0.0, 2.0_f32]);
        assert!(count == 1 && roots[0] == 0.0);
        assert_eq!(cubic_roots([1.0, 1.0, 1.0, 0.0_f64]).1, 0);
    }
}
