//! Depth from focus in C: a focus map in the caller's memory.
#![allow(unsafe_code)]

use super::Status;
use super::focus_types::{CFocusConfig, CFocusPeak};
use super::state::{Content, State, checked, kind, share_bytes};
use super::status::either;
use crate::focus::{Breathing, FocusCell, FocusMapState, FocusMapView};
use core::ffi::c_void;
use core::slice::{from_raw_parts, from_raw_parts_mut};

/// Focus map in the caller's memory.
pub struct FocusHandle {
    _opaque: [u8; 0],
}

/// A focus map: behind it come its cells, sums, rows, lines, and a flag for each cell of a row.
pub(super) struct Map {
    state: FocusMapState,
    width: usize,
    columns: usize,
    cells: usize,
    is_started: bool,
    is_finished: bool,
}

impl Content for Map {
    type Handle = FocusHandle;
    const NEW: Self = Self {
        state: FocusMapState::new(),
        width: 0,
        columns: 0,
        cells: 0,
        is_started: false,
        is_finished: false,
    };
    const KIND: usize = kind("focus map", &[]);
    const MOST_BYTES: usize = FIXED_BYTES;
}

/// Bytes of a map beside its cells and rows, on any target.
const FIXED_BYTES: usize = 104;
const CELL_BYTES: usize = size_of::<FocusCell>();
const COLUMN_BYTES: usize = 4 * FocusMapView::SUMS + 1;
const LINE_BYTES: usize = FocusMapView::LINES + 2 * FocusMapView::ROWS;
const _: () = assert!(align_of::<FocusCell>() <= 4 && align_of::<State<Map>>() >= 4);

/// Returns the bytes of memory that are enough for a focus map on any target, as the macro
/// `STEREOPSIS_FOCUS_BYTES` does.
pub const fn focus_bytes(width: usize, columns: usize, cells: usize) -> usize {
    FIXED_BYTES + tail_bytes(width, columns, cells)
}

const fn tail_bytes(width: usize, columns: usize, cells: usize) -> usize {
    cells * CELL_BYTES + columns * COLUMN_BYTES + width * LINE_BYTES
}

impl Map {
    /// Returns the view of the map at its handle, which is `started`.
    ///
    /// # Safety
    ///
    /// The handle is this map's, whose memory nothing else uses for `'a`.
    unsafe fn view<'a>(&'a mut self, handle: *mut FocusHandle) -> Result<FocusMapView<'a>, Status> {
        let Self { width, columns, cells, .. } = *self;
        // SAFETY: the memory holds all of them behind the state, as `init` has counted and cleared them:
        // zeros are cells, numbers and flags that are false.
        let (cells, sums, rows, lines, flags) = unsafe {
            let first = handle.cast::<State<Self>>().add(1).cast::<FocusCell>();
            let sums = first.add(cells).cast::<u32>();
            let rows = sums.add(columns * FocusMapView::SUMS).cast::<u16>();
            let lines = rows.add(width * FocusMapView::ROWS).cast::<u8>();
            let flags = lines.add(width * FocusMapView::LINES).cast::<bool>();
            (
                from_raw_parts_mut(first, cells),
                from_raw_parts_mut(sums, columns * FocusMapView::SUMS),
                from_raw_parts_mut(rows, width * FocusMapView::ROWS),
                from_raw_parts_mut(lines, width * FocusMapView::LINES),
                from_raw_parts_mut(flags, columns),
            )
        };
        Ok(FocusMapView::new(&mut self.state, lines, rows, sums, flags, cells)?)
    }

    /// Returns the map at a handle, which was started and is apart from an argument.
    ///
    /// # Safety
    ///
    /// `handle` is as [`focus_deinit`] asks.
    unsafe fn open<'a>(
        handle: *mut FocusHandle,
        data: *const c_void,
        length: usize,
    ) -> Result<&'a mut Self, Status> {
        // SAFETY: the caller's promise.
        let map = &mut unsafe { State::<Self>::open(handle) }?.content;
        let bytes = size_of::<State<Self>>() + tail_bytes(map.width, map.columns, map.cells);
        if share_bytes(handle.cast(), bytes, data, length) {
            return Err(Status::Overlap);
        }
        if map.is_started { Ok(map) } else { Err(Status::NotStarted) }
    }
}

/// Creates a focus map, as `stereopsis_focus_init`.
///
/// # Safety
///
/// `memory` is null or points to `length` bytes that nothing else uses until the map is given up; `handle` is
/// null or points to a pointer.
pub unsafe fn focus_init(
    memory: *mut c_void,
    length: usize,
    [width, columns]: [u16; 2],
    cells: u32,
    handle: *mut *mut FocusHandle,
) -> Status {
    let (width, columns) = (usize::from(width), usize::from(columns));
    let content = match usize::try_from(cells) {
        // The bytes of fewer cells than this are within an address space.
        Ok(cells) if cells < isize::MAX as usize / (2 * CELL_BYTES) => {
            let tail = tail_bytes(width, columns, cells);
            Ok((Map { width, columns, cells, ..Map::NEW }, tail))
        }
        _ => Err(Status::TooMany),
    };
    // SAFETY: the caller's promise.
    unsafe { State::<Map>::init_with_tail(memory, length, content, handle) }
}

/// Gives the memory up.
///
/// # Safety
///
/// `handle` is null or from [`focus_init`], and no other call uses it at the same time.
pub unsafe fn focus_deinit(handle: *mut FocusHandle) -> Status {
    // SAFETY: the caller's promise.
    unsafe { State::<Map>::deinit(handle) }
}

/// Begins a stack of frames, as `stereopsis_focus_start`.
///
/// # Safety
///
/// `handle` is as [`focus_deinit`] asks; `config` is null or points to a configuration.
pub unsafe fn focus_start(handle: *mut FocusHandle, config: *const CFocusConfig) -> Status {
    let start = || {
        checked(config)?;
        // SAFETY: the caller's promise, it is aligned, and every bit pattern is a configuration.
        let (map, config) = unsafe { (&mut State::<Map>::open(handle)?.content, config.read()) };
        // SAFETY: the caller's promise.
        unsafe { map.view(handle) }?.start(&config.into())?;
        (map.is_started, map.is_finished) = (true, false);
        Ok(Status::Ok)
    };
    either(start())
}

/// Begins the next frame, as `stereopsis_focus_begin_frame`.
///
/// # Safety
///
/// `handle` is as [`focus_deinit`] asks.
pub unsafe fn focus_begin_frame(handle: *mut FocusHandle, scale: f32) -> Status {
    let begin = || {
        let breathing = Breathing::new(scale)?;
        // SAFETY: the caller's promise.
        unsafe { Map::open(handle, core::ptr::null(), 0)?.view(handle) }?.begin_frame(breathing)?;
        Ok(Status::Ok)
    };
    either(begin())
}

/// Takes the next line, as `stereopsis_focus_push`.
///
/// # Safety
///
/// `handle` is as [`focus_deinit`] asks; `line` is null or points to `length` bytes.
pub unsafe fn focus_push(handle: *mut FocusHandle, line: *const u8, length: usize) -> Status {
    let push = || {
        checked(line)?;
        if length > usize::from(u16::MAX) {
            return Err(Status::LineLength);
        }
        // SAFETY: the caller's promise; the line is apart from the map.
        unsafe {
            Map::open(handle, line.cast(), length)?
                .view(handle)?
                .push(from_raw_parts(line, length), |_| ())?
        };
        Ok(Status::Ok)
    };
    either(push())
}

/// Ends the stack, as `stereopsis_focus_finish`.
///
/// # Safety
///
/// `handle` is as [`focus_deinit`] asks.
pub unsafe fn focus_finish(handle: *mut FocusHandle) -> Status {
    let finish = || {
        // SAFETY: the caller's promise.
        let map = unsafe { Map::open(handle, core::ptr::null(), 0) }?;
        // SAFETY: the caller's promise.
        unsafe { map.view(handle) }?.finish()?;
        map.is_finished = true;
        Ok(Status::Ok)
    };
    either(finish())
}

/// Writes the peaks of a row of cells, as `stereopsis_focus_row`.
///
/// # Safety
///
/// `handle` is as [`focus_deinit`] asks; `peaks` is null or points to `count` peaks' bytes.
pub unsafe fn focus_row(handle: *mut FocusHandle, row: u16, peaks: *mut CFocusPeak, count: usize) -> Status {
    let write = || {
        checked(peaks)?;
        if count > usize::from(u16::MAX) {
            return Err(Status::TooMany);
        }
        // SAFETY: the caller's promise.
        let map = unsafe { Map::open(handle, peaks.cast_const().cast(), count * size_of::<CFocusPeak>()) }?;
        if !map.is_finished {
            return Err(Status::FocusNotFinished);
        }
        // SAFETY: the caller's promise.
        let view = unsafe { map.view(handle) }?;
        for column in 0..count {
            let peak = CFocusPeak::from(view.peak(column, row.into()));
            // SAFETY: the caller's promise; the peaks are apart from the map.
            unsafe { peaks.add(column).write(peak) };
        }
        Ok(Status::Ok)
    };
    either(write())
}
