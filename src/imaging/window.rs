//! The last five lines of a stream.

/// Five lines over fixed storage: as line `n` comes in, line `n - 5` goes.
///
/// `W` is the capacity; the real width is set per frame. A window takes `5 W` bytes and a few words.
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
pub struct LineWindow<const W: usize> {
    lines: [Line<W>; 5],
    width: usize,
    count: usize,
}

/// One line, in whole words.
#[derive(Debug)]
#[repr(C, align(4))]
struct Line<const W: usize>([u8; W]);

impl<const W: usize> LineWindow<W> {
    /// An empty window.
    pub const fn new() -> Self {
        Self { lines: [const { Line([0; W]) }; 5], width: 0, count: 0 }
    }

    /// Forgets all lines; the next ones have `width` pixels (at most the capacity).
    pub fn begin(&mut self, width: usize) {
        self.width = width.min(W);
        self.count = 0;
    }

    /// Where the next line goes. It counts once [`Self::accept`] is called.
    pub fn next_line(&mut self) -> &mut [u8] {
        let width = self.width;
        match self.lines.get_mut(self.count % 5) {
            Some(Line(line)) => line.get_mut(..width).unwrap_or_default(),
            None => &mut [],
        }
    }

    /// The line is whole.
    pub fn accept(&mut self) {
        self.count += 1;
    }

    /// Lines accepted since [`Self::begin`].
    pub fn count(&self) -> usize {
        self.count
    }

    /// The rows `centre - 2` to `centre + 2`. Rows above the image are row 0; rows that did not come yet, the last one
    /// that did. The caller asks for a centre whose rows are still held: not more than two above the newest, or below it.
    pub fn around(&self, centre: usize) -> [&[u8]; 5] {
        let newest = self.count.saturating_sub(1);
        core::array::from_fn(|i| {
            let row = (centre + i).saturating_sub(2).min(newest);
            self.lines.get(row % 5).and_then(|Line(line)| line.get(..self.width)).unwrap_or(&[])
        })
    }
}

impl<const W: usize> Default for LineWindow<W> {
    fn default() -> Self {
        Self::new()
    }
}
