//! Pictures in memory as a camera.

use image::GrayImage;
use std::ops::Range;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineStart, PixelFormat, StereoSource,
};

/// Two pictures in memory as a stereo source: nothing but copying a line stands between the caller and the
/// matcher.
#[derive(Clone, Debug)]
pub struct MemoryPair {
    format: LineFormat,
    left: Vec<u8>,
    right: Vec<u8>,
    /// What was seen of the pictures; all, when there are none.
    masks: Option<[Vec<u8>; 2]>,
    frames: u32,
    row: u16,
}

impl MemoryPair {
    /// The next frame of `source`, to be played again and again.
    pub fn record<C: StereoSource>(source: &mut C) -> Result<Self, CameraError<C::Error>> {
        let format = source.format();
        let (line, lines) = (format.line_bytes(), usize::from(format.height));
        let (mut left, mut right) = (vec![0; line * lines], vec![0; line * lines]);
        source.start_frame()?;
        for (left, right) in left.chunks_exact_mut(line.max(1)).zip(right.chunks_exact_mut(line.max(1))) {
            source.next_lines(left, right)?;
        }
        let width = usize::from(format.width);
        let [mut of_left, mut of_right] = [(); 2].map(|()| vec![1; width * lines]);
        let rows = of_left.chunks_exact_mut(width.max(1)).zip(of_right.chunks_exact_mut(width.max(1)));
        let has_masks =
            (0..format.height).zip(rows).all(|(row, (left, right))| source.mask(row, [left, right]));
        let masks = has_masks.then_some([of_left, of_right]);
        Ok(Self { format, left, right, masks, frames: 0, row: format.height })
    }

    /// Two grey pictures with `width` pixels in a row; `None` when they are not the same whole number of
    /// rows, or one of the sides is 0 or over 65535.
    pub fn new(width: u16, left: Vec<u8>, right: Vec<u8>) -> Option<Self> {
        let rows = left.len().checked_div(usize::from(width))?;
        let height = u16::try_from(rows).ok().filter(|&height| height > 0)?;
        let whole = left.len() == rows * usize::from(width) && right.len() == left.len();
        let format = LineFormat { width, height, pixel: PixelFormat::Grey8 };
        whole.then_some(Self { format, left, right, masks: None, frames: 0, row: height })
    }

    /// Both pictures.
    pub fn pictures(&self) -> [GrayImage; 2] {
        let (width, height) = (u32::from(self.format.width), u32::from(self.format.height));
        let picture = |pixels: &[u8]| GrayImage::from_raw(width, height, pixels.to_vec()).unwrap_or_default();
        [picture(&self.left), picture(&self.right)]
    }

    /// Some rows of both pictures.
    ///
    /// # Panics
    ///
    /// When there are no such rows.
    pub fn rows(&self, rows: Range<usize>) -> Self {
        let line = self.format.line_bytes();
        let bytes = rows.start * line..rows.end * line;
        let format = LineFormat { height: rows.len() as u16, ..self.format };
        let width = usize::from(format.width);
        let pixels = rows.start * width..rows.end * width;
        let masks =
            self.masks.as_ref().map(|masks| masks.each_ref().map(|mask| mask[pixels.clone()].to_vec()));
        let (left, right) = (self.left[bytes.clone()].to_vec(), self.right[bytes].to_vec());
        Self { format, left, right, masks, frames: 0, row: format.height }
    }
}

impl ErrorType for MemoryPair {
    type Error = std::convert::Infallible;
}

impl StereoSource for MemoryPair {
    fn format(&self) -> LineFormat {
        self.format
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        let sequence = self.frames;
        self.frames = self.frames.wrapping_add(1);
        self.row = 0;
        Ok(FrameStart { sequence, ..FrameStart::default() })
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>> {
        let needed = self.format.line_bytes();
        if self.row >= self.format.height {
            return Err(CameraError::NoLineLeft);
        }
        let too_short = CameraError::BufferTooShort { needed };
        let first = usize::from(self.row) * needed;
        left.get_mut(..needed).ok_or(too_short)?.copy_from_slice(&self.left[first..first + needed]);
        right.get_mut(..needed).ok_or(too_short)?.copy_from_slice(&self.right[first..first + needed]);
        self.row += 1;
        Ok(LineStart { row: self.row - 1, timestamp_us: 0 })
    }

    fn mask(&self, row: u16, out: [&mut [u8]; 2]) -> bool {
        let Some(masks) = &self.masks else { return false };
        let width = usize::from(self.format.width);
        for (out, mask) in out.into_iter().zip(masks) {
            out.copy_from_slice(&mask[usize::from(row) * width..][..width]);
        }
        true
    }
}
