//! Rows of winners that something else computes, taken from C: the second half of a method.
#![allow(unsafe_code)]

use super::instance::{give, write_sigma_px};
use super::state::{Content, State, checked, kind};
use super::status::either;
use super::winner::CWinner;
use super::{CConfig, CRow, Instance, Status};
use crate::matching::{self, Capacity, External, Method, Supported, WinnerRecord};
use crate::pipeline::winners::{
    WinnerError, WinnerPipeline, WinnerPipelineError, WinnerSearch, WinnerSource,
};
use core::convert::Infallible;
use core::ffi::c_void;

/// Second half of a matcher in the caller's memory, which takes rows of winners.
pub struct WinnersHandle {
    _opaque: [u8; 0],
}

/// Bytes beside the arrays.
const FIXED_BYTES: usize = 192;

/// Returns the bytes of memory that are enough for the second half of any method, on any target.
pub const fn winners_bytes(width: usize, disparities: usize) -> usize {
    let line = 5 + WinnerRecord::BYTES;
    matching::array_bytes::<External<matching::Block>>(width, disparities) + line * width + FIXED_BYTES
}

impl<S: Method, const W: usize, const D: usize> Content for WinnerPipeline<S, W, D>
where
    External<S>: Method,
    Capacity<D>: Supported,
{
    type Handle = WinnersHandle;
    const NEW: Self = Self::new();
    const KIND: usize = kind(S::NAME, &[W, D, WinnerRecord::BYTES]);
    const MOST_BYTES: usize = winners_bytes(W, D);
}

/// The winners of one call, as a device that has this row and no other.
struct Given<'a>(Option<&'a [WinnerRecord]>);

impl WinnerSource for Given<'_> {
    type Error = Infallible;

    fn start(&mut self, _: &WinnerSearch) -> Result<(), WinnerError<Infallible>> {
        Ok(())
    }

    fn begin_frame(&mut self) -> Result<(), WinnerError<Infallible>> {
        Ok(())
    }

    fn push_lines(&mut self, _: &[u8], _: &[u8]) -> Result<(), WinnerError<Infallible>> {
        Ok(())
    }

    fn next_row(&mut self, row: u16, to: &mut [WinnerRecord]) -> Result<(), WinnerError<Infallible>> {
        let given = self.0.take().ok_or(WinnerError::Late { row })?;
        to.iter_mut().zip(given).for_each(|(to, from)| *to = *from);
        Ok(())
    }
}

impl From<WinnerPipelineError<Infallible>> for Status {
    fn from(e: WinnerPipelineError<Infallible>) -> Self {
        match e {
            WinnerPipelineError::Push(e) => e.into(),
            WinnerPipelineError::Config(e) => e.into(),
            // A row that was left out is replaced, and the source has no other error.
            WinnerPipelineError::Source(_) => Self::Winners,
        }
    }
}

type Half<S, const W: usize, const D: usize> = State<WinnerPipeline<S, W, D>>;

impl<S: Method, const W: usize, const D: usize> Instance<S, W, D>
where
    External<S>: Method,
    Capacity<D>: Supported,
{
    /// Returns the bytes that the second half of a matcher takes.
    pub const fn winners_size() -> usize {
        size_of::<Half<S, W, D>>()
    }

    /// Returns the delay of a row from the line that goes in with its last winners, lines.
    pub const fn winners_latency() -> usize {
        WinnerPipeline::<S, W, D>::LATENCY
    }

    /// Creates the second half of a matcher in the caller's memory, which is not read.
    ///
    /// # Safety
    ///
    /// `memory` is null or points to `length` bytes that nothing else uses until it is given up; `handle` is
    /// null or points to a pointer.
    pub unsafe fn winners_init(
        memory: *mut c_void,
        length: usize,
        handle: *mut *mut WinnersHandle,
    ) -> Status {
        // SAFETY: the caller's promise.
        unsafe { Half::<S, W, D>::init_handle(memory, length, false, handle) }
    }

    /// Gives the memory up.
    ///
    /// # Safety
    ///
    /// `handle` is null or from [`Self::winners_init`], and no other call uses it at the same time.
    pub unsafe fn winners_deinit(handle: *mut WinnersHandle) -> Status {
        // SAFETY: the caller's promise.
        unsafe { Half::<S, W, D>::deinit(handle) }
    }

    /// Checks a configuration, prepares for the first frame, and writes what the checks look at.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::winners_deinit`] asks; the others are null or point to a value.
    pub unsafe fn winners_start(
        handle: *mut WinnersHandle,
        config: *const CConfig,
        needs_lines: *mut u8,
        needs_second: *mut u8,
    ) -> Status {
        let start = || {
            checked(config)?;
            checked(needs_lines)?;
            checked(needs_second)?;
            // SAFETY: the caller's promise, it is aligned, and every bit pattern is a configuration.
            let (state, config) = unsafe { (Half::<S, W, D>::open(handle)?, config.read()) };
            if state.overlaps(needs_lines, 1)
                || state.overlaps(needs_second, 1)
                || needs_lines == needs_second
            {
                return Err(Status::Overlap);
            }
            let config = config.checked()?;
            config.check(W, D).map_err(WinnerPipelineError::Config)?;
            let pipeline = &mut state.content;
            pipeline.set_most_lost(u16::MAX);
            pipeline.start(&config, &mut Given(None))?;
            let needs = [pipeline.matcher().needs_lines(), pipeline.matcher().needs_second_best()];
            // SAFETY: the caller's promise, and both are apart from the state.
            unsafe {
                needs_lines.write(needs[0].into());
                needs_second.write(needs[1].into());
            }
            Ok(Status::Ok)
        };
        either(start())
    }

    /// Begins a frame.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::winners_deinit`] asks.
    pub unsafe fn winners_begin_frame(handle: *mut WinnersHandle) -> Status {
        // SAFETY: the caller's promise.
        let state = unsafe { Half::<S, W, D>::open(handle) };
        either(state.and_then(|state| Ok(state.content.begin_frame(&mut Given(None)).map(|()| Status::Ok)?)))
    }

    /// Writes the row whose winners the next call takes.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::winners_deinit`] asks; `row` is null or points to a number.
    pub unsafe fn winners_due(handle: *mut WinnersHandle, row: *mut u16) -> Status {
        let due = || {
            checked(row)?;
            // SAFETY: the caller's promise.
            let state = unsafe { Half::<S, W, D>::open(handle) }?;
            if state.overlaps(row, 1) {
                return Err(Status::Overlap);
            }
            let Some(due) = state.content.winners_due()? else { return Ok(Status::NoRowYet) };
            // SAFETY: the caller's promise, and it is apart from the state.
            unsafe { row.write(due) };
            Ok(Status::Ok)
        };
        either(due())
    }

    /// Takes the next line of the left camera where there `is_line`, and the winners that are due with it.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::winners_deinit`] asks; `left` is null or points to `length` bytes, `winners` is
    /// null or points to `count` winners, `row` is null or points to a row's bytes.
    pub unsafe fn winners_take(
        handle: *mut WinnersHandle,
        line: Option<(*const u8, usize)>,
        winners: *const CWinner,
        count: usize,
        row: *mut CRow,
    ) -> Status {
        let take = || {
            checked(row)?;
            // SAFETY: the caller's promise.
            let state = unsafe { Half::<S, W, D>::open(handle) }?;
            let width = usize::from(state.content.config().width);
            let due = state.content.winners_due()?;
            let (left, length) = line.unwrap_or((core::ptr::null(), width));
            // Only the right length makes a slice: any other might be longer than a slice can be.
            if length != width {
                return Err(Status::LineLength);
            }
            if line.is_some() && left.is_null() && state.content.matcher().needs_lines() {
                return Err(Status::Null);
            }
            if !winners.is_null() && (due.is_none() || count != width) {
                return Err(Status::Winners);
            }
            if state.overlaps(left, length) || state.overlaps(winners, count) || state.overlaps(row, 1) {
                return Err(Status::Overlap);
            }
            let left = if left.is_null() {
                &[][..]
            } else {
                // SAFETY: the caller's promise, and it is apart from the state.
                unsafe { core::slice::from_raw_parts(left, width) }
            };
            // SAFETY: the caller's promise, and it is apart from the state; a winner is a record's bytes.
            let given = (!winners.is_null())
                .then(|| unsafe { core::slice::from_raw_parts(winners.cast::<WinnerRecord>(), width) });
            if let (Some(given), Some(due)) = (given, due) {
                if !given.iter().all(|winner| winner.is_intact(due)) {
                    return Err(Status::WinnerDamaged);
                }
                state.content.matcher().check_winners(given)?;
            }
            let pipeline = &mut state.content;
            let (goes_on, without) = match line {
                Some(_) => (pipeline.take_line(left, &mut Given(given))?, Status::NoRowYet),
                None if pipeline.advance(&mut Given(given))? => (true, Status::NoRowYet),
                None => (false, Status::FrameDone),
            };
            let found = if goes_on { pipeline.matcher().row() } else { None };
            // SAFETY: the caller's promise, and the row is apart from the state.
            Ok(unsafe { give(row, found, without) })
        };
        either(take())
    }

    /// Writes the standard deviations of the last row, px.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::winners_deinit`] asks; `sigma_px` is null or points to `count` floats.
    pub unsafe fn winners_sigma_px(handle: *mut WinnersHandle, sigma_px: *mut f32, count: usize) -> Status {
        let write = || {
            checked(sigma_px)?;
            // SAFETY: the caller's promise.
            let state = unsafe { Half::<S, W, D>::open(handle) }?;
            if state.content.config().width == 0 {
                return Err(Status::NotStarted);
            }
            if state.overlaps(sigma_px, count) {
                return Err(Status::Overlap);
            }
            let row = state.content.matcher().row().ok_or(Status::NoRowYet)?;
            // SAFETY: the caller's promise, and the floats are apart from the state.
            unsafe { write_sigma_px(&row, sigma_px, count) }
        };
        either(write())
    }
}
