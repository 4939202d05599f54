//! Sampling pattern of the descriptor: 256 pairs of points, made by the compiler from a seed.

/// Radius of the circle that a patch is cut from, px.
pub const PATCH_RADIUS: i32 = 15;

/// How many pairs are compared.
pub const PAIRS: usize = 256;

/// Where the points of a pair lie from the patch's middle, px: to the right and down, of one and of the
/// other.
pub type PointPair = [[i8; 2]; 2];

/// The pairs. All their coordinates are drawn independently from a sum of three uniform distributions of -7
/// to 7 px, nearly the Gaussian one of the geometry G II of Calonder, Lepetit, Strecha & Fua ("BRIEF", ECCV
/// 2010); a pair is drawn again when a point is outside of the circle or both points are nearer to each other
/// than 3 px, which the smoothing makes alike. The standard deviation of a coordinate is 7.5 px as drawn, and
/// 6.5 px of those that are kept.
pub const PATTERN: [PointPair; PAIRS] = {
    let mut pattern = [[[0; 2]; 2]; PAIRS];
    let mut state = SEED;
    let mut i = 0;
    while i < PAIRS {
        let (a, b, c, d);
        (a, state) = draw(state);
        (b, state) = draw(state);
        (c, state) = draw(state);
        (d, state) = draw(state);
        let inside =
            a * a + b * b <= PATCH_RADIUS * PATCH_RADIUS && c * c + d * d <= PATCH_RADIUS * PATCH_RADIUS;
        if inside && (a - c) * (a - c) + (b - d) * (b - d) >= 9 {
            pattern[i] = [[a as i8, b as i8], [c as i8, d as i8]];
            i += 1;
        }
    }
    pattern
};

const SEED: u64 = 2010;

/// A coordinate, and the generator's next state (SplitMix64; Steele, Lea & Flood 2014).
const fn draw(state: u64) -> (i32, u64) {
    let state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (uniform(z) + uniform(z >> 16) + uniform(z >> 32) - 21, state)
}

/// One of 0 to 14, from 16 random bits.
const fn uniform(bits: u64) -> i32 {
    (((bits & 0xffff) * 15) >> 16) as i32
}
