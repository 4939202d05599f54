//! Logarithms in integers: peaks of sharpness are near to Gaussian, and a Gaussian's logarithm is a parabola.

/// Bits after the binary point of a logarithm.
pub(super) const FRACTION: u32 = 11;
/// A factor of two.
pub(super) const OCTAVE: u16 = 1 << FRACTION;
/// The table's steps in an octave.
const STEPS: usize = 64;

/// `2^15 log2(1 + i / 64)`, to the bit below.
const TABLE: [u16; STEPS + 1] = table();

/// Bit by bit: a number in `1..2` that is squared doubles its logarithm, whose next bit is whether 2 is
/// passed.
const fn table() -> [u16; STEPS + 1] {
    let mut table = [0; STEPS + 1];
    let mut i = 0;
    while i <= STEPS {
        // In 1/2^31.
        let mut x = ((STEPS + i) as u64) << (31 - 6);
        let mut log: u16 = (x >> 32) as u16;
        x >>= log;
        let mut bit = 0;
        while bit < 15 {
            x = (x * x) >> 31;
            let is_set = (x >> 32) as u16;
            log = log << 1 | is_set;
            x >>= is_set;
            bit += 1;
        }
        table[i] = log;
        i += 1;
    }
    table
}

/// The logarithm to base 2 in 1/2^11, at most 65535; of 0, 0. Interpolated in a table of 64 steps an octave:
/// at most 0.0006 off.
pub(super) fn log2(value: u32) -> u16 {
    let zeros = value.max(1).leading_zeros();
    let scaled = value.max(1) << zeros;
    let step = (scaled >> 25) as usize % STEPS;
    let rest = (scaled >> 9) & 0xffff;
    let at = |i: usize| u32::from(TABLE.get(i).copied().unwrap_or(0));
    let (low, high) = (at(step), at(step + 1));
    let fraction = ((low << 16) + (high - low) * rest + (1 << 19)) >> 20;
    let log = if value == 0 { 0 } else { ((31 - zeros) << FRACTION) + fraction };
    log.min(u16::MAX.into()) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worked_logarithms() {
        assert_eq!([0, 1, 2, 3, 1 << 20].map(log2), [0, 0, 2048, 3246, 20 * 2048]); // log2 3 = 1.58496
        assert_eq!(log2(u32::MAX), u16::MAX);
        let mut value = 1_u32;
        while value < 1 << 30 {
            let exact = f64::from(value).log2() * 2048.0;
            assert!((f64::from(log2(value)) - exact).abs() < 1.2, "{value}");
            value += value / 97 + 1;
        }
    }
}
