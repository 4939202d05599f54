//! Corners with descriptors in C: a detector in the caller's memory.
#![allow(unsafe_code)]

use super::Status;
use super::detection::{CDetection, CDetectionCounts};
use super::state::{Content, State, any_shared, checked, kind, share_bytes};
use super::status::either;
use crate::features::{
    CornerSlot, Descriptor, Feature, FeatureCounts, FeatureDetectorState, FeatureDetectorView,
    FeatureLineError,
};
use core::ffi::c_void;
use core::mem::offset_of;
use core::slice::{from_raw_parts, from_raw_parts_mut};

/// Detector of features in the caller's memory.
pub struct DetectorHandle {
    _opaque: [u8; 0],
}

/// A corner that can be found again.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(C)]
pub struct CFeature {
    /// What it looks like: 256 bits, in as many of which as possible other corners differ.
    pub descriptor: [u32; 8],
    /// Column, px.
    pub x_px: f32,
    /// Row, px.
    pub y_px: f32,
    /// How strong the corner is.
    pub score: u8,
    /// Level of the picture in a pyramid: 0 is the full picture.
    pub level: u8,
}

/// The type of C and the feature of Rust have the same fields in the same places, which may have any bits.
const _: () = assert!(
    size_of::<CFeature>() == size_of::<Feature>()
        && align_of::<CFeature>() == align_of::<Feature>()
        && offset_of!(CFeature, x_px) == offset_of!(Feature, x_px)
        && offset_of!(CFeature, y_px) == offset_of!(Feature, y_px)
        && offset_of!(CFeature, score) == offset_of!(Feature, score)
        && offset_of!(CFeature, level) == offset_of!(Feature, level)
        && offset_of!(CFeature, descriptor) == offset_of!(Feature, descriptor)
        && size_of::<Descriptor>() == size_of::<[u32; 8]>()
);

/// A detector: behind it come its slots, then its lines.
pub(super) struct Detector {
    state: FeatureDetectorState,
    width: usize,
    slots: usize,
    is_started: bool,
}

impl Content for Detector {
    type Handle = DetectorHandle;
    const NEW: Self = Self { state: FeatureDetectorState::new(), width: 0, slots: 0, is_started: false };
    const KIND: usize = kind("detector", &[]);
    const MOST_BYTES: usize = FIXED_BYTES;
}

/// Bytes of a detector beside its lines and slots, on any target.
const FIXED_BYTES: usize = 64;
/// Bytes of two rows of cells for each slot of one.
const SLOT_BYTES: usize = 2 * size_of::<CornerSlot>();
const _: () = assert!(align_of::<CornerSlot>() <= align_of::<State<Detector>>());

/// Returns the bytes of memory that are enough for a detector on any target, as the macro
/// `STEREOPSIS_DETECTOR_BYTES` does.
pub const fn detector_bytes(width: usize, slots: usize) -> usize {
    FIXED_BYTES + slots * SLOT_BYTES + width * FeatureDetectorView::LINE_BYTES
}

impl From<FeatureLineError> for Status {
    fn from(e: FeatureLineError) -> Self {
        match e {
            FeatureLineError::NoLineDue => Self::NoLineLeft,
            FeatureLineError::Length { .. } => Self::LineLength,
        }
    }
}

/// Creates a detector, as `stereopsis_detector_init`.
///
/// # Safety
///
/// `memory` is null or points to `length` bytes that nothing else uses until the detector is given up;
/// `handle` is null or points to a pointer.
pub unsafe fn detector_init(
    memory: *mut c_void,
    length: usize,
    [width, slots]: [u16; 2],
    handle: *mut *mut DetectorHandle,
) -> Status {
    let (width, slots) = (usize::from(width), usize::from(slots));
    let content = Detector { width, slots, ..Detector::NEW };
    let tail = slots * SLOT_BYTES + width * FeatureDetectorView::LINE_BYTES;
    // SAFETY: the caller's promise.
    unsafe { State::<Detector>::init_with_tail(memory, length, Ok((content, tail)), handle) }
}

/// Gives the memory up.
///
/// # Safety
///
/// `handle` is null or from [`detector_init`], and no other call uses it at the same time.
pub unsafe fn detector_deinit(handle: *mut DetectorHandle) -> Status {
    // SAFETY: the caller's promise.
    unsafe { State::<Detector>::deinit(handle) }
}

impl Detector {
    /// Returns whether the bytes at `data` are part of the detector at a handle.
    fn overlaps(&self, handle: *mut DetectorHandle, data: *const c_void, length: usize) -> bool {
        let tail = self.slots * SLOT_BYTES + self.width * FeatureDetectorView::LINE_BYTES;
        share_bytes(handle.cast(), size_of::<State<Self>>() + tail, data, length)
    }

    /// Returns the view of the detector at its handle.
    ///
    /// # Safety
    ///
    /// The handle is this detector's, whose memory nothing else uses for `'a`.
    unsafe fn view<'a>(&'a mut self, handle: *mut DetectorHandle) -> Result<FeatureDetectorView<'a>, Status> {
        // SAFETY: the memory holds slots and lines behind the state, as `init` has counted and cleared them;
        // a slot of zeros is an empty one.
        let (slots, lines) = unsafe {
            let slots = handle.cast::<State<Self>>().add(1).cast::<CornerSlot>();
            let lines = slots.add(2 * self.slots).cast::<u8>();
            (
                from_raw_parts_mut(slots, 2 * self.slots),
                from_raw_parts_mut(lines, self.width * FeatureDetectorView::LINE_BYTES),
            )
        };
        Ok(FeatureDetectorView::new(&mut self.state, lines, slots)?)
    }
}

/// Begins a frame, as `stereopsis_detector_start`.
///
/// # Safety
///
/// `handle` is as [`detector_deinit`] asks; `config` is null or points to a configuration.
pub unsafe fn detector_start(handle: *mut DetectorHandle, config: *const CDetection) -> Status {
    let start = || {
        checked(config)?;
        // SAFETY: the caller's promise, it is aligned, and every bit pattern is a configuration.
        let (detector, config) = unsafe { (&mut State::<Detector>::open(handle)?.content, config.read()) };
        // SAFETY: the caller's promise.
        unsafe { detector.view(handle) }?.start(&config.into())?;
        detector.is_started = true;
        Ok(Status::Ok)
    };
    either(start())
}

/// Takes the next line, as `stereopsis_detector_push`.
///
/// # Safety
///
/// `handle` is as [`detector_deinit`] asks; `line` is null or points to `length` bytes, `features` to
/// `capacity` features, and `count` to a number.
pub unsafe fn detector_push(
    handle: *mut DetectorHandle,
    line: *const u8,
    length: usize,
    features: *mut CFeature,
    capacity: usize,
    count: *mut usize,
) -> Status {
    let push = || {
        checked(line)?;
        checked(features)?;
        checked(count)?;
        if capacity > isize::MAX as usize / size_of::<CFeature>() || length > usize::from(u16::MAX) {
            return Err(Status::TooMany);
        }
        // SAFETY: the caller's promise.
        let detector = &mut unsafe { State::<Detector>::open(handle) }?.content;
        let bytes = capacity * size_of::<CFeature>();
        let arrays = [
            (line.cast(), length),
            (features.cast_const().cast(), bytes),
            (count.cast_const().cast(), size_of::<usize>()),
        ];
        let is_inside = |&(array, length): &_| detector.overlaps(handle, array, length);
        if arrays.iter().any(is_inside) || any_shared(&arrays, &[]) {
            return Err(Status::Overlap);
        }
        if !detector.is_started {
            return Err(Status::NotStarted);
        }
        // SAFETY: the caller's promise, and it is aligned.
        let mut found = unsafe { count.read() };
        if found > capacity {
            return Err(Status::TooMany);
        }
        let mut keep = |feature: Feature| {
            let has_room = found < capacity;
            if has_room {
                // SAFETY: the caller's promise, and features are apart from all else.
                unsafe { features.cast::<Feature>().add(found).write(feature) };
                found += 1;
            }
            has_room
        };
        // SAFETY: the caller's promise, and the line is apart from the detector.
        let line = unsafe { from_raw_parts(line, length) };
        // SAFETY: the caller's promise.
        unsafe { detector.view(handle) }?.push_into(line, &mut keep)?;
        // SAFETY: as above.
        unsafe { count.write(found) };
        Ok(Status::Ok)
    };
    either(push())
}

/// Writes what became of the corners, as `stereopsis_detector_counts`.
///
/// # Safety
///
/// `handle` is as [`detector_deinit`] asks; `counts` is null or points to counts' bytes.
pub unsafe fn detector_counts(handle: *mut DetectorHandle, counts: *mut CDetectionCounts) -> Status {
    let write = || {
        checked(counts)?;
        // SAFETY: the caller's promise.
        let detector = &mut unsafe { State::<Detector>::open(handle) }?.content;
        if detector.overlaps(handle, counts.cast_const().cast(), size_of::<CDetectionCounts>()) {
            return Err(Status::Overlap);
        }
        let FeatureCounts { corners, crowded_out, dropped } = detector.state.counts();
        // SAFETY: the caller's promise; it is aligned and apart from the detector.
        unsafe { counts.write(CDetectionCounts { corners, crowded_out, dropped }) };
        Ok(Status::Ok)
    };
    either(write())
}
