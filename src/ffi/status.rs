//! Status codes of the C interface.

use crate::matching::MatchError;
use crate::pipeline::PushError;

/// Version of this interface, which changes when a program compiled with another header would go wrong.
pub const STEREOPSIS_ABI: u32 = 7;

/// Result of a call; below 0 it is an error, and nothing has changed unless the function says so.
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
    /// Line queue: no line waits.
    NoLineYet = 3,
    /// Line queue: all slots but one hold lines that wait, so that this one is lost, and counted.
    NoSlot = 4,
    /// Features: the list has no room for all matches.
    Dropped = 5,
    /// Rectification: the row needs a raw line that was lost; `stereopsis_push_lost` tells the matcher.
    Lost = 6,
    /// A pointer is null.
    Null = -1,
    /// A pointer is not aligned as what it points to has to be.
    Misaligned = -2,
    /// The memory is shorter than what the function makes in it, as the header says.
    MemoryTooShort = -3,
    /// The memory holds what this function makes already: its `_deinit` gives it up.
    AlreadyInitialised = -4,
    /// The handle's memory holds no such thing of this library.
    NotInitialised = -5,
    /// An argument points into the handle's memory, or two results overlap.
    Overlap = -6,
    /// There are more elements than the function takes.
    TooMany = -7,
    /// The handle's start has to come first.
    NotStarted = -8,
    /// The beginning of the handle's frame has to come first.
    NotBegun = -9,
    /// The length is not the width that the handle was started for.
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
    /// Configuration: the search must end at 2046 px at most.
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
    /// Line queue: `stereopsis_line_queue_begin` has to come first, and to give a slot.
    LineNotBegun = -59,
    /// Line queue: `stereopsis_line_queue_next` has to come first, and to give a line.
    LineNotTaken = -60,
    /// Line queue: a line has 1 to 65535 bytes.
    LineBytes = -61,
    /// Decimation: a block has 2 to 8 pixels a side.
    Block = -62,
    /// Temporal filter: the shift is over 4.
    Shift = -63,
    /// Features: the lines are longer than those that the detector was created for.
    DetectorWidth = -64,
    /// Features: a cell has under 16 px a side, or no corner is kept in it.
    DetectorCells = -65,
    /// Features: more corners are kept in a row of cells than the detector has slots for.
    DetectorSlots = -66,
    /// Features: the ratio is not 1 to 100 percent, or a distance is negative or not a number.
    Search = -67,
    /// Focus: a frame has no pixel, or the map was created for fewer pixels, columns or cells.
    FocusSize = -68,
    /// Focus: a cell has no side, the radius is too large, or a window counts over 16384 pixels.
    FocusWindow = -69,
    /// Focus: a stack has at most 65535 frames.
    FocusFrames = -70,
    /// Focus: the scale of a frame is not 1/2 to 2.
    FocusScale = -71,
    /// Focus: `stereopsis_focus_finish` has to come first.
    FocusNotFinished = -72,
    /// Odometry: it follows 16 to 65534 points.
    OdometryPoints = -73,
    /// Odometry: a number of the configuration is none that frames can be followed with.
    OdometryConfig = -74,
    /// Odometry: the pictures differ in size, or from those of the frames before.
    PictureSize = -75,
    /// Winners: the row has another length than a line, or none is due.
    Winners = -76,
    /// Winners: a record's check byte does not fit, or it is of another row.
    WinnerDamaged = -77,
    /// Winners: a record is none that the search can have.
    WinnerRefused = -78,
    /// Obstacles: a cell has sides of 1 to 16 px, and at most 255 px.
    ObstacleCells = -79,
    /// Obstacles: there are 1 to 32 sectors.
    ObstacleSectors = -80,
    /// Obstacles: a height is 0, the pitch or roll is over 500 mrad, or the heights searched are in no order.
    ObstaclePose = -81,
    /// Obstacles: the deviation is not 1 to 320 steps, or an obstacle's height or a drop's depth is 0.
    ObstacleLimits = -82,
    /// Obstacles: no cell, over 255 rows of cells, or more columns or rows than the finder was created for.
    ObstacleSize = -83,
    /// Obstacles: the ground is none of the `STEREOPSIS_GROUND_` numbers.
    ObstacleGround = -84,
    /// Configuration: the margin of open places is over 127.
    OpenMargin = -85,
    /// Configuration: the least confidence is over 207.
    MinConfidence = -86,
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
            MatchError::Winners { .. } => Self::Winners,
            MatchError::WinnerRefused { .. } => Self::WinnerRefused,
        }
    }
}

/// Merges both outcomes of a call into its status.
pub(super) fn either(result: Result<Status, Status>) -> Status {
    result.unwrap_or_else(|status| status)
}
