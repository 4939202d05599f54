//! What the page calls. It has one thread and makes one call at a time.
#![allow(unsafe_code)]

use crate::cameras::{Cameras, Files};
use crate::pair::Pair;
use crate::rig_plan;
use crate::session::{MOST_WIDTH, Planes, Session};
use crate::settings::Settings;
use std::cell::UnsafeCell;
use std::slice::{from_raw_parts, from_raw_parts_mut};
use stereopsis::geometry::camera::ImageSize;

/// Bytes for a pixel: two of grey, flags, confidence, disparity (2), depth (2), deviation (4), two of grey as
/// they came, two of masks.
const PIXEL_BYTES: usize = 16;

#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// The time, ms.
    safe fn now() -> f64;
}

fn clock() -> f64 {
    now()
}

/// What there is beside the session.
struct Whole {
    /// The planes, one after another, aligned for numbers of four bytes.
    memory: Vec<u32>,
    width: u16,
    height: u16,
    /// Whether the pictures are what a remap made, with masks.
    is_rectified: bool,
    files: Files,
    /// What the page gives: a name, and bytes.
    given: Vec<u8>,
    name_bytes: usize,
    /// What it is answered.
    answer: String,
}

struct Held<T>(UnsafeCell<T>);

// SAFETY: the page has one thread.
unsafe impl<T> Sync for Held<T> {}

/// By itself, for it is many megabytes of zeros, of which the module's file has none.
static SESSION: Held<Session> = Held(UnsafeCell::new(Session::new()));

static WHOLE: Held<Whole> = Held(UnsafeCell::new(Whole {
    memory: Vec::new(),
    width: 0,
    height: 0,
    is_rectified: false,
    files: Files::new(),
    given: Vec::new(),
    name_bytes: 0,
    answer: String::new(),
}));

fn whole() -> &'static mut Whole {
    // SAFETY: each export takes it once, and nothing that it calls comes back to an export: the page's clock
    // does not.
    unsafe { &mut *WHOLE.0.get() }
}

fn session() -> &'static mut Session {
    // SAFETY: as of `whole`.
    unsafe { &mut *SESSION.0.get() }
}

/// Bytes of a plane of one byte for each pixel: a multiple of four, so that planes of numbers are aligned.
fn plane_bytes(width: u16, height: u16) -> usize {
    (usize::from(width) * usize::from(height)).next_multiple_of(4)
}

impl Whole {
    /// Where a plane begins, that many planes of bytes after the first.
    fn place(&mut self, plane: usize) -> *mut u8 {
        // A plane has whole numbers of four bytes. All planes are within the memory that `begin` makes.
        let first = plane * plane_bytes(self.width, self.height) / size_of::<u32>();
        self.memory.get_mut(first..).unwrap_or_default().as_mut_ptr().cast()
    }

    fn pixels(&self) -> usize {
        usize::from(self.width) * usize::from(self.height)
    }

    /// Two planes side by side, to be written.
    fn two(&mut self, first: usize) -> [&'static mut [u8]; 2] {
        let pixels = self.pixels();
        // SAFETY: as of `planes`; those that are written are read by nothing else in the same call.
        [first, first + 1].map(|plane| unsafe { from_raw_parts_mut(self.place(plane), pixels) })
    }

    fn planes(&mut self) -> Planes<'static> {
        let (width, height, pixels) = (self.width, self.height, self.pixels());
        // SAFETY: `begin` has made the memory for all of these planes, which do not overlap and are aligned
        // to four bytes. It is made anew by `begin` alone, and the planes of one call are gone before the
        // next.
        unsafe {
            Planes {
                width,
                height,
                pictures: [0, 1].map(|plane| from_raw_parts(self.place(plane).cast_const(), pixels)),
                masks: self
                    .is_rectified
                    .then(|| [14, 15].map(|plane| from_raw_parts(self.place(plane).cast_const(), pixels))),
                flags: from_raw_parts_mut(self.place(2), pixels),
                confidences: from_raw_parts_mut(self.place(3), pixels),
                disparities: from_raw_parts_mut(self.place(4).cast(), pixels),
                depths: from_raw_parts_mut(self.place(6).cast(), pixels),
                sigmas: from_raw_parts_mut(self.place(8).cast(), pixels),
                sigma_row: None,
            }
        }
    }

    /// Says what is wrong, or the answer: 0 or 1.
    fn say(&mut self, session: &mut Session, said: Result<String, String>) -> u32 {
        match said {
            Ok(answer) => {
                self.answer = answer;
                1
            }
            Err(line) => {
                session.message.set(&line);
                0
            }
        }
    }
}

/// Makes room for pictures of a size, and says where: the left picture, the right one, flags and confidences,
/// a byte for each pixel, each plane on a multiple of four bytes; then disparities and depths of two bytes,
/// deviations of four; and of a byte again both pictures as they came, and both masks. 0: there is no such
/// room.
#[unsafe(no_mangle)]
extern "C" fn begin(width: u32, height: u32) -> usize {
    let whole = whole();
    let most = MOST_WIDTH as u32;
    if width == 0 || height == 0 || width > most || height > most {
        return 0;
    }
    let (width, height) = (width as u16, height as u16);
    let words = PIXEL_BYTES * plane_bytes(width, height) / size_of::<u32>();
    whole.memory = Vec::new();
    (whole.width, whole.height, whole.is_rectified) = (0, 0, false);
    if whole.memory.try_reserve_exact(words).is_err() {
        return 0;
    }
    whole.memory.resize(words, 0);
    (whole.width, whole.height) = (width, height);
    whole.place(0).expose_provenance()
}

/// Makes room for a name and for bytes, and says where.
#[unsafe(no_mangle)]
extern "C" fn give(name_bytes: usize, bytes: usize) -> *mut u8 {
    let whole = whole();
    whole.name_bytes = name_bytes;
    whole.given.clear();
    whole.given.resize(name_bytes + bytes, 0);
    whole.given.as_mut_ptr()
}

/// Takes what was given as a calibration file.
#[unsafe(no_mangle)]
extern "C" fn add_file() {
    let whole = whole();
    let (name, bytes) = whole.given.split_at_checked(whole.name_bytes).unwrap_or_default();
    whole.files.add(&String::from_utf8_lossy(name), bytes);
}

/// Forgets the calibration files.
#[unsafe(no_mangle)]
extern "C" fn clear_files() {
    let whole = whole();
    whole.files.clear();
    whole.is_rectified = false;
}

/// Reads the calibration files for the pictures' size. `rectify` is 0 or 1, or 2 where the files decide. The
/// answer is JSON; 0 with a message.
#[unsafe(no_mangle)]
extern "C" fn cameras(unit: usize, rectify: u32) -> u32 {
    let (whole, session) = (whole(), session());
    let size = ImageSize { width: whole.width, height: whole.height };
    whole.is_rectified = false;
    let rectify = (rectify < 2).then_some(rectify == 1);
    let said = whole.files.cameras(size, unit, rectify).and_then(|Cameras { told, rectification }| {
        let is_set = rectification.is_none_or(|rectification| session.set_warps(&rectification));
        if !is_set {
            return Err(session.message.as_str().to_owned());
        }
        serde_json::to_string(&told).map_err(|e| e.to_string())
    });
    whole.say(session, said)
}

/// Makes the pictures of those that came, with masks; 0 with a message.
#[unsafe(no_mangle)]
extern "C" fn rectify() -> u32 {
    let whole = whole();
    let [left, right] = whole.two(12);
    let raw = Pair::new(whole.width, whole.height, [left, right]);
    let (pictures, masks) = (whole.two(0), whole.two(14));
    whole.is_rectified = session().rectify(raw, pictures, masks);
    whole.is_rectified.into()
}

/// Plans what was given as JSON. The answer is JSON; 0 with a message.
#[unsafe(no_mangle)]
extern "C" fn plan() -> u32 {
    let whole = whole();
    let said = rig_plan::answer(whole.given.get(whole.name_bytes..).unwrap_or_default());
    whole.say(session(), said)
}

/// Where the answer is.
#[unsafe(no_mangle)]
extern "C" fn answer() -> *const u8 {
    whole().answer.as_ptr()
}

/// Bytes of the answer.
#[unsafe(no_mangle)]
extern "C" fn answer_bytes() -> usize {
    whole().answer.len()
}

/// Where the settings are.
#[unsafe(no_mangle)]
extern "C" fn settings() -> *mut Settings {
    &raw mut session().settings
}

/// Sets checks and penalties to those of the method, the filter and the noise.
#[unsafe(no_mangle)]
extern "C" fn preset() {
    session().preset();
}

/// Measures the noise, and notes it in the settings.
#[unsafe(no_mangle)]
extern "C" fn measure() {
    let whole = whole();
    let planes = whole.planes();
    session().measure(&planes);
}

/// Matches; the milliseconds, or less than 0 with a message. Deviations are told of one row, or of all where
/// that is less than 0, and confidences unless that is 0.
#[unsafe(no_mangle)]
extern "C" fn run(sigma_row: i32, confidence: u32) -> f64 {
    let whole = whole();
    let mut planes = Planes { sigma_row: u16::try_from(sigma_row).ok(), ..whole.planes() };
    session().run(&mut planes, confidence != 0, clock).unwrap_or(-1.0)
}

/// Tells depth; 0 with a message.
#[unsafe(no_mangle)]
extern "C" fn depth(focal_px: f32, baseline_m: f32, offset_px: f32) -> u32 {
    let whole = whole();
    let mut planes = whole.planes();
    session().depth(&mut planes, focal_px, baseline_m, offset_px).into()
}

/// Where the message is.
#[unsafe(no_mangle)]
extern "C" fn message() -> *const u8 {
    session().message.as_str().as_ptr()
}

/// Bytes of the message.
#[unsafe(no_mangle)]
extern "C" fn message_bytes() -> usize {
    session().message.as_str().len()
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
