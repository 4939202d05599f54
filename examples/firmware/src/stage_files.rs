//! Rows of the matcher's stages to files on the host, in the bytes that `stereo dump` writes.

use crate::choice::ROOM;
use crate::host::{HostError, HostFile};
use stereopsis::matching::{Row, StageTrace, TracedStage, WinnerRecord};
use stereopsis::units::{Disparity, PixelFlags};

/// Pixels that are written at a time.
const PIXELS: usize = 32;

/// A file for each stage.
pub struct StageFiles {
    winners: HostFile,
    /// What partners keep, and flags.
    partners: HostFile,
    kept: [u8; ROOM],
    subpixel: HostFile,
    smoothed: HostFile,
    checked: HostFile,
    /// What comes out.
    last: HostFile,
    written: Result<(), HostError>,
}

impl StageFiles {
    /// Empty files.
    ///
    /// # Errors
    /// When the host does not let them be made.
    pub fn create() -> Result<Self, HostError> {
        Ok(Self {
            winners: HostFile::create(c"winner.bin")?,
            partners: HostFile::create(c"left-right.bin")?,
            kept: [0; ROOM],
            subpixel: HostFile::create(c"subpixel.bin")?,
            smoothed: HostFile::create(c"smoothed.bin")?,
            checked: HostFile::create(c"checked.bin")?,
            last: HostFile::create(c"final.bin")?,
            written: Ok(()),
        })
    }

    /// Adds a row that came out, whose confidences were not asked for.
    pub fn finished(&mut self, row: &Row<'_>) {
        self.written = self.written.and(with_flags(&self.last, row.disparities(), row.flags()));
    }

    /// Whether all rows are written.
    ///
    /// # Errors
    /// When the host did not take all of one.
    pub fn end(self) -> Result<(), HostError> {
        self.written
    }
}

impl StageTrace for StageFiles {
    fn winner(&mut self, _: usize, column: usize, winner: WinnerRecord) {
        if let Some(kept) = self.kept.get_mut(column) {
            *kept = winner.kept();
        }
        self.written = self.written.and(self.winners.write(&winner.bytes()));
    }

    fn row(&mut self, stage: TracedStage, _: usize, answers: &[Disparity], flags: &[PixelFlags]) {
        let written = match stage {
            TracedStage::Subpixel => {
                let partners = flags.iter().zip(&self.kept).map(|(flags, &kept)| [kept, flags.bits()]);
                write(&self.partners, partners).and(alone(&self.subpixel, answers))
            }
            TracedStage::Smoothed => alone(&self.smoothed, answers),
            TracedStage::Checked => with_flags(&self.checked, answers, flags),
        };
        self.written = self.written.and(written);
    }
}

/// Writes disparities, two bytes each, the low one first.
fn alone(file: &HostFile, answers: &[Disparity]) -> Result<(), HostError> {
    write(file, answers.iter().map(|answer| answer.raw().to_le_bytes()))
}

/// Writes disparities and flags, four bytes each: the last one is zero.
fn with_flags(file: &HostFile, answers: &[Disparity], flags: &[PixelFlags]) -> Result<(), HostError> {
    let pixels = answers.iter().zip(flags).map(|(answer, flags)| {
        let [low, high] = answer.raw().to_le_bytes();
        [low, high, flags.bits(), 0]
    });
    write(file, pixels)
}

/// Writes a row's elements, some of them at a time.
fn write<const BYTES: usize>(
    file: &HostFile,
    mut elements: impl ExactSizeIterator<Item = [u8; BYTES]>,
) -> Result<(), HostError> {
    for _ in 0..elements.len().div_ceil(PIXELS) {
        let mut bytes = [[0; BYTES]; PIXELS];
        let mut count = 0;
        for (to, element) in bytes.iter_mut().zip(elements.by_ref()) {
            *to = element;
            count += BYTES;
        }
        file.write(bytes.as_flattened().get(..count).unwrap_or_default())?;
    }
    Ok(())
}
