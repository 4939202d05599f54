/* Depth from two cameras, line by line: the functions of libstereopsis.a.

   The caller gives memory, a configuration and lines, and gets rows of disparities. Nothing is allocated, nothing is
   kept of a caller's pointer but the memory given to stereopsis_init. Every function answers with a status; below 0 it
   is an error and nothing has changed.

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
  ((size_t)3504 + (size_t)66 * (width) + (size_t)13 * (disparities) + \
   (size_t)1 * (width) * (disparities))

/**
 * Bytes that are enough for a matcher of method block, on any target. `disparities` is a multiple of 16, and
 * `width` at least as large, as the library was built with.
 */
#define STEREOPSIS_BLOCK_BYTES(width, disparities) \
  ((size_t)416 + (size_t)70 * (width) + (size_t)13 * (disparities) + \
   (size_t)1 * (width) * (disparities))

/**
 * Bytes that are enough for a matcher of method sgm-lean, on any target. `disparities` is a multiple of 16, and
 * `width` at least as large, as the library was built with.
 */
#define STEREOPSIS_SGM_LEAN_BYTES(width, disparities) \
  ((size_t)416 + (size_t)52 * (width) + (size_t)8 * (disparities) + \
   (size_t)3 * (width) * (disparities))

/**
 * Bytes that are enough for a matcher of method sgm, on any target. `disparities` is a multiple of 16, and
 * `width` at least as large, as the library was built with.
 */
#define STEREOPSIS_SGM_BYTES(width, disparities) \
  ((size_t)416 + (size_t)52 * (width) + (size_t)8 * (disparities) + \
   (size_t)3 * (width) * (disparities))

/**
 * Bytes that are enough for a matcher of method sgm-edge, on any target. `disparities` is a multiple of 16, and
 * `width` at least as large, as the library was built with.
 */
#define STEREOPSIS_SGM_EDGE_BYTES(width, disparities) \
  ((size_t)416 + (size_t)53 * (width) + (size_t)8 * (disparities) + \
   (size_t)5 * (width) * (disparities))


/**
 * The version of this interface. It changes when a program that was compiled with another header would go
 * wrong.
 */
#define STEREOPSIS_ABI 5

/**
 * Every matcher's memory may be aligned to this many bytes: `uint64_t` will do.
 */
#define STEREOPSIS_ALIGN 8

/**
 * `stereopsis_config_default` and `_noise`: an answer wherever there is a candidate.
 */
#define STEREOPSIS_PRESET_DENSE 0

/**
 * `stereopsis_config_default` and `_noise`: drops what the other image or the neighbourhood contradicts.
 */
#define STEREOPSIS_PRESET_DEFAULT 1

/**
 * `stereopsis_config_default` and `_noise`: drops what is ambiguous or has little texture as well.
 */
#define STEREOPSIS_PRESET_STRICT 2

/**
 * In `left_right_px` and `uniqueness_percent` of a configuration: not checked.
 */
#define STEREOPSIS_NOT_CHECKED -1

/**
 * In `noise` of a configuration: little, so that pixels are compared as they are.
 */
#define STEREOPSIS_NOISE_NONE 0

/**
 * In `noise` of a configuration: a deviation of about 2 grey levels.
 */
#define STEREOPSIS_NOISE_LOW 1

/**
 * In `noise` of a configuration: a deviation from about 3 grey levels on.
 */
#define STEREOPSIS_NOISE_HIGH 2

/**
 * The disparity that means "no answer".
 */
#define STEREOPSIS_NONE 65535

/**
 * Steps of a disparity in one pixel.
 */
#define STEREOPSIS_STEPS_PER_PX 32

/**
 * No candidate lies inside the right image.
 */
#define STEREOPSIS_FLAG_OUTSIDE 1

/**
 * The winner is the largest disparity searched: the surface may be nearer.
 */
#define STEREOPSIS_FLAG_CEILING 2

/**
 * The winner costs as much as both its neighbours, or too few pixels of the window have a gradient.
 */
#define STEREOPSIS_FLAG_UNTEXTURED 4

/**
 * Another disparity matches nearly as well.
 */
#define STEREOPSIS_FLAG_AMBIGUOUS 8

/**
 * The right image's pixel found a better partner elsewhere.
 */
#define STEREOPSIS_FLAG_MISMATCH 16

/**
 * Too few answers around it are of its surface.
 */
#define STEREOPSIS_FLAG_SPECKLE 32

/**
 * The answer is not the pixel's own but the farther one of those on both sides of a small gap in the row.
 */
#define STEREOPSIS_FLAG_FILLED 64

/**
 * A line near the row was lost (`stereopsis_push_lost`). Beside an answer: the line can have touched it.
 */
#define STEREOPSIS_FLAG_DAMAGED 128

/**
 * The line did not come, or no buffer was free for it.
 */
#define STEREOPSIS_LOST_DROPPED 0

/**
 * The line was overwritten while it was read, or has fewer or more pixels than a line.
 */
#define STEREOPSIS_LOST_TORN 1

/**
 * The line came after the time at which it was of use.
 */
#define STEREOPSIS_LOST_LATE 2

/**
 * The buffer holds a line of before: nobody has filled it since.
 */
#define STEREOPSIS_LOST_STALE 3

/**
 * What a call answers: below 0 it is an error, and nothing has changed.
 */
enum stereopsis_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Done. Where the call gives a row, there is one.
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
   * A pointer is null.
   */
  STEREOPSIS_STATUS_NULL = -1,
  /**
   * A pointer is not aligned as what it points to has to be.
   */
  STEREOPSIS_STATUS_MISALIGNED = -2,
  /**
   * The memory is shorter than `stereopsis_size()`.
   */
  STEREOPSIS_STATUS_MEMORY_TOO_SHORT = -3,
  /**
   * The memory holds a matcher already: `stereopsis_deinit` gives it up.
   */
  STEREOPSIS_STATUS_ALREADY_INITIALISED = -4,
  /**
   * The handle's memory holds no matcher of this library.
   */
  STEREOPSIS_STATUS_NOT_INITIALISED = -5,
  /**
   * An argument points into the matcher's memory.
   */
  STEREOPSIS_STATUS_OVERLAP = -6,
  /**
   * More elements than an address space holds.
   */
  STEREOPSIS_STATUS_TOO_MANY = -7,
  /**
   * `stereopsis_start` has to come first.
   */
  STEREOPSIS_STATUS_NOT_STARTED = -8,
  /**
   * `stereopsis_begin_frame` has to come first.
   */
  STEREOPSIS_STATUS_NOT_BEGUN = -9,
  /**
   * The length is not the width that the matcher was started for.
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
   * Configuration: the search ends beyond 2046 px.
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
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum stereopsis_status stereopsis_status;
#else
typedef int32_t stereopsis_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * A matcher in memory that the caller gave.
 */
typedef struct stereopsis stereopsis;

/**
 * Frame size, search range and checks. `stereopsis_config_default` fills it, fields may be changed after
 * that.
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
   * How many whole disparities are searched: 16 to `stereopsis_max_disparities()`.
   */
  uint16_t disparities;
  /**
   * The smallest disparity searched, px.
   */
  uint16_t min_disparity;
  /**
   * Left-right check: the largest difference of the two answers, 0 to 255 px, or
   * `STEREOPSIS_NOT_CHECKED`.
   */
  int16_t left_right_px;
  /**
   * Uniqueness: by how much the second best has to cost more, 0 to 99 percent, or
   * `STEREOPSIS_NOT_CHECKED`.
   */
  int16_t uniqueness_percent;
  /**
   * Texture: a pixel counts when its neighbours left and right differ by this many grey levels.
   */
  uint8_t texture_gradient;
  /**
   * Texture: how many such pixels the window of an answer holds at least; 0 is not checked.
   */
  uint8_t texture_pixels;
  /**
   * Whether a winner at the largest disparity searched is refused; 0 is no.
   */
  uint8_t refuse_ceiling;
  /**
   * Whether a winner is refused that costs as much as both its neighbours; 0 is no.
   */
  uint8_t refuse_flat;
  /**
   * Answers are averaged along the line with this many pairs of neighbours of their surface, 0 to 8.
   */
  uint8_t smoothing_radius;
  /**
   * Whether every answer becomes the middle one of those in 3 x 3 pixels around it; 0 is no.
   */
  uint8_t median;
  /**
   * Neighbours are of one surface when they differ by at most this, in 1/32 px, 0 to 32.
   */
  uint16_t surface_step;
  /**
   * Speckle: answers with fewer of their surface on a cross around them are dropped; with 0 none is.
   */
  uint8_t speckle_pixels;
  /**
   * Methods along paths: gradients are cut off at this many eighths of a grey level per pixel, 1 to 14.
   */
  uint8_t gradient;
  /**
   * Methods along paths: a pixel's cost is cut off at this, at least 1.
   */
  uint8_t cost;
  /**
   * Methods along paths: what a change of the disparity by one px costs where the brightness changes
   * little, and more; at least 1, and the second at most the first.
   */
  uint8_t step[2];
  /**
   * Methods along paths: what a larger change costs where the brightness changes little, more, and much;
   * each at least the first step. `cost + step + jump` is at most 127 and `3 cost + 2 jump` at most
   * 254.
   */
  uint8_t jump[3];
  /**
   * Methods along paths: the changes of brightness, in grey levels, at which it is more, and much.
   */
  uint8_t edges[2];
  /**
   * Fill: gaps along the row of at most this many pixels, between two answers, get the farther of the two
   * and `STEREOPSIS_FLAG_FILLED`; with 0 none does.
   */
  uint8_t fill_pixels;
  /**
   * Whether rows say how sure each answer is; 0 is no, and saves the search for each pixel's second best.
   */
  uint8_t confidence;
  /**
   * Fill: by how much the two answers may differ, in 1/32 px; 65535 for any two.
   */
  uint16_t fill_step;
  /**
   * How noisy both cameras are, a `STEREOPSIS_NOISE_`: what is compared is smoothed accordingly.
   * `stereopsis_config_noise` sets it with the checks and penalties that suit it.
   */
  uint8_t noise;
} stereopsis_config;

/**
 * A row of results. The arrays stand in the matcher's memory and hold until the next call with its handle.
 */
typedef struct stereopsis_row {
  /**
   * The row in the image, from 0.
   */
  uint16_t index;
  /**
   * Pixels in the row: the length of the arrays.
   */
  uint16_t width;
  /**
   * A disparity for each column in 1/32 px, `STEREOPSIS_NONE` for no answer.
   */
  const uint16_t *disparities;
  /**
   * The `STEREOPSIS_FLAG_` bits of each column: why there is no answer, or none of its own.
   */
  const uint8_t *flags;
  /**
   * How sure the answer of each column is, 1 to 207, 0 for no answer; null unless the configuration's
   * `confidence` asked for it. The number puts answers in order, the wrong ones first; it is no
   * probability.
   */
  const uint8_t *confidences;
} stereopsis_row;

/**
 * Counts since `stereopsis_start`, each of which stays at its largest value when it is reached.
 */
typedef struct stereopsis_counts {
  /**
   * Frames begun.
   */
  uint32_t frames;
  /**
   * Frames of which every line came, and every row went out.
   */
  uint32_t frames_whole;
  /**
   * Frames of which every row went out, some of them flagged.
   */
  uint32_t frames_damaged;
  /**
   * Frames that were given up after they had begun.
   */
  uint32_t frames_broken;
  /**
   * Rows that went out.
   */
  uint32_t rows;
  /**
   * Rows of these with `STEREOPSIS_FLAG_DAMAGED`.
   */
  uint32_t rows_damaged;
  /**
   * Lines that came.
   */
  uint32_t lines;
  /**
   * Lines told as `STEREOPSIS_LOST_DROPPED`.
   */
  uint32_t lines_dropped;
  /**
   * Lines told as `STEREOPSIS_LOST_TORN`.
   */
  uint32_t lines_torn;
  /**
   * Lines told as `STEREOPSIS_LOST_LATE`.
   */
  uint32_t lines_late;
  /**
   * Lines told as `STEREOPSIS_LOST_STALE`.
   */
  uint32_t lines_stale;
} stereopsis_counts;

/**
 * How noisy the lines are that it was given: the caller's memory, for `stereopsis_noise_clear` and what
 * follows it. The words are the library's.
 */
typedef struct stereopsis_noise_meter {
  /**
   * Counters.
   */
  uint32_t words[65];
} stereopsis_noise_meter;

/**
 * Two cameras after rectification: rows are aligned, both have one focal length.
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

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * The library's interface: a program that was compiled with another `STEREOPSIS_ABI` must not go
 * on.
 */
uint32_t stereopsis_abi(void);

/**
 * The library's version, such as "1.2.3".
 */
const char *stereopsis_version(void);

/**
 * What a status says, in a line without an end; there is a text for every number.
 */
const char *stereopsis_status_text(int32_t status);

/**
 * Bytes of memory that a matcher takes.
 */
size_t stereopsis_size(void);

/**
 * What the memory's address has to be a multiple of; `STEREOPSIS_ALIGN` at most.
 */
size_t stereopsis_align(void);

/**
 * The longest line that this library was built for, in pixels.
 */
size_t stereopsis_max_width(void);

/**
 * The most disparities that this library was built for.
 */
size_t stereopsis_max_disparities(void);

/**
 * Row y comes out when line y + `stereopsis_latency()` goes in; the last rows come by
 * `stereopsis_flush`.
 */
size_t stereopsis_latency(void);

/**
 * Makes a matcher in the caller's memory of `length` bytes, and gives the handle for all other
 * calls; a null handle on an error, unless `handle` itself is what is wrong.
 *
 * The memory needs no content, and is the matcher's alone until `stereopsis_deinit`. Memory that
 * still holds a matcher, such as RAM that a warm start does not clear, is refused as already
 * initialised.
 */
stereopsis_status stereopsis_init(void *memory, size_t length, struct stereopsis **handle);

/**
 * Ends a matcher; the memory is the caller's again. The handle is the memory's address.
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
 * Makes a configuration one for cameras with `noise`, a `STEREOPSIS_NOISE_` such as
 * `stereopsis_noise_level` tells: sets that, and the checks of a `STEREOPSIS_PRESET_` and
 * the method's penalties for it. Size, search and `confidence` stay as they are.
 */
stereopsis_status stereopsis_config_noise(int32_t preset, uint8_t noise, struct stereopsis_config *config);

/**
 * Checks a configuration, which is copied, and gets ready for the first frame. It can be called
 * again, for another configuration; a frame that is under way is lost, and counters go to
 * zero.
 */
stereopsis_status stereopsis_start(struct stereopsis *handle, const struct stereopsis_config *config);

/**
 * `stereopsis_start` between two frames, for the noise of the one before as it may be: counters
 * go on, and a frame that is under way counts as broken off. A configuration that is refused
 * changes nothing.
 */
stereopsis_status stereopsis_restart(struct stereopsis *handle, const struct stereopsis_config *config);

/**
 * Begins a frame and forgets the one before.
 */
stereopsis_status stereopsis_begin_frame(struct stereopsis *handle);

/**
 * Takes the next line of both cameras, 8-bit grey, `length` bytes each: the configuration's
 * width. The lines are copied; both may be one array.
 *
 * `STEREOPSIS_STATUS_OK` with a row, or `STEREOPSIS_STATUS_NO_ROW_YET` with an empty one for the
 * first lines of a frame. On an error the row is left as it is.
 */
stereopsis_status stereopsis_push(struct stereopsis *handle,
                                  const uint8_t *left,
                                  const uint8_t *right,
                                  size_t length,
                                  struct stereopsis_row *row);

/**
 * In place of `stereopsis_push`, of a line that did not come, for a reason of the
 * `STEREOPSIS_LOST_` numbers: the line above stands in. Rows whose matching window saw it
 * have no answers and `STEREOPSIS_FLAG_DAMAGED` on every pixel, rows that it can have
 * touched otherwise keep theirs and have the flag, and every other row is what it would be
 * without the loss. Answers as `stereopsis_push` does.
 */
stereopsis_status stereopsis_push_lost(struct stereopsis *handle, int32_t fault, struct stereopsis_row *row);

/**
 * Takes answers of the row that came out last away where a camera did not see, such as the black
 * border of a rectified image: masks of the left and of the right image's row, `length`
 * bytes each, 0 for a pixel that was not seen; null where all were. An answer goes, and has
 * `STEREOPSIS_FLAG_OUTSIDE`, where its own pixel or its partner was not seen. The row's
 * arrays change in place.
 */
stereopsis_status stereopsis_mask(struct stereopsis *handle,
                                  const uint8_t *left,
                                  const uint8_t *right,
                                  size_t length);

/**
 * What was counted since `stereopsis_start`.
 */
stereopsis_status stereopsis_counters(struct stereopsis *handle, struct stereopsis_counts *counters);

/**
 * Gives the next row when all lines are in: `STEREOPSIS_STATUS_OK` with a row, or
 * `STEREOPSIS_STATUS_FRAME_DONE` with an empty one when all are out.
 */
stereopsis_status stereopsis_flush(struct stereopsis *handle, struct stereopsis_row *row);

/**
 * Standard deviations of the row that came out last, in px, for `count` columns: all of the row.
 * Infinite where there is no answer. Before a frame's first row it is
 * `STEREOPSIS_STATUS_NO_ROW_YET`, and nothing is written.
 */
stereopsis_status stereopsis_sigma_px(struct stereopsis *handle, float *sigma_px, size_t count);

/**
 * A meter that has seen no line; it needs no matcher. As often as light may change: measure a
 * frame, and give what it says to the configuration of the next ones.
 */
stereopsis_status stereopsis_noise_clear(struct stereopsis_noise_meter *meter);

/**
 * Measures a line of either camera, 8-bit grey, 65535 bytes at most.
 */
stereopsis_status stereopsis_noise_line(struct stereopsis_noise_meter *meter,
                                        const uint8_t *line,
                                        size_t length);

/**
 * The `STEREOPSIS_NOISE_` number of the lines so far, for `stereopsis_config_noise`, and unless
 * `sigma_16ths` is null the deviation in 1/16 grey level; none and 0 before the first line.
 */
stereopsis_status stereopsis_noise_level(struct stereopsis_noise_meter *meter,
                                         uint8_t *noise,
                                         uint16_t *sigma_16ths);

/**
 * Depths of `count` disparities to the nearest millimetre, 0 for none: no answer, at infinity,
 * or beyond 65.535 m. Both may be one array.
 */
stereopsis_status stereopsis_millimetres(const struct stereopsis_rig *rig,
                                         const uint16_t *disparities,
                                         uint16_t *millimetres,
                                         size_t count);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* STEREOPSIS_H */
