/* Memory as malloc leaves it, never written: everything that is created in it and run reads none of it before it has been
   written. valgrind watches; with an argument the memory is read by stereopsis_init, which valgrind has to find. */
#include "stereopsis.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = STEREOPSIS_WIDTH, HEIGHT = 24, DISPARITIES = 32 };

static int failures;

static void *fresh(size_t size) {
    void *memory = malloc(size);
    if (memory == NULL) exit(100);
    return memory;
}

static stereopsis_status good(stereopsis_status status) {
    if (status < 0) printf("%s\n", stereopsis_status_text(status)), failures++;
    return status;
}

/* A sum that depends on everything that came out. */
static uint32_t frame(stereopsis *matcher) {
    static uint8_t left[WIDTH], right[WIDTH];
    uint32_t sum = 0;
    stereopsis_config config;
    stereopsis_row row;
    float sigma[WIDTH];
    good(stereopsis_config_default(WIDTH, HEIGHT, DISPARITIES, STEREOPSIS_PRESET_STRICT, &config));
    config.confidence = 1;
    good(stereopsis_start(matcher, &config));
    good(stereopsis_begin_frame(matcher));
    for (int y = 0;; y++) {
        stereopsis_status status;
        for (int x = 0; x < WIDTH; x++) {
            left[x] = (uint8_t)((x * 37 + y * 11) ^ (x * y));
            right[x] = (uint8_t)(((x + 9) * 37 + y * 11) ^ ((x + 9) * y));
        }
        status = good(y < HEIGHT ? stereopsis_push(matcher, left, right, WIDTH, &row) : stereopsis_flush(matcher, &row));
        if (status < 0 || status == STEREOPSIS_STATUS_FRAME_DONE) return sum;
        if (status != STEREOPSIS_STATUS_OK) continue;
        good(stereopsis_mask(matcher, NULL, NULL, WIDTH));
        good(stereopsis_sigma_px(matcher, sigma, WIDTH));
        for (int x = 0; x < WIDTH; x++)
            sum = sum * 31 + row.disparities[x] + row.flags[x] + row.confidences[x] + (sigma[x] < 1.0f ? 1u : 0u);
    }
}

static uint32_t queue(void) {
    size_t size = STEREOPSIS_LINE_QUEUE_BYTES(WIDTH, 3);
    void *memory = fresh(size);
    stereopsis_line_queue *queue;
    stereopsis_line line;
    uint8_t *bytes;
    uint32_t sum = 0, overruns = 0;
    good(stereopsis_line_queue_init(memory, size, WIDTH, &queue));
    for (uint16_t row = 0; row < 9; row++) {
        if (good(stereopsis_line_queue_begin(queue, &bytes)) == STEREOPSIS_STATUS_OK) {
            for (int x = 0; x < WIDTH; x++) bytes[x] = (uint8_t)(x + row);
            good(stereopsis_line_queue_finish(queue, 1, row, row));
        } else if (good(stereopsis_line_queue_next(queue, &line)) == STEREOPSIS_STATUS_OK) {
            for (int x = 0; x < WIDTH; x++) sum = sum * 31 + line.bytes[x] + line.row;
            good(stereopsis_line_queue_done(queue));
        }
    }
    good(stereopsis_line_queue_overruns(queue, &overruns));
    good(stereopsis_line_queue_deinit(queue));
    free(memory);
    return sum + overruns;
}

static uint32_t temporal(void) {
    uint16_t *averages = (uint16_t *)fresh(WIDTH * sizeof *averages), row[WIDTH], filtered[WIDTH], smaller[WIDTH / 2];
    uint16_t *rows = (uint16_t *)fresh(2 * WIDTH * sizeof *rows);
    uint8_t *ages = (uint8_t *)fresh(WIDTH), origins[WIDTH];
    stereopsis_temporal config;
    uint32_t sum = 0;
    good(stereopsis_temporal_default(&config));
    good(stereopsis_temporal_forget(averages, ages, WIDTH));
    for (uint16_t y = 0; y < 4; y++) {
        for (uint16_t x = 0; x < WIDTH; x++) row[x] = x % 5 == y ? STEREOPSIS_NONE : (uint16_t)(10 * x);
        good(stereopsis_temporal_row(&config, averages, ages, row, filtered, origins, WIDTH));
        for (int x = 0; x < WIDTH; x++) sum = sum * 31 + filtered[x] + origins[x];
        if (good(stereopsis_decimate(rows, 2, y, filtered, WIDTH, smaller)) != STEREOPSIS_STATUS_OK) continue;
        for (int x = 0; x < WIDTH / 2; x++) sum = sum * 31 + smaller[x];
    }
    free(averages), free(rows), free(ages);
    return sum;
}

/* Features of a picture, the motion of a pair, and a stack of frames. */
static uint32_t motion(void) {
    enum { ROWS = 64, SLOTS = 15, POINTS = 24, COLUMNS = WIDTH / 8, CELLS = COLUMNS * ROWS / 8, MOST = 40 };
    static uint8_t pixels[2][ROWS][WIDTH];
    size_t sizes[3] = {STEREOPSIS_DETECTOR_BYTES(WIDTH, SLOTS), STEREOPSIS_ODOMETRY_BYTES(POINTS),
                       STEREOPSIS_FOCUS_BYTES(WIDTH, COLUMNS, CELLS)};
    void *memory[3] = {fresh(sizes[0]), fresh(sizes[1]), fresh(sizes[2])};
    stereopsis_detector *detector;
    stereopsis_odometry *odometry;
    stereopsis_focus *map;
    stereopsis_detection detection;
    stereopsis_odometry_config config;
    stereopsis_focus_config cells;
    stereopsis_rig rig = {90.0f, 0.1f, 47.5f, 31.5f, 47.5f};
    stereopsis_feature features[MOST];
    stereopsis_focus_peak peaks[COLUMNS];
    stereopsis_step step;
    stereopsis_picture left = {pixels[0][0], WIDTH, ROWS}, right = {pixels[1][0], WIDTH, ROWS};
    uint32_t sum = 0;
    good(stereopsis_detector_init(memory[0], sizes[0], WIDTH, SLOTS, &detector));
    good(stereopsis_odometry_init(memory[1], sizes[1], POINTS, &odometry));
    good(stereopsis_focus_init(memory[2], sizes[2], WIDTH, COLUMNS, CELLS, &map));
    good(stereopsis_detection_default(WIDTH, ROWS, &detection));
    good(stereopsis_odometry_default(WIDTH, &config));
    good(stereopsis_odometry_start(odometry, &rig, &config));
    good(stereopsis_focus_default(WIDTH, ROWS, &cells));
    cells.cell_px = 8, cells.radius = 0;
    good(stereopsis_focus_start(map, &cells));
    for (int frame = 0; frame < 4; frame++) {
        size_t count = 0;
        for (int i = 0; i < 2 * ROWS * WIDTH; i++) {
            int camera = i / (ROWS * WIDTH), y = i / WIDTH % ROWS, x = i % WIDTH + 5 * camera + 2 * frame;
            int across = x / 7, down = y / 6;
            pixels[camera][y][i % WIDTH] = (uint8_t)(40 + (across * 73 + down * 151 + across * down * 37) % (180 - 20 * frame));
        }
        good(stereopsis_detector_start(detector, &detection));
        good(stereopsis_focus_begin_frame(map, 1.0f));
        for (int y = 0; y < ROWS; y++) {
            good(stereopsis_detector_push(detector, pixels[0][y], WIDTH, features, MOST, &count));
            good(stereopsis_focus_push(map, pixels[0][y], WIDTH));
        }
        good(stereopsis_odometry_step(odometry, &left, &right, features, count, &step));
        sum = sum * 31 + (uint32_t)count + step.state + step.inliers + (step.motion.rotation[2] > 0.0f ? 1u : 0u);
    }
    good(stereopsis_focus_finish(map));
    for (uint16_t row = 0; row < ROWS / 8; row++) {
        good(stereopsis_focus_row(map, row, peaks, COLUMNS));
        for (int x = 0; x < COLUMNS; x++) sum = sum * 31 + peaks[x].position_q8 + peaks[x].confidence + peaks[x].found;
    }
    good(stereopsis_detector_deinit(detector)), good(stereopsis_odometry_deinit(odometry)), good(stereopsis_focus_deinit(map));
    for (int i = 0; i < 3; i++) free(memory[i]);
    return sum;
}

/* Obstacles on a floor, the health of both cameras, and decisions. */
static uint32_t obstacles(void) {
    enum { ROWS = 60, CELLS = WIDTH / 4, CELL_ROWS = ROWS / 5, SECTORS = 16 };
    size_t sizes[4] = {STEREOPSIS_OBSTACLES_BYTES(CELLS, CELL_ROWS), STEREOPSIS_DRIVE_BYTES, STEREOPSIS_FREE_SPACE_BYTES,
                       STEREOPSIS_PAIR_MONITOR_BYTES};
    void *memory[4] = {fresh(sizes[0]), fresh(sizes[1]), fresh(sizes[2]), fresh(sizes[3])};
    stereopsis_obstacles *finder;
    stereopsis_drive *drive;
    stereopsis_free_space *space;
    stereopsis_pair_monitor *monitor;
    stereopsis_obstacles_config config;
    stereopsis_drive_config driving;
    stereopsis_rig rig = {90.0f, 0.1f, 47.5f, 29.5f, 47.5f};
    stereopsis_ground ground;
    stereopsis_stixel stixels[CELLS];
    stereopsis_sector sectors[SECTORS];
    stereopsis_scan scan;
    stereopsis_verdict verdict;
    float ranges[SECTORS];
    uint16_t disparities[WIDTH], cells[CELLS];
    uint8_t flags[WIDTH], blind, health[3];
    uint32_t sum = 0;
    good(stereopsis_obstacles_init(memory[0], sizes[0], CELLS, CELL_ROWS, &finder));
    good(stereopsis_drive_init(memory[1], sizes[1], &drive));
    good(stereopsis_free_space_init(memory[2], sizes[2], 1, 2, &space));
    good(stereopsis_pair_monitor_init(memory[3], sizes[3], 20, &monitor));
    good(stereopsis_obstacles_default(&config)), good(stereopsis_drive_default(&driving));
    good(stereopsis_obstacles_start(finder, &config, &rig, WIDTH, ROWS, 32)), good(stereopsis_drive_start(drive, &driving));
    for (int number = 0; number < 3; number++) {
        good(stereopsis_obstacles_begin_frame(finder)), good(stereopsis_pair_monitor_begin_frame(monitor));
        for (uint16_t y = 0; y < ROWS; y++) {
            stereopsis_row row = {y, WIDTH, disparities, flags, NULL};
            for (int x = 0; x < WIDTH; x++) {
                int floor = y > 20 ? 32 * (y - 20) / 3 : 0, wall = x > 40 && x < 70 ? 128 + 32 * number : 0;
                disparities[x] = x % 11 == y % 7 ? STEREOPSIS_NONE : (uint16_t)(floor > wall ? floor : wall);
                flags[x] = (uint8_t)((x * 37 + y * 11) ^ (x * y));
            }
            good(stereopsis_pair_monitor_push(monitor, flags, flags, WIDTH));
            memset(flags, 0, sizeof flags);
            good(stereopsis_obstacles_push(finder, &row));
        }
        good(stereopsis_pair_monitor_health(monitor, &health[0], &health[1], &health[2]));
        good(stereopsis_obstacles_cameras(finder, monitor));
        good(stereopsis_obstacles_finish(finder, &blind)), good(stereopsis_obstacles_ground(finder, &ground));
        good(stereopsis_obstacles_stixels(finder, stixels, CELLS)), good(stereopsis_free_space_update(space, finder));
        good(stereopsis_free_space_sectors(space, sectors, SECTORS));
        good(stereopsis_obstacles_scan(finder, ranges, SECTORS, &scan));
        good(stereopsis_drive_decide(drive, finder, 500, &verdict));
        sum = sum * 31 + blind + health[0] + health[1] + health[2] + ground.height_mm + verdict.decision + verdict.contact_ms;
        for (int i = 0; i < SECTORS; i++) sum = sum * 31 + sectors[i].state + sectors[i].range_mm + (ranges[i] < 3.0f ? 1u : 0u);
        for (uint16_t row = 0; row < CELL_ROWS; row++) {
            good(stereopsis_obstacles_cells(finder, row, cells, CELLS));
            for (int x = 0; x < CELLS; x++) sum = sum * 31 + cells[x] + stixels[x].kind + stixels[x].depth_mm + stixels[x].seen_row;
        }
    }
    good(stereopsis_obstacles_deinit(finder)), good(stereopsis_drive_deinit(drive));
    good(stereopsis_free_space_deinit(space)), good(stereopsis_pair_monitor_deinit(monitor));
    for (int i = 0; i < 4; i++) free(memory[i]);
    return sum;
}

int main(int count, char **arguments) {
    void *memory = fresh(stereopsis_size());
    stereopsis *matcher;
    (void)arguments;
    good(count > 1 ? stereopsis_init(memory, stereopsis_size(), &matcher)
                   : stereopsis_init_fresh(memory, stereopsis_size(), &matcher));
    /* Printing decides by every bit of the sums. */
    printf("%u %u %u ", (unsigned)frame(matcher), (unsigned)queue(), (unsigned)temporal());
    printf("%u %u\n", (unsigned)motion(), (unsigned)obstacles());
    good(stereopsis_deinit(matcher));
    free(memory);
    return failures > 0;
}
