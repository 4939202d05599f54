//! Line buffers: the last lines of a stream as rows around a centre.

/// Lines that are held.
const N: usize = 5;

/// Ring buffer of the last five lines.
///
/// The capacity is `W` columns; [`Self::begin`] sets the real width per frame. A window takes `5 W` bytes and
/// a few words. Every line is word-aligned, so that four pixels can be read at a time.
///
/// ```
/// use stereopsis::imaging::LineWindow;
/// let mut window = LineWindow::<8>::new();
/// window.begin(3);
/// for brightness in [10, 20, 30] {
///     window.next_line().fill(brightness);
///     window.accept();
/// }
/// // Rows above row 0 repeat it.
/// assert_eq!(window.around(0).map(|row| row[0]), [10, 10, 10, 20, 30]);
/// ```
#[derive(Debug)]
pub struct LineWindow<const W: usize> {
    lines: [Line<W>; N],
    width: usize,
    count: usize,
}

/// One word-aligned line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(4))]
struct Line<const W: usize>([u8; W]);

impl<const W: usize> LineWindow<W> {
    /// Creates an empty window.
    pub const fn new() -> Self {
        Self { lines: [const { Line([0; W]) }; N], width: 0, count: 0 }
    }

    /// Begins a frame with lines of `width` pixels, at most the capacity.
    pub fn begin(&mut self, width: usize) {
        self.width = width.min(W);
        self.count = 0;
    }

    /// Returns the buffer for the next line, which counts once [`Self::accept`] is called.
    pub fn next_line(&mut self) -> &mut [u8] {
        let width = self.width;
        match self.lines.get_mut(self.count % N) {
            Some(Line(line)) => line.get_mut(..width).unwrap_or_default(),
            None => &mut [],
        }
    }

    /// Accepts the line in [`Self::next_line`].
    pub fn accept(&mut self) {
        self.count += 1;
    }

    /// Copies the newest line, or zeros where there is none, to the next one: a substitute for a lost line.
    pub fn repeat(&mut self) {
        let (newest, next) = (self.count.wrapping_sub(1), self.count);
        if self.count == 0 {
            self.next_line().fill(0);
        } else if let Ok([Line(from), Line(to)]) = self.lines.get_disjoint_mut([newest % N, next % N]) {
            *to = *from;
        }
    }

    /// Returns the number of lines accepted since [`Self::begin`].
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the five rows around `centre`. Rows above the image repeat row 0, and rows below the newest
    /// line repeat it. The rows must still be in the window.
    // Asked for once in a row of each camera.
    #[cfg_attr(not(stereopsis_simd), inline(never))]
    pub fn around(&self, centre: usize) -> [&[u8]; N] {
        let (newest, width) = (self.count.saturating_sub(1), self.width.min(W));
        let mut rows = [&[][..]; N];
        // A loop over a slice of any length, in which something may happen: it is not written out.
        for (row, number) in core::hint::black_box(&mut rows[..]).iter_mut().zip(centre..) {
            core::hint::black_box(());
            let number = number.saturating_sub(N / 2).min(newest);
            *row = self.lines.get(number % N).and_then(|Line(line)| line.get(..width)).unwrap_or_default();
        }
        rows
    }
}

impl<const W: usize> Default for LineWindow<W> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first pixels of the rows around a centre.
    fn around(window: &LineWindow<8>, centre: usize) -> [u8; 5] {
        window.around(centre).map(|row| row[0])
    }

    #[test]
    fn the_last_five_lines_are_there() {
        let mut window = LineWindow::<8>::new();
        window.begin(6);
        for row in 0..9 {
            window.next_line().fill(row);
            window.accept();
        }
        assert_eq!(window.count(), 9);
        assert_eq!(around(&window, 6), [4, 5, 6, 7, 8]);
        // Below the newest line it repeats.
        assert_eq!([around(&window, 7), around(&window, 8)], [[5, 6, 7, 8, 8], [6, 7, 8, 8, 8]]);
        assert!(window.around(6).iter().all(|row| row.len() == 6));
        // No more than the capacity, and from the first line on again.
        window.begin(99);
        assert_eq!((window.count(), window.next_line().len()), (0, 8));
    }

    #[test]
    fn a_lost_line_is_like_the_one_above() {
        let mut window = LineWindow::<8>::new();
        window.begin(8);
        window.next_line().fill(9);
        // Above the first line there is none.
        window.repeat();
        assert_eq!(window.next_line(), [0; 8]);
        window.accept();
        for row in 1..7 {
            window.next_line().fill(10 * row);
            window.accept();
            window.repeat();
            assert_eq!(window.next_line(), [10 * row; 8]);
        }
        window.accept();
        assert_eq!(around(&window, 5), [30, 40, 50, 60, 60]);
    }
}
