/* Every misuse of focus maps and odometries has its status, and leaves everything else as it was. Ends with the number of
   failures; built as misuse.c is. */
#include "check.h"

enum { WIDTH = 128, HEIGHT = 96, COLUMNS = 16, CELLS = 192, POINTS = 64, MOST = 80 };

static uint8_t frames[2][HEIGHT][WIDTH];

static void draw(int blur) {
    for (int camera = 0; camera < 2; camera++)
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                int across = (x + 5 * camera) / 6, down = y / 5;
                frames[camera][y][x] = (uint8_t)(128 + ((across * 73 + down * 151 + across * down * 37) % 100 - 50) / blur);
            }
}

static void maps(void) {
    guarded g = guard(STEREOPSIS_FOCUS_BYTES(WIDTH, COLUMNS, CELLS));
    stereopsis_focus *h = NULL;
    stereopsis_focus_config config, wrong;
    stereopsis_focus_peak peaks[COLUMNS + 1];
    volatile float zero = 0.0f;
    EXPECT(stereopsis_focus_init(g.memory, g.size, WIDTH, COLUMNS, CELLS, NULL), NULL);
    EXPECT(stereopsis_focus_init(g.memory, g.size, WIDTH, COLUMNS, CELLS, (stereopsis_focus **)MISALIGN(&h)), MISALIGNED);
    EXPECT(stereopsis_focus_init(NULL, g.size, WIDTH, COLUMNS, CELLS, &h), NULL);
    EXPECT(stereopsis_focus_init(g.memory + 1, g.size, WIDTH, COLUMNS, CELLS, &h), MISALIGNED);
    EXPECT(stereopsis_focus_init(g.memory, g.size - WIDTH, WIDTH, COLUMNS, CELLS, &h), MEMORY_TOO_SHORT);
    EXPECT(stereopsis_focus_init(g.memory, g.size, 65535, 65535, UINT32_MAX, &h), MEMORY_TOO_SHORT);
    EXPECT(stereopsis_focus_init(g.memory, g.size, WIDTH, COLUMNS, CELLS, (stereopsis_focus **)(void *)g.memory), OVERLAP);
    CHECK(h == NULL);
    for (size_t i = 0; i < g.size; i++) CHECK(g.memory[i] == 0xA5);
    EXPECT(stereopsis_focus_finish((stereopsis_focus *)(void *)g.memory), NOT_INITIALISED);
    EXPECT(stereopsis_focus_init(g.memory, g.size, WIDTH, COLUMNS, CELLS, &h), OK);
    EXPECT(stereopsis_focus_begin_frame(h, 1.0f), NOT_STARTED);
    EXPECT(stereopsis_focus_push(h, frames[0][0], WIDTH), NOT_STARTED);
    EXPECT(stereopsis_focus_finish(h), NOT_STARTED);
    EXPECT(stereopsis_focus_row(h, 0, peaks, COLUMNS), NOT_STARTED);
    EXPECT(stereopsis_focus_default(WIDTH, HEIGHT, NULL), NULL);
    EXPECT(stereopsis_focus_default(WIDTH, HEIGHT, (stereopsis_focus_config *)MISALIGN(&config)), MISALIGNED);
    EXPECT(stereopsis_focus_default(WIDTH, HEIGHT, &config), OK);
    EXPECT(stereopsis_focus_start(h, &config), FOCUS_SIZE); /* a cell a pixel */
    config.cell_px = 8, config.radius = 0;
    EXPECT(stereopsis_focus_start(NULL, &config), NULL);
    EXPECT(stereopsis_focus_start(h, NULL), NULL);
    EXPECT(stereopsis_focus_start(h, (stereopsis_focus_config *)MISALIGN(&config)), MISALIGNED);
    wrong = config, wrong.width = WIDTH + 1;
    EXPECT(stereopsis_focus_start(h, &wrong), FOCUS_SIZE);
    wrong = config, wrong.height = HEIGHT + 1;
    EXPECT(stereopsis_focus_start(h, &wrong), FOCUS_SIZE);
    wrong = config, wrong.width = 0;
    EXPECT(stereopsis_focus_start(h, &wrong), FOCUS_SIZE);
    wrong = config, wrong.cell_px = 0;
    EXPECT(stereopsis_focus_start(h, &wrong), FOCUS_WINDOW);
    wrong = config, wrong.radius = 255;
    EXPECT(stereopsis_focus_start(h, &wrong), FOCUS_WINDOW);
    EXPECT(stereopsis_focus_start(h, &config), OK);
    EXPECT(stereopsis_focus_push(h, frames[0][0], WIDTH), NO_LINE_LEFT);
    EXPECT(stereopsis_focus_begin_frame(NULL, 1.0f), NULL);
    EXPECT(stereopsis_focus_begin_frame(h, 0.49f), FOCUS_SCALE);
    EXPECT(stereopsis_focus_begin_frame(h, 2.1f), FOCUS_SCALE);
    EXPECT(stereopsis_focus_begin_frame(h, zero / zero), FOCUS_SCALE);
    for (int frame = 0; frame < 9; frame++) {
        draw(frame > 4 ? frame - 3 : 5 - frame);
        EXPECT(stereopsis_focus_begin_frame(h, frame % 2 == 0 ? 1.0f : 1.01f), OK);
        EXPECT(stereopsis_focus_begin_frame(h, 1.0f), LINES_MISSING);
        EXPECT(stereopsis_focus_finish(h), LINES_MISSING);
        EXPECT(stereopsis_focus_push(NULL, frames[0][0], WIDTH), NULL);
        EXPECT(stereopsis_focus_push(h, NULL, WIDTH), NULL);
        EXPECT(stereopsis_focus_push(h, frames[0][0], WIDTH - 1), LINE_LENGTH);
        EXPECT(stereopsis_focus_push(h, frames[0][0], SIZE_MAX), LINE_LENGTH);
        EXPECT(stereopsis_focus_push(h, g.memory, WIDTH), OVERLAP);
        for (int y = 0; y < HEIGHT; y++) EXPECT(stereopsis_focus_push(h, frames[0][y], WIDTH), OK);
        EXPECT(stereopsis_focus_push(h, frames[0][0], WIDTH), NO_LINE_LEFT);
    }
    EXPECT(stereopsis_focus_row(h, 0, peaks, COLUMNS), FOCUS_NOT_FINISHED);
    EXPECT(stereopsis_focus_finish(NULL), NULL);
    EXPECT(stereopsis_focus_finish(h), OK);
    EXPECT(stereopsis_focus_finish(h), NOT_STARTED);
    EXPECT(stereopsis_focus_begin_frame(h, 1.0f), NOT_STARTED);
    EXPECT(stereopsis_focus_row(NULL, 0, peaks, COLUMNS), NULL);
    EXPECT(stereopsis_focus_row(h, 0, NULL, COLUMNS), NULL);
    EXPECT(stereopsis_focus_row(h, 0, (stereopsis_focus_peak *)MISALIGN(peaks), COLUMNS), MISALIGNED);
    EXPECT(stereopsis_focus_row(h, 0, peaks, SIZE_MAX), TOO_MANY);
    EXPECT(stereopsis_focus_row(h, 0, (stereopsis_focus_peak *)(void *)g.memory, 1), OVERLAP);
    EXPECT(stereopsis_focus_row(h, 2, peaks, COLUMNS + 1), OK);
    for (int x = 0; x < COLUMNS; x++)
        CHECK(peaks[x].found == STEREOPSIS_FOCUS_FOUND && peaks[x].position_q8 > 3 * 256 && peaks[x].position_q8 < 5 * 256);
    CHECK(peaks[COLUMNS].found == STEREOPSIS_FOCUS_FEW && peaks[COLUMNS].position_q8 == 0);
    EXPECT(stereopsis_focus_row(h, 65535, peaks, COLUMNS), OK);
    CHECK(peaks[0].found == STEREOPSIS_FOCUS_FEW);
    /* As many frames as a stack has, of a row each. */
    wrong = config, wrong.width = 8, wrong.height = 1, wrong.cell_px = 1;
    EXPECT(stereopsis_focus_start(h, &wrong), OK);
    for (int frame = 0; frame < 65535; frame++) {
        EXPECT(stereopsis_focus_begin_frame(h, 1.0f), OK);
        EXPECT(stereopsis_focus_push(h, frames[0][0], 8), OK);
    }
    EXPECT(stereopsis_focus_begin_frame(h, 1.0f), FOCUS_FRAMES);
    EXPECT(stereopsis_focus_deinit(NULL), NULL);
    EXPECT(stereopsis_focus_deinit(h), OK);
    EXPECT(stereopsis_focus_deinit(h), NOT_INITIALISED);
    release(g);
}

static void odometries(void) {
    guarded g = guard(STEREOPSIS_ODOMETRY_BYTES(POINTS));
    stereopsis_odometry *h = NULL;
    stereopsis_odometry_config config, wrong;
    stereopsis_rig rig = {120.0f, 0.1f, 63.5f, 47.5f, 63.5f}, none = rig;
    stereopsis_picture left, right, small;
    stereopsis_step step, untouched;
    stereopsis_feature features[MOST];
    volatile float zero = 0.0f;
    draw(1);
    memset(features, 0, sizeof features), memset(&step, 0x5A, sizeof step), memcpy(&untouched, &step, sizeof step);
    left.pixels = frames[0][0], right.pixels = frames[1][0];
    left.width = right.width = WIDTH, left.height = right.height = HEIGHT;
    for (size_t i = 0; i < MOST; i++) {
        features[i].x_px = (float)(24 + 9 * (i % 10)), features[i].y_px = (float)(12 + 9 * (i / 10)), features[i].score = 30;
        for (size_t word = 0; word < 8; word++) features[i].descriptor[word] = (uint32_t)((i * 2654435761u) ^ (word * 40503u));
    }
    EXPECT(stereopsis_odometry_init(g.memory, g.size, POINTS, NULL), NULL);
    EXPECT(stereopsis_odometry_init(g.memory, g.size, POINTS, (stereopsis_odometry **)MISALIGN(&h)), MISALIGNED);
    EXPECT(stereopsis_odometry_init(NULL, g.size, POINTS, &h), NULL);
    EXPECT(stereopsis_odometry_init(g.memory + 1, g.size, POINTS, &h), MISALIGNED);
    EXPECT(stereopsis_odometry_init(g.memory, g.size, POINTS + 8, &h), MEMORY_TOO_SHORT);
    EXPECT(stereopsis_odometry_init(g.memory, g.size, 15, &h), ODOMETRY_POINTS);
    EXPECT(stereopsis_odometry_init(g.memory, g.size, 65535, &h), ODOMETRY_POINTS);
    EXPECT(stereopsis_odometry_init(g.memory, g.size, POINTS, (stereopsis_odometry **)(void *)g.memory), OVERLAP);
    CHECK(h == NULL);
    for (size_t i = 0; i < g.size; i++) CHECK(g.memory[i] == 0xA5);
    EXPECT(stereopsis_odometry_default(WIDTH, &config), OK);
    EXPECT(stereopsis_odometry_start((stereopsis_odometry *)(void *)g.memory, &rig, &config), NOT_INITIALISED);
    EXPECT(stereopsis_odometry_init(g.memory, g.size, POINTS, &h), OK);
    EXPECT(stereopsis_odometry_step(h, &left, &right, features, MOST, &step), NOT_STARTED);
    EXPECT(stereopsis_odometry_default(WIDTH, NULL), NULL);
    EXPECT(stereopsis_odometry_default(WIDTH, (stereopsis_odometry_config *)MISALIGN(&config)), MISALIGNED);
    EXPECT(stereopsis_odometry_default(WIDTH, &config), OK);
    EXPECT(stereopsis_odometry_start(NULL, &rig, &config), NULL);
    EXPECT(stereopsis_odometry_start(h, NULL, &config), NULL);
    EXPECT(stereopsis_odometry_start(h, &rig, NULL), NULL);
    EXPECT(stereopsis_odometry_start(h, (stereopsis_rig *)MISALIGN(&rig), &config), MISALIGNED);
    EXPECT(stereopsis_odometry_start(h, &rig, (stereopsis_odometry_config *)MISALIGN(&config)), MISALIGNED);
    none.baseline_m = 0.0f;
    EXPECT(stereopsis_odometry_start(h, &none, &config), RIG_BASELINE);
    none = rig, none.focal_px = zero / zero;
    EXPECT(stereopsis_odometry_start(h, &none, &config), RIG_NOT_FINITE);
    wrong = config, wrong.near_px = -1.0f;
    EXPECT(stereopsis_odometry_start(h, &rig, &wrong), ODOMETRY_CONFIG);
    wrong = config, wrong.sigma_px = zero / zero;
    EXPECT(stereopsis_odometry_start(h, &rig, &wrong), ODOMETRY_CONFIG);
    wrong = config, wrong.sigma_px = zero;
    EXPECT(stereopsis_odometry_start(h, &rig, &wrong), ODOMETRY_CONFIG);
    wrong = config, wrong.most_samples = 0;
    EXPECT(stereopsis_odometry_start(h, &rig, &wrong), ODOMETRY_CONFIG);
    wrong = config, wrong.spacing_px = 1.0f / zero;
    EXPECT(stereopsis_odometry_start(h, &rig, &wrong), ODOMETRY_CONFIG);
    EXPECT(stereopsis_odometry_start(h, &rig, &config), OK);
    EXPECT(stereopsis_odometry_step(NULL, &left, &right, features, MOST, &step), NULL);
    EXPECT(stereopsis_odometry_step(h, NULL, &right, features, MOST, &step), NULL);
    EXPECT(stereopsis_odometry_step(h, &left, NULL, features, MOST, &step), NULL);
    EXPECT(stereopsis_odometry_step(h, &left, &right, NULL, MOST, &step), NULL);
    EXPECT(stereopsis_odometry_step(h, &left, &right, features, MOST, NULL), NULL);
    EXPECT(stereopsis_odometry_step(h, (stereopsis_picture *)MISALIGN(&left), &right, features, MOST, &step), MISALIGNED);
    EXPECT(stereopsis_odometry_step(h, &left, &right, (stereopsis_feature *)MISALIGN(features), MOST - 1, &step), MISALIGNED);
    EXPECT(stereopsis_odometry_step(h, &left, &right, features, MOST, (stereopsis_step *)MISALIGN(&step)), MISALIGNED);
    EXPECT(stereopsis_odometry_step(h, &left, &right, features, SIZE_MAX, &step), TOO_MANY);
    EXPECT(stereopsis_odometry_step(h, &left, &right, features, MOST, (stereopsis_step *)(void *)g.memory), OVERLAP);
    EXPECT(stereopsis_odometry_step(h, &left, &right, (stereopsis_feature *)(void *)g.memory, 1, &step), OVERLAP);
    small = right, small.height--;
    EXPECT(stereopsis_odometry_step(h, &left, &small, features, MOST, &step), PICTURE_SIZE);
    small = right, small.pixels = NULL;
    EXPECT(stereopsis_odometry_step(h, &left, &small, features, MOST, &step), NULL);
    small = right, small.pixels = g.memory;
    EXPECT(stereopsis_odometry_step(h, &left, &small, features, MOST, &step), OVERLAP);
    CHECK(memcmp(&step, &untouched, sizeof step) == 0);
    EXPECT(stereopsis_odometry_step(h, &left, &right, features, MOST, &step), OK);
    CHECK(step.state == STEREOPSIS_MOTION_FIRST && step.points > 0 && step.points <= POINTS);
    small = left, small.width--;
    right.width--;
    EXPECT(stereopsis_odometry_step(h, &small, &right, features, MOST, &step), PICTURE_SIZE);
    right.width++;
    EXPECT(stereopsis_odometry_step(h, &left, &right, features, MOST, &step), OK);
    CHECK(step.state == STEREOPSIS_MOTION_STATIONARY && step.motion.translation[0] == 0.0f);
    CHECK(step.motion.rotation[0] == 1.0f && step.covariance[0] < 1.0f);
    /* Features and numbers from nowhere. */
    memset(features, 0xFF, sizeof features);
    for (int frame = 0; frame < 8; frame++) EXPECT(stereopsis_odometry_step(h, &left, &right, features, MOST, &step), OK);
    memset(features, 0x7F, sizeof features), wrong = config;
    wrong.far_px = wrong.near_px = 1.0f / zero, wrong.sigma_px = 1000.0f, wrong.spacing_px = 1e30f, wrong.most_disparity_px = 65535;
    EXPECT(stereopsis_odometry_start(h, &rig, &wrong), OK);
    for (int frame = 0; frame < 3; frame++) EXPECT(stereopsis_odometry_step(h, &left, &right, features, MOST, &step), OK);
    wrong.far_px = wrong.near_px = 1e-30f, wrong.sigma_px = 0.001f, wrong.spacing_px = 0.0f, wrong.most_samples = 1;
    EXPECT(stereopsis_odometry_start(h, &rig, &wrong), OK);
    for (int frame = 0; frame < 3; frame++) EXPECT(stereopsis_odometry_step(h, &left, &right, features, 0, &step), OK);
    EXPECT(stereopsis_odometry_deinit(NULL), NULL);
    EXPECT(stereopsis_odometry_deinit(h), OK);
    EXPECT(stereopsis_odometry_deinit(h), NOT_INITIALISED);
    release(g);
}

int main(void) {
    maps();
    odometries();
    printf("%d failures\n", failures);
    return failures > 0;
}
