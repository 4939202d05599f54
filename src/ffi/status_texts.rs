//! Texts of the status codes of the C interface.
#![allow(unsafe_code)]

use super::Status;
use core::ffi::CStr;

/// Text of every status, of which a program holds no more than [`PACKED`].
const TEXTS: [(Status, &CStr); 93] = [
    (Status::Ok, c"done"),
    (Status::NoRowYet, c"the first row comes some lines later"),
    (Status::FrameDone, c"all rows of the frame are out"),
    (Status::NoLineYet, c"no line waits"),
    (Status::NoSlot, c"no slot is free: the line is lost"),
    (Status::Dropped, c"not all matches have room"),
    (Status::Lost, c"the row needs a raw line that was lost"),
    (Status::Null, c"a pointer is null"),
    (Status::Misaligned, c"a pointer is misaligned"),
    (Status::MemoryTooShort, c"the memory is too short"),
    (Status::AlreadyInitialised, c"the memory is in use already: it has to be given up first"),
    (Status::NotInitialised, c"the memory holds no such thing of this library"),
    (Status::Overlap, c"an argument points into the handle's memory, or two results overlap"),
    (Status::TooMany, c"there are too many elements"),
    (Status::NotStarted, c"its start has to come first"),
    (Status::NotBegun, c"no frame was begun"),
    (Status::LineLength, c"a line must have the width of the start"),
    (Status::NoLineLeft, c"all lines of the frame are in"),
    (Status::LinesMissing, c"lines of the frame are missing"),
    (Status::Preset, c"there is no such preset"),
    (Status::Width, c"the width must be 1 to stereopsis_max_width()"),
    (Status::Height, c"the height must be at least 1"),
    (Status::Disparities, c"the disparities must be 16 to stereopsis_max_disparities()"),
    (Status::MinDisparity, c"the search must end at 2046 px at most"),
    (Status::LeftRight, c"the left-right check must be 0 to 255 px, or -1"),
    (Status::Uniqueness, c"the uniqueness must be 0 to 99 percent, or -1"),
    (Status::Smoothing, c"the smoothing radius must be at most 8"),
    (Status::SurfaceStep, c"the step of a surface must be at most 32"),
    (Status::RigNotFinite, c"a number of the rig is not finite"),
    (Status::RigFocalLength, c"the focal length must be greater than zero"),
    (Status::RigBaseline, c"the baseline must be greater than zero"),
    (Status::RigTooLarge, c"focal length times baseline must be under 134000 px m"),
    (Status::RigTooSmall, c"focal length times baseline must be over 0.0000156 px m"),
    (Status::RigOffset, c"the principal points must be under 30000 px apart"),
    (Status::Gradient, c"the range of gradients must be 1 to 14"),
    (Status::Penalties, c"the penalties must be in order, and their sums within bytes"),
    (Status::Noise, c"there is no such level of noise"),
    (Status::Fault, c"there is no such fault of a line"),
    (Status::RecordTooShort, c"a record has 328 bytes; these are fewer"),
    (Status::NotARecord, c"the bytes are no record of a rig, which begins with STRG"),
    (Status::RecordVersion, c"the record is of another version"),
    (Status::RecordChecksum, c"the record's checksum is wrong"),
    (Status::RecordLens, c"the record has a lens of another model"),
    (Status::RecordNumbers, c"the record's numbers are no stereo rig"),
    (Status::RawSizes, c"the cameras' raw images differ in size"),
    (Status::RectifySwapped, c"the cameras are swapped"),
    (Status::RectifyVertical, c"the cameras stand one above the other"),
    (Status::RectifyPose, c"the cameras do not stand side by side"),
    (Status::RectifyNothing, c"the rectified images would show nothing of one of the cameras"),
    (Status::RectifyAlpha, c"alpha must be from 0 to 1, or -1"),
    (Status::RectifySize, c"the images are larger than the library was built for, or under 2 px"),
    (Status::RectifyBent, c"a lens bends too much between 16 pixels"),
    (Status::RectifyLines, c"more raw lines are needed than the library was built for"),
    (Status::LineWaiting, c"a rectified line has to be taken first"),
    (Status::Row, c"there is no such row"),
    (Status::TooFewMatches, c"eight matches at least are needed"),
    (Status::MatchNotFinite, c"a coordinate of a match is not finite"),
    (Status::MatchThreshold, c"the threshold must be greater than zero"),
    (Status::MatchesDisagree, c"no fundamental matrix has more than seven matches agree with it"),
    (Status::MatchesOnPlane, c"the matches are on a plane, or the camera has only rotated"),
    (Status::MatchesDegenerate, c"the matches leave the fundamental matrix undetermined"),
    (Status::FundamentalRank, c"the matrix must be finite and of rank two at least"),
    (Status::PinholeNumbers, c"the numbers are those of no camera"),
    (Status::PoseAmbiguous, c"no pose has more than half of the matches in front of both cameras"),
    (Status::PoseNumbers, c"the rotation is none, or both cameras stand in one place"),
    (Status::LineNotBegun, c"no line was begun"),
    (Status::LineNotTaken, c"no line was taken"),
    (Status::LineBytes, c"a line has 1 to 65535 bytes"),
    (Status::Block, c"a block has 2 to 8 pixels a side"),
    (Status::Shift, c"the shift must be 0 to 4"),
    (Status::DetectorWidth, c"longer lines than the detector takes"),
    (Status::DetectorCells, c"a cell has 16 px or more, and a corner"),
    (Status::DetectorSlots, c"more slots than the detector has"),
    (Status::Search, c"the ratio is 1 to 100, distances not negative"),
    (Status::FocusSize, c"no pixels, or more than the map takes"),
    (Status::FocusWindow, c"no cell, or too large a window"),
    (Status::FocusFrames, c"a stack has at most 65535 frames"),
    (Status::FocusScale, c"the scale is 1/2 to 2"),
    (Status::FocusNotFinished, c"the stack is not finished"),
    (Status::OdometryPoints, c"16 to 65534 points are followed"),
    (Status::OdometryConfig, c"no frame can be followed with such a number"),
    (Status::PictureSize, c"the pictures differ in size"),
    (Status::Winners, c"a row of winners is as long as a line, and given where one is due"),
    (Status::WinnerDamaged, c"a winner's check byte does not fit, or it is of another row"),
    (Status::WinnerRefused, c"a winner is none that the search can have"),
    (Status::ObstacleCells, c"a cell has sides of 1 to 16 px and at most 255 px"),
    (Status::ObstacleSectors, c"there are 1 to 32 sectors"),
    (Status::ObstaclePose, c"no height, too much pitch, or heights in no order"),
    (Status::ObstacleLimits, c"no deviation, or obstacles or drops of 0 mm"),
    (Status::ObstacleSize, c"no cells, or more than the finder takes"),
    (Status::ObstacleGround, c"there is no such source of the ground"),
    (Status::OpenMargin, c"the margin of open places must be at most 127"),
    (Status::MinConfidence, c"the least confidence must be at most 207"),
];

/// Largest status.
const LARGEST: i32 = Status::Lost as i32;
/// Bytes of all texts with a zero behind each.
const BYTES: usize = {
    let (mut bytes, mut i) = (0, 0);
    while i < TEXTS.len() {
        bytes += TEXTS[i].1.count_bytes() + 1;
        i += 1;
    }
    bytes
};
/// All texts, one behind the other: from status 0 up to the largest one, then from -1 down to the smallest. A
/// table of pointers would take as much flash as a third of the texts.
static PACKED: [u8; BYTES] = {
    let (mut packed, mut end, mut place) = ([0; BYTES], 0, 0);
    while place < TEXTS.len() {
        let code = if place as i32 <= LARGEST { place as i32 } else { LARGEST - place as i32 };
        let mut i = 0;
        // Without a text for it this ends beyond the table, and nothing compiles.
        while TEXTS[i].0 as i32 != code {
            i += 1;
        }
        let (text, mut k) = (TEXTS[i].1.to_bytes_with_nul(), 0);
        while k < text.len() {
            packed[end + k] = text[k];
            k += 1;
        }
        end += text.len();
        place += 1;
    }
    packed
};

impl Status {
    /// Returns the text of a status, one line without an end.
    pub fn text(self) -> &'static CStr {
        status_text(self as i32)
    }
}

/// Returns the text of a number that may be a status.
pub fn status_text(code: i32) -> &'static CStr {
    let place = if code < 0 { LARGEST.wrapping_sub(code) } else { code };
    if place < 0 || code > LARGEST || place as usize >= TEXTS.len() {
        return c"no status of this library";
    }
    let (mut rest, mut before) = (PACKED.as_ptr(), place);
    // SAFETY: as many texts are there, each with a zero at its end.
    unsafe {
        while before > 0 {
            before -= i32::from(rest.read() == 0);
            rest = rest.add(1);
        }
        CStr::from_ptr(rest.cast())
    }
}

/// Returns the version of the library.
pub const fn version_text() -> &'static CStr {
    match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(text) => text,
        Err(_) => c"",
    }
}
