//! The line source at the end of a hand-off from an interrupt.

use super::{
    CameraError, ErrorType, FilledLine, FrameStart, LineConsumer, LineFormat, LineSource, LineStart,
};
use core::convert::Infallible;

/// The line source that an interrupt feeds through [`LineSlots`](super::LineSlots).
///
/// `wait` is called while no line waits, to sleep until the next interrupt. It returns false when the time is
/// over, which it must do eventually: [`CameraError::TimedOut`], unless a line has come by then. An interrupt
/// may come after the look for a line and before the sleep, which then lasts until the next one: a sleep that
/// an event ends (`WFE` on Arm, with `SEV` in the interrupt) misses none. A line lost on the way shows in the
/// next one's row. A line with another [`FrameStart`] than the one before it begins a frame.
pub struct HandedLines<'a, 'b, F, const B: usize> {
    consumer: LineConsumer<'a, 'b, B>,
    format: LineFormat,
    wait: F,
    /// A line of a frame that was not started yet.
    pending: Option<FilledLine<'b, B>>,
    /// The frame that was started.
    frame: Option<FrameStart>,
    is_over: bool,
    overruns: u32,
}

impl<'a, 'b, F: FnMut() -> bool, const B: usize> HandedLines<'a, 'b, F, B> {
    /// Creates a source of this format; refused when its lines are longer than a slot.
    pub fn new(
        consumer: LineConsumer<'a, 'b, B>,
        format: LineFormat,
        wait: F,
    ) -> Result<Self, CameraError<Infallible>> {
        let needed = format.line_bytes();
        if needed > B {
            return Err(CameraError::BufferTooShort { needed });
        }
        Ok(Self { consumer, format, wait, pending: None, frame: None, is_over: true, overruns: 0 })
    }

    /// Number of lines that found no slot, up to the newest one that came.
    pub fn overruns(&self) -> u32 {
        self.overruns
    }

    /// Takes the next line of any frame.
    fn take(&mut self) -> Result<FilledLine<'b, B>, CameraError<Infallible>> {
        let mut is_in_time = true;
        loop {
            if let Some(line) = self.pending.take().or_else(|| self.consumer.next()) {
                self.overruns = line.overruns();
                return Ok(line);
            }
            if !is_in_time {
                return Err(CameraError::TimedOut);
            }
            // A line that comes while the time ends has come.
            is_in_time = (self.wait)();
        }
    }
}

impl<F, const B: usize> ErrorType for HandedLines<'_, '_, F, B> {
    type Error = Infallible;
}

impl<F: FnMut() -> bool, const B: usize> LineSource for HandedLines<'_, '_, F, B> {
    fn format(&self) -> LineFormat {
        self.format
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        self.is_over = true;
        // What is left of the frame before goes: its lines and as many that come meanwhile, but not without
        // an end.
        for _ in 0..=2 * u32::from(self.format.height) {
            let line = self.take()?;
            if self.frame != Some(line.frame()) {
                let frame = line.frame();
                (self.frame, self.is_over) = (Some(frame), false);
                self.pending = Some(line);
                return Ok(frame);
            }
            self.consumer.done(line);
        }
        Err(CameraError::LostSync)
    }

    fn next_line(&mut self, to: &mut [u8]) -> Result<LineStart, CameraError<Infallible>> {
        let needed = self.format.line_bytes();
        let Some(to) = to.get_mut(..needed) else { return Err(CameraError::BufferTooShort { needed }) };
        if self.is_over {
            return Err(CameraError::NoLineLeft);
        }
        let line = self.take()?;
        if self.frame != Some(line.frame()) {
            // The next frame has begun: this one was short.
            self.pending = Some(line);
            self.is_over = true;
            return Err(CameraError::NoLineLeft);
        }
        to.iter_mut().zip(line.bytes()).for_each(|(to, &from)| *to = from);
        let start = line.start();
        self.consumer.done(line);
        self.is_over = start.row.saturating_add(1) >= self.format.height;
        Ok(start)
    }
}
