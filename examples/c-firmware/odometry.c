/* Where a rectified pair of cameras goes, from frame to frame, without malloc: pictures -> features -> motion.

   Reads left0.pgm and right0.pgm, left1.pgm and right1.pgm, and so on, in the current folder, as many as there are. For each
   frame it says on the standard error how many points agree, and the step in mm and the turn in mrad since the one before.
   Prints the CRC-32 of all motions with their covariances. */
#include "files.h"
#include "stereopsis.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 160, HEIGHT = 120, CELL_PX = 24, PER_CELL = 2, SLOTS = (WIDTH / CELL_PX + 1) * PER_CELL, POINTS = 40 };

static const float FOCAL_PX = 120.0f, BASELINE_M = 0.1f;

static uint64_t detector_memory[STEREOPSIS_DETECTOR_BYTES(WIDTH, SLOTS) / 8 + 1];
static uint64_t odometry_memory[STEREOPSIS_ODOMETRY_BYTES(POINTS) / 8 + 1];
static uint8_t pixels[2][WIDTH * HEIGHT];
static stereopsis_feature features[POINTS];
static stereopsis_detector *detector;
static stereopsis_odometry *odometry;
static uint32_t crc = UINT32_MAX;

static stereopsis_status checked(stereopsis_status status) {
    if (status < 0) fail("stereopsis", stereopsis_status_text(status));
    return status;
}

static void sum(const void *data, size_t length) {
    const uint8_t *bytes = (const uint8_t *)data;
    for (size_t i = 0; i < length; i++) crc = crc32(crc, bytes[i]);
}

/* The picture of a camera at frames 0 to 9; 0 when there is none any more. */
static int load(int camera, int frame, stereopsis_picture *picture) {
    char names[2][11] = {"left0.pgm", "right0.pgm"};
    char *name = names[camera];
    name[camera == 0 ? 4 : 5] = (char)('0' + frame);
    if (frame > 9 || !is_there(name)) return 0;
    int file = open_pgm(name, &picture->width, &picture->height);
    if (picture->width > WIDTH || picture->height > HEIGHT) fail(name, "is larger than 160 x 120");
    take(name, file, pixels[camera], (size_t)picture->width * picture->height);
    close(file);
    picture->pixels = pixels[camera];
    return 1;
}

static size_t detect(const stereopsis_picture *picture) {
    stereopsis_detection config;
    size_t count = 0;
    checked(stereopsis_detection_default(picture->width, picture->height, &config));
    config.cell_px = CELL_PX, config.per_cell = PER_CELL;
    checked(stereopsis_detector_start(detector, &config));
    for (size_t y = 0; y < picture->height; y++)
        checked(stereopsis_detector_push(detector, picture->pixels + y * picture->width, picture->width, features, POINTS,
                                         &count));
    return count;
}

static void report(int frame, const stereopsis_step *step) {
    const float *t = step->motion.translation, *r = step->motion.rotation;
    say(STDERR_FILENO, "frame"), say_number(STDERR_FILENO, frame), say(STDERR_FILENO, ", points that agree:");
    say_number(STDERR_FILENO, (int32_t)step->inliers), say(STDERR_FILENO, ", step in mm:");
    for (int axis = 0; axis < 3; axis++) say_number(STDERR_FILENO, (int32_t)(t[axis] * 1000.0f));
    /* The turns are small. */
    say(STDERR_FILENO, ", turn in mrad:"), say_number(STDERR_FILENO, (int32_t)(r[7] * 1000.0f));
    say_number(STDERR_FILENO, (int32_t)(r[2] * 1000.0f)), say_number(STDERR_FILENO, (int32_t)(r[3] * 1000.0f));
    say(STDERR_FILENO, "\n");
    sum(r, sizeof step->motion.rotation), sum(t, sizeof step->motion.translation);
    sum(step->covariance, sizeof step->covariance), sum(&step->residual, sizeof step->residual);
    sum(&step->points, sizeof step->points), sum(&step->found, sizeof step->found);
    sum(&step->inliers, sizeof step->inliers);
}

int main(void) {
    stereopsis_picture left, right;
    stereopsis_step step;
    checked(stereopsis_detector_init(detector_memory, sizeof detector_memory, WIDTH, SLOTS, &detector));
    checked(stereopsis_odometry_init(odometry_memory, sizeof odometry_memory, POINTS, &odometry));
    for (int frame = 0; load(0, frame, &left) && load(1, frame, &right); frame++) {
        if (frame == 0) {
            stereopsis_odometry_config config;
            stereopsis_rig rig = {FOCAL_PX, BASELINE_M, 0.0f, 0.0f, 0.0f};
            rig.cx = rig.cx_right = (float)(left.width - 1) / 2.0f, rig.cy = (float)(left.height - 1) / 2.0f;
            checked(stereopsis_odometry_default(left.width, &config));
            checked(stereopsis_odometry_start(odometry, &rig, &config));
        }
        size_t count = detect(&left);
        checked(stereopsis_odometry_step(odometry, &left, &right, features, count, &step));
        report(frame, &step);
    }
    say_crc(crc);
    return EXIT_SUCCESS;
}
