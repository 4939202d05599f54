//! Status codes of the C interface, and their texts.

use crate::matching::MatchError;
use crate::pipeline::PushError;
use core::ffi::CStr;

/// Version of this interface, which changes when a program compiled with another header would go wrong.
pub const STEREOPSIS_ABI: u32 = 6;

/// Result of a call; below 0 it is an error, and nothing has changed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(i32)]
#[non_exhaustive]
pub enum Status {
    /// Done; a call that gives a row gave one.
    Ok = 0,
    /// The line was taken; the first row comes some lines later.
    NoRowYet = 1,
    /// All rows of the frame are out.
    FrameDone = 2,
    /// A pointer is null.
    Null = -1,
    /// A pointer is not aligned as what it points to has to be.
    Misaligned = -2,
    /// The memory is shorter than `stereopsis_size()`, or than `stereopsis_rectifier_size()`.
    MemoryTooShort = -3,
    /// The memory holds a matcher already: `stereopsis_deinit` gives it up.
    AlreadyInitialised = -4,
    /// The handle's memory holds no such matcher or rectifier of this library.
    NotInitialised = -5,
    /// An argument points into the matcher's or rectifier's memory, or two results overlap.
    Overlap = -6,
    /// More elements than an address space holds.
    TooMany = -7,
    /// `stereopsis_start`, or `stereopsis_rectifier_start`, has to come first.
    NotStarted = -8,
    /// `stereopsis_begin_frame`, or `stereopsis_rectifier_begin_frame`, has to come first.
    NotBegun = -9,
    /// The length is not the width that the matcher or rectifier was started for.
    LineLength = -10,
    /// All lines of the frame are in: flush, or begin the next one.
    NoLineLeft = -11,
    /// Lines of the frame are missing: push them before flushing.
    LinesMissing = -12,
    /// The preset is none of the `STEREOPSIS_PRESET_` numbers.
    Preset = -13,
    /// Configuration: the width is 0 or over `stereopsis_max_width()`.
    Width = -14,
    /// Configuration: the height is 0.
    Height = -15,
    /// Configuration: the disparities are under 16 or over `stereopsis_max_disparities()`.
    Disparities = -16,
    /// Configuration: the search ends beyond 2046 px.
    MinDisparity = -17,
    /// Configuration: the left-right check is neither 0 to 255 px nor `STEREOPSIS_NOT_CHECKED`.
    LeftRight = -18,
    /// Configuration: the uniqueness is neither 0 to 99 percent nor `STEREOPSIS_NOT_CHECKED`.
    Uniqueness = -19,
    /// Configuration: the smoothing radius is over 8.
    Smoothing = -20,
    /// Configuration: the step of a surface is over 32.
    SurfaceStep = -21,
    /// Rig: a number is infinite or not a number.
    RigNotFinite = -22,
    /// Rig: the focal length is not over 0.
    RigFocalLength = -23,
    /// Rig: the baseline is not over 0.
    RigBaseline = -24,
    /// Rig: focal length times baseline is over 134000 px m.
    RigTooLarge = -25,
    /// Rig: focal length times baseline is under 0.0000156 px m.
    RigTooSmall = -26,
    /// Rig: the principal points are over 30000 px apart.
    RigOffset = -27,
    /// Configuration: the range of gradients is 0 or over 14.
    Gradient = -28,
    /// Configuration: the penalties are not in order, or too large together.
    Penalties = -29,
    /// Configuration: the noise is none of the `STEREOPSIS_NOISE_` numbers.
    Noise = -30,
    /// The fault is none of the `STEREOPSIS_LOST_` numbers.
    Fault = -31,
    /// Record: it has fewer than `STEREOPSIS_RECORD_BYTES` bytes.
    RecordTooShort = -32,
    /// Record: it begins with something else, such as erased flash.
    NotARecord = -33,
    /// Record: this library does not read its version.
    RecordVersion = -34,
    /// Record: a bit has changed, or it was written in part.
    RecordChecksum = -35,
    /// Record: this library does not know the model of a lens.
    RecordLens = -36,
    /// Record: its numbers are no cameras, or no rig.
    RecordNumbers = -37,
    /// Rectification: the raw images of the two cameras differ in size.
    RawSizes = -38,
    /// Rectification: the second camera stands left of the first one, or above it.
    RectifySwapped = -39,
    /// Rectification: the cameras stand one above the other, so that columns match, not rows.
    RectifyVertical = -40,
    /// Rectification: one camera stands before the other, or they look into different directions.
    RectifyPose = -41,
    /// Rectification: the rectified images would show nothing that both cameras see.
    RectifyNothing = -42,
    /// Rectification: `alpha` is neither from 0 to 1 nor `STEREOPSIS_ALPHA_NATURAL`.
    RectifyAlpha = -43,
    /// Rectification: raw or rectified images have over `stereopsis_max_width()` columns, the rectified ones
    /// more rows than the library was built for, or under 2 of either.
    RectifySize = -44,
    /// Rectification: a lens bends too much for the tables.
    RectifyBent = -45,
    /// Rectification: more raw lines are needed at once than `stereopsis_rectifier_lines()`.
    RectifyLines = -46,
    /// Rectification: `stereopsis_rectifier_line` has to take the next line before another raw line.
    LineWaiting = -47,
    /// The row is not one of the image.
    Row = -48,
    /// Two views: eight matches at least are needed.
    TooFewMatches = -49,
    /// Two views: a coordinate of a match is infinite or not a number.
    MatchNotFinite = -50,
    /// Two views: the threshold is not over 0.
    MatchThreshold = -51,
    /// Two views: no fundamental matrix has more than seven matches agree with it.
    MatchesDisagree = -52,
    /// Two views: the matches are on a plane, or the camera has only rotated.
    MatchesOnPlane = -53,
    /// Two views: the matches leave the fundamental matrix undetermined.
    MatchesDegenerate = -54,
    /// Two views: the matrix is not finite, or of rank one or less.
    FundamentalRank = -55,
    /// Two views: the numbers are those of no camera.
    PinholeNumbers = -56,
    /// Two views: no pose has more than half of the matches in front of both cameras.
    PoseAmbiguous = -57,
    /// Two views: the rotation is none, or both cameras stand in one place.
    PoseNumbers = -58,
}

impl Status {
    /// Returns the text of a status, one line without an end.
    pub fn text(self) -> &'static CStr {
        status_text(self as i32)
    }
}

/// Text of every status.
const TEXTS: [(Status, &CStr); 61] = [
    (Status::Ok, c"done"),
    (Status::NoRowYet, c"the first row comes some lines later"),
    (Status::FrameDone, c"all rows of the frame are out"),
    (Status::Null, c"a pointer is null"),
    (Status::Misaligned, c"a pointer is misaligned"),
    (Status::MemoryTooShort, c"the memory is too short"),
    (Status::AlreadyInitialised, c"the memory holds a matcher already"),
    (Status::NotInitialised, c"the memory holds no such matcher or rectifier of this library"),
    (Status::Overlap, c"an argument points into the matcher's memory, or two results overlap"),
    (Status::TooMany, c"there are too many elements"),
    (Status::NotStarted, c"the matcher or rectifier was not started"),
    (Status::NotBegun, c"no frame was begun"),
    (Status::LineLength, c"a line must have the width that the matcher or rectifier was started for"),
    (Status::NoLineLeft, c"all lines of the frame are in"),
    (Status::LinesMissing, c"lines of the frame are missing"),
    (Status::Preset, c"there is no such preset"),
    (Status::Width, c"the width must be 1 to stereopsis_max_width()"),
    (Status::Height, c"the height must be at least 1"),
    (Status::Disparities, c"the disparities must be 16 to stereopsis_max_disparities()"),
    (Status::MinDisparity, c"the search must end at 2046 px"),
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
];

/// Returns the text of a number that may be a status.
pub fn status_text(code: i32) -> &'static CStr {
    let found = TEXTS.iter().find(|(status, _)| *status as i32 == code);
    found.map_or(c"no status of this library", |(_, text)| text)
}

/// Returns the version of the library.
pub const fn version_text() -> &'static CStr {
    match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(text) => text,
        Err(_) => c"",
    }
}

impl From<PushError> for Status {
    fn from(e: PushError) -> Self {
        match e {
            PushError::NotBegun => Self::NotBegun,
            PushError::LineLength { .. } => Self::LineLength,
            PushError::NoLineLeft => Self::NoLineLeft,
            PushError::LinesMissing { .. } => Self::LinesMissing,
            PushError::Matcher(e) => e.into(),
        }
    }
}

impl From<MatchError> for Status {
    fn from(e: MatchError) -> Self {
        match e {
            MatchError::NotStarted => Self::NotStarted,
            MatchError::FrameDone => Self::NoLineLeft,
            MatchError::LineTooShort { .. } => Self::LineLength,
        }
    }
}

/// Merges both outcomes of a call into its status.
pub(super) fn either(result: Result<Status, Status>) -> Status {
    result.unwrap_or_else(|status| status)
}
