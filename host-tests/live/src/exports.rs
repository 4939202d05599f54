//! What the page calls. It has one thread and makes one call at a time.
#![allow(unsafe_code)]

use crate::session::{MOST_WIDTH, Planes, Session};
use crate::settings::Settings;
use core::arch::wasm32::{memory_grow, memory_size};
use core::cell::UnsafeCell;
use core::ptr::with_exposed_provenance_mut;
use core::slice::{from_raw_parts, from_raw_parts_mut};

/// Bytes of a page of memory.
const PAGE: usize = 1 << 16;
/// Bytes for a pixel: two of grey, flags, confidence, disparity (2), depth (2), deviation (4).
const PIXEL_BYTES: usize = 12;

#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// The time, ms.
    safe fn now() -> f64;
}

fn clock() -> f64 {
    now()
}

/// Everything that there is.
struct Whole {
    session: Session,
    /// Where the planes begin; 0 before there are any.
    planes: usize,
    width: u16,
    height: u16,
}

struct Held(UnsafeCell<Whole>);

// SAFETY: the page has one thread.
unsafe impl Sync for Held {}

static WHOLE: Held = Held(UnsafeCell::new(Whole { session: Session::new(), planes: 0, width: 0, height: 0 }));

fn whole() -> &'static mut Whole {
    // SAFETY: each export takes it once, and nothing that it calls comes back to an export: the page's clock
    // does not.
    unsafe { &mut *WHOLE.0.get() }
}

/// Bytes of a plane of one byte for each pixel: a multiple of four, so that planes of numbers are aligned.
fn plane_bytes(width: u16, height: u16) -> usize {
    (usize::from(width) * usize::from(height)).next_multiple_of(4)
}

impl Whole {
    fn planes(&self) -> Planes<'static> {
        let (width, height) = (self.width, self.height);
        let pixels = usize::from(width) * usize::from(height);
        let place = |bytes: usize| {
            with_exposed_provenance_mut::<u8>(self.planes + bytes * plane_bytes(width, height))
        };
        // SAFETY: `begin` has grown the memory by all of these planes, which do not overlap and are aligned
        // to four bytes. Nothing else is in this memory, and the planes of one call are gone before the next.
        unsafe {
            Planes {
                width,
                height,
                pictures: [0, 1].map(|plane| from_raw_parts(place(plane).cast_const(), pixels)),
                flags: from_raw_parts_mut(place(2), pixels),
                confidences: from_raw_parts_mut(place(3), pixels),
                disparities: from_raw_parts_mut(place(4).cast(), pixels),
                depths: from_raw_parts_mut(place(6).cast(), pixels),
                sigmas: from_raw_parts_mut(place(8).cast(), pixels),
            }
        }
    }
}

/// Makes room for pictures of a size, and says where: the left picture, the right one, flags and confidences,
/// a byte for each pixel, each plane on a multiple of four bytes; then disparities and depths of two bytes,
/// and deviations of four. 0: there is no such room.
#[unsafe(no_mangle)]
extern "C" fn begin(width: u32, height: u32) -> usize {
    let whole = whole();
    let most = MOST_WIDTH as u32;
    if width == 0 || height == 0 || width > most || height > most {
        return 0;
    }
    let (width, height) = (width as u16, height as u16);
    if whole.planes == 0 {
        whole.planes = memory_size::<0>() * PAGE;
    }
    let end = whole.planes + PIXEL_BYTES * plane_bytes(width, height);
    let missing = end.div_ceil(PAGE).saturating_sub(memory_size::<0>());
    if missing > 0 && memory_grow::<0>(missing) == usize::MAX {
        return 0;
    }
    (whole.width, whole.height) = (width, height);
    whole.planes
}

/// Where the settings are.
#[unsafe(no_mangle)]
extern "C" fn settings() -> *mut Settings {
    &raw mut whole().session.settings
}

/// Sets checks and penalties to those of the method, the filter and the noise.
#[unsafe(no_mangle)]
extern "C" fn preset() {
    whole().session.preset();
}

/// Measures the noise, and notes it in the settings.
#[unsafe(no_mangle)]
extern "C" fn measure() {
    let whole = whole();
    let planes = whole.planes();
    whole.session.measure(&planes);
}

/// Matches; the milliseconds, or less than 0 with a message.
#[unsafe(no_mangle)]
extern "C" fn run() -> f64 {
    let whole = whole();
    let mut planes = whole.planes();
    whole.session.run(&mut planes, clock).unwrap_or(-1.0)
}

/// Tells depth; 0 with a message.
#[unsafe(no_mangle)]
extern "C" fn depth(focal_px: f32, baseline_m: f32, offset_px: f32) -> u32 {
    let whole = whole();
    let mut planes = whole.planes();
    whole.session.depth(&mut planes, focal_px, baseline_m, offset_px).into()
}

/// Where the message is.
#[unsafe(no_mangle)]
extern "C" fn message() -> *const u8 {
    whole().session.message.as_ptr()
}

/// Bytes of the message.
#[unsafe(no_mangle)]
extern "C" fn message_bytes() -> usize {
    whole().session.message.len()
}

/// Where the kernel's name is.
#[unsafe(no_mangle)]
extern "C" fn kernel() -> *const u8 {
    Session::kernel().as_ptr()
}

/// Bytes of the kernel's name.
#[unsafe(no_mangle)]
extern "C" fn kernel_bytes() -> usize {
    Session::kernel().len()
}
