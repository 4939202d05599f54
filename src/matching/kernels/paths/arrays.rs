//! Bytes in an array, which the compiler keeps in a vector register where the target has vectors.

use super::group::Group;

/// So many bytes.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(in crate::matching) struct Array<const N: usize>([u8; N]);

impl<const N: usize> Array<N> {
    #[inline(always)]
    fn with(self, other: Self, work: impl Fn(u8, u8) -> u8) -> Self {
        let mut out = self.0;
        for i in 0..N {
            out[i] = work(self.0[i], other.0[i]);
        }
        Self(out)
    }
}

impl<const N: usize> Group for Array<N> {
    const LANES: usize = N;
    const PUTS_ROWS: bool = true;
    type Cell = [u8; N];
    type Bytes = [u8; N];

    #[inline(always)]
    fn cells(bytes: &[u8]) -> &[[u8; N]] {
        bytes.as_chunks().0
    }

    #[inline(always)]
    fn cells_mut(bytes: &mut [u8]) -> &mut [[u8; N]] {
        bytes.as_chunks_mut().0
    }

    #[inline(always)]
    fn groups(bytes: &[u8]) -> &[[u8; N]] {
        bytes.as_chunks().0
    }

    #[inline(always)]
    fn of(cell: [u8; N]) -> Self {
        Self(cell)
    }

    #[inline(always)]
    fn of_bytes(bytes: [u8; N]) -> Self {
        Self(bytes)
    }

    #[inline(always)]
    fn cell(self) -> [u8; N] {
        self.0
    }

    #[inline(always)]
    fn splat(number: u8) -> Self {
        Self([number; N])
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self.with(other, u8::wrapping_add)
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        self.with(other, u8::wrapping_sub)
    }

    #[inline(always)]
    fn plus_saturating(self, other: Self) -> Self {
        self.with(other, u8::saturating_add)
    }

    #[inline(always)]
    fn minus_saturating(self, other: Self) -> Self {
        self.with(other, u8::saturating_sub)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.with(other, Ord::min)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.with(other, Ord::max)
    }

    #[inline(always)]
    fn apart(self, other: Self) -> Self {
        self.with(other, u8::abs_diff)
    }

    #[inline(always)]
    fn average_up(self, other: Self) -> Self {
        self.with(other, |a, b| a.wrapping_add(b).wrapping_add(1) >> 1)
    }

    #[inline(always)]
    fn average_down(self, other: Self) -> Self {
        self.with(other, |a, b| a.wrapping_add(b) >> 1)
    }

    #[inline(always)]
    fn quarter(self) -> Self {
        self.with(self, |a, _| a >> 2)
    }

    #[inline(always)]
    fn bits_apart(self, other: Self) -> Self {
        self.with(other, |a, b| {
            let bits = a ^ b;
            let pairs = bits - (bits >> 1 & 0x55);
            let fours = (pairs & 0x33) + (pairs >> 2 & 0x33);
            (fours + (fours >> 4)) & 0x0f
        })
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self.with(other, |a, b| a | b)
    }

    #[inline(always)]
    fn after(self, before: Self) -> Self {
        let mut out = self.0;
        out[0] = before.0[N - 1];
        for i in 1..N {
            out[i] = self.0[i - 1];
        }
        Self(out)
    }

    #[inline(always)]
    fn before(self, next: Self) -> Self {
        let mut out = self.0;
        for i in 1..N {
            out[i - 1] = self.0[i];
        }
        out[N - 1] = next.0[0];
        Self(out)
    }

    #[inline(always)]
    fn least(self) -> Self {
        Self::splat(self.0.iter().fold(u8::MAX, |least, &lane| least.min(lane)))
    }

    #[inline(always)]
    fn last_least(cells: &[Self]) -> (u8, usize) {
        let all = cells.iter().fold(
            Self::splat(u8::MAX),
            #[inline(always)]
            |all, &cell| all.min(cell),
        );
        let least = all.least().0[0];
        let mut place = 0;
        for (first, cell) in (0..).step_by(N).zip(cells) {
            for (lane, &number) in (first..).zip(&cell.0) {
                place = if number == least { lane } else { place };
            }
        }
        (least, place)
    }

    #[inline(always)]
    fn lane(cells: &[Self], lane: usize) -> u8 {
        cells.get(lane / N).and_then(|cell| cell.0.get(lane % N)).copied().unwrap_or(0)
    }

    #[inline(always)]
    fn raise(cells: &mut [Self], lane: usize) {
        if let Some(lane) = cells.get_mut(lane / N).and_then(|cell| cell.0.get_mut(lane % N)) {
            *lane = u8::MAX;
        }
    }
}
