//! Real roots of a polynomial, bracketed by those of its derivatives (Rolle's theorem).

/// The highest degree.
const DEGREE: usize = 10;
/// Largest number of steps for each root; so many halvings alone bring an interval of length 2 below 2e-18.
const STEPS: usize = 60;

/// The real roots of `c[0] + c[1] x + ... + c[10] x^10`, and how many there are; a double root counts once or
/// not at all. Every loop is bounded: between two roots of the derivative there is at most one.
///
/// Those beyond -1 and 1 are one over the roots of the polynomial with its coefficients the other way round,
/// so that no power overflows.
pub(crate) fn polynomial_roots(coefficients: &[f64; DEGREE + 1]) -> ([f64; DEGREE], usize) {
    let mut out = [0.0; DEGREE];
    let mut count = 0;
    let mut add = |root: f64| {
        if let Some(place) = out.get_mut(count) {
            *place = root;
            count += 1;
        }
    };
    let (roots, inside) = within_one(coefficients);
    roots.iter().take(inside).for_each(|&root| add(root));
    let mut reversed = *coefficients;
    reversed.reverse();
    let (roots, outside) = within_one(&reversed);
    roots
        .iter()
        .take(outside)
        .filter(|root| root.abs() > 0.0 && root.abs() < 1.0)
        .for_each(|&r| add(1.0 / r));
    (out, count)
}

/// The roots from -1 to 1, in order.
fn within_one(coefficients: &[f64; DEGREE + 1]) -> ([f64; DEGREE], usize) {
    // Those of the last derivative but one first, which is linear; each says where the next may have its own.
    let (mut roots, mut count) = ([0.0; DEGREE], 0_usize);
    for degree in 1..=DEGREE {
        let derivative = derived(coefficients, DEGREE - degree);
        let (mut next, mut found) = ([0.0; DEGREE], 0);
        let mut low = -1.0;
        let ends = roots.iter().copied().take(count).chain([1.0]);
        for high in ends {
            if let Some(root) = root_between(&derivative, low, high)
                && let Some(place) = next.get_mut(found)
            {
                *place = root;
                found += 1;
            }
            low = high;
        }
        (roots, count) = (next, found);
    }
    (roots, count)
}

/// The derivative of that order.
fn derived(coefficients: &[f64; DEGREE + 1], order: usize) -> [f64; DEGREE + 1] {
    let mut out = [0.0; DEGREE + 1];
    for (power, (to, &c)) in out.iter_mut().zip(coefficients.iter().skip(order)).enumerate() {
        *to = (0..order).fold(c, |product, i| product * (power + order - i) as f64);
    }
    out
}

/// The root of a polynomial that is monotonous from `low` to `high`: Newton's steps, and halves where these
/// leave the interval.
fn root_between(coefficients: &[f64; DEGREE + 1], mut low: f64, mut high: f64) -> Option<f64> {
    let at = |x: f64| {
        coefficients.iter().rev().fold((0.0, 0.0), |(value, slope), &c| (value * x + c, slope * x + value))
    };
    let (first, last) = (at(low).0, at(high).0);
    if first == 0.0 {
        // The end of the interval before.
        return (low == -1.0).then_some(low);
    }
    if last == 0.0 {
        return Some(high);
    }
    if (first < 0.0) == (last < 0.0) || !first.is_finite() || !last.is_finite() {
        return None;
    }
    let mut x = 0.5 * (low + high);
    for _ in 0..STEPS {
        let (value, slope) = at(x);
        if value == 0.0 {
            break;
        }
        if (value < 0.0) == (first < 0.0) {
            low = x;
        } else {
            high = x;
        }
        let newton = x - value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - x).abs() <= f64::EPSILON * x.abs().max(1e-3) {
            x = next;
            break;
        }
        x = next;
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_inside_and_outside() {
        // (x - 1/2)(x + 1/4)(x - 3)(x + 10)(x^2 + 1), from the constant term up, as a product.
        let mut c = [0.0; 11];
        c[0] = 1.0;
        let mut multiply = |factor: [f64; 3]| {
            let mut out = [0.0; 11];
            for (i, a) in c.iter().enumerate() {
                for (j, b) in factor.iter().enumerate().filter(|(j, _)| i + j < 11) {
                    out[i + j] += a * b;
                }
            }
            c = out;
        };
        for root in [0.5, -0.25, 3.0, -10.0] {
            multiply([-root, 1.0, 0.0]);
        }
        multiply([1.0, 0.0, 1.0]);
        let (mut roots, count) = polynomial_roots(&c);
        roots[..count].sort_by(f64::total_cmp);
        assert_eq!(count, 4, "{roots:?}");
        for (found, root) in roots.iter().zip([-10.0, -0.25, 0.5, 3.0]) {
            assert!((found - root).abs() < 1e-12 * root.abs().max(1.0), "{found}");
        }
    }

    #[test]
    fn none_and_nothing() {
        let mut c = [0.0; 11];
        (c[0], c[2], c[10]) = (1.0, 1.0, 1.0);
        assert_eq!(polynomial_roots(&c).1, 0);
        assert_eq!(polynomial_roots(&[f64::NAN; 11]).1, 0);
        assert!(polynomial_roots(&[0.0; 11]).1 <= 10);
    }
}
