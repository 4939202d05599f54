//! A frame in bands of rows, one pipeline each: what a chip with two cores does.

use super::Pipeline;
use super::reach::reach_of_checks;
use crate::matching::{Config, Method};
use core::ops::Range;

/// Rows of a frame that one pipeline gives, and the lines that it takes for them.
///
/// With [`Fast`](crate::matching::Fast) and [`Block`](crate::matching::Block) every row is bit-equal to that
/// of one pipeline over the whole frame, because a band takes more lines than it gives rows. A check of open
/// places, which reach down from the image's first row, is the exception: for a band it is its own first row.
///
/// * below, as many as a row waits for ([`Pipeline::LATENCY`]);
/// * above, as many again, for windows and for the uncertainty, which looks back at finished rows; one for
///   the [median](crate::matching::Checks::median), which looks at the row above; and one for each answer
///   that the speckle filter asks for ([`speckle_pixels`](crate::matching::Checks::speckle_pixels)), since a
///   surface that goes on through so many rows has them.
///
/// Along paths a band's first rows lack what a path from above has gathered farther up: under 1 % of the
/// pixels differ by over a pixel, or in having an answer, with four bands of 240 rows. Only half as many
/// lines are taken there for the speckle filter and the median: a surface mostly has several answers in a
/// row. [Repeats](crate::matching::Checks::refuse_repeats) are looked for in every fifth line, counted from
/// the band's own first. On 15 real pairs `Sgm` misses 3.32 % in one band, and 3.44 % in two
/// (`stereo eval --scenes DIR --threads 2`).
///
/// A pipeline's work is that on its lines, so a frame is split into bands of equal lines, not of equal rows:
/// 120 rows of `Block` with the default checks, which take 34 lines above and 10 below, go to two cores as 72
/// and 48 rows, of 82 lines each. A Cortex-M4 needs 0.69 of the whole frame's instructions for such a band at
/// 160 px and 32 disparities (1.45 times as fast), and 0.79 for the 94 lines of the lower one of two halves:
/// `STEREO_HEIGHT=82 cargo run --release` in `examples/firmware` beside 120 and 94.
/// With [`Checks::DENSE`](crate::matching::Checks::DENSE), which has no speckle filter, it is 70 lines.
///
/// ```
/// use stereopsis::matching::{Block, Config};
/// use stereopsis::pipeline::{Band, Pipeline};
/// let grey = |u: u32, v: u32| ((u * 64 + v).wrapping_mul(0x9e37_79b1) >> 24) as u8;
/// let left = |v: u32| core::array::from_fn::<_, 64, _>(|u| grey(u as u32, v));
/// let right = |v: u32| core::array::from_fn::<_, 64, _>(|u| grey(u as u32 + 5, v)); // 5 px everywhere
///
/// let whole = Config::for_method::<Block>(64, 120, 16);
/// // On a microcontroller: a core each, and a static each for the pipeline.
/// std::thread::scope(|scope| {
///     for band in Band::split::<Block>(&whole, 2) {
///         scope.spawn(move || {
///             let mut pipeline = Box::new(Pipeline::<Block, 64, 16>::new());
///             pipeline.start(&band.config(&whole)).expect("within its capacity");
///             pipeline.begin().expect("a frame");
///             let mut rows = band.rows();
///             for line in band.lines() {
///                 let row = pipeline.push(&left(line.into()), &right(line.into())).expect("a line");
///                 if let Some(row) = row.and_then(|row| band.row(row.index())) {
///                     assert_eq!(rows.next(), Some(row));
///                 }
///             }
///             while let Some(row) = pipeline.flush().expect("all lines are in") {
///                 if let Some(row) = band.row(row.index()) {
///                     assert_eq!(rows.next(), Some(row));
///                 }
///             }
///             assert_eq!(rows.next(), None);
///         });
///     }
/// });
/// ```
#[derive(Clone, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Band {
    rows: Range<u16>,
    lines: Range<u16>,
}

impl Band {
    /// Splits a frame of `config` into at most `most` bands from top to bottom, so that the band with the
    /// most lines has as few as can be. There are fewer bands where another one would only repeat lines.
    pub fn split<S: Method>(config: &Config, most: u16) -> Bands {
        let height = usize::from(config.height);
        let below = Pipeline::<S, 0, 0>::LATENCY;
        let reach = reach_of_checks(&config.checks);
        let above = below + if S::ALONG_PATHS { reach / 2 } else { reach };
        let bands = |lines| Bands { from: 0, height, above, below, lines };
        let most = usize::from(most).max(1);
        // Bands of more lines are no more bands. One of as many lines as the frame has is enough, and fewer
        // than these are too few without any overlap. A height has 16 bits.
        let (mut too_few, mut enough) = ((height / most).saturating_sub(1), height);
        for _ in 0..u16::BITS {
            let lines = too_few.midpoint(enough);
            let is_whole = bands(lines).take(most).last().is_some_and(|band| band.is_last(height));
            if is_whole {
                enough = lines;
            } else {
                too_few = lines;
            }
        }
        bands(enough)
    }

    /// Returns the rows of the frame that the band gives.
    pub fn rows(&self) -> Range<u16> {
        self.rows.clone()
    }

    /// Returns the lines of the frame that the band takes.
    pub fn lines(&self) -> Range<u16> {
        self.lines.clone()
    }

    /// Returns the configuration of the band's pipeline: `whole`, with the band's lines for a frame.
    pub fn config(&self, whole: &Config) -> Config {
        Config { height: self.lines.end.saturating_sub(self.lines.start), ..*whole }
    }

    /// Returns the frame's row that the band's pipeline calls `index`; `None` where another band gives it.
    pub fn row(&self, index: u16) -> Option<u16> {
        self.lines.start.checked_add(index).filter(|row| self.rows.contains(row))
    }

    /// Whether the band gives the last row.
    fn is_last(&self, height: usize) -> bool {
        usize::from(self.rows.end) == height
    }
}

/// Bands of a frame from top to bottom, made by [`Band::split`].
#[derive(Clone, Debug)]
pub struct Bands {
    /// The first row of the next band.
    from: usize,
    height: usize,
    /// Lines that a band takes above its first row, and below its last one.
    above: usize,
    below: usize,
    /// Lines of a band, at most.
    lines: usize,
}

impl Iterator for Bands {
    type Item = Band;

    fn next(&mut self) -> Option<Band> {
        let first = self.from.saturating_sub(self.above);
        let last = self.height.min(first + self.lines);
        // The frame's last rows wait for no line.
        let to = if last < self.height { last.saturating_sub(self.below) } else { last };
        if to <= self.from {
            return None;
        }
        // A height has 16 bits.
        let range = |from: usize, to: usize| from as u16..to as u16;
        let band = Band { rows: range(self.from, to), lines: range(first, last) };
        self.from = to;
        Some(band)
    }
}
