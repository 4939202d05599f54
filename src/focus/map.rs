//! Shape from focus (Nayar & Nakagawa 1994): frames of a focus sweep to a map of peaks, line by line.

use super::box_filter::BoxFilter;
use super::logarithm::log2;
use super::peak::BIAS;
use super::{
    AllInFocusRow, Breathing, FocusCell, FocusConfig, FocusConfigError, FocusLineError, FocusPeak, NoFocus,
    binomial, modified_laplacian,
};
use crate::imaging::LineBand;

/// Depth from focus: the frame in which each cell is sharpest, with a fraction, from frames that come one at
/// a time.
///
/// `W` is the longest line, px, and `C` the most cells in a row; `S` is the owner's memory for the cells, 44
/// bytes each. Beside them the map takes 13 bytes for every pixel of a line and 73 for every cell of a row
/// ([`Self::LINE_BYTES`]). The work for a line is bounded by its length, and that for a stack grows with the
/// number of frames.
///
/// In running order: lines are smoothed ([`binomial`]); [`modified_laplacian`]; summed up in cells, then
/// twice over windows; their logarithms pass through the cells, which keep the last eleven frames and the
/// peak so far: a parabola through seven logarithms, or through eleven where it is broad and noise would move
/// its top. A peak is found the better, the more frames it spans; three are enough.
///
/// The measure is the default against noise and changes of brightness: smoothing keeps 3/8 of the noise,
/// absolute values grow in proportion to the contrast where squares would let the strongest edge of a window
/// decide, and a frame's mean brightness is divided out. On rendered stacks (fine, coarse and photographed
/// texture; slopes, steps, cones and waves; noise of 1 and 4 grey levels) a window of two sums of 7 by 7 has
/// the least error; narrower ones follow the depth more closely, wider ones average more noise.
#[derive(Debug)]
pub struct FocusMap<const W: usize, const C: usize, S> {
    config: FocusConfig,
    raw: LineBand<W, 3>,
    smooth: [[u16; W]; 3],
    /// The measure of the last two rows, the newest first.
    lines: [[u16; W]; 2],
    boxes: [BoxFilter<C>; 2],
    sums: [u32; C],
    sharper: [bool; C],
    cells: S,
    /// What every window's sharpness is raised by: two sixteenths of a grey level a pixel, so that rounding
    /// is no texture.
    floor: u32,
    breathing: Breathing,
    /// Frames begun, and lines of the last one that came.
    frames: u32,
    taken: u16,
    /// The next row of the reference, of rows of cells, and of those that went through the windows.
    next_row: u16,
    rows_out: usize,
    brightness: u64,
    /// The first frame's logarithm of its mean brightness, and what the last complete frame's adds to
    /// sharpness.
    reference: u16,
    shift: u16,
    is_running: bool,
}

impl<const W: usize, const C: usize, S: AsRef<[FocusCell]> + AsMut<[FocusCell]>> FocusMap<W, C, S> {
    /// Bytes of a map beside its cells.
    pub const LINE_BYTES: usize = size_of::<FocusMap<W, C, ()>>();

    /// A map over its memory for cells, which waits for [`Self::start`]. All zeros: in a `static` it takes no
    /// flash.
    pub const fn new(cells: S) -> Self {
        Self {
            config: FocusConfig::NONE,
            raw: LineBand::new(),
            smooth: [[0; W]; 3],
            lines: [[0; W]; 2],
            boxes: [const { BoxFilter::new() }; 2],
            sums: [0; C],
            sharper: [false; C],
            cells,
            floor: 0,
            breathing: Breathing::UNSET,
            frames: 0,
            taken: 0,
            next_row: 0,
            rows_out: 0,
            brightness: 0,
            reference: 0,
            shift: 0,
            is_running: false,
        }
    }

    /// Begins a stack of frames; what is left of another one is forgotten.
    pub fn start(&mut self, config: &FocusConfig) -> Result<(), FocusConfigError> {
        config.check(W, C, self.cells.as_ref().len())?;
        self.config = *config;
        self.floor = 2 * config.weight() as u32;
        self.frames = 0;
        self.taken = config.height;
        self.shift = BIAS;
        self.is_running = true;
        self.cells.as_mut().fill(FocusCell::EMPTY);
        Ok(())
    }

    /// Frames begun since [`Self::start`].
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// Begins the next frame; all lines of the one before have come.
    pub fn begin_frame(&mut self, breathing: Breathing) -> Result<(), FocusLineError> {
        if !self.is_running {
            return Err(FocusLineError::NoLineDue);
        }
        self.check_complete()?;
        if self.frames >= u16::MAX.into() {
            return Err(FocusLineError::TooManyFrames);
        }
        self.measure_brightness();
        self.frames += 1;
        self.breathing = breathing;
        (self.taken, self.next_row, self.rows_out, self.brightness) = (0, 0, 0, 0);
        self.raw.begin(self.config.width.into());
        for boxes in &mut self.boxes {
            boxes.begin(self.config.columns(), self.config.radius.into());
        }
        self.sums.fill(0);
        Ok(())
    }

    fn check_complete(&self) -> Result<(), FocusLineError> {
        let missing = self.config.height - self.taken;
        if missing == 0 { Ok(()) } else { Err(FocusLineError::FrameIncomplete { missing }) }
    }

    /// What the last frame's brightness adds to the logarithms of its sharpness: those of a frame half as
    /// bright are raised by 1.
    fn measure_brightness(&mut self) {
        if self.frames == 0 || !self.config.exposure_varies {
            return;
        }
        let pixels = u64::from(self.config.width) * u64::from(self.config.height);
        // In 1/256 of a grey level: at most 16 bits.
        let mean = log2((self.brightness * 256).checked_div(pixels).unwrap_or(0) as u32);
        if self.frames == 1 {
            self.reference = mean;
        }
        self.shift = (BIAS + self.reference).saturating_sub(mean).min(2 * BIAS);
    }

    /// Takes the next line of grey pixels, and calls `row` with every row of cells that it completes.
    pub fn push(
        &mut self,
        line: &[u8],
        mut row: impl FnMut(AllInFocusRow<'_>),
    ) -> Result<(), FocusLineError> {
        if !self.is_running || self.frames == 0 || self.taken >= self.config.height {
            return Err(FocusLineError::NoLineDue);
        }
        let place = self.raw.next_line();
        if line.len() != place.len() {
            return Err(FocusLineError::Length { needed: place.len() });
        }
        place.copy_from_slice(line);
        self.raw.accept();
        self.brightness += u64::from(line.iter().map(|&pixel| u32::from(pixel)).sum::<u32>());
        let newest = usize::from(self.taken);
        self.taken += 1;
        let is_last = self.taken == self.config.height;
        if let Some(centre) = newest.checked_sub(1) {
            self.smooth(centre, &mut row);
        }
        if is_last {
            self.smooth(newest, &mut row);
            self.measure(newest, newest, &mut row);
            let radius = self.config.radius;
            (0..radius).for_each(|_| self.first_window(false, &mut row));
            (0..radius).for_each(|_| self.second_window(None, &mut row));
        }
        Ok(())
    }

    /// Smooths row `centre`, below which a line has come if the picture has one; then the row above it can be
    /// measured.
    fn smooth(&mut self, centre: usize, row: &mut impl FnMut(AllInFocusRow<'_>)) {
        let width = usize::from(self.config.width);
        if let Some(out) = self.smooth.get_mut(centre % 3).and_then(|out| out.get_mut(..width)) {
            binomial(self.raw.around(centre), out);
        }
        if let Some(above) = centre.checked_sub(1) {
            self.measure(above, centre, row);
        }
    }

    /// Measures row `centre`, of which rows down to `newest` are smoothed, and adds it to the rows of the
    /// reference that show it.
    fn measure(&mut self, centre: usize, newest: usize, row: &mut impl FnMut(AllInFocusRow<'_>)) {
        let (width, height) = (usize::from(self.config.width), usize::from(self.config.height));
        let rows = [centre.saturating_sub(1), centre, (centre + 1).min(newest)];
        let rows = rows.map(|y| self.smooth.get(y % 3).and_then(|row| row.get(..width)).unwrap_or(&[]));
        self.lines.reverse();
        let [newest, _] = &mut self.lines;
        modified_laplacian(rows, newest);
        while usize::from(self.next_row) < height {
            let (before, part) = self.breathing.between(self.next_row.into(), height);
            if before + usize::from(part > 0) > centre {
                break;
            }
            self.add_row(part, row);
        }
    }

    /// Adds the next row of the reference to its cells: it lies by `part` of 256 between the last two
    /// measured rows, if it is not the last one.
    fn add_row(&mut self, part: u32, row: &mut impl FnMut(AllInFocusRow<'_>)) {
        let (width, side) = (usize::from(self.config.width), usize::from(self.config.cell_px).max(1));
        let [newest, before] = self.lines.each_ref().map(|line| line.get(..width).unwrap_or(&[]));
        if self.breathing.is_none() {
            for (sum, pixels) in self.sums.iter_mut().zip(newest.chunks(side)) {
                *sum += pixels.iter().map(|&pixel| u32::from(pixel)).sum::<u32>();
            }
        } else {
            let above = if part > 0 { before } else { newest };
            let seen = |x| {
                let (left, right_part) = self.breathing.between(x, width);
                // 14 bits of the measure and 16 of the parts.
                let along = |line: &[u16]| {
                    let at = |x: usize| u32::from(line.get(x).copied().unwrap_or(0));
                    at(left) * (256 - right_part) + at(left + 1) * right_part
                };
                (along(above) * (256 - part) + along(newest) * part + (1 << 15)) >> 16
            };
            for (first, sum) in (0..width).step_by(side).zip(&mut self.sums) {
                *sum += (first..(first + side).min(width)).map(seen).sum::<u32>();
            }
        }
        self.next_row += 1;
        let is_last = self.next_row == self.config.height;
        if is_last || usize::from(self.next_row).is_multiple_of(side) {
            self.first_window(true, row);
            self.sums.fill(0);
        }
    }

    /// Passes a row of cells, or what is below the picture, through the first window.
    fn first_window(&mut self, is_inside: bool, row: &mut impl FnMut(AllInFocusRow<'_>)) {
        let sums = self.sums.get(..self.config.columns()).unwrap_or(&[]);
        let mut out = [0; C];
        if self.config.radius == 0 {
            out.copy_from_slice(&self.sums);
            self.cells(&out, row);
        } else if self.boxes[0].push(is_inside.then_some(sums), &mut out) {
            self.second_window(Some(&out), row);
        }
    }

    /// Passes a row of the first window's sums, or what is below the picture, through the second one.
    fn second_window(&mut self, sums: Option<&[u32; C]>, row: &mut impl FnMut(AllInFocusRow<'_>)) {
        let mut out = [0; C];
        if self.boxes[1].push(sums.map(<[u32; C]>::as_slice), &mut out) {
            self.cells(&out, row);
        }
    }

    /// Passes the sharpness of the next row of cells through them.
    fn cells(&mut self, sharpness: &[u32; C], row: &mut impl FnMut(AllInFocusRow<'_>)) {
        let (columns, index) = (self.config.columns(), self.rows_out);
        self.rows_out += 1;
        let cells = self.cells.as_mut().chunks_exact_mut(columns.max(1)).nth(index).unwrap_or_default();
        let frame = self.frames.saturating_sub(1);
        for ((cell, &sum), sharper) in cells.iter_mut().zip(sharpness).zip(&mut self.sharper) {
            *sharper = cell.push(frame, sum + self.floor, self.shift);
        }
        row(AllInFocusRow { index, sharper: self.sharper.get(..columns).unwrap_or(&[]) });
    }

    /// Ends the stack: then all peaks are known.
    pub fn finish(&mut self) -> Result<(), FocusLineError> {
        if !self.is_running {
            return Err(FocusLineError::NoLineDue);
        }
        self.check_complete()?;
        self.measure_brightness();
        let (frames, shift) = (self.frames, self.shift);
        let count = self.config.cells();
        self.cells.as_mut().iter_mut().take(count).for_each(|cell| cell.finish(frames, shift));
        self.is_running = false;
        Ok(())
    }

    /// The peak of a cell, once the stack has ended; [`NoFocus::TooFewFrames`] for one that is not in the
    /// picture.
    pub fn peak(&self, column: usize, row: usize) -> Result<FocusPeak, NoFocus> {
        let columns = self.config.columns();
        let place = (column < columns && row < self.config.rows() && !self.is_running)
            .then(|| row * columns + column);
        let cell = place.and_then(|place| self.cells.as_ref().get(place));
        cell.ok_or(NoFocus::TooFewFrames { needed: FocusCell::FEWEST_FRAMES })?.peak(self.frames)
    }
}
