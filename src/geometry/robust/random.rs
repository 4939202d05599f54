//! SplitMix64: random numbers that a seed repeats (Steele, Lea & Flood 2014).

/// Numbers by SplitMix64 (Steele, Lea & Flood 2014): a counter in steps of the golden ratio, its bits mixed.
/// One multiplication of 64 bits twice a number, eight bytes of state, every seed is as good as any other.
pub(super) struct Random(u64);

impl Random {
    pub(super) const fn new(seed: u64) -> Self {
        Self(seed)
    }

    #[inline(never)]
    fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 32) as u32
    }

    /// A number below `n` (below 2^32), by the upper half of a product (Lemire 2019); one of them is more
    /// likely than another by at most n / 2^32.
    pub(super) fn below(&mut self, n: usize) -> usize {
        ((u64::from(self.bits()) * n as u64) >> 32) as usize
    }

    /// K different numbers below `n`, which is K at least: Floyd's method, one number for each (Bentley &
    /// Floyd 1987).
    pub(super) fn sample<const K: usize>(&mut self, n: usize) -> [usize; K] {
        let mut chosen = [usize::MAX; K];
        for k in 0..K {
            let last = n - K + k;
            let number = self.below(last + 1);
            let taken = chosen.contains(&number);
            if let Some(slot) = chosen.get_mut(k) {
                *slot = if taken { last } else { number };
            }
        }
        chosen
    }
}

#[cfg(test)]
mod tests {
    use super::Random;

    #[test]
    fn the_generator_is_splitmix64() {
        // The first outputs of the reference implementation for the seed 0, their upper halves.
        let mut random = Random::new(0);
        let first = [0xe220_a839, 0x6e78_9e6a, 0x06c4_5d18, 0xf88b_b8a8, 0x1b39_896a];
        assert_eq!([(); 5].map(|()| random.bits()), first);
    }

    #[test]
    fn samples_are_different_numbers_of_all_that_there_are() {
        let mut random = Random::new(5);
        let mut seen = [0; 9];
        for _ in 0..900 {
            let mut sample: [usize; 7] = random.sample(9);
            sample.sort_unstable();
            assert!(sample.windows(2).all(|pair| pair[0] < pair[1]), "{sample:?}");
            sample.iter().for_each(|&i| seen[i] += 1);
        }
        // Seven of nine, 700 times each; the standard deviation is 12.
        assert!(seen.iter().all(|n| (640..760).contains(n)), "{seen:?}");
        assert_eq!(random.sample::<7>(7).iter().sum::<usize>(), 21);
    }
}
