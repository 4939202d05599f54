//! Stereo odometry in C: the motion of a rectified pair from frame to frame, in the caller's memory.
#![allow(unsafe_code)]

use super::features::CFeature;
use super::odometry_types::{COdometryConfig, CPicture, CStep, picture_of};
use super::rig::rig_at;
use super::state::{Content, State, checked, kind, share_bytes};
use super::status::either;
use super::{CRig, Status};
use crate::features::Feature;
use crate::geometry::absolute::Landmark;
use crate::motion::odometry::{Frame, OdometryRig, OdometryState, OdometryView, PointMatch, Track};
use core::ffi::c_void;
use core::slice::{from_raw_parts, from_raw_parts_mut};
use nalgebra::{Point2, Point3};

/// Odometry in the caller's memory.
pub struct OdometryHandle {
    _opaque: [u8; 0],
}

/// An odometry: behind it come tracks, matches, landmarks, partners and flags, one of each for every point.
pub(super) struct Odometry {
    state: OdometryState<f32>,
    points: usize,
}

impl Content for Odometry {
    type Handle = OdometryHandle;
    const NEW: Self = Self { state: OdometryState::new(), points: 0 };
    const KIND: usize = kind("odometry", &[]);
    const MOST_BYTES: usize = FIXED_BYTES;
}

/// Bytes of an odometry beside its points, on any target.
const FIXED_BYTES: usize = 504;
/// Bytes of a point, on any target.
const POINT_BYTES: usize = size_of::<Track<f32>>()
    + size_of::<PointMatch<f32>>()
    + size_of::<Landmark<f32>>()
    + size_of::<(u16, u16)>()
    + 1;
const _: () = {
    assert!(align_of::<State<Odometry>>() >= align_of::<Track<f32>>());
    assert!(align_of::<Track<f32>>() >= align_of::<PointMatch<f32>>());
    assert!(align_of::<PointMatch<f32>>() >= align_of::<Landmark<f32>>());
    assert!(align_of::<Landmark<f32>>() >= align_of::<(u16, u16)>());
};

/// Returns the bytes of memory that are enough for an odometry on any target, as the macro
/// `STEREOPSIS_ODOMETRY_BYTES` does.
pub const fn odometry_bytes(points: usize) -> usize {
    FIXED_BYTES + points * POINT_BYTES
}

/// Where the parts of an odometry's points begin.
struct Parts {
    tracks: *mut Track<f32>,
    matches: *mut PointMatch<f32>,
    landmarks: *mut Landmark<f32>,
    partners: *mut (u16, u16),
    inliers: *mut bool,
}

impl Parts {
    /// Returns the parts of the memory behind a state.
    ///
    /// # Safety
    ///
    /// The memory is there.
    unsafe fn of(state: *mut State<Odometry>, points: usize) -> Self {
        // SAFETY: the caller's promise.
        unsafe {
            let tracks = state.add(1).cast::<Track<f32>>();
            let matches = tracks.add(points).cast::<PointMatch<f32>>();
            let landmarks = matches.add(points).cast::<Landmark<f32>>();
            let partners = landmarks.add(points).cast::<(u16, u16)>();
            let inliers = partners.add(points).cast::<bool>();
            Self { tracks, matches, landmarks, partners, inliers }
        }
    }
}

/// Creates an odometry, as `stereopsis_odometry_init`.
///
/// # Safety
///
/// `memory` is null or points to `length` bytes that nothing else uses until the odometry is given up;
/// `handle` is null or points to a pointer.
pub unsafe fn odometry_init(
    memory: *mut c_void,
    length: usize,
    points: u16,
    handle: *mut *mut OdometryHandle,
) -> Status {
    let count = usize::from(points);
    let content = if (16..=65534).contains(&points) {
        Ok((Odometry { points: count, ..Odometry::NEW }, count * POINT_BYTES))
    } else {
        Err(Status::OdometryPoints)
    };
    // SAFETY: the caller's promise.
    let status = unsafe { State::<Odometry>::init_with_tail(memory, length, content, handle) };
    if status == Status::Ok {
        let landmark = Landmark { world: Point3::new(0.0, 0.0, 0.0), pixel: Point2::new(0.0, 0.0) };
        // SAFETY: the state was made with as much memory behind it. Partners and flags are 0 already.
        unsafe {
            let Parts { tracks, matches, landmarks, .. } = Parts::of(memory.cast(), count);
            for i in 0..count {
                tracks.add(i).write(Track::EMPTY);
                matches.add(i).write(PointMatch::EMPTY);
                landmarks.add(i).write(landmark);
            }
        }
    }
    status
}

/// Gives the memory up.
///
/// # Safety
///
/// `handle` is null or from [`odometry_init`], and no other call uses it at the same time.
pub unsafe fn odometry_deinit(handle: *mut OdometryHandle) -> Status {
    // SAFETY: the caller's promise.
    unsafe { State::<Odometry>::deinit(handle) }
}

impl Odometry {
    /// Returns the view of the odometry at its handle.
    ///
    /// # Safety
    ///
    /// The handle is this odometry's, whose memory nothing else uses for `'a`.
    unsafe fn view<'a>(&'a mut self, handle: *mut OdometryHandle) -> Result<OdometryView<'a, f32>, Status> {
        let points = self.points;
        // SAFETY: `init` has filled all parts, and the state is apart from them.
        unsafe {
            let parts = Parts::of(handle.cast(), points);
            Ok(OdometryView::new(
                &mut self.state,
                from_raw_parts_mut(parts.tracks, points),
                from_raw_parts_mut(parts.matches, points),
                from_raw_parts_mut(parts.landmarks, points),
                from_raw_parts_mut(parts.inliers, points),
                from_raw_parts_mut(parts.partners, points),
                &mut [],
            )?)
        }
    }
}

/// Begins with a rig, as `stereopsis_odometry_start`.
///
/// # Safety
///
/// `handle` is as [`odometry_deinit`] asks; `rig` is null or points to a rig, `config` to a configuration.
pub unsafe fn odometry_start(
    handle: *mut OdometryHandle,
    rig: *const CRig,
    config: *const COdometryConfig,
) -> Status {
    let start = || {
        checked(config)?;
        // SAFETY: the caller's promise, they are aligned, and any bits are numbers.
        let (rig, config) = unsafe { (OdometryRig::stereo(&rig_at(rig)?)?, config.read()) };
        // SAFETY: the caller's promise.
        unsafe { State::<Odometry>::open(handle)?.content.view(handle) }?.start(rig, config.into())?;
        Ok(Status::Ok)
    };
    either(start())
}

/// Takes the next frame, as `stereopsis_odometry_step`.
///
/// # Safety
///
/// `handle` is as [`odometry_deinit`] asks; `left` and `right` are null or point to pictures whose pixels are
/// null or there, `features` is null or points to `count` features, `step` to a step's bytes.
pub unsafe fn odometry_step(
    handle: *mut OdometryHandle,
    [left, right]: [*const CPicture; 2],
    features: *const CFeature,
    count: usize,
    step: *mut CStep,
) -> Status {
    let run = || {
        checked(features)?;
        checked(step)?;
        if count > isize::MAX as usize / size_of::<CFeature>() {
            return Err(Status::TooMany);
        }
        // SAFETY: the caller's promise.
        let (left, right) = unsafe { (picture_of(left)?, picture_of(right)?) };
        // SAFETY: the caller's promise.
        let odometry = &mut unsafe { State::<Odometry>::open(handle) }?.content;
        let bytes = size_of::<State<Odometry>>() + odometry.points * POINT_BYTES;
        let is_inside = |data: *const c_void, length| share_bytes(handle.cast(), bytes, data, length);
        let pixels = |picture: &crate::imaging::Picture<'_>| {
            let all = picture.run(0, 0, picture.width()).unwrap_or_default();
            is_inside(all.as_ptr().cast(), picture.width() * picture.height())
        };
        if is_inside(features.cast(), count * size_of::<CFeature>())
            || is_inside(step.cast_const().cast(), size_of::<CStep>())
            || pixels(&left)
            || pixels(&right)
        {
            return Err(Status::Overlap);
        }
        // SAFETY: the caller's promise; a feature may have any bits.
        let features = unsafe { from_raw_parts(features.cast::<Feature>(), count) };
        // SAFETY: the caller's promise; everything else is apart from the memory.
        let found = unsafe { odometry.view(handle) }?.step(&Frame { left, right: Some(right), features })?;
        // SAFETY: the caller's promise; it is aligned and apart from the memory.
        unsafe { step.write(found.into()) };
        Ok(Status::Ok)
    };
    either(run())
}
