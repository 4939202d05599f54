//! Inner products of short rows of numbers.

/// Takes the mean off.
#[inline(never)]
pub(super) fn centre<const N: usize>(values: &mut [f32; N]) {
    let mean = dot(values, &[1.0; N]) / N as f32;
    values.iter_mut().for_each(|value| *value -= mean);
}

/// The inner product, of four sums that a processor with vectors has side by side.
#[inline(never)]
pub(super) fn dot<const N: usize>(a: &[f32; N], b: &[f32; N]) -> f32 {
    let mut sums = [0.0; 4];
    let (mut a, mut b) = (a.chunks_exact(4), b.chunks_exact(4));
    for (a, b) in (&mut a).zip(&mut b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let rest: f32 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    let [p, q, r, s] = sums;
    (p + q) + (r + s) + rest
}
