//! Line source that never waits, at the end of a queue of lines.

use super::{
    CameraError, ErrorType, FrameStart, HandedLines, LineConsumer, LineFormat, LineSource, LineStart,
};
use core::convert::Infallible;

/// The line source that an interrupt feeds through [`LineSlots`](super::LineSlots), for callers that do not
/// block: without a line it gives [`CameraError::WouldBlock`].
///
/// A task awaits rows of it by `Pipeline::next_row_async`; a loop that does other work too calls
/// `Pipeline::next_row` again later.
pub struct PolledLines<'a, 'b, const B: usize> {
    lines: HandedLines<'a, 'b, fn() -> bool, B>,
}

impl<'a, 'b, const B: usize> PolledLines<'a, 'b, B> {
    /// Creates a source of this format; refused when its lines are longer than a slot.
    pub fn new(
        consumer: LineConsumer<'a, 'b, B>,
        format: LineFormat,
    ) -> Result<Self, CameraError<Infallible>> {
        let never: fn() -> bool = || false;
        HandedLines::new(consumer, format, never).map(|lines| Self { lines })
    }

    /// Number of lines that found no slot, up to the newest one that came.
    pub fn overruns(&self) -> u32 {
        self.lines.overruns()
    }
}

/// A wait of no time that is over means that nothing is there.
fn would_block(error: CameraError<Infallible>) -> CameraError<Infallible> {
    if error == CameraError::TimedOut { CameraError::WouldBlock } else { error }
}

impl<const B: usize> ErrorType for PolledLines<'_, '_, B> {
    type Error = Infallible;
}

impl<const B: usize> LineSource for PolledLines<'_, '_, B> {
    fn format(&self) -> LineFormat {
        self.lines.format()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        self.lines.start_frame().map_err(would_block)
    }

    fn next_line(&mut self, to: &mut [u8]) -> Result<LineStart, CameraError<Infallible>> {
        self.lines.next_line(to).map_err(would_block)
    }
}
