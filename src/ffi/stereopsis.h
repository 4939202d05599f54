/* Depth from two cameras, line by line: the functions of libstereopsis.a.

   The caller gives memory, a configuration and lines, and gets rows of disparities. Nothing is allocated, nothing is
   kept of a caller's pointer but the memory given to stereopsis_init. Every function answers with a status; below 0 it
   is an error and nothing has changed unless the function says so.

     static uint64_t memory[STEREOPSIS_BLOCK_BYTES(320, 64) / 8 + 1];
     stereopsis *matcher;
     stereopsis_config config;
     stereopsis_row row;
     stereopsis_init(memory, sizeof memory, &matcher);
     stereopsis_config_default(320, 240, 64, STEREOPSIS_PRESET_DEFAULT, &config);
     stereopsis_start(matcher, &config);
     stereopsis_begin_frame(matcher);
     for each line: stereopsis_push(matcher, left, right, 320, &row);
       or, where it was lost: stereopsis_push_lost(matcher, STEREOPSIS_LOST_DROPPED, &row);
     until STEREOPSIS_STATUS_FRAME_DONE: stereopsis_flush(matcher, &row);

   One call at a time for one handle. Pointers are checked for null, alignment and overlap; what cannot be checked is the
   caller's promise: a pointer points to as many elements as the function says. */

#ifndef STEREOPSIS_H
#define STEREOPSIS_H

/* Made by `cargo xtask header`. */

#include <stddef.h>
#include <stdint.h>

/**
 * Bytes that are enough for a matcher of method fast, on any target. `disparities` is a multiple of 16, and
 * `width` at least as large, as the library was built with.
 */
#define STEREOPSIS_FAST_BYTES(width, disparities) \
  ((size_t)3504 + (size_t)68 * (width) + (size_t)13 * (disparities) + \
   (size_t)1 * (width) * (disparities))

/**
 * Bytes that are enough for a matcher of method block, on any target. `disparities` is a multiple of 16, and
 * `width` at least as large, as the library was built with.
 */
#define STEREOPSIS_BLOCK_BYTES(width, disparities) \
  ((size_t)3232 + (size_t)72 * (width) + (size_t)13 * (disparities) + \
   (size_t)1 * (width) * (disparities))

/**
 * Bytes that are enough for a matcher of method sgm-lean, on any target. `disparities` is a multiple of 16, and
 * `width` at least as large, as the library was built with.
 */
#define STEREOPSIS_SGM_LEAN_BYTES(width, disparities) \
  ((size_t)416 + (size_t)54 * (width) + (size_t)8 * (disparities) + \
   (size_t)3 * (width) * (disparities))

/**
 * Bytes that are enough for a matcher of method sgm, on any target. `disparities` is a multiple of 16, and
 * `width` at least as large, as the library was built with.
 */
#define STEREOPSIS_SGM_BYTES(width, disparities) \
  ((size_t)416 + (size_t)54 * (width) + (size_t)8 * (disparities) + \
   (size_t)3 * (width) * (disparities))

/**
 * Bytes that are enough for a matcher of method sgm-edge, on any target. `disparities` is a multiple of 16, and
 * `width` at least as large, as the library was built with.
 */
#define STEREOPSIS_SGM_EDGE_BYTES(width, disparities) \
  ((size_t)416 + (size_t)55 * (width) + (size_t)8 * (disparities) + \
   (size_t)5 * (width) * (disparities))

/**
 * Bytes that are enough for the second half of a matcher, on any target. `disparities` is a multiple of 16, and
 * `width` at least as large, as the library was built with.
 */
#define STEREOPSIS_WINNERS_BYTES(width, disparities) \
  ((size_t)192 + (size_t)63 * (width) + (size_t)3 * (disparities) + \
   (size_t)0 * (width) * (disparities))

/**
 * Bytes that are enough for a rectifier, on any target, with the library's longest line, the rows of its
 * largest rectified image, and the raw lines of each camera that it holds.
 */
#define STEREOPSIS_RECTIFIER_BYTES(width, height, lines) \
  ((size_t)80 + (size_t)(lines) + (size_t)2 * (width) * ((size_t)(lines) + 1) + \
   (size_t)16 * ((((size_t)(width) + 15) / 16 + 3) * (((size_t)(height) + 15) / 16 + 3) + \
                 ((size_t)(height) + 1) / 2))

/**
 * Bytes that are enough for a queue of `slots` lines of `line_bytes` bytes, on any target.
 */
#define STEREOPSIS_LINE_QUEUE_BYTES(line_bytes, slots) \
  ((size_t)48 + (size_t)(slots) * (((size_t)(line_bytes) + 7) / 8 * 8 + 32))

/**
 * Bytes that are enough for a detector of features, on any target, for lines of up to `width`
 * pixels and `slots` corners of a row of cells.
 */
#define STEREOPSIS_DETECTOR_BYTES(width, slots) \
  ((size_t)64 + (size_t)42 * (width) + (size_t)80 * (slots))

/**
 * Bytes that are enough for a focus map, on any target, for lines of up to `width` pixels, rows of
 * up to `columns` cells, and frames of up to `cells` cells.
 */
#define STEREOPSIS_FOCUS_BYTES(width, columns, cells) \
  ((size_t)104 + (size_t)13 * (width) + \
   (size_t)69 * (columns) + (size_t)48 * (cells))

/**
 * Bytes that are enough for an odometry that follows up to `points` points, on any target.
 */
#define STEREOPSIS_ODOMETRY_BYTES(points) ((size_t)504 + (size_t)457 * (points))

/**
 * Bytes that are enough for a finder of obstacles, on any target, in frames of up to `columns`
 * columns and `rows` rows of cells.
 */
#define STEREOPSIS_OBSTACLES_BYTES(columns, rows) \
  ((size_t)272 + (size_t)30 * (columns) + (size_t)17 * (rows) + \
   (size_t)2 * (columns) * (rows))


/**
 * Version of this interface, which changes when a program compiled with another header would go wrong.
 */
#define STEREOPSIS_ABI 7

/**
 * Alignment that is enough for every matcher's memory, that of `uint64_t`.
 */
#define STEREOPSIS_ALIGN 8

/**
 * Preset of checks: an answer wherever there is a candidate.
 */
#define STEREOPSIS_PRESET_DENSE 0

/**
 * Preset of checks: drops what the other image or the neighbourhood contradicts.
 */
#define STEREOPSIS_PRESET_DEFAULT 1

/**
 * Preset of checks: drops what is ambiguous and larger speckle as well, and of methods with windows what has
 * little texture.
 */
#define STEREOPSIS_PRESET_STRICT 2

/**
 * Value of `left_right_px` and `uniqueness_percent` that disables the check.
 */
#define STEREOPSIS_NOT_CHECKED -1

/**
 * Noise level: little noise, so that pixels are compared as they are.
 */
#define STEREOPSIS_NOISE_NONE 0

/**
 * Noise level: a standard deviation of about 2 grey levels.
 */
#define STEREOPSIS_NOISE_LOW 1

/**
 * Noise level: a standard deviation from about 3 grey levels on.
 */
#define STEREOPSIS_NOISE_HIGH 2

/**
 * Disparity that means "no answer".
 */
#define STEREOPSIS_NONE 65535

/**
 * Steps of a disparity per pixel.
 */
#define STEREOPSIS_STEPS_PER_PX 32

/**
 * Flag: no candidate lies inside the right image, or a camera did not see the pixel.
 */
#define STEREOPSIS_FLAG_OUTSIDE 1

/**
 * Flag: the winner is the largest disparity searched, or its partner is the first column of the right image;
 * the surface may be nearer, or the right camera may not see it.
 */
#define STEREOPSIS_FLAG_CEILING 2

/**
 * Flag: the winner costs as much as both its neighbours, too few pixels of the window have a gradient, or
 * the answer had spread from an edge over a place without any.
 */
#define STEREOPSIS_FLAG_UNTEXTURED 4

/**
 * Flag: another disparity matches nearly as well, the answer was less sure than asked for, or it stood on a
 * pattern that repeats.
 */
#define STEREOPSIS_FLAG_AMBIGUOUS 8

/**
 * Flag: the right image's pixel has a better partner elsewhere.
 */
#define STEREOPSIS_FLAG_MISMATCH 16

/**
 * Flag: too few answers around the pixel belong to its surface.
 */
#define STEREOPSIS_FLAG_SPECKLE 32

/**
 * Flag: the answer is the farther one of those on both sides of a small gap in the row.
 */
#define STEREOPSIS_FLAG_FILLED 64

/**
 * Flag: the pixel depends on a line that was lost (`stereopsis_push_lost`); an answer may be affected.
 */
#define STEREOPSIS_FLAG_DAMAGED 128

/**
 * Fault: the line did not arrive, or found no free buffer.
 */
#define STEREOPSIS_LOST_DROPPED 0

/**
 * Fault: the line was overwritten while it was read, or has too few or too many pixels.
 */
#define STEREOPSIS_LOST_TORN 1

/**
 * Fault: the line arrived too late to be used.
 */
#define STEREOPSIS_LOST_LATE 2

/**
 * Fault: the buffer still holds an earlier line.
 */
#define STEREOPSIS_LOST_STALE 3

/**
 * Bytes of a calibration record.
 */
#define STEREOPSIS_RECORD_BYTES 328

/**
 * Value of `alpha` that keeps the scale of the raw images.
 */
#define STEREOPSIS_ALPHA_NATURAL -1.0

/**
 * Origin: there is no answer, neither now nor in the last frames.
 */
#define STEREOPSIS_ORIGIN_NOTHING 0

/**
 * Origin: the answer is this frame's alone, the first here or far from the average.
 */
#define STEREOPSIS_ORIGIN_NEW 1

/**
 * Origin: the answer is the average of this frame's and earlier ones.
 */
#define STEREOPSIS_ORIGIN_AVERAGED 2

/**
 * Origin: the answer is of an earlier frame, as this one has none.
 */
#define STEREOPSIS_ORIGIN_HELD 3

/**
 * Focus of a cell: the peak is known.
 */
#define STEREOPSIS_FOCUS_FOUND 0

/**
 * Focus of a cell: too few frames came, three are enough.
 */
#define STEREOPSIS_FOCUS_FEW 1

/**
 * Focus of a cell: the sharpness changes no more than noise does.
 */
#define STEREOPSIS_FOCUS_UNTEXTURED 2

/**
 * Focus of a cell: the peak is so broad that noise hides where it is.
 */
#define STEREOPSIS_FOCUS_BROAD 3

/**
 * Motion: this is the first frame.
 */
#define STEREOPSIS_MOTION_FIRST 0

/**
 * Motion: rotation and step are measured.
 */
#define STEREOPSIS_MOTION_TRACKED 1

/**
 * Motion: the pictures are the same to their noise, and the motion is none.
 */
#define STEREOPSIS_MOTION_STATIONARY 2

/**
 * Motion: the rotation is measured, a step is too small to be measured.
 */
#define STEREOPSIS_MOTION_ROTATION_ONLY 3

/**
 * Motion: the rotation is measured, the step is not known.
 */
#define STEREOPSIS_MOTION_STEP_UNKNOWN 4

/**
 * Motion: too little was found again, and nothing is known; the next frame that is found has the whole
 * motion.
 */
#define STEREOPSIS_MOTION_LOST 5

/**
 * Motion: found again, by points that were known before.
 */
#define STEREOPSIS_MOTION_FOUND 6

/**
 * Motion: begun anew; the motion since the last known pose is not known.
 */
#define STEREOPSIS_MOTION_RESTARTED 7

/**
 * Motion: an estimate that is not sure; its covariance says how little, or few points say that it differs
 * much from the one before.
 */
#define STEREOPSIS_MOTION_UNCERTAIN 8

/**
 * Motion: measured by the left camera alone, for what the right one sees disagrees with all that was known.
 */
#define STEREOPSIS_MOTION_LEFT_ONLY 9

/**
 * Camera: no fault shows.
 */
#define STEREOPSIS_CAMERA_GOOD 0

/**
 * Camera: at least 99 % of the pixels are black: dark, covered or dead.
 */
#define STEREOPSIS_CAMERA_BLACK 1

/**
 * Camera: at least half of the pixels are saturated.
 */
#define STEREOPSIS_CAMERA_SATURATED 2

/**
 * Camera: all pixels are in one of the 16 bins of 16 levels, as from a stuck port.
 */
#define STEREOPSIS_CAMERA_FLAT 3

/**
 * Camera: at least half of the lines equal the one above bit for bit: a hanging line or a test pattern.
 */
#define STEREOPSIS_CAMERA_REPEATING 4

/**
 * Bytes that are enough for a monitor of two cameras, on any target.
 */
#define STEREOPSIS_PAIR_MONITOR_BYTES 240

/**
 * Ground: there is none, as for a camera that flies; every surface in range is an obstacle.
 */
#define STEREOPSIS_GROUND_ABSENT 0

/**
 * Ground: the camera's `pitch_mrad`, `roll_mrad` and `height_mm` are known, as from an inertial sensor.
 */
#define STEREOPSIS_GROUND_GIVEN 1

/**
 * Ground: it is searched in each frame, within the heights, the pitch and the roll of the configuration.
 */
#define STEREOPSIS_GROUND_SEARCHED 2

/**
 * Stixel: nothing that enough cells show; that is not to say that the column is free.
 */
#define STEREOPSIS_STIXEL_NOTHING 0

/**
 * Stixel: a surface that rises above the ground.
 */
#define STEREOPSIS_STIXEL_OBSTACLE 1

/**
 * Stixel: the edge of a surface that is deeper than the ground.
 */
#define STEREOPSIS_STIXEL_DROP 2

/**
 * Sector: too little is seen to say anything; never take it for free.
 */
#define STEREOPSIS_SECTOR_BLIND 0

/**
 * Sector: there is no obstacle up to `seen_mm`.
 */
#define STEREOPSIS_SECTOR_FREE 1

/**
 * Sector: there is an obstacle.
 */
#define STEREOPSIS_SECTOR_OBSTACLE 2

/**
 * Sector: the ground ends.
 */
#define STEREOPSIS_SECTOR_DROP 3

/**
 * Blind: it is not, the frame is to be trusted.
 */
#define STEREOPSIS_BLIND_NOT 0

/**
 * Blind: no frame has been finished since the start.
 */
#define STEREOPSIS_BLIND_NO_FRAME 1

/**
 * Blind: too many rows were lost or are damaged.
 */
#define STEREOPSIS_BLIND_ROWS_LOST 2

/**
 * Blind: too few cells have an answer, as in the dark, behind a covered lens, before a white wall.
 */
#define STEREOPSIS_BLIND_FEW_ANSWERS 3

/**
 * Blind: a camera's picture is black, saturated, flat or repeating.
 */
#define STEREOPSIS_BLIND_CAMERA 4

/**
 * Blind: the left and the right camera are swapped.
 */
#define STEREOPSIS_BLIND_SWAPPED 5

/**
 * Blind: a ground was to be searched and is not found.
 */
#define STEREOPSIS_BLIND_NO_GROUND 6

/**
 * Blind: too little of the ground that is driven on next is seen.
 */
#define STEREOPSIS_BLIND_UNSEEN 7

/**
 * Decision: nothing is known, and `blind` says why: stop.
 */
#define STEREOPSIS_DECISION_BLIND 0

/**
 * Decision: something is in the corridor at `distance_mm`: stop.
 */
#define STEREOPSIS_DECISION_STOP 1

/**
 * Decision: something is in the corridor at `distance_mm`: slow down.
 */
#define STEREOPSIS_DECISION_SLOW 2

/**
 * Decision: the corridor is seen to be free for twice the stopping distance.
 */
#define STEREOPSIS_DECISION_CLEAR 3

/**
 * Time to contact where nothing is there, or the vehicle stands.
 */
#define STEREOPSIS_NO_CONTACT 4294967295

/**
 * Bytes that are enough for a drive rule, on any target.
 */
#define STEREOPSIS_DRIVE_BYTES 40

/**
 * Bytes that are enough for the free space over frames, on any target.
 */
#define STEREOPSIS_FREE_SPACE_BYTES 1536

/**
 * Result of a call; below 0 it is an error, and nothing has changed unless the function says so.
 */
#if defined(__cplusplus) ? __cplusplus >= 201103L : __STDC_VERSION__ >= 202311L
enum stereopsis_status : int32_t
#elif defined(__cplusplus)
enum stereopsis_status_numbers
#else
enum stereopsis_status
#endif
{
  /**
   * Done; a call that gives a row gave one.
   */
  STEREOPSIS_STATUS_OK = 0,
  /**
   * The line was taken; the first row comes some lines later.
   */
  STEREOPSIS_STATUS_NO_ROW_YET = 1,
  /**
   * All rows of the frame are out.
   */
  STEREOPSIS_STATUS_FRAME_DONE = 2,
  /**
   * Line queue: no line waits.
   */
  STEREOPSIS_STATUS_NO_LINE_YET = 3,
  /**
   * Line queue: all slots but one hold lines that wait, so that this one is lost, and counted.
   */
  STEREOPSIS_STATUS_NO_SLOT = 4,
  /**
   * Features: the list has no room for all matches.
   */
  STEREOPSIS_STATUS_DROPPED = 5,
  /**
   * Rectification: the row needs a raw line that was lost; `stereopsis_push_lost` tells the matcher.
   */
  STEREOPSIS_STATUS_LOST = 6,
  /**
   * A pointer is null.
   */
  STEREOPSIS_STATUS_NULL = -1,
  /**
   * A pointer is not aligned as what it points to has to be.
   */
  STEREOPSIS_STATUS_MISALIGNED = -2,
  /**
   * The memory is shorter than what the function makes in it, as the header says.
   */
  STEREOPSIS_STATUS_MEMORY_TOO_SHORT = -3,
  /**
   * The memory holds what this function makes already: its `_deinit` gives it up.
   */
  STEREOPSIS_STATUS_ALREADY_INITIALISED = -4,
  /**
   * The handle's memory holds no such thing of this library.
   */
  STEREOPSIS_STATUS_NOT_INITIALISED = -5,
  /**
   * An argument points into the handle's memory, or two results overlap.
   */
  STEREOPSIS_STATUS_OVERLAP = -6,
  /**
   * There are more elements than the function takes.
   */
  STEREOPSIS_STATUS_TOO_MANY = -7,
  /**
   * The handle's start has to come first.
   */
  STEREOPSIS_STATUS_NOT_STARTED = -8,
  /**
   * The beginning of the handle's frame has to come first.
   */
  STEREOPSIS_STATUS_NOT_BEGUN = -9,
  /**
   * The length is not the width that the handle was started for.
   */
  STEREOPSIS_STATUS_LINE_LENGTH = -10,
  /**
   * All lines of the frame are in: flush, or begin the next one.
   */
  STEREOPSIS_STATUS_NO_LINE_LEFT = -11,
  /**
   * Lines of the frame are missing: push them before flushing.
   */
  STEREOPSIS_STATUS_LINES_MISSING = -12,
  /**
   * The preset is none of the `STEREOPSIS_PRESET_` numbers.
   */
  STEREOPSIS_STATUS_PRESET = -13,
  /**
   * Configuration: the width is 0 or over `stereopsis_max_width()`.
   */
  STEREOPSIS_STATUS_WIDTH = -14,
  /**
   * Configuration: the height is 0.
   */
  STEREOPSIS_STATUS_HEIGHT = -15,
  /**
   * Configuration: the disparities are under 16 or over `stereopsis_max_disparities()`.
   */
  STEREOPSIS_STATUS_DISPARITIES = -16,
  /**
   * Configuration: the search must end at 2046 px at most.
   */
  STEREOPSIS_STATUS_MIN_DISPARITY = -17,
  /**
   * Configuration: the left-right check is neither 0 to 255 px nor `STEREOPSIS_NOT_CHECKED`.
   */
  STEREOPSIS_STATUS_LEFT_RIGHT = -18,
  /**
   * Configuration: the uniqueness is neither 0 to 99 percent nor `STEREOPSIS_NOT_CHECKED`.
   */
  STEREOPSIS_STATUS_UNIQUENESS = -19,
  /**
   * Configuration: the smoothing radius is over 8.
   */
  STEREOPSIS_STATUS_SMOOTHING = -20,
  /**
   * Configuration: the step of a surface is over 32.
   */
  STEREOPSIS_STATUS_SURFACE_STEP = -21,
  /**
   * Rig: a number is infinite or not a number.
   */
  STEREOPSIS_STATUS_RIG_NOT_FINITE = -22,
  /**
   * Rig: the focal length is not over 0.
   */
  STEREOPSIS_STATUS_RIG_FOCAL_LENGTH = -23,
  /**
   * Rig: the baseline is not over 0.
   */
  STEREOPSIS_STATUS_RIG_BASELINE = -24,
  /**
   * Rig: focal length times baseline is over 134000 px m.
   */
  STEREOPSIS_STATUS_RIG_TOO_LARGE = -25,
  /**
   * Rig: focal length times baseline is under 0.0000156 px m.
   */
  STEREOPSIS_STATUS_RIG_TOO_SMALL = -26,
  /**
   * Rig: the principal points are over 30000 px apart.
   */
  STEREOPSIS_STATUS_RIG_OFFSET = -27,
  /**
   * Configuration: the range of gradients is 0 or over 14.
   */
  STEREOPSIS_STATUS_GRADIENT = -28,
  /**
   * Configuration: the penalties are not in order, or too large together.
   */
  STEREOPSIS_STATUS_PENALTIES = -29,
  /**
   * Configuration: the noise is none of the `STEREOPSIS_NOISE_` numbers.
   */
  STEREOPSIS_STATUS_NOISE = -30,
  /**
   * The fault is none of the `STEREOPSIS_LOST_` numbers.
   */
  STEREOPSIS_STATUS_FAULT = -31,
  /**
   * Record: it has fewer than `STEREOPSIS_RECORD_BYTES` bytes.
   */
  STEREOPSIS_STATUS_RECORD_TOO_SHORT = -32,
  /**
   * Record: it begins with something else, such as erased flash.
   */
  STEREOPSIS_STATUS_NOT_A_RECORD = -33,
  /**
   * Record: this library does not read its version.
   */
  STEREOPSIS_STATUS_RECORD_VERSION = -34,
  /**
   * Record: a bit has changed, or it was written in part.
   */
  STEREOPSIS_STATUS_RECORD_CHECKSUM = -35,
  /**
   * Record: this library does not know the model of a lens.
   */
  STEREOPSIS_STATUS_RECORD_LENS = -36,
  /**
   * Record: its numbers are no cameras, or no rig.
   */
  STEREOPSIS_STATUS_RECORD_NUMBERS = -37,
  /**
   * Rectification: the raw images of the two cameras differ in size.
   */
  STEREOPSIS_STATUS_RAW_SIZES = -38,
  /**
   * Rectification: the second camera stands left of the first one, or above it.
   */
  STEREOPSIS_STATUS_RECTIFY_SWAPPED = -39,
  /**
   * Rectification: the cameras stand one above the other, so that columns match, not rows.
   */
  STEREOPSIS_STATUS_RECTIFY_VERTICAL = -40,
  /**
   * Rectification: one camera stands before the other, or they look into different directions.
   */
  STEREOPSIS_STATUS_RECTIFY_POSE = -41,
  /**
   * Rectification: the rectified images would show nothing that both cameras see.
   */
  STEREOPSIS_STATUS_RECTIFY_NOTHING = -42,
  /**
   * Rectification: `alpha` is neither from 0 to 1 nor `STEREOPSIS_ALPHA_NATURAL`.
   */
  STEREOPSIS_STATUS_RECTIFY_ALPHA = -43,
  /**
   * Rectification: raw or rectified images have over `stereopsis_max_width()` columns, the rectified ones
   * more rows than the library was built for, or under 2 of either.
   */
  STEREOPSIS_STATUS_RECTIFY_SIZE = -44,
  /**
   * Rectification: a lens bends too much for the tables.
   */
  STEREOPSIS_STATUS_RECTIFY_BENT = -45,
  /**
   * Rectification: more raw lines are needed at once than `stereopsis_rectifier_lines()`.
   */
  STEREOPSIS_STATUS_RECTIFY_LINES = -46,
  /**
   * Rectification: `stereopsis_rectifier_line` has to take the next line before another raw line.
   */
  STEREOPSIS_STATUS_LINE_WAITING = -47,
  /**
   * The row is not one of the image.
   */
  STEREOPSIS_STATUS_ROW = -48,
  /**
   * Two views: eight matches at least are needed.
   */
  STEREOPSIS_STATUS_TOO_FEW_MATCHES = -49,
  /**
   * Two views: a coordinate of a match is infinite or not a number.
   */
  STEREOPSIS_STATUS_MATCH_NOT_FINITE = -50,
  /**
   * Two views: the threshold is not over 0.
   */
  STEREOPSIS_STATUS_MATCH_THRESHOLD = -51,
  /**
   * Two views: no fundamental matrix has more than seven matches agree with it.
   */
  STEREOPSIS_STATUS_MATCHES_DISAGREE = -52,
  /**
   * Two views: the matches are on a plane, or the camera has only rotated.
   */
  STEREOPSIS_STATUS_MATCHES_ON_PLANE = -53,
  /**
   * Two views: the matches leave the fundamental matrix undetermined.
   */
  STEREOPSIS_STATUS_MATCHES_DEGENERATE = -54,
  /**
   * Two views: the matrix is not finite, or of rank one or less.
   */
  STEREOPSIS_STATUS_FUNDAMENTAL_RANK = -55,
  /**
   * Two views: the numbers are those of no camera.
   */
  STEREOPSIS_STATUS_PINHOLE_NUMBERS = -56,
  /**
   * Two views: no pose has more than half of the matches in front of both cameras.
   */
  STEREOPSIS_STATUS_POSE_AMBIGUOUS = -57,
  /**
   * Two views: the rotation is none, or both cameras stand in one place.
   */
  STEREOPSIS_STATUS_POSE_NUMBERS = -58,
  /**
   * Line queue: `stereopsis_line_queue_begin` has to come first, and to give a slot.
   */
  STEREOPSIS_STATUS_LINE_NOT_BEGUN = -59,
  /**
   * Line queue: `stereopsis_line_queue_next` has to come first, and to give a line.
   */
  STEREOPSIS_STATUS_LINE_NOT_TAKEN = -60,
  /**
   * Line queue: a line has 1 to 65535 bytes.
   */
  STEREOPSIS_STATUS_LINE_BYTES = -61,
  /**
   * Decimation: a block has 2 to 8 pixels a side.
   */
  STEREOPSIS_STATUS_BLOCK = -62,
  /**
   * Temporal filter: the shift is over 4.
   */
  STEREOPSIS_STATUS_SHIFT = -63,
  /**
   * Features: the lines are longer than those that the detector was created for.
   */
  STEREOPSIS_STATUS_DETECTOR_WIDTH = -64,
  /**
   * Features: a cell has under 16 px a side, or no corner is kept in it.
   */
  STEREOPSIS_STATUS_DETECTOR_CELLS = -65,
  /**
   * Features: more corners are kept in a row of cells than the detector has slots for.
   */
  STEREOPSIS_STATUS_DETECTOR_SLOTS = -66,
  /**
   * Features: the ratio is not 1 to 100 percent, or a distance is negative or not a number.
   */
  STEREOPSIS_STATUS_SEARCH = -67,
  /**
   * Focus: a frame has no pixel, or the map was created for fewer pixels, columns or cells.
   */
  STEREOPSIS_STATUS_FOCUS_SIZE = -68,
  /**
   * Focus: a cell has no side, the radius is too large, or a window counts over 16384 pixels.
   */
  STEREOPSIS_STATUS_FOCUS_WINDOW = -69,
  /**
   * Focus: a stack has at most 65535 frames.
   */
  STEREOPSIS_STATUS_FOCUS_FRAMES = -70,
  /**
   * Focus: the scale of a frame is not 1/2 to 2.
   */
  STEREOPSIS_STATUS_FOCUS_SCALE = -71,
  /**
   * Focus: `stereopsis_focus_finish` has to come first.
   */
  STEREOPSIS_STATUS_FOCUS_NOT_FINISHED = -72,
  /**
   * Odometry: it follows 16 to 65534 points.
   */
  STEREOPSIS_STATUS_ODOMETRY_POINTS = -73,
  /**
   * Odometry: a number of the configuration is none that frames can be followed with.
   */
  STEREOPSIS_STATUS_ODOMETRY_CONFIG = -74,
  /**
   * Odometry: the pictures differ in size, or from those of the frames before.
   */
  STEREOPSIS_STATUS_PICTURE_SIZE = -75,
  /**
   * Winners: the row has another length than a line, or none is due.
   */
  STEREOPSIS_STATUS_WINNERS = -76,
  /**
   * Winners: a record's check byte does not fit, or it is of another row.
   */
  STEREOPSIS_STATUS_WINNER_DAMAGED = -77,
  /**
   * Winners: a record is none that the search can have.
   */
  STEREOPSIS_STATUS_WINNER_REFUSED = -78,
  /**
   * Obstacles: a cell has sides of 1 to 16 px, and at most 255 px.
   */
  STEREOPSIS_STATUS_OBSTACLE_CELLS = -79,
  /**
   * Obstacles: there are 1 to 32 sectors.
   */
  STEREOPSIS_STATUS_OBSTACLE_SECTORS = -80,
  /**
   * Obstacles: a height is 0, the pitch or roll is over 500 mrad, or the heights searched are in no order.
   */
  STEREOPSIS_STATUS_OBSTACLE_POSE = -81,
  /**
   * Obstacles: the deviation is not 1 to 320 steps, or an obstacle's height or a drop's depth is 0.
   */
  STEREOPSIS_STATUS_OBSTACLE_LIMITS = -82,
  /**
   * Obstacles: no cell, over 255 rows of cells, or more columns or rows than the finder was created for.
   */
  STEREOPSIS_STATUS_OBSTACLE_SIZE = -83,
  /**
   * Obstacles: the ground is none of the `STEREOPSIS_GROUND_` numbers.
   */
  STEREOPSIS_STATUS_OBSTACLE_GROUND = -84,
  /**
   * Configuration: the margin of open places is over 127.
   */
  STEREOPSIS_STATUS_OPEN_MARGIN = -85,
  /**
   * Configuration: the least confidence is over 207.
   */
  STEREOPSIS_STATUS_MIN_CONFIDENCE = -86
};
#if defined(__cplusplus) ? __cplusplus < 201103L : __STDC_VERSION__ < 202311L
typedef int32_t stereopsis_status;
#elif !defined(__cplusplus)
typedef enum stereopsis_status stereopsis_status;
#endif

/**
 * Detector of features in the caller's memory.
 */
typedef struct stereopsis_detector stereopsis_detector;

/**
 * Drive rule in the caller's memory.
 */
typedef struct stereopsis_drive stereopsis_drive;

/**
 * Focus map in the caller's memory.
 */
typedef struct stereopsis_focus stereopsis_focus;

/**
 * Free space over frames in the caller's memory.
 */
typedef struct stereopsis_free_space stereopsis_free_space;

/**
 * Matcher in the caller's memory.
 */
typedef struct stereopsis stereopsis;

/**
 * Queue of lines in the caller's memory, from an interrupt to the program that takes them.
 */
typedef struct stereopsis_line_queue stereopsis_line_queue;

/**
 * Finder of obstacles in the caller's memory.
 */
typedef struct stereopsis_obstacles stereopsis_obstacles;

/**
 * Odometry in the caller's memory.
 */
typedef struct stereopsis_odometry stereopsis_odometry;

/**
 * Monitor of two cameras in the caller's memory.
 */
typedef struct stereopsis_pair_monitor stereopsis_pair_monitor;

/**
 * Rectifier of raw lines in the caller's memory.
 */
typedef struct stereopsis_rectifier stereopsis_rectifier;

/**
 * Second half of a matcher in the caller's memory, which takes rows of winners.
 */
typedef struct stereopsis_winners stereopsis_winners;

/**
 * Frame size, search range and checks, filled by `stereopsis_config_default` and then open to changes.
 */
typedef struct stereopsis_config {
  /**
   * Pixels in a line: 1 to `stereopsis_max_width()`.
   */
  uint16_t width;
  /**
   * Lines in a frame, at least 1.
   */
  uint16_t height;
  /**
   * Number of whole disparities searched: 16 to `stereopsis_max_disparities()`.
   */
  uint16_t disparities;
  /**
   * Smallest disparity searched, px.
   */
  uint16_t min_disparity;
  /**
   * Left-right check: largest difference of the two answers, 0 to 255 px, or
   * `STEREOPSIS_NOT_CHECKED`.
   */
  int16_t left_right_px;
  /**
   * Uniqueness check: least extra cost of the second best, 0 to 99 percent, or
   * `STEREOPSIS_NOT_CHECKED`.
   */
  int16_t uniqueness_percent;
  /**
   * Texture check: least difference of a textured pixel's left and right neighbours, grey levels.
   */
  uint8_t texture_gradient;
  /**
   * Texture check: least number of textured pixels in the window of an answer; 0 disables it.
   */
  uint8_t texture_pixels;
  /**
   * Whether a winner at the largest disparity searched, or one whose partner is the first column of the
   * right image, is refused; 0 means no.
   */
  uint8_t refuse_ceiling;
  /**
   * Whether a winner that costs as much as both its neighbours is refused; 0 means no.
   */
  uint8_t refuse_flat;
  /**
   * Smoothing: pairs of neighbours along the line that are averaged within a surface, 0 to 8.
   */
  uint8_t smoothing_radius;
  /**
   * Whether a median filter of 3 x 3 pixels is applied; 0 means no.
   */
  uint8_t median;
  /**
   * Largest difference of neighbours of one surface, in 1/32 px, 0 to 32.
   */
  uint16_t surface_step;
  /**
   * Speckle filter: least number of answers of one surface on a cross around an answer; 0 disables it.
   */
  uint8_t speckle_pixels;
  /**
   * Semi-global matching: truncation of gradients, eighths of a grey level per pixel, 1 to 14.
   */
  uint8_t gradient;
  /**
   * Semi-global matching: truncation of a pixel's cost, at least 1.
   */
  uint8_t cost;
  /**
   * Semi-global matching: penalty P1 of a disparity change by one px, at small and larger changes of
   * brightness; at least 1, and the second at most the first.
   */
  uint8_t step[2];
  /**
   * Semi-global matching: penalty P2 of larger disparity changes, at small, larger and large changes of
   * brightness; the first at least the first step, the others at least the second. `cost + step + jump` is
   * at most 127, `3 cost + 2 jump` at most 254.
   */
  uint8_t jump[3];
  /**
   * Semi-global matching: least larger and least large change of brightness, grey levels.
   */
  uint8_t edges[2];
  /**
   * Gap filling: longest gap in a row, pixels, that is filled with the farther of the answers at its ends
   * and flagged `STEREOPSIS_FLAG_FILLED`; 0 disables it.
   */
  uint8_t fill_pixels;
  /**
   * Whether rows have confidences; 0 means no, and saves the search for each pixel's second best.
   */
  uint8_t confidence;
  /**
   * Gap filling: largest difference of the two answers, in 1/32 px; 65535 for no limit.
   */
  uint16_t fill_step;
  /**
   * Noise level of both cameras, a `STEREOPSIS_NOISE_`, which selects the smoothing of compared pixels;
   * `stereopsis_config_noise` sets it with matching checks and penalties.
   */
  uint8_t noise;
  /**
   * Speckle filter: most answers of one row of a surface that count; 0 for no limit.
   */
  uint8_t speckle_run;
  /**
   * Fattening check: by how much an answer may be nearer than others in its row, in 1/32 px for each pixel
   * between, where no edge of brightness lies between; 65535 disables it.
   */
  uint16_t fattening_slope;
  /**
   * Least confidence of an answer, 1 to 207: one that is less sure is refused and flagged
   * `STEREOPSIS_FLAG_AMBIGUOUS`, and rows have confidences; 0 refuses none.
   */
  uint8_t min_confidence;
  /**
   * Open check: in and beside a place without edges that reaches up to the first row, as a sky does, most
   * answers of one row of a surface that count for its speckle; 0 for as many as anywhere.
   */
  uint8_t open_run;
  /**
   * Open check: how much more than an answer's its second best has to cost there, up to 127; 0 disables
   * it.
   */
  uint8_t open_margin;
  /**
   * Whether the methods along paths refuse answers on patterns that repeat along the row within the
   * search, such as a chessboard's; 0 means no.
   */
  uint8_t refuse_repeats;
} stereopsis_config;

/**
 * Winner of one pixel, computed by another device: eight bytes in the order that they are sent in.
 *
 * In columns left of the smallest disparity, which have no candidate, only `row` and `check` mean anything.
 */
typedef struct stereopsis_winner {
  /**
   * Cost of the disparity one below the winner; of that above, where the winner is the smallest candidate;
   * the winner's own, where it is the only one.
   */
  uint8_t below;
  /**
   * Cost of the winner.
   */
  uint8_t cost;
  /**
   * Cost of the disparity one above the winner; of that below, where the winner is the largest candidate.
   */
  uint8_t above;
  /**
   * Winner over the smallest disparity searched, px.
   */
  uint8_t disparity;
  /**
   * Disparity that the winner's partner in the right image keeps, likewise: that of the cheapest winner
   * that chose it, of the leftmost among equals. Methods along paths add four times the difference of the
   * two pixels' grey levels to a winner's cost here, up to 255, unless noise is configured or the rows
   * that a winner looks at end below the picture.
   */
  uint8_t kept;
  /**
   * Least cost of the candidates over two px from the winner; 255 where there is none or none was sought.
   */
  uint8_t second;
  /**
   * Number of the row, its lowest eight bits.
   */
  uint8_t row;
  /**
   * Exclusive or of the seven bytes before, all bits inverted: `stereopsis_winners_seal` writes it.
   */
  uint8_t check;
} stereopsis_winner;

/**
 * Row of results, with arrays in the matcher's memory that hold until the next call with its handle.
 */
typedef struct stereopsis_row {
  /**
   * Row in the image, from 0.
   */
  uint16_t index;
  /**
   * Number of pixels, the length of the arrays.
   */
  uint16_t width;
  /**
   * Disparities of the columns in 1/32 px, `STEREOPSIS_NONE` for no answer.
   */
  const uint16_t *disparities;
  /**
   * `STEREOPSIS_FLAG_` bits of the columns.
   */
  const uint8_t *flags;
  /**
   * Confidences of the columns, 1 to 207, 0 for no answer; null unless the configuration's `confidence` or
   * `min_confidence` is over 0. They rank answers, likely wrong ones first, and are no probabilities.
   */
  const uint8_t *confidences;
} stereopsis_row;

/**
 * Line that waits in a queue.
 */
typedef struct stereopsis_line {
  /**
   * The line's bytes, in the queue's memory: they hold until `stereopsis_line_queue_done`.
   */
  const uint8_t *bytes;
  /**
   * Time of the line, as the interrupt gave it, microseconds.
   */
  uint64_t timestamp_us;
  /**
   * Number of the frame that the line belongs to.
   */
  uint32_t frame;
  /**
   * Number of lines that had found no slot when this one was finished.
   */
  uint32_t overruns;
  /**
   * Row in the frame: it jumps where lines were lost.
   */
  uint16_t row;
} stereopsis_line;

/**
 * What a calibration record says about the raw images.
 */
typedef struct stereopsis_cameras {
  /**
   * Columns of the left camera's raw images, and of the right one's, px.
   */
  uint16_t width[2];
  /**
   * Rows of the left camera's raw images, and of the right one's, px.
   */
  uint16_t height[2];
  /**
   * Distance between the optical centres, m.
   */
  float baseline_m;
} stereopsis_cameras;

/**
 * Rectified stereo rig: aligned rows and one focal length.
 */
typedef struct stereopsis_rig {
  /**
   * Focal length, px.
   */
  float focal_px;
  /**
   * Distance between the optical centres, m.
   */
  float baseline_m;
  /**
   * Principal point of the left camera, column, px.
   */
  float cx;
  /**
   * Principal point of both cameras, row, px.
   */
  float cy;
  /**
   * Principal point of the right camera, column, px.
   */
  float cx_right;
} stereopsis_rig;

/**
 * Noise meter in the caller's memory, for the `stereopsis_noise_` functions; its contents are private.
 */
typedef struct stereopsis_noise_meter {
  /**
   * Counters.
   */
  uint32_t words[65];
} stereopsis_noise_meter;

/**
 * Point in the left camera's frame: X to the right, Y down, Z forward.
 */
typedef struct stereopsis_point {
  /**
   * X, m.
   */
  float x_m;
  /**
   * Y, m.
   */
  float y_m;
  /**
   * Z, m; 0, as X and Y are, where there is no point.
   */
  float z_m;
} stereopsis_point;

/**
 * Histogram of a frame's grey levels in the caller's memory, for the `stereopsis_histogram_` functions; its
 * contents are private.
 */
typedef struct stereopsis_histogram {
  /**
   * Counters.
   */
  uint64_t words[10];
} stereopsis_histogram;

/**
 * Map from the right camera's grey levels to the left one's: `grey <- (gain grey + offset) / 256`, rounded
 * and clamped to 0 to 255.
 */
typedef struct stereopsis_balance {
  /**
   * Offset in 256ths of a grey level.
   */
  int32_t offset_256ths;
  /**
   * Gain in 256ths, 128 to 512 as estimated; 256 with an offset of 0 changes nothing.
   */
  uint16_t gain_256ths;
} stereopsis_balance;

/**
 * Smoothing and holding of the filter over frames, filled by `stereopsis_temporal_default`.
 */
typedef struct stereopsis_temporal {
  /**
   * Largest difference of answers of one surface, in 1/32 px.
   */
  uint16_t most_step;
  /**
   * Weight `1 / 2^shift` of a new answer in the average: 0 does not smooth, at most 4.
   */
  uint8_t shift;
  /**
   * Number of frames for which an answer is held where there is none.
   */
  uint8_t most_held;
} stereopsis_temporal;

/**
 * How the features of a picture are found, filled by `stereopsis_detection_default` and then open to
 * changes.
 */
typedef struct stereopsis_detection {
  /**
   * Pixels in a line.
   */
  uint16_t width;
  /**
   * Lines in a frame.
   */
  uint16_t height;
  /**
   * Side of the square cells over which corners are spread, px: 16 at least.
   */
  uint16_t cell_px;
  /**
   * How many corners are kept in a cell, the strongest first: 1 at least. A detector needs as many slots
   * as are kept in a row of cells.
   */
  uint16_t per_cell;
  /**
   * A corner differs from its circle by more than so many grey levels.
   */
  uint8_t threshold;
  /**
   * Whether descriptors turn with the picture, for any turn of the camera, with fewer matches; 0 means no.
   */
  uint8_t turned;
} stereopsis_detection;

/**
 * A corner that can be found again.
 */
typedef struct stereopsis_feature {
  /**
   * What it looks like: 256 bits, in as many of which as possible other corners differ.
   */
  uint32_t descriptor[8];
  /**
   * Column, px.
   */
  float x_px;
  /**
   * Row, px.
   */
  float y_px;
  /**
   * How strong the corner is.
   */
  uint8_t score;
  /**
   * Level of the picture in a pyramid: 0 is the full picture.
   */
  uint8_t level;
} stereopsis_feature;

/**
 * What became of a picture's corners.
 */
typedef struct stereopsis_detection_counts {
  /**
   * Corners that were found.
   */
  uint32_t corners;
  /**
   * Corners dropped because stronger ones of their cell took its slots.
   */
  uint32_t crowded_out;
  /**
   * Features dropped because the caller's list was full.
   */
  uint32_t dropped;
} stereopsis_detection_counts;

/**
 * What a match of two features has to be, filled by `stereopsis_search_default` and then open to changes.
 */
typedef struct stereopsis_search {
  /**
   * How far partners may lie apart along the row, px.
   */
  float along_px;
  /**
   * How far partners may lie apart across the rows, px.
   */
  float across_px;
  /**
   * The second best partner is one that lies at least so far from the best, px.
   */
  float apart_px;
  /**
   * How far from its epipolar line a partner may lie, px, where a fundamental matrix is given.
   */
  float epipolar_px;
  /**
   * Most bits in which the descriptors of partners differ.
   */
  uint16_t most_different;
  /**
   * A match has fewer different bits than so many percent of the second best partner: 1 to 100.
   */
  uint8_t ratio_percent;
  /**
   * Largest difference of pyramid level between partners.
   */
  uint8_t levels_apart;
} stereopsis_search;

/**
 * Point of the first image and the point of the second image that matches it, undistorted, px.
 */
typedef struct stereopsis_match {
  /**
   * Column in the first image.
   */
  float u;
  /**
   * Row in the first image.
   */
  float v;
  /**
   * Column in the second image.
   */
  float u2;
  /**
   * Row in the second image.
   */
  float v2;
} stereopsis_match;

/**
 * How far matches agree with a fundamental matrix.
 */
typedef struct stereopsis_agreement {
  /**
   * Number of matches within the threshold.
   */
  uint32_t inliers;
  /**
   * Root mean square of their Sampson distances, px.
   */
  float rms_px;
  /**
   * Probability that an estimate as good was missed, by the matches within 1.5 thresholds.
   */
  float miss_probability;
} stereopsis_agreement;

/**
 * Camera without lens distortion.
 */
typedef struct stereopsis_pinhole {
  /**
   * Focal length along rows, px.
   */
  float fx;
  /**
   * Focal length along columns, px.
   */
  float fy;
  /**
   * Principal point, column, px.
   */
  float cx;
  /**
   * Principal point, row, px.
   */
  float cy;
} stereopsis_pinhole;

/**
 * Pose of the second camera beside the first: P = R P' + t.
 */
typedef struct stereopsis_pose {
  /**
   * Rotation R, from the second camera's frame into the first one's, row by row.
   */
  float rotation[9];
  /**
   * Translation t, from the first camera to the second. Two views do not say how long it is:
   * `stereopsis_pose_of` writes length 1, and points come out in its unit.
   */
  float translation[3];
} stereopsis_pose;

/**
 * Size and cells of a focus map, filled by `stereopsis_focus_default` and then open to changes.
 */
typedef struct stereopsis_focus_config {
  /**
   * Pixels in a line.
   */
  uint16_t width;
  /**
   * Lines in a frame.
   */
  uint16_t height;
  /**
   * Side of a cell, px: 1 for an answer a pixel.
   */
  uint16_t cell_px;
  /**
   * A cell's sharpness is that of the window of `4 r + 1` by `4 r + 1` cells around it, nearer ones
   * counting more.
   */
  uint8_t radius;
  /**
   * Whether frames differ in exposure: each one's sharpness counts in proportion to its brightness; 0
   * means no.
   */
  uint8_t exposure_varies;
} stereopsis_focus_config;

/**
 * Where a cell is in focus, and how sure that is.
 */
typedef struct stereopsis_focus_peak {
  /**
   * The frame, counted from 0, in 1/256; 0 where there is none.
   */
  uint32_t position_q8;
  /**
   * Standard deviation of a right peak, in 1/256 frame.
   */
  uint32_t sigma_q8;
  /**
   * How far the peak stands out, in 1/255.
   */
  uint8_t confidence;
  /**
   * Whether there is a peak: a `STEREOPSIS_FOCUS_` number.
   */
  uint8_t found;
} stereopsis_focus_peak;

/**
 * Configuration of an odometry, filled by `stereopsis_odometry_default` and then open to changes.
 */
typedef struct stereopsis_odometry_config {
  /**
   * Seed of the random samples: equal seeds give equal motions.
   */
  uint64_t seed;
  /**
   * Radius of the search around a predicted place while the motion is not known, px; over 0.
   */
  float far_px;
  /**
   * Radius of the search while the motion is known, px; over 0.
   */
  float near_px;
  /**
   * Standard deviation of a place found by template alignment, px; 0.001 to 1000.
   */
  float sigma_px;
  /**
   * Smallest distance of a new point from all others, px; finite.
   */
  float spacing_px;
  /**
   * Largest number of RANSAC samples for a frame, which bounds its time; over 0.
   */
  uint32_t most_samples;
  /**
   * Largest disparity of a new point, px; over 0.
   */
  uint16_t most_disparity_px;
} stereopsis_odometry_config;

/**
 * Whole picture in memory, 8-bit grey, row by row.
 */
typedef struct stereopsis_picture {
  /**
   * `width * height` bytes.
   */
  const uint8_t *pixels;
  /**
   * Number of columns.
   */
  uint16_t width;
  /**
   * Number of rows.
   */
  uint16_t height;
} stereopsis_picture;

/**
 * Motion from the frame before to this one.
 */
typedef struct stereopsis_step {
  /**
   * Carries a point of this camera into the one before, P = R P' + t: t is where this one stands, m.
   */
  struct stereopsis_pose motion;
  /**
   * Covariance of the motion, row by row: a rotation vector, radians, and a step, m, both along this
   * camera's axes. Very large where nothing is known.
   */
  float covariance[36];
  /**
   * Root mean square of what is left of the observations, in units of what was expected.
   */
  float residual;
  /**
   * Points that are followed.
   */
  uint32_t points;
  /**
   * Points that were found in this frame.
   */
  uint32_t found;
  /**
   * Points that agree with the pose.
   */
  uint32_t inliers;
  /**
   * What is known of the motion: a `STEREOPSIS_MOTION_` number.
   */
  uint8_t state;
} stereopsis_step;

/**
 * Limits by which rows of disparity become ground, obstacles and drops, filled by
 * `stereopsis_obstacles_default` and then open to changes.
 */
typedef struct stereopsis_obstacles_config {
  /**
   * Standard deviation of a right answer, in 1/32 px, 1 to 320.
   */
  uint16_t sigma_steps;
  /**
   * Least height of an obstacle above the ground, mm.
   */
  uint16_t obstacle_mm;
  /**
   * Least depth of a drop below the ground, mm.
   */
  uint16_t drop_mm;
  /**
   * Height above which a surface is passed under, mm; 65535 where nothing is.
   */
  uint16_t headroom_mm;
  /**
   * Least area of the connected surface of an obstacle or a drop, px.
   */
  uint16_t min_pixels;
  /**
   * Smallest height of the camera above a ground that is searched, mm.
   */
  uint16_t least_height_mm;
  /**
   * Largest height of the camera above a ground that is searched, mm.
   */
  uint16_t most_height_mm;
  /**
   * Largest tangent of the camera's pitch above a ground that is searched, up or down, in thousandths.
   */
  uint16_t most_pitch;
  /**
   * Largest tangent of the camera's roll above a ground that is searched, to either side, in thousandths.
   */
  uint16_t most_roll;
  /**
   * Height of the camera above a ground that is given, mm.
   */
  uint16_t height_mm;
  /**
   * Downward pitch of the camera above a ground that is given, thousandths of a radian, -500 to 500.
   */
  int16_t pitch_mrad;
  /**
   * Roll of the camera above a ground that is given, thousandths of a radian, -500 to 500: positive where
   * its right side is the lower one.
   */
  int16_t roll_mrad;
  /**
   * Where the ground comes from: a `STEREOPSIS_GROUND_` number.
   */
  uint8_t ground;
  /**
   * Columns of pixels in a cell, 1 to 16.
   */
  uint8_t cell_width;
  /**
   * Rows of pixels in a cell, 1 to 16; a cell has at most 255 pixels.
   */
  uint8_t cell_height;
  /**
   * Least confidence of an answer that counts, where rows have confidences.
   */
  uint8_t min_confidence;
  /**
   * Least confidence of an answer above the horizon, where rows have confidences.
   */
  uint8_t sky_confidence;
  /**
   * Number of sectors that the field of view is cut into, 1 to 32.
   */
  uint8_t sectors;
  /**
   * Least share of cells with an answer in a frame, percent; fewer make it blind.
   */
  uint8_t least_answered;
  /**
   * Largest share of rows that were lost or are damaged, percent; more make a frame blind.
   */
  uint8_t most_lost;
} stereopsis_obstacles_config;

/**
 * Ground plane: its parallax grows by `slope` from row to row and by `lean` from column to column.
 */
typedef struct stereopsis_ground {
  /**
   * Parallax at row 0 in the column of the principal point, in 1/32 px, in 65536ths.
   */
  int64_t level;
  /**
   * Growth of the parallax from a row to the next, in 1/32 px, in 65536ths.
   */
  int64_t slope;
  /**
   * Growth of the parallax from a column to the next, in 1/32 px, in 65536ths.
   */
  int32_t lean;
  /**
   * Downward pitch of the camera, radians.
   */
  float pitch_rad;
  /**
   * Roll of the camera, radians: positive where its right side is the lower one.
   */
  float roll_rad;
  /**
   * Standard deviation of the pitch, radians.
   */
  float pitch_sigma_rad;
  /**
   * Variance of the parallax, squares of 1/32 px.
   */
  uint32_t variance;
  /**
   * Height of the camera above the ground, mm.
   */
  uint16_t height_mm;
  /**
   * Whether the ground is known: three deviations of its pitch are within half a degree. Where it is not,
   * the rest is the plane from which heights are measured, of which too little is seen to be sure of its
   * pitch; the height is 0 where there is none, as is all else.
   */
  uint8_t is_known;
} stereopsis_ground;

/**
 * Nearest obstacle or drop of a column of cells.
 */
typedef struct stereopsis_stixel {
  /**
   * First row of pixels.
   */
  uint16_t top_row;
  /**
   * Last row of pixels.
   */
  uint16_t base_row;
  /**
   * Disparity in 1/32 px, `STEREOPSIS_NONE` for nothing; of a drop that of the ground at its edge.
   */
  uint16_t disparity;
  /**
   * Standard deviation of the disparity, in 1/32 px, at most 255.
   */
  uint16_t sigma_steps;
  /**
   * Depth along the optical axis, mm; 0 for nothing.
   */
  uint16_t depth_mm;
  /**
   * Uppermost row of pixels to which the ground is seen from the lowest one on; the first row below
   * the cells where it is not, and 65535 in a frame that is not finished.
   */
  uint16_t seen_row;
  /**
   * What it is: a `STEREOPSIS_STIXEL_` number.
   */
  uint8_t kind;
} stereopsis_stixel;

/**
 * Nearest surface in a sector of the field of view.
 */
typedef struct stereopsis_sector {
  /**
   * Area of the connected surface, px, in whole cells.
   */
  uint32_t pixels;
  /**
   * Bearing of the surface, or of the sector's middle where there is none, thousandths of a radian, to the
   * right.
   */
  int16_t bearing_mrad;
  /**
   * Depth of the surface along the optical axis, mm; 0 where there is none.
   */
  uint16_t depth_mm;
  /**
   * Standard deviation of the depth, mm.
   */
  uint16_t sigma_mm;
  /**
   * Distance of the surface in the plane of the optical axis and the rows, mm.
   */
  uint16_t range_mm;
  /**
   * Height of the surface's upper end above the ground, mm; 0 where no ground is known.
   */
  int16_t height_mm;
  /**
   * Depth up to which the ground is seen in all columns that show it, mm; without a ground, 65535.
   */
  uint16_t seen_mm;
  /**
   * What the sector shows: a `STEREOPSIS_SECTOR_` number.
   */
  uint8_t state;
} stereopsis_sector;

/**
 * Angles and limits of a laser scan: radians to the left, as ROS has them, and metres.
 */
typedef struct stereopsis_scan {
  /**
   * Angle of the first range, rad: the middle of the rightmost sector.
   */
  float angle_min;
  /**
   * Angle of the last range that was written, rad: the middle of the leftmost sector where all are.
   */
  float angle_max;
  /**
   * Angle between two ranges, rad.
   */
  float angle_increment;
  /**
   * Smallest range that can be measured, m.
   */
  float range_min;
  /**
   * The range up to which a free sector is free, m: that up to which all of them are seen. Obstacles
   * beyond it are there, but who takes a scan leaves them out.
   */
  float range_max;
  /**
   * Number of ranges that were written.
   */
  uint32_t count;
} stereopsis_scan;

/**
 * How a vehicle drives and brakes, filled by `stereopsis_drive_default` and then open to changes.
 */
typedef struct stereopsis_drive_config {
  /**
   * Width of the corridor that the vehicle drives through, mm, half of it on each side of the optical axis
   * of the left camera: where the vehicle's middle is elsewhere, twice the distance of the two more.
   */
  uint16_t corridor_mm;
  /**
   * Distance from the camera at which the vehicle has to stand, mm.
   */
  uint16_t margin_mm;
  /**
   * Time from a picture to the brakes, ms.
   */
  uint16_t reaction_ms;
  /**
   * Deceleration of the brakes, mm/s^2; 0 is taken as 1.
   */
  uint16_t brake_mm_s2;
  /**
   * Time to contact below which to slow down, ms.
   */
  uint16_t slow_ms;
  /**
   * Frames in a row that have to show an obstacle before it counts; 1 is at once.
   */
  uint8_t confirm;
  /**
   * Frames in a row without an obstacle for which it still counts.
   */
  uint8_t release;
} stereopsis_drive_config;

/**
 * What to do, and what that rests on.
 */
typedef struct stereopsis_verdict {
  /**
   * Time until the vehicle reaches what is nearest at its speed, ms, or `STEREOPSIS_NO_CONTACT`.
   */
  uint32_t contact_ms;
  /**
   * Distance of what stops the vehicle or slows it down, less two standard deviations, mm; 0 of others.
   */
  uint16_t distance_mm;
  /**
   * Way that the vehicle needs to stand, mm, margin included.
   */
  uint16_t stopping_mm;
  /**
   * What to do: a `STEREOPSIS_DECISION_` number.
   */
  uint8_t decision;
  /**
   * Why nothing is known: a `STEREOPSIS_BLIND_` number, 0 of other decisions.
   */
  uint8_t blind;
  /**
   * What is nearest in this frame's corridor, a `STEREOPSIS_STIXEL_` number; nothing where the decision is
   * held from an earlier frame.
   */
  uint8_t nearest;
} stereopsis_verdict;

/**
 * Saturating counts since `stereopsis_start`.
 */
typedef struct stereopsis_counts {
  /**
   * Frames that began.
   */
  uint32_t frames;
  /**
   * Frames of which every line came and every row was given.
   */
  uint32_t frames_whole;
  /**
   * Frames of which every row was given, some of them flagged.
   */
  uint32_t frames_damaged;
  /**
   * Frames that ended early.
   */
  uint32_t frames_broken;
  /**
   * Rows that were given.
   */
  uint32_t rows;
  /**
   * Rows with `STEREOPSIS_FLAG_DAMAGED`.
   */
  uint32_t rows_damaged;
  /**
   * Lines that came.
   */
  uint32_t lines;
  /**
   * Lines reported as `STEREOPSIS_LOST_DROPPED`.
   */
  uint32_t lines_dropped;
  /**
   * Lines reported as `STEREOPSIS_LOST_TORN`.
   */
  uint32_t lines_torn;
  /**
   * Lines reported as `STEREOPSIS_LOST_LATE`.
   */
  uint32_t lines_late;
  /**
   * Lines reported as `STEREOPSIS_LOST_STALE`.
   */
  uint32_t lines_stale;
} stereopsis_counts;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Returns the bytes of memory that the second half of a matcher takes.
 */
size_t stereopsis_winners_size(void);

/**
 * Returns the delay in lines of the second half: row y comes out when line y +
 * `stereopsis_winners_latency()` goes in; the last rows come by `stereopsis_winners_flush`.
 */
size_t stereopsis_winners_latency(void);

/**
 * Creates the second half of a matcher in the caller's memory of `length` bytes, aligned to
 * `STEREOPSIS_ALIGN`: it takes rows of winners that something else computed, such as gates or
 * another core, and gives the rows that a matcher of this library gives. Writes the handle; a null
 * handle on an error, unless `handle` itself is invalid. The memory is not read, and belongs to it
 * until `stereopsis_winners_deinit`.
 */
stereopsis_status stereopsis_winners_init(void *memory, size_t length, struct stereopsis_winners **handle);

/**
 * Ends a second half, whose memory returns to the caller.
 */
stereopsis_status stereopsis_winners_deinit(struct stereopsis_winners *handle);

/**
 * Checks a configuration, which is copied, and prepares for the first frame. Writes 1 or 0: whether
 * a check looks at the left camera's lines, and whether one looks at the winners' `second`.
 */
stereopsis_status stereopsis_winners_start(struct stereopsis_winners *handle,
                                           const struct stereopsis_config *config,
                                           uint8_t *needs_lines,
                                           uint8_t *needs_second);

/**
 * Begins a frame, and drops the one before.
 */
stereopsis_status stereopsis_winners_begin_frame(struct stereopsis_winners *handle);

/**
 * Writes the row whose winners the next call of `stereopsis_winners_push` takes, or of
 * `stereopsis_winners_flush` after the last line; with `STEREOPSIS_STATUS_NO_ROW_YET` that call
 * takes none, and nothing is written.
 */
stereopsis_status stereopsis_winners_due(struct stereopsis_winners *handle, uint16_t *row);

/**
 * Takes the next line of the left camera, `length` bytes, which is the configuration's width, and
 * the `count` winners of the row of `stereopsis_winners_due`, as many as a line has pixels. The line
 * may be null where no check looks at it. Null winners mean none where none are due, and a lost row
 * where some are: it has no answers and `STEREOPSIS_FLAG_DAMAGED` on every pixel, and rows that it
 * affects through checks have the flag.
 *
 * Returns `STEREOPSIS_STATUS_OK` with a row, or `STEREOPSIS_STATUS_NO_ROW_YET` with an empty one for
 * the first lines of a frame. After an error, such as `STEREOPSIS_STATUS_WINNER_DAMAGED`, the same
 * row may be given again.
 */
stereopsis_status stereopsis_winners_push(struct stereopsis_winners *handle,
                                          const uint8_t *left,
                                          size_t length,
                                          const struct stereopsis_winner *winners,
                                          size_t count,
                                          struct stereopsis_row *row);

/**
 * Takes the winners that are due after the last line, as `stereopsis_winners_push` does: returns
 * `STEREOPSIS_STATUS_OK` with a row, `STEREOPSIS_STATUS_NO_ROW_YET` with an empty one in frames of
 * few lines, or `STEREOPSIS_STATUS_FRAME_DONE` with an empty one after the last row.
 */
stereopsis_status stereopsis_winners_flush(struct stereopsis_winners *handle,
                                           const struct stereopsis_winner *winners,
                                           size_t count,
                                           struct stereopsis_row *row);

/**
 * Writes the standard deviations of the last row of a second half, as `stereopsis_sigma_px` does.
 */
stereopsis_status stereopsis_winners_sigma_px(struct stereopsis_winners *handle,
                                              float *sigma_px,
                                              size_t count);

/**
 * Writes `row` and `check` of `count` winners of a row.
 */
stereopsis_status stereopsis_winners_seal(struct stereopsis_winner *winners, size_t count, uint16_t row);

/**
 * Creates a queue of lines of `line_bytes` bytes, 1 to 65535, in the caller's memory of `length`
 * bytes, aligned to `STEREOPSIS_ALIGN`: as many slots as have room, at least two. Writes the handle;
 * a null handle on an error, unless `handle` itself is invalid. Fails with
 * `STEREOPSIS_STATUS_LINE_BYTES` for other lengths, with `STEREOPSIS_STATUS_MEMORY_TOO_SHORT` for
 * fewer slots.
 *
 * One slot less than there are holds lines that wait, among them the one that is being read. So two
 * slots are enough where each line is done before the next one begins; three let a line come in
 * while another one is read.
 *
 * A queue takes lines from one interrupt, which calls `stereopsis_line_queue_begin` and `_finish`,
 * to one program, which calls `stereopsis_line_queue_next` and `_done`. Either side may interrupt
 * the other, on one core or on two; there is no lock. The memory is not read, and belongs to the
 * queue until `stereopsis_line_queue_deinit`.
 */
stereopsis_status stereopsis_line_queue_init(void *memory,
                                             size_t length,
                                             size_t line_bytes,
                                             struct stereopsis_line_queue **handle);

/**
 * Ends a queue, whose memory returns to the caller: when neither side uses it any more.
 */
stereopsis_status stereopsis_line_queue_deinit(struct stereopsis_line_queue *handle);

/**
 * In the interrupt: writes where the next line goes, `line_bytes` bytes aligned to 8, for a DMA or a
 * loop to fill. Where all slots but one hold lines that wait, the result is
 * `STEREOPSIS_STATUS_NO_SLOT`, `bytes` is left as it was, and the line counts as lost. A slot that
 * was not finished is given once more.
 */
stereopsis_status stereopsis_line_queue_begin(struct stereopsis_line_queue *handle, uint8_t **bytes);

/**
 * In the interrupt: hands the line of `stereopsis_line_queue_begin` over, with the number of its
 * frame, its row and its time. Fails with `STEREOPSIS_STATUS_LINE_NOT_BEGUN` without one.
 */
stereopsis_status stereopsis_line_queue_finish(struct stereopsis_line_queue *handle,
                                               uint32_t frame,
                                               uint16_t row,
                                               uint64_t timestamp_us);

/**
 * In the program: writes the line that has waited longest, or answers
 * `STEREOPSIS_STATUS_NO_LINE_YET` and writes nothing. It is the same line until
 * `stereopsis_line_queue_done`.
 */
stereopsis_status stereopsis_line_queue_next(struct stereopsis_line_queue *handle,
                                             struct stereopsis_line *line);

/**
 * In the program: gives the slot of the line of `stereopsis_line_queue_next` back to the interrupt.
 * Fails with `STEREOPSIS_STATUS_LINE_NOT_TAKEN` without one.
 */
stereopsis_status stereopsis_line_queue_done(struct stereopsis_line_queue *handle);

/**
 * Writes how many lines have found no slot; either side may ask.
 */
stereopsis_status stereopsis_line_queue_overruns(struct stereopsis_line_queue *handle, uint32_t *overruns);

/**
 * Checks a calibration record, what `stereo calib convert --to c` writes, in the first
 * `STEREOPSIS_RECORD_BYTES` of `length` bytes, which need no alignment, and writes what it says
 * about the raw images.
 */
stereopsis_status stereopsis_record_read(const uint8_t *record,
                                         size_t length,
                                         struct stereopsis_cameras *cameras);

/**
 * Returns the bytes of memory that a rectifier takes.
 */
size_t stereopsis_rectifier_size(void);

/**
 * Returns the raw lines of each camera that a rectifier of this library holds, one of which is a
 * copy.
 */
size_t stereopsis_rectifier_lines(void);

/**
 * Creates a rectifier in the caller's memory of `length` bytes, aligned to `STEREOPSIS_ALIGN`, and
 * writes the handle for its other calls; a null handle on an error, unless `handle` itself is
 * invalid.
 *
 * The memory is not read, and belongs to the rectifier until `stereopsis_rectifier_deinit`.
 */
stereopsis_status stereopsis_rectifier_init(void *memory,
                                            size_t length,
                                            struct stereopsis_rectifier **handle);

/**
 * Ends a rectifier, whose memory returns to the caller. The handle is the memory's address.
 */
stereopsis_status stereopsis_rectifier_deinit(struct stereopsis_rectifier *handle);

/**
 * Reads a calibration record and prepares its rectification, which is for lines of both cameras in
 * step, into images of `width` x `height` pixels. `alpha` is OpenCV's: from 0, nothing but what both
 * cameras see, to 1, all of both raw images; `STEREOPSIS_ALPHA_NATURAL` keeps the scale of the raw
 * images. Writes the rectified rig for depths and, unless `lines` is null, how many lines a
 * rectifier needs to hold for it, which is at least so many where the result is
 * `STEREOPSIS_STATUS_RECTIFY_LINES`.
 *
 * It is in single precision: every core finds the same lines. A record or sizes that are refused
 * leave the rectifier as it was; after `STEREOPSIS_STATUS_RECTIFY_LINES` or
 * `STEREOPSIS_STATUS_RECTIFY_BENT` it is not started.
 */
stereopsis_status stereopsis_rectifier_start(struct stereopsis_rectifier *handle,
                                             const uint8_t *record,
                                             size_t length,
                                             uint16_t width,
                                             uint16_t height,
                                             float alpha,
                                             struct stereopsis_rig *rig,
                                             size_t *lines);

/**
 * Begins a frame, and drops the one before.
 */
stereopsis_status stereopsis_rectifier_begin_frame(struct stereopsis_rectifier *handle);

/**
 * Takes the next raw line of both cameras, 8-bit grey, `length` bytes each, which is the record's
 * width. The lines are copied; both may be one array.
 *
 * Returns `STEREOPSIS_STATUS_OK` where `stereopsis_rectifier_line` has lines, all of which have to
 * be taken before the next raw line, else `STEREOPSIS_STATUS_NO_ROW_YET`;
 * `STEREOPSIS_STATUS_FRAME_DONE` for raw lines below the last rectified one, which need not be
 * pushed.
 */
stereopsis_status stereopsis_rectifier_push(struct stereopsis_rectifier *handle,
                                            const uint8_t *left,
                                            const uint8_t *right,
                                            size_t length);

/**
 * Takes the raw lines above again in place of lost ones, zeros for a frame's first ones, and returns
 * what `stereopsis_rectifier_push` does.
 */
stereopsis_status stereopsis_rectifier_push_lost(struct stereopsis_rectifier *handle);

/**
 * Writes the next rectified line of both cameras, in the order of their rows, `length` bytes each,
 * which is the rectified width, for `stereopsis_push`. A pixel that a camera does not see is 0.
 *
 * Returns `STEREOPSIS_STATUS_OK` with lines, `STEREOPSIS_STATUS_NO_ROW_YET` where raw lines are
 * needed, `STEREOPSIS_STATUS_LOST` for a row that needs a lost one, for `stereopsis_push_lost`, and
 * `STEREOPSIS_STATUS_FRAME_DONE` after the last row.
 */
stereopsis_status stereopsis_rectifier_line(struct stereopsis_rectifier *handle,
                                            uint8_t *left,
                                            uint8_t *right,
                                            size_t length);

/**
 * Writes which pixels of a rectified row each camera sees, 1 or 0, `length` bytes each, for
 * `stereopsis_mask` when that row of disparities comes out. It needs no frame.
 */
stereopsis_status stereopsis_rectifier_mask(struct stereopsis_rectifier *handle,
                                            uint16_t row,
                                            uint8_t *left,
                                            uint8_t *right,
                                            size_t length);

/**
 * Clears a noise meter, which needs no matcher. Measure a frame as often as the light may change,
 * and set the level in the configuration of the next ones.
 */
stereopsis_status stereopsis_noise_clear(struct stereopsis_noise_meter *meter);

/**
 * Measures a line of either camera, 8-bit grey, 65535 bytes at most.
 */
stereopsis_status stereopsis_noise_line(struct stereopsis_noise_meter *meter,
                                        const uint8_t *line,
                                        size_t length);

/**
 * Writes the `STEREOPSIS_NOISE_` number of the lines so far, for `stereopsis_config_noise`, and
 * unless `sigma_16ths` is null the standard deviation in 1/16 grey level; none and 0 before the
 * first line.
 */
stereopsis_status stereopsis_noise_level(struct stereopsis_noise_meter *meter,
                                         uint8_t *noise,
                                         uint16_t *sigma_16ths);

/**
 * Converts `count` disparities to depths in whole millimetres, 0 for no answer, at infinity, or
 * beyond 65.535 m. Both arrays may be one.
 */
stereopsis_status stereopsis_millimetres(const struct stereopsis_rig *rig,
                                         const uint16_t *disparities,
                                         uint16_t *millimetres,
                                         size_t count);

/**
 * Converts `count` disparities, with standard deviations as from `stereopsis_sigma_px`, to depths in
 * metres and their standard deviations: 0 and infinity for no answer, or at infinity. `sigma_px` and
 * `sigma_m` may be one array, or both null: then depths alone are written. No other two may overlap.
 */
stereopsis_status stereopsis_metres(const struct stereopsis_rig *rig,
                                    const uint16_t *disparities,
                                    const float *sigma_px,
                                    float *depth_m,
                                    float *sigma_m,
                                    size_t count);

/**
 * Converts the `count` disparities of row `row`, from its first column on, to points in the left
 * camera's frame; all 0 for no answer, or at infinity. A row has at most 65535 of them. The arrays
 * do not overlap.
 */
stereopsis_status stereopsis_points(const struct stereopsis_rig *rig,
                                    uint16_t row,
                                    const uint16_t *disparities,
                                    struct stereopsis_point *points,
                                    size_t count);

/**
 * Clears a histogram, one for each camera, before a frame.
 */
stereopsis_status stereopsis_histogram_clear(struct stereopsis_histogram *histogram);

/**
 * Counts every eighth pixel of row `row`, 8-bit grey, 65535 bytes at most.
 */
stereopsis_status stereopsis_histogram_line(struct stereopsis_histogram *histogram,
                                            uint16_t row,
                                            const uint8_t *line,
                                            size_t length);

/**
 * Estimates from the histograms of a frame, of the lines as the cameras gave them, by which gain and
 * offset the right camera's next frame becomes as bright as the left one's. Cameras that differ by
 * less than 16 grey levels in the mean, and frames without contrast, are left as they are: a gain of
 * 256 and an offset of 0.
 */
stereopsis_status stereopsis_balance_between(const struct stereopsis_histogram *left,
                                             const struct stereopsis_histogram *right,
                                             struct stereopsis_balance *balance);

/**
 * Balances a line of the right camera in place, 8-bit grey, `length` bytes, before the matcher takes
 * it.
 */
stereopsis_status stereopsis_balance_line(const struct stereopsis_balance *balance,
                                          uint8_t *line,
                                          size_t length);

/**
 * Takes the `count` disparities of row `row`, at most 65535, into blocks of `block` x `block`
 * pixels, 2 to 8 a side. With the last row of blocks it writes `count / block` disparities to
 * `smaller`, which are row `row / block` of the smaller image, and returns `STEREOPSIS_STATUS_OK`;
 * else it returns `STEREOPSIS_STATUS_NO_ROW_YET`. Each is the median of its block's answers, the
 * nearer of two middle ones, where at least half of the pixels have one; disparities stay in pixels
 * of the full image. `rows` holds `block * count` words from call to call and needs no content: a
 * frame's rows come from 0 on, without gaps. The arrays do not overlap.
 */
stereopsis_status stereopsis_decimate(uint16_t *rows,
                                      uint16_t block,
                                      uint16_t row,
                                      const uint16_t *disparities,
                                      size_t count,
                                      uint16_t *smaller);

/**
 * Fills a configuration of the filter over frames: it averages within one pixel with weight 1/4, and
 * holds answers for two frames.
 */
stereopsis_status stereopsis_temporal_default(struct stereopsis_temporal *config);

/**
 * Prepares the filter's memory, a word and a byte for each of `count` pixels, all rows together or
 * one by one: before the first frame, after a cut, or when the cameras were moved.
 */
stereopsis_status stereopsis_temporal_forget(uint16_t *averages, uint8_t *ages, size_t count);

/**
 * Filters a row of `count` disparities over its part of the filter's memory: writes the running
 * averages, which hold answers over short gaps, to `filtered`, and a `STEREOPSIS_ORIGIN_` number for
 * each to `origins`. The arrays do not overlap. Fails on a shift over 4.
 */
stereopsis_status stereopsis_temporal_row(const struct stereopsis_temporal *config,
                                          uint16_t *averages,
                                          uint8_t *ages,
                                          const uint16_t *disparities,
                                          uint16_t *filtered,
                                          uint8_t *origins,
                                          size_t count);

/**
 * Fills a configuration for pictures of `width` x `height` pixels: the five strongest corners of
 * every 32 x 32 pixels, over 12 grey levels, for cameras that do not turn about their axes.
 */
stereopsis_status stereopsis_detection_default(uint16_t width,
                                               uint16_t height,
                                               struct stereopsis_detection *config);

/**
 * Creates a detector of features in the caller's memory of `length` bytes, aligned to
 * `STEREOPSIS_ALIGN`: for lines of up to `width` pixels, and `slots` corners that are kept in a row
 * of cells, `per_cell` for each of them. Writes the handle; a null handle on an error, unless
 * `handle` itself is invalid. The memory is not read, and belongs to the detector until
 * `stereopsis_detector_deinit`.
 */
stereopsis_status stereopsis_detector_init(void *memory,
                                           size_t length,
                                           uint16_t width,
                                           uint16_t slots,
                                           struct stereopsis_detector **handle);

/**
 * Ends a detector, whose memory returns to the caller.
 */
stereopsis_status stereopsis_detector_deinit(struct stereopsis_detector *handle);

/**
 * Checks a configuration, which is copied, and begins a picture. Fails with
 * `STEREOPSIS_STATUS_DETECTOR_WIDTH`, `_DETECTOR_CELLS` or `_DETECTOR_SLOTS`, and leaves the
 * detector as it was.
 */
stereopsis_status stereopsis_detector_start(struct stereopsis_detector *handle,
                                            const struct stereopsis_detection *config);

/**
 * Takes the next line of a picture, 8-bit grey, `length` bytes, which is the configuration's width.
 * Features that are ready are added to `features`, which has room for `capacity`, behind the `count`
 * that are there, and `count` grows: 0 before the first line. With the last line all are ready.
 * What finds no room is counted as dropped. Fails where `count` is over `capacity`, with
 * `STEREOPSIS_STATUS_NO_LINE_LEFT` after the last line, and with `_LINE_LENGTH`.
 */
stereopsis_status stereopsis_detector_push(struct stereopsis_detector *handle,
                                           const uint8_t *line,
                                           size_t length,
                                           struct stereopsis_feature *features,
                                           size_t capacity,
                                           size_t *count);

/**
 * Writes what became of the picture's corners.
 */
stereopsis_status stereopsis_detector_counts(struct stereopsis_detector *handle,
                                             struct stereopsis_detection_counts *counts);

/**
 * Fills a search: partners lie anywhere in the other picture, differ in at most 64 bits, and in less
 * than 80 percent of those of the second best, which lies 4 px or more from the best.
 */
stereopsis_status stereopsis_search_default(struct stereopsis_search *search);

/**
 * Matches the features of two pictures, each with its best partner in both directions, for
 * `stereopsis_fundamental` and the functions beside it. `fundamental` says on which lines partners
 * lie, or is null. `slots` has five words for each feature of the longer list and needs no content.
 * Writes up to `capacity` matches and their number.
 *
 * Returns `STEREOPSIS_STATUS_DROPPED` where `matches` had no room for all of them. Fails with
 * `STEREOPSIS_STATUS_SEARCH` on numbers that make no search, with `_FUNDAMENTAL_RANK`, and with
 * `_TOO_MANY` on over 65534 features. What is written overlaps nothing else.
 */
stereopsis_status stereopsis_match_features(const struct stereopsis_search *search,
                                            const float *fundamental,
                                            const struct stereopsis_feature *left,
                                            size_t left_count,
                                            const struct stereopsis_feature *right,
                                            size_t right_count,
                                            uint16_t *slots,
                                            struct stereopsis_match *matches,
                                            size_t capacity,
                                            size_t *count);

/**
 * Computes the fundamental matrix F of `count` matches, eight or more, all of them right: row by
 * row, with p^T F p' = 0 for p in the first image and p' in the second (eight-point algorithm).
 * Fails on fewer, on numbers that are not finite, and where the matches leave F undetermined.
 */
stereopsis_status stereopsis_eight_point(const struct stereopsis_match *matches,
                                         size_t count,
                                         float *fundamental);

/**
 * Estimates F of `count` matches, some of them wrong, and which agree with it (RANSAC, at most
 * 10 000 samples): `inliers` gets 1 for a match whose Sampson distance is up to `threshold_px`, and
 * 0 for another. Equal seeds give equal results. Fails on fewer than eight matches, on numbers that
 * are not finite, on a threshold that is not over 0, where not more than seven matches agree, and
 * where they are on a plane; `inliers` may have been written then. What is written overlaps nothing
 * else.
 */
stereopsis_status stereopsis_fundamental(const struct stereopsis_match *matches,
                                         size_t count,
                                         float threshold_px,
                                         uint64_t seed,
                                         float *fundamental,
                                         uint8_t *inliers,
                                         struct stereopsis_agreement *agreement);

/**
 * Recovers the pose of the second camera from F, with which most of the `count` matches are in
 * front of both cameras. `inliers` says which matches count, as from `stereopsis_fundamental`; null
 * for all of them. Fails where F is no fundamental matrix, a camera's numbers cannot be, or no pose
 * has more than half of the matches in front.
 */
stereopsis_status stereopsis_pose_of(const struct stereopsis_match *matches,
                                     const uint8_t *inliers,
                                     size_t count,
                                     const float *fundamental,
                                     const struct stereopsis_pinhole *first,
                                     const struct stereopsis_pinhole *second,
                                     struct stereopsis_pose *pose);

/**
 * Triangulates `count` matches with least re-projection error: points in the first camera's frame,
 * in the unit of the pose's translation; all 0 where the rays are nearly parallel or do not meet
 * in front of both cameras. Fails where a camera's or the pose's numbers cannot be.
 */
stereopsis_status stereopsis_triangulate(const struct stereopsis_match *matches,
                                         size_t count,
                                         const struct stereopsis_pinhole *first,
                                         const struct stereopsis_pinhole *second,
                                         const struct stereopsis_pose *pose,
                                         struct stereopsis_point *points);

/**
 * Fills a configuration for frames of `width` x `height` pixels: an answer a pixel, from windows of
 * radius 3. Cells of 8 px and radius 0 are an answer a tile.
 */
stereopsis_status stereopsis_focus_default(uint16_t width,
                                           uint16_t height,
                                           struct stereopsis_focus_config *config);

/**
 * Creates a focus map in the caller's memory of `length` bytes, aligned to `STEREOPSIS_ALIGN`: for
 * lines of up to `width` pixels, rows of up to `columns` cells, and frames of up to `cells` cells.
 * Writes the handle; a null handle on an error, unless `handle` itself is invalid. The memory is not
 * read, and belongs to the map until `stereopsis_focus_deinit`.
 */
stereopsis_status stereopsis_focus_init(void *memory,
                                        size_t length,
                                        uint16_t width,
                                        uint16_t columns,
                                        uint32_t cells,
                                        struct stereopsis_focus **handle);

/**
 * Ends a focus map, whose memory returns to the caller.
 */
stereopsis_status stereopsis_focus_deinit(struct stereopsis_focus *handle);

/**
 * Checks a configuration, which is copied, and begins a stack of frames; what is left of another one
 * is forgotten. Fails with `STEREOPSIS_STATUS_FOCUS_SIZE` or `_FOCUS_WINDOW`, and leaves the map as
 * it was.
 */
stereopsis_status stereopsis_focus_start(struct stereopsis_focus *handle,
                                         const struct stereopsis_focus_config *config);

/**
 * Begins the next frame of the stack, in which everything is `scale` times as large as in the first
 * one, 1/2 to 2: 1 where the lens does not breathe. Fails with `STEREOPSIS_STATUS_LINES_MISSING`
 * before the last line of the frame before, with `_FOCUS_SCALE`, and with `_FOCUS_FRAMES` after
 * 65535 frames.
 */
stereopsis_status stereopsis_focus_begin_frame(struct stereopsis_focus *handle, float scale);

/**
 * Takes the next line of a frame, 8-bit grey, `length` bytes, which is the configuration's width.
 * Fails with `STEREOPSIS_STATUS_NO_LINE_LEFT` where none is due, and with `_LINE_LENGTH`.
 */
stereopsis_status stereopsis_focus_push(struct stereopsis_focus *handle, const uint8_t *line, size_t length);

/**
 * Ends the stack: then all peaks are known. Fails with `STEREOPSIS_STATUS_LINES_MISSING` before the
 * last line of a frame, and with `_NOT_STARTED` where it has ended.
 */
stereopsis_status stereopsis_focus_finish(struct stereopsis_focus *handle);

/**
 * Writes the peaks of the first `count` cells of row `row` of cells, at most 65535. Cells that are
 * not in the frame are as those of too few frames. Fails with
 * `STEREOPSIS_STATUS_FOCUS_NOT_FINISHED` before the end of the stack.
 */
stereopsis_status stereopsis_focus_row(struct stereopsis_focus *handle,
                                       uint16_t row,
                                       struct stereopsis_focus_peak *peaks,
                                       size_t count);

/**
 * Fills a configuration for pictures of `width` columns.
 */
stereopsis_status stereopsis_odometry_default(uint16_t width, struct stereopsis_odometry_config *config);

/**
 * Creates an odometry of a rectified pair in the caller's memory of `length` bytes, aligned to
 * `STEREOPSIS_ALIGN`, which follows up to `points` points, 16 to 65534. Writes the handle; a null
 * handle on an error, unless `handle` itself is invalid. The memory is not read, and belongs to the
 * odometry until `stereopsis_odometry_deinit`.
 */
stereopsis_status stereopsis_odometry_init(void *memory,
                                           size_t length,
                                           uint16_t points,
                                           struct stereopsis_odometry **handle);

/**
 * Ends an odometry, whose memory returns to the caller.
 */
stereopsis_status stereopsis_odometry_deinit(struct stereopsis_odometry *handle);

/**
 * Begins with a rectified rig, as from `stereopsis_rectifier_start`; what was known is forgotten.
 * Fails where the rig's numbers are none, and with `STEREOPSIS_STATUS_ODOMETRY_CONFIG` where
 * `far_px`, `near_px`, `most_disparity_px` or `most_samples` is not over 0, `sigma_px` is not 0.001
 * to 1000, or `spacing_px` is negative, infinite or not a number.
 */
stereopsis_status stereopsis_odometry_start(struct stereopsis_odometry *handle,
                                            const struct stereopsis_rig *rig,
                                            const struct stereopsis_odometry_config *config);

/**
 * Takes the next frame: both rectified pictures, and the `count` features of the left one, as from
 * `stereopsis_detector_push`. Writes the motion since the frame before. Fails with
 * `STEREOPSIS_STATUS_PICTURE_SIZE` where pictures differ in size, or from those before, and with
 * `_NOT_STARTED`; what is not known of a motion is no failure, and stands in `state`.
 */
stereopsis_status stereopsis_odometry_step(struct stereopsis_odometry *handle,
                                           const struct stereopsis_picture *left,
                                           const struct stereopsis_picture *right,
                                           const struct stereopsis_feature *features,
                                           size_t count,
                                           struct stereopsis_step *step);

/**
 * Fills a configuration: cells of 4 x 5 px, a deviation of 0.15 px, a ground that is searched 0.1 m
 * to 3 m below the camera, obstacles and drops of 5 cm, and 16 sectors.
 */
stereopsis_status stereopsis_obstacles_default(struct stereopsis_obstacles_config *config);

/**
 * Creates a finder of obstacles in the caller's memory of `length` bytes, aligned to
 * `STEREOPSIS_ALIGN`: for frames of up to `columns` columns and `rows` rows of cells, 1 to 255.
 * Writes the handle; a null handle on an error, unless `handle` itself is invalid. The memory is not
 * read, and belongs to the finder until `stereopsis_obstacles_deinit`.
 */
stereopsis_status stereopsis_obstacles_init(void *memory,
                                            size_t length,
                                            uint16_t columns,
                                            uint16_t rows,
                                            struct stereopsis_obstacles **handle);

/**
 * Ends a finder, whose memory returns to the caller.
 */
stereopsis_status stereopsis_obstacles_deinit(struct stereopsis_obstacles *handle);

/**
 * Starts on frames of `width` x `height` pixels from a rectified rig, with disparities of up to
 * `largest_px`; what was carried from frame to frame is forgotten. Columns and rows of pixels that
 * fill no cell are left out. Fails with `STEREOPSIS_STATUS_OBSTACLE_CELLS`, `_OBSTACLE_SECTORS`,
 * `_OBSTACLE_POSE`, `_OBSTACLE_LIMITS`, `_OBSTACLE_GROUND` or `_OBSTACLE_SIZE`, or where the rig's
 * numbers are none, and leaves the finder as it was.
 */
stereopsis_status stereopsis_obstacles_start(struct stereopsis_obstacles *handle,
                                             const struct stereopsis_obstacles_config *config,
                                             const struct stereopsis_rig *rig,
                                             uint16_t width,
                                             uint16_t height,
                                             uint16_t largest_px);

/**
 * Begins a frame. One that was not finished is forgotten.
 */
stereopsis_status stereopsis_obstacles_begin_frame(struct stereopsis_obstacles *handle);

/**
 * Takes what a monitor says of both cameras in this frame, before it is finished: a camera without a
 * picture and swapped cameras make it blind.
 */
stereopsis_status stereopsis_obstacles_cameras(struct stereopsis_obstacles *handle,
                                               struct stereopsis_pair_monitor *monitor);

/**
 * Sets the pose of the camera from this frame on, as from an inertial sensor: its downward pitch
 * and its roll, positive where its right side is the lower one, -500 to 500 thousandths of a radian,
 * and its height above the ground, mm. Fails with `STEREOPSIS_STATUS_OBSTACLE_POSE`.
 */
stereopsis_status stereopsis_obstacles_set_pose(struct stereopsis_obstacles *handle,
                                                int16_t pitch_mrad,
                                                int16_t roll_mrad,
                                                uint16_t height_mm);

/**
 * Takes a row as it leaves the matcher; rows that are left out count as lost. Fails with
 * `STEREOPSIS_STATUS_ROW` for one that is not in the frame, or not below all that came, and with
 * `_LINE_LENGTH` for one that is too short.
 */
stereopsis_status stereopsis_obstacles_push(struct stereopsis_obstacles *handle,
                                            const struct stereopsis_row *row);

/**
 * Ends a frame: finds its ground, stixels and surfaces, and writes a `STEREOPSIS_BLIND_` number: why
 * the frame is not to be trusted, or 0. A frame that is blind is no failure.
 */
stereopsis_status stereopsis_obstacles_finish(struct stereopsis_obstacles *handle, uint8_t *blind);

/**
 * Writes the ground of the last finished frame.
 */
stereopsis_status stereopsis_obstacles_ground(struct stereopsis_obstacles *handle,
                                              struct stereopsis_ground *ground);

/**
 * Writes the stixels of the first `count` columns of cells from the left, at most 65535. Columns
 * that are not in the frame show nothing.
 */
stereopsis_status stereopsis_obstacles_stixels(struct stereopsis_obstacles *handle,
                                               struct stereopsis_stixel *stixels,
                                               size_t count);

/**
 * Writes the first `count` sectors from the left, at most 65535. Sectors that there are not are
 * blind, as all are in a frame that is not to be trusted.
 */
stereopsis_status stereopsis_obstacles_sectors(struct stereopsis_obstacles *handle,
                                               struct stereopsis_sector *sectors,
                                               size_t count);

/**
 * Writes the disparities of the first `count` cells of row `row` of cells, at most 65535, in 1/32
 * px; `STEREOPSIS_NONE` for no answer, and for a cell that is not in the frame.
 */
stereopsis_status stereopsis_obstacles_cells(struct stereopsis_obstacles *handle,
                                             uint16_t row,
                                             uint16_t *disparities,
                                             size_t count);

/**
 * Writes the ranges of the sectors from right to left, m, at most `count`, and the angles of the
 * scan, as ROS's LaserScan has them: a free sector is infinite, a blind one is not a number. Floats
 * beyond the last sector are 0.
 */
stereopsis_status stereopsis_obstacles_scan(struct stereopsis_obstacles *handle,
                                            float *ranges,
                                            size_t count,
                                            struct stereopsis_scan *scan);

/**
 * Fills a configuration for a small robot: 0.4 m wide, stands 0.2 m before an obstacle, 100 ms from
 * picture to brakes, 1 m/s^2.
 */
stereopsis_status stereopsis_drive_default(struct stereopsis_drive_config *config);

/**
 * Creates a drive rule in the caller's memory of `length` bytes, aligned to `STEREOPSIS_ALIGN`.
 * Writes the handle; a null handle on an error, unless `handle` itself is invalid. The memory is not
 * read, and belongs to the rule until `stereopsis_drive_deinit`.
 */
stereopsis_status stereopsis_drive_init(void *memory, size_t length, struct stereopsis_drive **handle);

/**
 * Ends a rule, whose memory returns to the caller.
 */
stereopsis_status stereopsis_drive_deinit(struct stereopsis_drive *handle);

/**
 * Sets how the vehicle drives, and forgets the frames before.
 */
stereopsis_status stereopsis_drive_start(struct stereopsis_drive *handle,
                                         const struct stereopsis_drive_config *config);

/**
 * Writes the way that the vehicle needs to stand: margin + v t + v^2 / (2 a), mm.
 */
stereopsis_status stereopsis_drive_stopping_mm(struct stereopsis_drive *handle,
                                               uint16_t speed_mm_s,
                                               uint16_t *stopping_mm);

/**
 * Decides on the frame of a finder that was finished last, at a speed. In this order: blind where
 * another one has begun since, or the frame is not to be trusted; stop for what is within the
 * stopping distance, or left the picture at a side within the corridor; blind where the ground is
 * not found, or too little of the corridor is seen, as where it is wider than the picture; slow down
 * for what is within twice the stopping distance or the time to contact; clear. What left the
 * picture is held until it is seen again: `stereopsis_drive_start` forgets it, once the vehicle has
 * turned. No hardware is called.
 */
stereopsis_status stereopsis_drive_decide(struct stereopsis_drive *handle,
                                          struct stereopsis_obstacles *obstacles,
                                          uint16_t speed_mm_s,
                                          struct stereopsis_verdict *verdict);

/**
 * Returns the speed of a vehicle of which odometry gave the last step, mm/s; 65535 at most, and for
 * a period of 0.
 */
uint16_t stereopsis_speed_mm_s(uint16_t step_mm, uint32_t period_us);

/**
 * Creates a free space over frames in the caller's memory of `length` bytes, aligned to
 * `STEREOPSIS_ALIGN`: `confirm` frames in a row have to show an obstacle before it counts, and for
 * `release` frames without it it still does. All sectors are blind. Writes the handle; a null handle
 * on an error, unless `handle` itself is invalid. The memory is not read, and belongs to the free
 * space until `stereopsis_free_space_deinit`.
 */
stereopsis_status stereopsis_free_space_init(void *memory,
                                             size_t length,
                                             uint8_t confirm,
                                             uint8_t release,
                                             struct stereopsis_free_space **handle);

/**
 * Ends a free space, whose memory returns to the caller.
 */
stereopsis_status stereopsis_free_space_deinit(struct stereopsis_free_space *handle);

/**
 * Takes the last finished frame of a finder. A sector that turns blind is blind at once, whatever it
 * was before.
 */
stereopsis_status stereopsis_free_space_update(struct stereopsis_free_space *handle,
                                               struct stereopsis_obstacles *obstacles);

/**
 * Writes the first `count` sectors from the left, at most 65535; blind ones where there are none.
 */
stereopsis_status stereopsis_free_space_sectors(struct stereopsis_free_space *handle,
                                                struct stereopsis_sector *sectors,
                                                size_t count);

/**
 * Creates a monitor of two cameras in the caller's memory of `length` bytes, aligned to
 * `STEREOPSIS_ALIGN`. To find swapped cameras it tries disparities up to `most_disparity` on every
 * eighth line. Writes the handle; a null handle on an error, unless `handle` itself is invalid. The
 * memory is not read, and belongs to the monitor until `stereopsis_pair_monitor_deinit`.
 */
stereopsis_status stereopsis_pair_monitor_init(void *memory,
                                               size_t length,
                                               uint16_t most_disparity,
                                               struct stereopsis_pair_monitor **handle);

/**
 * Ends a monitor, whose memory returns to the caller.
 */
stereopsis_status stereopsis_pair_monitor_deinit(struct stereopsis_pair_monitor *handle);

/**
 * Begins a frame.
 */
stereopsis_status stereopsis_pair_monitor_begin_frame(struct stereopsis_pair_monitor *handle);

/**
 * Takes the next rectified line of both cameras, 8-bit grey, `length` bytes each, at most 65535.
 */
stereopsis_status stereopsis_pair_monitor_push(struct stereopsis_pair_monitor *handle,
                                               const uint8_t *left,
                                               const uint8_t *right,
                                               size_t length);

/**
 * Writes the condition of the left and of the right camera, `STEREOPSIS_CAMERA_` numbers, and
 * whether the two are swapped.
 */
stereopsis_status stereopsis_pair_monitor_health(struct stereopsis_pair_monitor *handle,
                                                 uint8_t *left,
                                                 uint8_t *right,
                                                 uint8_t *swapped);

/**
 * Returns the version of the library's interface: a program compiled with another
 * `STEREOPSIS_ABI` must not continue.
 */
uint32_t stereopsis_abi(void);

/**
 * Returns the library's version, such as "1.2.3".
 */
const char *stereopsis_version(void);

/**
 * Returns the text of any number as a status, one line without an end.
 */
const char *stereopsis_status_text(int32_t status);

/**
 * Returns the bytes of memory that a matcher takes.
 */
size_t stereopsis_size(void);

/**
 * Returns the alignment that a matcher's memory needs, at most `STEREOPSIS_ALIGN`.
 */
size_t stereopsis_align(void);

/**
 * Returns the longest line that this library was built for, in pixels.
 */
size_t stereopsis_max_width(void);

/**
 * Returns the largest number of disparities that this library was built for.
 */
size_t stereopsis_max_disparities(void);

/**
 * Returns the delay in lines: row y comes out when line y + `stereopsis_latency()` goes in; the
 * last rows come by `stereopsis_flush`.
 */
size_t stereopsis_latency(void);

/**
 * Creates a matcher in the caller's memory of `length` bytes, and writes the handle for all
 * other calls; a null handle on an error, unless `handle` itself is invalid.
 *
 * The memory needs no content, and belongs to the matcher until `stereopsis_deinit`. Memory that
 * still holds a matcher, such as RAM that a warm start does not clear, is refused as already
 * initialised.
 */
stereopsis_status stereopsis_init(void *memory, size_t length, struct stereopsis **handle);

/**
 * Creates a matcher in memory that was never written, such as that of `malloc`: it is not read,
 * and a matcher that it still holds is overwritten.
 */
stereopsis_status stereopsis_init_fresh(void *memory, size_t length, struct stereopsis **handle);

/**
 * Ends a matcher, whose memory returns to the caller. The handle is the memory's address.
 */
stereopsis_status stereopsis_deinit(struct stereopsis *handle);

/**
 * Fills a configuration: frames of `width` x `height` pixels, a search over `disparities` from
 * 0, the checks of a `STEREOPSIS_PRESET_`, and the method's penalties. Sizes are checked by
 * `stereopsis_start`.
 */
stereopsis_status stereopsis_config_default(uint16_t width,
                                            uint16_t height,
                                            uint16_t disparities,
                                            int32_t preset,
                                            struct stereopsis_config *config);

/**
 * Sets a configuration's `noise`, a `STEREOPSIS_NOISE_` as from `stereopsis_noise_level`, with
 * the checks of a `STEREOPSIS_PRESET_` and the method's penalties for it. Size, search and
 * confidences are kept.
 */
stereopsis_status stereopsis_config_noise(int32_t preset, uint8_t noise, struct stereopsis_config *config);

/**
 * Checks a configuration, which is copied, and prepares for the first frame. Another call drops
 * a frame that is under way, and clears the counters.
 */
stereopsis_status stereopsis_start(struct stereopsis *handle, const struct stereopsis_config *config);

/**
 * Changes the configuration between two frames, for instance for the noise of the last one:
 * counters continue, and a frame that is under way counts as broken. A refused configuration
 * changes nothing.
 */
stereopsis_status stereopsis_restart(struct stereopsis *handle, const struct stereopsis_config *config);

/**
 * Begins a frame, and drops the one before.
 */
stereopsis_status stereopsis_begin_frame(struct stereopsis *handle);

/**
 * Takes the next line of both cameras, 8-bit grey, `length` bytes each, which is the
 * configuration's width. The lines are copied; both may be one array.
 *
 * Returns `STEREOPSIS_STATUS_OK` with a row, or `STEREOPSIS_STATUS_NO_ROW_YET` with an empty one
 * for the first lines of a frame. An error leaves the row unchanged.
 */
stereopsis_status stereopsis_push(struct stereopsis *handle,
                                  const uint8_t *left,
                                  const uint8_t *right,
                                  size_t length,
                                  struct stereopsis_row *row);

/**
 * Takes the line above in place of a lost one, with the `STEREOPSIS_LOST_` number of its fault,
 * where `stereopsis_push` would be called. Rows whose matching window contains the lost line
 * have no answers and `STEREOPSIS_FLAG_DAMAGED` on every pixel, rows that it affects otherwise
 * keep theirs and have the flag, and every other row is what it would be without the loss.
 * Returns what `stereopsis_push` returns.
 */
stereopsis_status stereopsis_push_lost(struct stereopsis *handle, int32_t fault, struct stereopsis_row *row);

/**
 * Removes answers of the last row at pixels that a camera did not see, such as the black border
 * of a rectified image. The masks of the left and the right image's row have `length` bytes
 * each, 0 for an unseen pixel; a null mask means that all were seen. An answer whose pixel or
 * partner was not seen is removed and flagged `STEREOPSIS_FLAG_OUTSIDE`. The row's arrays change
 * in place. Before a frame's first row the result is `STEREOPSIS_STATUS_NO_ROW_YET`.
 */
stereopsis_status stereopsis_mask(struct stereopsis *handle,
                                  const uint8_t *left,
                                  const uint8_t *right,
                                  size_t length);

/**
 * Writes the counts since `stereopsis_start`.
 */
stereopsis_status stereopsis_counters(struct stereopsis *handle, struct stereopsis_counts *counters);

/**
 * Gives the next row after the last line: `STEREOPSIS_STATUS_OK` with a row, or
 * `STEREOPSIS_STATUS_FRAME_DONE` with an empty one after the last row.
 */
stereopsis_status stereopsis_flush(struct stereopsis *handle, struct stereopsis_row *row);

/**
 * Writes the standard deviations of the last row, px, for all its `count` columns, infinite
 * where there is no answer. Before a frame's first row the result is
 * `STEREOPSIS_STATUS_NO_ROW_YET`, and nothing is written.
 */
stereopsis_status stereopsis_sigma_px(struct stereopsis *handle, float *sigma_px, size_t count);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

/**
 * Declares all functions with `prefix` before their names, for a library that was built with it:
 * `STEREOPSIS_FUNCTIONS(near_);` in a file makes `near_stereopsis_init` and the others known.
 */
#ifdef __cplusplus
#define STEREOPSIS_EXTERN extern "C"
#else
#define STEREOPSIS_EXTERN extern
#endif
#define STEREOPSIS_FUNCTIONS(prefix) \
  STEREOPSIS_EXTERN size_t prefix##stereopsis_winners_size(void); \
  STEREOPSIS_EXTERN size_t prefix##stereopsis_winners_latency(void); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_winners_init(void *memory, size_t length, struct stereopsis_winners **handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_winners_deinit(struct stereopsis_winners *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_winners_start(struct stereopsis_winners *handle, const struct stereopsis_config *config, uint8_t *needs_lines, uint8_t *needs_second); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_winners_begin_frame(struct stereopsis_winners *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_winners_due(struct stereopsis_winners *handle, uint16_t *row); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_winners_push(struct stereopsis_winners *handle, const uint8_t *left, size_t length, const struct stereopsis_winner *winners, size_t count, struct stereopsis_row *row); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_winners_flush(struct stereopsis_winners *handle, const struct stereopsis_winner *winners, size_t count, struct stereopsis_row *row); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_winners_sigma_px(struct stereopsis_winners *handle, float *sigma_px, size_t count); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_winners_seal(struct stereopsis_winner *winners, size_t count, uint16_t row); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_line_queue_init(void *memory, size_t length, size_t line_bytes, struct stereopsis_line_queue **handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_line_queue_deinit(struct stereopsis_line_queue *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_line_queue_begin(struct stereopsis_line_queue *handle, uint8_t **bytes); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_line_queue_finish(struct stereopsis_line_queue *handle, uint32_t frame, uint16_t row, uint64_t timestamp_us); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_line_queue_next(struct stereopsis_line_queue *handle, struct stereopsis_line *line); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_line_queue_done(struct stereopsis_line_queue *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_line_queue_overruns(struct stereopsis_line_queue *handle, uint32_t *overruns); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_record_read(const uint8_t *record, size_t length, struct stereopsis_cameras *cameras); \
  STEREOPSIS_EXTERN size_t prefix##stereopsis_rectifier_size(void); \
  STEREOPSIS_EXTERN size_t prefix##stereopsis_rectifier_lines(void); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_rectifier_init(void *memory, size_t length, struct stereopsis_rectifier **handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_rectifier_deinit(struct stereopsis_rectifier *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_rectifier_start(struct stereopsis_rectifier *handle, const uint8_t *record, size_t length, uint16_t width, uint16_t height, float alpha, struct stereopsis_rig *rig, size_t *lines); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_rectifier_begin_frame(struct stereopsis_rectifier *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_rectifier_push(struct stereopsis_rectifier *handle, const uint8_t *left, const uint8_t *right, size_t length); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_rectifier_push_lost(struct stereopsis_rectifier *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_rectifier_line(struct stereopsis_rectifier *handle, uint8_t *left, uint8_t *right, size_t length); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_rectifier_mask(struct stereopsis_rectifier *handle, uint16_t row, uint8_t *left, uint8_t *right, size_t length); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_noise_clear(struct stereopsis_noise_meter *meter); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_noise_line(struct stereopsis_noise_meter *meter, const uint8_t *line, size_t length); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_noise_level(struct stereopsis_noise_meter *meter, uint8_t *noise, uint16_t *sigma_16ths); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_millimetres(const struct stereopsis_rig *rig, const uint16_t *disparities, uint16_t *millimetres, size_t count); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_metres(const struct stereopsis_rig *rig, const uint16_t *disparities, const float *sigma_px, float *depth_m, float *sigma_m, size_t count); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_points(const struct stereopsis_rig *rig, uint16_t row, const uint16_t *disparities, struct stereopsis_point *points, size_t count); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_histogram_clear(struct stereopsis_histogram *histogram); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_histogram_line(struct stereopsis_histogram *histogram, uint16_t row, const uint8_t *line, size_t length); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_balance_between(const struct stereopsis_histogram *left, const struct stereopsis_histogram *right, struct stereopsis_balance *balance); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_balance_line(const struct stereopsis_balance *balance, uint8_t *line, size_t length); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_decimate(uint16_t *rows, uint16_t block, uint16_t row, const uint16_t *disparities, size_t count, uint16_t *smaller); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_temporal_default(struct stereopsis_temporal *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_temporal_forget(uint16_t *averages, uint8_t *ages, size_t count); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_temporal_row(const struct stereopsis_temporal *config, uint16_t *averages, uint8_t *ages, const uint16_t *disparities, uint16_t *filtered, uint8_t *origins, size_t count); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_detection_default(uint16_t width, uint16_t height, struct stereopsis_detection *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_detector_init(void *memory, size_t length, uint16_t width, uint16_t slots, struct stereopsis_detector **handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_detector_deinit(struct stereopsis_detector *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_detector_start(struct stereopsis_detector *handle, const struct stereopsis_detection *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_detector_push(struct stereopsis_detector *handle, const uint8_t *line, size_t length, struct stereopsis_feature *features, size_t capacity, size_t *count); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_detector_counts(struct stereopsis_detector *handle, struct stereopsis_detection_counts *counts); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_search_default(struct stereopsis_search *search); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_match_features(const struct stereopsis_search *search, const float *fundamental, const struct stereopsis_feature *left, size_t left_count, const struct stereopsis_feature *right, size_t right_count, uint16_t *slots, struct stereopsis_match *matches, size_t capacity, size_t *count); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_eight_point(const struct stereopsis_match *matches, size_t count, float *fundamental); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_fundamental(const struct stereopsis_match *matches, size_t count, float threshold_px, uint64_t seed, float *fundamental, uint8_t *inliers, struct stereopsis_agreement *agreement); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_pose_of(const struct stereopsis_match *matches, const uint8_t *inliers, size_t count, const float *fundamental, const struct stereopsis_pinhole *first, const struct stereopsis_pinhole *second, struct stereopsis_pose *pose); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_triangulate(const struct stereopsis_match *matches, size_t count, const struct stereopsis_pinhole *first, const struct stereopsis_pinhole *second, const struct stereopsis_pose *pose, struct stereopsis_point *points); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_focus_default(uint16_t width, uint16_t height, struct stereopsis_focus_config *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_focus_init(void *memory, size_t length, uint16_t width, uint16_t columns, uint32_t cells, struct stereopsis_focus **handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_focus_deinit(struct stereopsis_focus *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_focus_start(struct stereopsis_focus *handle, const struct stereopsis_focus_config *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_focus_begin_frame(struct stereopsis_focus *handle, float scale); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_focus_push(struct stereopsis_focus *handle, const uint8_t *line, size_t length); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_focus_finish(struct stereopsis_focus *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_focus_row(struct stereopsis_focus *handle, uint16_t row, struct stereopsis_focus_peak *peaks, size_t count); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_odometry_default(uint16_t width, struct stereopsis_odometry_config *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_odometry_init(void *memory, size_t length, uint16_t points, struct stereopsis_odometry **handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_odometry_deinit(struct stereopsis_odometry *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_odometry_start(struct stereopsis_odometry *handle, const struct stereopsis_rig *rig, const struct stereopsis_odometry_config *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_odometry_step(struct stereopsis_odometry *handle, const struct stereopsis_picture *left, const struct stereopsis_picture *right, const struct stereopsis_feature *features, size_t count, struct stereopsis_step *step); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_default(struct stereopsis_obstacles_config *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_init(void *memory, size_t length, uint16_t columns, uint16_t rows, struct stereopsis_obstacles **handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_deinit(struct stereopsis_obstacles *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_start(struct stereopsis_obstacles *handle, const struct stereopsis_obstacles_config *config, const struct stereopsis_rig *rig, uint16_t width, uint16_t height, uint16_t largest_px); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_begin_frame(struct stereopsis_obstacles *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_cameras(struct stereopsis_obstacles *handle, struct stereopsis_pair_monitor *monitor); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_set_pose(struct stereopsis_obstacles *handle, int16_t pitch_mrad, int16_t roll_mrad, uint16_t height_mm); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_push(struct stereopsis_obstacles *handle, const struct stereopsis_row *row); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_finish(struct stereopsis_obstacles *handle, uint8_t *blind); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_ground(struct stereopsis_obstacles *handle, struct stereopsis_ground *ground); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_stixels(struct stereopsis_obstacles *handle, struct stereopsis_stixel *stixels, size_t count); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_sectors(struct stereopsis_obstacles *handle, struct stereopsis_sector *sectors, size_t count); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_cells(struct stereopsis_obstacles *handle, uint16_t row, uint16_t *disparities, size_t count); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_obstacles_scan(struct stereopsis_obstacles *handle, float *ranges, size_t count, struct stereopsis_scan *scan); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_drive_default(struct stereopsis_drive_config *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_drive_init(void *memory, size_t length, struct stereopsis_drive **handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_drive_deinit(struct stereopsis_drive *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_drive_start(struct stereopsis_drive *handle, const struct stereopsis_drive_config *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_drive_stopping_mm(struct stereopsis_drive *handle, uint16_t speed_mm_s, uint16_t *stopping_mm); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_drive_decide(struct stereopsis_drive *handle, struct stereopsis_obstacles *obstacles, uint16_t speed_mm_s, struct stereopsis_verdict *verdict); \
  STEREOPSIS_EXTERN uint16_t prefix##stereopsis_speed_mm_s(uint16_t step_mm, uint32_t period_us); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_free_space_init(void *memory, size_t length, uint8_t confirm, uint8_t release, struct stereopsis_free_space **handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_free_space_deinit(struct stereopsis_free_space *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_free_space_update(struct stereopsis_free_space *handle, struct stereopsis_obstacles *obstacles); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_free_space_sectors(struct stereopsis_free_space *handle, struct stereopsis_sector *sectors, size_t count); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_pair_monitor_init(void *memory, size_t length, uint16_t most_disparity, struct stereopsis_pair_monitor **handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_pair_monitor_deinit(struct stereopsis_pair_monitor *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_pair_monitor_begin_frame(struct stereopsis_pair_monitor *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_pair_monitor_push(struct stereopsis_pair_monitor *handle, const uint8_t *left, const uint8_t *right, size_t length); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_pair_monitor_health(struct stereopsis_pair_monitor *handle, uint8_t *left, uint8_t *right, uint8_t *swapped); \
  STEREOPSIS_EXTERN uint32_t prefix##stereopsis_abi(void); \
  STEREOPSIS_EXTERN const char *prefix##stereopsis_version(void); \
  STEREOPSIS_EXTERN const char *prefix##stereopsis_status_text(int32_t status); \
  STEREOPSIS_EXTERN size_t prefix##stereopsis_size(void); \
  STEREOPSIS_EXTERN size_t prefix##stereopsis_align(void); \
  STEREOPSIS_EXTERN size_t prefix##stereopsis_max_width(void); \
  STEREOPSIS_EXTERN size_t prefix##stereopsis_max_disparities(void); \
  STEREOPSIS_EXTERN size_t prefix##stereopsis_latency(void); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_init(void *memory, size_t length, struct stereopsis **handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_init_fresh(void *memory, size_t length, struct stereopsis **handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_deinit(struct stereopsis *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_config_default(uint16_t width, uint16_t height, uint16_t disparities, int32_t preset, struct stereopsis_config *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_config_noise(int32_t preset, uint8_t noise, struct stereopsis_config *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_start(struct stereopsis *handle, const struct stereopsis_config *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_restart(struct stereopsis *handle, const struct stereopsis_config *config); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_begin_frame(struct stereopsis *handle); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_push(struct stereopsis *handle, const uint8_t *left, const uint8_t *right, size_t length, struct stereopsis_row *row); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_push_lost(struct stereopsis *handle, int32_t fault, struct stereopsis_row *row); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_mask(struct stereopsis *handle, const uint8_t *left, const uint8_t *right, size_t length); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_counters(struct stereopsis *handle, struct stereopsis_counts *counters); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_flush(struct stereopsis *handle, struct stereopsis_row *row); \
  STEREOPSIS_EXTERN stereopsis_status prefix##stereopsis_sigma_px(struct stereopsis *handle, float *sigma_px, size_t count)

#endif  /* STEREOPSIS_H */
