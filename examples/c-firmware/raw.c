/* Depth in metres from raw pictures of two cameras as they are mounted, line by line, without malloc:
   raw pair -> calibration record -> rectified lines -> disparities -> depths and points.

   Usage: raw [LEFT.pgm RIGHT.pgm], else left.pgm and right.pgm in the current folder. rig.h is what
   `stereo calib convert --calib FILE --to c --out rig.h` writes for the cameras. Prints the CRC-32 of all disparities,
   flags, depths with their standard deviations, and points. */
#include "files.h"
#include "rig.h"
#include "stereopsis.h"
#include <stdlib.h>
#include <string.h>

#ifndef STEREOPSIS_BYTES /* stereopsis.cmake says what the library was built for */
#define STEREOPSIS_BYTES STEREOPSIS_BLOCK_BYTES
#define STEREOPSIS_WIDTH 320
#define STEREOPSIS_HEIGHT 240
#define STEREOPSIS_LINES 33
#define STEREOPSIS_DISPARITIES 64
#endif

static uint64_t memory[STEREOPSIS_BYTES(STEREOPSIS_WIDTH, STEREOPSIS_DISPARITIES) / 8 + 1];
static uint64_t remaps[STEREOPSIS_RECTIFIER_BYTES(STEREOPSIS_WIDTH, STEREOPSIS_HEIGHT, STEREOPSIS_LINES) / 8 + 1];
static uint8_t left[STEREOPSIS_WIDTH], right[STEREOPSIS_WIDTH];
static float sigma[STEREOPSIS_WIDTH], depth[STEREOPSIS_WIDTH];
static stereopsis_point points[STEREOPSIS_WIDTH];

static stereopsis *matcher;
static stereopsis_rectifier *rectifier;
static stereopsis_rig rig;
static uint32_t crc = UINT32_MAX;

static stereopsis_status checked(stereopsis_status status) {
    if (status < 0) fail("stereopsis", stereopsis_status_text(status));
    return status;
}

static void sum(const void *data, size_t length) {
    const uint8_t *bytes = (const uint8_t *)data;
    for (size_t i = 0; i < length; i++) crc = crc32(crc, bytes[i]);
}

/* A row of disparities came out: what a camera did not see goes, the rest becomes metres. */
static void give(const stereopsis_row *row) {
    size_t width = row->width;
    checked(stereopsis_rectifier_mask(rectifier, row->index, left, right, width));
    checked(stereopsis_mask(matcher, left, right, width));
    checked(stereopsis_sigma_px(matcher, sigma, width));
    checked(stereopsis_metres(&rig, row->disparities, sigma, depth, sigma, width));
    checked(stereopsis_points(&rig, row->index, row->disparities, points, width));
    sum(row->disparities, width * sizeof *row->disparities);
    sum(row->flags, width);
    sum(depth, width * sizeof *depth);
    sum(sigma, width * sizeof *sigma);
    sum(points, width * sizeof *points);
}

int main(int count, char **names) {
    if (count == 2 || count > 3) fail("usage", "raw [LEFT.pgm RIGHT.pgm]");
    const char *left_name = count == 3 ? names[1] : "left.pgm", *right_name = count == 3 ? names[2] : "right.pgm";
    uint16_t width, height, right_width, right_height;
    int left_file = open_pgm(left_name, &width, &height), right_file = open_pgm(right_name, &right_width, &right_height);
    stereopsis_cameras cameras;
    stereopsis_config config;
    stereopsis_row row;
    checked(stereopsis_record_read(stereo_rig, sizeof stereo_rig, &cameras));
    if (width != cameras.width[0] || height != cameras.height[0]) fail(left_name, "is not of the record's size");
    if (right_width != cameras.width[1] || right_height != cameras.height[1])
        fail(right_name, "is not of the record's size");
    checked(stereopsis_rectifier_init(remaps, sizeof remaps, &rectifier));
    checked(stereopsis_rectifier_start(rectifier, stereo_rig, sizeof stereo_rig, width, height, STEREOPSIS_ALPHA_NATURAL,
                                       &rig, NULL));
    checked(stereopsis_init_fresh(memory, sizeof memory, &matcher));
    checked(stereopsis_config_default(width, height, STEREOPSIS_DISPARITIES, STEREOPSIS_PRESET_DEFAULT, &config));
    checked(stereopsis_start(matcher, &config));

    checked(stereopsis_rectifier_begin_frame(rectifier));
    checked(stereopsis_begin_frame(matcher));
    for (uint16_t line = 0; line < height; line++) {
        take(left_name, left_file, left, width);
        take(right_name, right_file, right, width);
        checked(stereopsis_rectifier_push(rectifier, left, right, width));
        /* A raw line completes any number of rectified ones, and each of those a row of disparities or none. */
        while (checked(stereopsis_rectifier_line(rectifier, left, right, width)) == STEREOPSIS_STATUS_OK)
            if (checked(stereopsis_push(matcher, left, right, width, &row)) == STEREOPSIS_STATUS_OK) give(&row);
    }
    while (checked(stereopsis_flush(matcher, &row)) == STEREOPSIS_STATUS_OK) give(&row);
    say_crc(crc);
    return EXIT_SUCCESS;
}
