//! Rows that a task awaits: the pipeline is asked again whenever the interrupt has brought a line.

use super::{Guarded, Pipeline, PipelineError};
use crate::camera::{CameraError, FrameStart, LineListener, StereoSource};
use crate::matching::{Method, Row};
use core::task::Poll;

impl<S: Method, const W: usize, const D: usize> Pipeline<S, W, D> {
    /// Awaits the camera's next frame, and drops the one before, as [`Self::begin_frame`] does.
    ///
    /// The source gives [`CameraError::WouldBlock`] where there is nothing yet, and `lines` hears from the
    /// interrupt that feeds it.
    pub async fn begin_frame_async<C: StereoSource>(
        &mut self,
        camera: &mut C,
        lines: &mut LineListener<'_>,
    ) -> Result<FrameStart, PipelineError<C::Error>> {
        lines.until(|| pending(self.begin_frame(camera))).await
    }

    /// Awaits the next row; `None` after the frame's last row. An error ends the frame.
    ///
    /// A future that is dropped before it is ready loses nothing: the next call goes on with the same row. A
    /// dead camera is the caller's to notice, by the executor's own time-out around this call. While there
    /// are lines, it works without giving way to other tasks: for a frame's first row on
    /// [`Self::LATENCY`] + 1 lines, then on a line a call.
    pub async fn next_row_async<C: StereoSource>(
        &mut self,
        camera: &mut C,
        lines: &mut LineListener<'_>,
    ) -> Result<Option<Row<'_>>, PipelineError<C::Error>> {
        let is_out = lines.until(|| pending(self.next_row(camera).map(|row| row.is_some()))).await?;
        Ok(self.row().filter(|_| is_out))
    }
}

impl<S: Method, const W: usize, const D: usize> Guarded<S, W, D> {
    /// Awaits the camera's next frame, as [`Pipeline::begin_frame_async`] does.
    pub async fn begin_frame_async<C: StereoSource>(
        &mut self,
        camera: &mut C,
        lines: &mut LineListener<'_>,
    ) -> Result<FrameStart, PipelineError<C::Error>> {
        lines.until(|| pending(self.begin_frame(camera))).await
    }

    /// Awaits the next row, as [`Pipeline::next_row_async`] does; `None` after the frame's last row.
    pub async fn next_row_async<C: StereoSource>(
        &mut self,
        camera: &mut C,
        lines: &mut LineListener<'_>,
    ) -> Result<Option<Row<'_>>, PipelineError<C::Error>> {
        let is_out = lines.until(|| pending(self.next_row(camera).map(|row| row.is_some()))).await?;
        Ok(self.row().filter(|_| is_out))
    }
}

/// A result that is still to come where the source has nothing yet.
fn pending<T, E>(result: Result<T, PipelineError<E>>) -> Poll<Result<T, PipelineError<E>>> {
    match result {
        Err(PipelineError::Camera(CameraError::WouldBlock)) => Poll::Pending,
        result => Poll::Ready(result),
    }
}
