/* Memory as malloc leaves it, never written: everything that is created in it and run reads none of it before it has been
   written. valgrind watches; with an argument the memory is read by stereopsis_init, which valgrind has to find. */
#include "stereopsis.h"
#include <stdio.h>
#include <stdlib.h>

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

int main(int count, char **arguments) {
    void *memory = fresh(stereopsis_size());
    stereopsis *matcher;
    (void)arguments;
    good(count > 1 ? stereopsis_init(memory, stereopsis_size(), &matcher)
                   : stereopsis_init_fresh(memory, stereopsis_size(), &matcher));
    /* Printing decides by every bit of the sums. */
    printf("%u %u %u ", (unsigned)frame(matcher), (unsigned)queue(), (unsigned)temporal());
    printf("%u\n", (unsigned)motion());
    good(stereopsis_deinit(matcher));
    free(memory);
    return failures > 0;
}
