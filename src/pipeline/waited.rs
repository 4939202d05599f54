//! Rows that a task awaits: the pipeline is asked again whenever the interrupt has brought a line.

use super::error::CameraResult;
use super::{Guarded, Pipeline, PipelineError};
use crate::camera::{CameraError, FrameStart, LineListener, StereoSource};
use crate::matching::{Method, Row};
use core::future::Future;
use core::task::Poll;

// The futures are made by hand: one that the compiler makes of an `async fn` panics when it is polled after
// its end, and a firmware that may have no panic does not link with it.

impl<S: Method, const W: usize, const D: usize> Pipeline<S, W, D> {
    /// Awaits the camera's next frame, and drops the one before, as [`Self::begin_frame`] does.
    ///
    /// The source gives [`CameraError::WouldBlock`] where there is nothing yet, and `lines` hears from the
    /// interrupt that feeds it.
    pub fn begin_frame_async<C: StereoSource>(
        &mut self,
        camera: &mut C,
        lines: &mut LineListener<'_>,
    ) -> impl Future<Output = CameraResult<FrameStart, C>> {
        lines.until(move || pending(self.begin_frame(camera)))
    }

    /// Awaits the next row; `None` after the frame's last row. An error ends the frame.
    ///
    /// A future that is dropped before it is ready loses nothing: the next call goes on with the same row. A
    /// dead camera is the caller's to notice, by the executor's own time-out around this call. While there
    /// are lines, it works without giving way to other tasks: for a frame's first row on
    /// [`Self::LATENCY`] + 1 lines, then on a line a call.
    pub fn next_row_async<'p, C: StereoSource>(
        &'p mut self,
        camera: &mut C,
        lines: &mut LineListener<'_>,
    ) -> impl Future<Output = CameraResult<Option<Row<'p>>, C>> {
        lines.until(row(self, move |this| this.next_row(camera).map(|row| row.is_some()), Self::row))
    }
}

impl<S: Method, const W: usize, const D: usize> Guarded<S, W, D> {
    /// Awaits the camera's next frame, as [`Pipeline::begin_frame_async`] does.
    pub fn begin_frame_async<C: StereoSource>(
        &mut self,
        camera: &mut C,
        lines: &mut LineListener<'_>,
    ) -> impl Future<Output = CameraResult<FrameStart, C>> {
        lines.until(move || pending(self.begin_frame(camera)))
    }

    /// Awaits the next row, as [`Pipeline::next_row_async`] does; `None` after the frame's last row.
    pub fn next_row_async<'p, C: StereoSource>(
        &'p mut self,
        camera: &mut C,
        lines: &mut LineListener<'_>,
    ) -> impl Future<Output = CameraResult<Option<Row<'p>>, C>> {
        lines.until(row(self, move |this| this.next_row(camera).map(|row| row.is_some()), Self::row))
    }
}

/// Attempts of `next`, which says whether a row came out, up to the first that is an answer: then the row.
fn row<'p, P, E>(
    pipeline: &'p mut P,
    mut next: impl FnMut(&mut P) -> Result<bool, PipelineError<E>>,
    row: impl Fn(&'p P) -> Option<Row<'p>>,
) -> impl FnMut() -> Poll<Result<Option<Row<'p>>, PipelineError<E>>> {
    // Taken out with the answer: the row borrows it from then on.
    let mut held = Some(pipeline);
    move || {
        let Some(pipeline) = &mut held else { return Poll::Pending };
        pending(next(pipeline))
            .map_ok(|is_out| held.take().and_then(|pipeline| row(pipeline)).filter(|_| is_out))
    }
}

/// A result that is still to come where the source has nothing yet.
fn pending<T, E>(result: Result<T, PipelineError<E>>) -> Poll<Result<T, PipelineError<E>>> {
    match result {
        Err(PipelineError::Camera(CameraError::WouldBlock)) => Poll::Pending,
        result => Poll::Ready(result),
    }
}
