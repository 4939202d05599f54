//! Obstacles, ground and free space in C: a finder in the caller's memory.
#![allow(unsafe_code)]

use super::obstacles_config::CObstacleConfig;
use super::rig::scale_of;
use super::state::{Content, State, checked, kind, share_bytes};
use super::status::either;
use super::{CRig, Status};
use crate::obstacles::{Column, Filling, Interval, ObstaclesState, ObstaclesView};
use crate::units::Disparity;
use core::ffi::c_void;
use core::slice::from_raw_parts_mut;

/// Finder of obstacles in the caller's memory.
pub struct ObstaclesHandle {
    _opaque: [u8; 0],
}

/// A finder: behind it come what each row of cells shows of the ground, what each column has, the cells, and
/// the labels of a column.
pub(super) struct Finder {
    state: ObstaclesState,
    columns: usize,
    rows: usize,
    /// Pixels of a row that fill cells, and rows of a picture; 0 before a start.
    pub(super) width: usize,
    pub(super) height: u16,
    /// The next row of pixels.
    pub(super) next: u16,
    pub(super) is_begun: bool,
}

impl Content for Finder {
    type Handle = ObstaclesHandle;
    const NEW: Self = Self {
        state: ObstaclesState::new(),
        columns: 0,
        rows: 0,
        width: 0,
        height: 0,
        next: 0,
        is_begun: false,
    };
    const KIND: usize = kind("obstacles", &[]);
    const MOST_BYTES: usize = FIXED_BYTES;
}

/// Bytes of a finder beside its cells, on any target.
const FIXED_BYTES: usize = 272;
const COLUMN_BYTES: usize = size_of::<Column>() + size_of::<Filling>() + size_of::<i16>();
const ROW_BYTES: usize = size_of::<Interval>() + 1;
const _: () = {
    assert!(align_of::<State<Finder>>() >= align_of::<Interval>());
    assert!(align_of::<Interval>() >= align_of::<Column>());
    assert!(align_of::<Column>() >= align_of::<Filling>());
    assert!(align_of::<Filling>() >= align_of::<Disparity>());
    assert!(align_of::<Disparity>() == align_of::<i16>());
};

/// Returns the bytes of memory that are enough for a finder on any target, as the macro
/// `STEREOPSIS_OBSTACLES_BYTES` does.
pub const fn obstacles_bytes(columns: usize, rows: usize) -> usize {
    FIXED_BYTES + tail_bytes(columns, rows)
}

const fn tail_bytes(columns: usize, rows: usize) -> usize {
    columns * COLUMN_BYTES + rows * ROW_BYTES + columns * rows * size_of::<Disparity>()
}

impl Finder {
    /// Returns the view of the finder at its handle.
    ///
    /// # Safety
    ///
    /// The handle is this finder's, whose memory nothing else uses for `'a`.
    pub(super) unsafe fn view<'a>(&'a mut self, handle: *mut ObstaclesHandle) -> ObstaclesView<'a> {
        let Self { columns, rows, .. } = *self;
        let cells = columns * rows;
        // SAFETY: the memory holds all of them behind the state, as `init` has counted and cleared them:
        // zeros are columns that show nothing, cells that are empty, disparities and numbers.
        unsafe {
            let intervals = handle.cast::<State<Self>>().add(1).cast::<Interval>();
            let first = intervals.add(rows).cast::<Column>();
            let filling = first.add(columns).cast::<Filling>();
            let disparities = filling.add(columns).cast::<Disparity>();
            let bearings = disparities.add(cells).cast::<i16>();
            let labels = bearings.add(columns).cast::<u8>();
            ObstaclesView::new(
                &mut self.state,
                from_raw_parts_mut(disparities, cells),
                from_raw_parts_mut(filling, columns),
                from_raw_parts_mut(intervals, rows),
                from_raw_parts_mut(first, columns),
                from_raw_parts_mut(labels, rows),
                from_raw_parts_mut(bearings, columns),
            )
        }
    }

    /// Returns whether the bytes at `data` are part of the finder at a handle.
    pub(super) fn overlaps(&self, handle: *mut ObstaclesHandle, data: *const c_void, length: usize) -> bool {
        let bytes = size_of::<State<Self>>() + tail_bytes(self.columns, self.rows);
        share_bytes(handle.cast(), bytes, data, length)
    }

    /// Returns the finder at a handle, which was started and is apart from an argument.
    ///
    /// # Safety
    ///
    /// `handle` is as [`obstacles_deinit`] asks.
    pub(super) unsafe fn open<'a>(
        handle: *mut ObstaclesHandle,
        data: *const c_void,
        length: usize,
    ) -> Result<&'a mut Self, Status> {
        // SAFETY: the caller's promise.
        let finder = &mut unsafe { State::<Self>::open(handle) }?.content;
        if finder.overlaps(handle, data, length) {
            return Err(Status::Overlap);
        }
        if finder.width > 0 { Ok(finder) } else { Err(Status::NotStarted) }
    }
}

/// Returns the view of the finder at a handle, which was started and is apart from an argument.
///
/// # Safety
///
/// `handle` is as [`obstacles_deinit`] asks, and nothing else uses its memory for `'a`.
pub(super) unsafe fn view_at<'a>(
    handle: *mut ObstaclesHandle,
    data: *const c_void,
    length: usize,
) -> Result<ObstaclesView<'a>, Status> {
    // SAFETY: the caller's promise.
    Ok(unsafe { Finder::open(handle, data, length)?.view(handle) })
}

/// Creates a finder, as `stereopsis_obstacles_init`.
///
/// # Safety
///
/// `memory` is null or points to `length` bytes that nothing else uses until the finder is given up; `handle`
/// is null or points to a pointer.
pub unsafe fn obstacles_init(
    memory: *mut c_void,
    length: usize,
    [columns, rows]: [u16; 2],
    handle: *mut *mut ObstaclesHandle,
) -> Status {
    let content = if columns > 0 && (1..=255).contains(&rows) {
        let (columns, rows) = (usize::from(columns), usize::from(rows));
        Ok((Finder { columns, rows, ..Finder::NEW }, tail_bytes(columns, rows)))
    } else {
        Err(Status::ObstacleSize)
    };
    // SAFETY: the caller's promise.
    unsafe { State::<Finder>::init_with_tail(memory, length, content, handle) }
}

/// Gives the memory up.
///
/// # Safety
///
/// `handle` is null or from [`obstacles_init`], and no other call uses it at the same time.
pub unsafe fn obstacles_deinit(handle: *mut ObstaclesHandle) -> Status {
    // SAFETY: the caller's promise.
    unsafe { State::<Finder>::deinit(handle) }
}

/// Starts on frames of a size from a rig, as `stereopsis_obstacles_start`.
///
/// # Safety
///
/// `handle` is as [`obstacles_deinit`] asks; `config` is null or points to a configuration, `rig` to a rig.
pub unsafe fn obstacles_start(
    handle: *mut ObstaclesHandle,
    config: *const CObstacleConfig,
    rig: *const CRig,
    [width, height]: [u16; 2],
    largest_px: u16,
) -> Status {
    let start = || {
        checked(config)?;
        // SAFETY: the caller's promise, it is aligned, and every bit pattern is a configuration.
        let (scale, config) = unsafe { (scale_of(rig)?, config.read().checked()?) };
        // SAFETY: the caller's promise.
        let finder = &mut unsafe { State::<Finder>::open(handle) }?.content;
        let largest = Disparity::from_pixels(largest_px);
        // SAFETY: the caller's promise; the view is dropped before the finder is changed.
        let columns = unsafe {
            let mut view = finder.view(handle);
            view.check(&config, &scale, [width, height], largest)?;
            view.start(&config, &scale, [width, height], largest)?;
            view.columns()
        };
        finder.width = columns * usize::from(config.cell_width);
        (finder.height, finder.next, finder.is_begun) = (height, 0, false);
        Ok(Status::Ok)
    };
    either(start())
}
