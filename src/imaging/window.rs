//! The last lines of a stream.

/// The last five lines: the rows around a centre.
pub type LineWindow<const W: usize> = LineBand<W, 5>;

/// `N` lines over fixed storage: as line `n` comes in, line `n - N` goes.
///
/// `W` is the capacity; the real width is set per frame. A band takes `N W` bytes and a few words.
///
/// ```
/// use stereopsis::imaging::LineWindow;
/// let mut window = LineWindow::<8>::new();
/// window.begin(3);
/// for brightness in [10, 20, 30] {
///     window.next_line().fill(brightness);
///     window.accept();
/// }
/// // Row 0 with the rows above it repeated from row 0, and the two below.
/// assert_eq!(window.around(0).map(|row| row[0]), [10, 10, 10, 20, 30]);
/// ```
/// Each line begins where a word may stand: those who look at it can take four pixels at a time.
#[derive(Debug)]
pub struct LineBand<const W: usize, const N: usize> {
    lines: [Line<W>; N],
    width: usize,
    count: usize,
}

/// One line, in whole words.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(4))]
struct Line<const W: usize>([u8; W]);

impl<const W: usize, const N: usize> LineBand<W, N> {
    /// An empty band.
    pub const fn new() -> Self {
        const { assert!(N > 0, "a band holds at least one line") };
        Self { lines: [const { Line([0; W]) }; N], width: 0, count: 0 }
    }

    /// Forgets all lines; the next ones have `width` pixels (at most the capacity).
    pub fn begin(&mut self, width: usize) {
        self.width = width.min(W);
        self.count = 0;
    }

    /// Where the next line goes. It counts once [`Self::accept`] is called.
    pub fn next_line(&mut self) -> &mut [u8] {
        let width = self.width;
        match self.lines.get_mut(self.count % N) {
            Some(Line(line)) => line.get_mut(..width).unwrap_or_default(),
            None => &mut [],
        }
    }

    /// The line is whole.
    pub fn accept(&mut self) {
        self.count += 1;
    }

    /// Puts a copy of the newest line, of zeros where there is none, where the next line goes: it stands in
    /// for one that is lost.
    pub fn repeat(&mut self) {
        let (newest, next) = (self.count.wrapping_sub(1), self.count);
        if self.count == 0 {
            self.next_line().fill(0);
        } else if let Ok([Line(from), Line(to)]) = self.lines.get_disjoint_mut([newest % N, next % N]) {
            *to = *from;
        }
    }

    /// Lines accepted since [`Self::begin`].
    pub fn count(&self) -> usize {
        self.count
    }

    /// The `M` rows around `centre`, of an odd number: two above to two below where `M` is 5. Rows above the
    /// image are row 0; rows that did not come yet, the last one that did. The caller asks for a centre
    /// whose rows are still held.
    // Asked for once in a row of each camera.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    pub fn around<const M: usize>(&self, centre: usize) -> [&[u8]; M] {
        let newest = self.count.saturating_sub(1);
        core::array::from_fn(|i| {
            let row = (centre + i).saturating_sub(M / 2).min(newest);
            self.lines.get(row % N).and_then(|Line(line)| line.get(..self.width)).unwrap_or(&[])
        })
    }
}

impl<const W: usize, const N: usize> Default for LineBand<W, N> {
    fn default() -> Self {
        Self::new()
    }
}
