/* Every misuse of the C interface has its status, and leaves everything else as it was. Ends with the number of failures;
   built with the address and undefined-behaviour sanitizers, as C and as C++. */
#include "check.h"

enum { WIDTH = 40, HEIGHT = 4 };

static guarded take(void) {
    return guard(stereopsis_size());
}

static stereopsis_config config(void) {
    stereopsis_config c;
    EXPECT(stereopsis_config_default(WIDTH, HEIGHT, 32, STEREOPSIS_PRESET_DEFAULT, &c), OK);
    return c;
}

static void constants(void) {
    CHECK(stereopsis_abi() == STEREOPSIS_ABI);
    CHECK(strchr(stereopsis_version(), '.') != NULL);
    CHECK(stereopsis_align() <= STEREOPSIS_ALIGN && STEREOPSIS_ALIGN % stereopsis_align() == 0);
    CHECK(stereopsis_size() <= STEREOPSIS_BYTES(STEREOPSIS_WIDTH, STEREOPSIS_DISPARITIES));
    /* Not much more: 3088 bytes of tables that only some cores have, and a few. */
    CHECK(stereopsis_size() + 3088 + 256 > STEREOPSIS_BYTES(STEREOPSIS_WIDTH, STEREOPSIS_DISPARITIES));
    CHECK(stereopsis_max_width() == STEREOPSIS_WIDTH && stereopsis_max_disparities() == STEREOPSIS_DISPARITIES);
    CHECK(strcmp(stereopsis_status_text(STEREOPSIS_STATUS_NULL), "a pointer is null") == 0);
    CHECK(strcmp(stereopsis_status_text(INT32_MIN), "no status of this library") == 0);
}

static void memory(void) {
    guarded g = take();
    size_t align = stereopsis_align();
    stereopsis *s;
    EXPECT(stereopsis_init(g.memory, g.size, NULL), NULL);
    s = (stereopsis *)(void *)g.memory;
    EXPECT(stereopsis_init(NULL, g.size, &s), NULL);
    CHECK(s == NULL);
    for (size_t off = 1; off < align; off++) EXPECT(stereopsis_init(g.memory + off, g.size, &s), MISALIGNED);
    EXPECT(stereopsis_init(g.memory, 0, &s), MEMORY_TOO_SHORT);
    EXPECT(stereopsis_init(g.memory, g.size - 1, &s), MEMORY_TOO_SHORT);
    EXPECT(stereopsis_init(g.memory, g.size, (stereopsis **)(void *)(g.memory + align)), OVERLAP);
    for (size_t i = 0; i < g.size; i++) CHECK(g.memory[i] == 0xA5);

    EXPECT(stereopsis_begin_frame((stereopsis *)(void *)g.memory), NOT_INITIALISED);
    EXPECT(stereopsis_init(g.memory, g.size, &s), OK);
    CHECK((unsigned char *)s == g.memory);
    stereopsis *again = s;
    EXPECT(stereopsis_init(g.memory, g.size, &again), ALREADY_INITIALISED);
    CHECK(again == NULL);

    /* A copy somewhere else is no matcher. */
    guarded copy = take();
    memcpy(copy.memory, g.memory, g.size);
    EXPECT(stereopsis_begin_frame((stereopsis *)(void *)copy.memory), NOT_INITIALISED);
    release(copy);

    EXPECT(stereopsis_deinit(NULL), NULL);
    EXPECT(stereopsis_deinit((stereopsis *)(void *)(g.memory + 1)), MISALIGNED);
    EXPECT(stereopsis_deinit(s), OK);
    EXPECT(stereopsis_deinit(s), NOT_INITIALISED);
    EXPECT(stereopsis_init(g.memory, g.size, &s), OK);
    /* One for memory that was never written makes a new one over it. */
    EXPECT(stereopsis_init_fresh(g.memory, g.size, NULL), NULL);
    EXPECT(stereopsis_init_fresh(NULL, g.size, &s), NULL);
    EXPECT(stereopsis_init_fresh(g.memory + 1, g.size, &s), MISALIGNED);
    EXPECT(stereopsis_init_fresh(g.memory, g.size - 1, &s), MEMORY_TOO_SHORT);
    EXPECT(stereopsis_init_fresh(g.memory, g.size, (stereopsis **)(void *)(g.memory + align)), OVERLAP);
    EXPECT(stereopsis_init_fresh(g.memory, g.size, (stereopsis **)MISALIGN(&s)), MISALIGNED);
    EXPECT(stereopsis_init_fresh(g.memory, g.size, &s), OK);
    EXPECT(stereopsis_deinit(s), OK);
    release(g);
}

/* One field of a configuration that is refused. */
#define REFUSED(field, value, status)                 \
    do {                                              \
        stereopsis_config wrong = config();           \
        wrong.field = (value);                        \
        EXPECT(stereopsis_start(s, &wrong), status);  \
        EXPECT(stereopsis_restart(s, &wrong), status); \
        EXPECT(stereopsis_begin_frame(s), NOT_STARTED); \
    } while (0)

static void configurations(void) {
    guarded g = take();
    stereopsis *s;
    stereopsis_config c;
    EXPECT(stereopsis_config_default(1, 1, 16, STEREOPSIS_PRESET_STRICT, NULL), NULL);
    EXPECT(stereopsis_config_default(1, 1, 16, -1, &c), PRESET);
    EXPECT(stereopsis_config_default(1, 1, 16, 3, &c), PRESET);
    EXPECT(stereopsis_init(g.memory, g.size, &s), OK);
    c = config();
    EXPECT(stereopsis_start(NULL, &c), NULL);
    EXPECT(stereopsis_start(s, NULL), NULL);
    EXPECT(stereopsis_start(s, (stereopsis_config *)MISALIGN(&c)), MISALIGNED);
    EXPECT(stereopsis_restart(s, (stereopsis_config *)MISALIGN(&c)), MISALIGNED);
    EXPECT(stereopsis_config_default(1, 1, 16, STEREOPSIS_PRESET_STRICT, (stereopsis_config *)MISALIGN(&c)), MISALIGNED);
    EXPECT(stereopsis_config_noise(STEREOPSIS_PRESET_STRICT, 0, (stereopsis_config *)MISALIGN(&c)), MISALIGNED);
    EXPECT(stereopsis_restart(NULL, &c), NULL);
    EXPECT(stereopsis_restart(s, NULL), NULL);
    REFUSED(width, 0, WIDTH);
    REFUSED(width, STEREOPSIS_WIDTH + 1, WIDTH);
    REFUSED(height, 0, HEIGHT);
    REFUSED(disparities, 15, DISPARITIES);
    REFUSED(disparities, STEREOPSIS_DISPARITIES + 1, DISPARITIES);
    REFUSED(min_disparity, 2047, MIN_DISPARITY);
    REFUSED(left_right_px, 256, LEFT_RIGHT);
    REFUSED(left_right_px, -2, LEFT_RIGHT);
    REFUSED(uniqueness_percent, 100, UNIQUENESS);
    REFUSED(uniqueness_percent, -2, UNIQUENESS);
    REFUSED(smoothing_radius, 9, SMOOTHING);
    REFUSED(surface_step, 33, SURFACE_STEP);
    REFUSED(gradient, 0, GRADIENT);
    REFUSED(gradient, 15, GRADIENT);
    REFUSED(cost, 0, PENALTIES);
    REFUSED(step[0], 27, PENALTIES);
    REFUSED(step[1], 19, PENALTIES);
    REFUSED(jump[0], 96, PENALTIES);
    REFUSED(edges[0], 21, PENALTIES);
    REFUSED(noise, 3, NOISE);
    REFUSED(open_margin, 128, OPEN_MARGIN);
    REFUSED(min_confidence, 208, MIN_CONFIDENCE);

    /* For cameras with noise: what is wrong changes nothing, what is right keeps the search. */
    stereopsis_config before;
    c = config();
    memcpy(&before, &c, sizeof c);
    EXPECT(stereopsis_config_noise(STEREOPSIS_PRESET_DEFAULT, STEREOPSIS_NOISE_LOW, NULL), NULL);
    EXPECT(stereopsis_config_noise(-1, STEREOPSIS_NOISE_LOW, &c), PRESET);
    EXPECT(stereopsis_config_noise(3, 3, &c), PRESET);
    EXPECT(stereopsis_config_noise(STEREOPSIS_PRESET_DEFAULT, 3, &c), NOISE);
    CHECK(memcmp(&c, &before, sizeof c) == 0);
    for (uint8_t level = STEREOPSIS_NOISE_NONE; level <= STEREOPSIS_NOISE_HIGH; level++) {
        c = before;
        c.min_disparity = 5;
        c.confidence = 2;
        c.cost = 0;
        EXPECT(stereopsis_config_noise(STEREOPSIS_PRESET_DEFAULT, level, &c), OK);
        CHECK(c.noise == level && c.min_disparity == 5 && c.confidence == 2 && c.cost > 0);
        CHECK(c.width == WIDTH && c.height == HEIGHT && c.disparities == 32);
        EXPECT(stereopsis_start(s, &c), OK);
    }
    /* Refused, it leaves the frame that is under way; taken, it ends it. */
    EXPECT(stereopsis_begin_frame(s), OK);
    c.width = 0;
    EXPECT(stereopsis_restart(s, &c), WIDTH);
    c.width = WIDTH;
    {
        uint8_t line[WIDTH] = {0};
        stereopsis_row row;
        EXPECT(stereopsis_push(s, line, line, WIDTH, &row), NO_ROW_YET);
        EXPECT(stereopsis_restart(s, &c), OK);
        EXPECT(stereopsis_push(s, line, line, WIDTH, &row), NOT_BEGUN);
    }
    for (int32_t preset = STEREOPSIS_PRESET_DENSE; preset <= STEREOPSIS_PRESET_STRICT; preset++) {
        EXPECT(stereopsis_config_default(WIDTH, HEIGHT, 32, preset, &c), OK);
        EXPECT(stereopsis_start(s, &c), OK);
    }
    EXPECT(stereopsis_deinit(s), OK);
    release(g);
}

static void lines(void) {
    guarded g = take();
    stereopsis *s;
    stereopsis_config c = config();
    stereopsis_row row, untouched;
    uint8_t line[WIDTH];
    float sigma[WIDTH];
    for (size_t i = 0; i < WIDTH; i++) line[i] = (uint8_t)(i * 37 % 251);
    memset(&row, 0x5A, sizeof row);
    untouched = row;
    EXPECT(stereopsis_init(g.memory, g.size, &s), OK);
    EXPECT(stereopsis_begin_frame(NULL), NULL);
    EXPECT(stereopsis_begin_frame(s), NOT_STARTED);
    EXPECT(stereopsis_push(s, line, line, WIDTH, &row), NOT_STARTED);
    EXPECT(stereopsis_flush(s, &row), NOT_STARTED);
    EXPECT(stereopsis_sigma_px(s, sigma, WIDTH), NOT_STARTED);
    EXPECT(stereopsis_mask(s, line, line, WIDTH), NOT_STARTED);
    EXPECT(stereopsis_start(s, &c), OK);
    EXPECT(stereopsis_sigma_px(s, sigma, WIDTH), NO_ROW_YET);
    EXPECT(stereopsis_push(s, line, line, WIDTH, &row), NOT_BEGUN);
    EXPECT(stereopsis_flush(s, &row), NOT_BEGUN);

    for (int frame = 0; frame < 2; frame++) {
        EXPECT(stereopsis_begin_frame(s), OK);
        row = untouched;
        EXPECT(stereopsis_push(NULL, line, line, WIDTH, &row), NULL);
        EXPECT(stereopsis_push(s, NULL, line, WIDTH, &row), NULL);
        EXPECT(stereopsis_push(s, line, NULL, WIDTH, &row), NULL);
        EXPECT(stereopsis_push(s, line, line, WIDTH, NULL), NULL);
        EXPECT(stereopsis_push(s, line, line, WIDTH, (stereopsis_row *)MISALIGN(&row)), MISALIGNED);
        EXPECT(stereopsis_push_lost(s, STEREOPSIS_LOST_TORN, (stereopsis_row *)MISALIGN(&row)), MISALIGNED);
        EXPECT(stereopsis_flush(s, (stereopsis_row *)MISALIGN(&row)), MISALIGNED);
        EXPECT(stereopsis_push(s, line, line, 0, &row), LINE_LENGTH);
        EXPECT(stereopsis_push(s, line, line, WIDTH - 1, &row), LINE_LENGTH);
        EXPECT(stereopsis_push(s, line, line, SIZE_MAX, &row), LINE_LENGTH);
        EXPECT(stereopsis_push(s, g.memory, line, WIDTH, &row), OVERLAP);
        EXPECT(stereopsis_push(s, line, g.memory + g.size - 1, WIDTH, &row), OVERLAP);
        EXPECT(stereopsis_push(s, line, line, WIDTH, (stereopsis_row *)(void *)g.memory), OVERLAP);
        EXPECT(stereopsis_flush(s, &row), LINES_MISSING);
        CHECK(memcmp(&row, &untouched, sizeof row) == 0);
        for (int y = 0; y < HEIGHT; y++) {
            EXPECT(stereopsis_push(s, line, line, WIDTH, &row), NO_ROW_YET);
            CHECK(row.width == 0 && row.disparities == NULL && row.flags == NULL);
        }
        EXPECT(stereopsis_push(s, line, line, WIDTH, &row), NO_LINE_LEFT);
        EXPECT(stereopsis_flush(NULL, &row), NULL);
        EXPECT(stereopsis_flush(s, NULL), NULL);
        EXPECT(stereopsis_flush(s, (stereopsis_row *)(void *)g.memory), OVERLAP);
        for (uint16_t y = 0; y < HEIGHT; y++) {
            EXPECT(stereopsis_flush(s, &row), OK);
            CHECK(row.index == y && row.width == WIDTH);
            CHECK((const unsigned char *)row.flags > g.memory && (const unsigned char *)row.flags < g.memory + g.size);
            /* Both cameras see the same: what has an answer is infinitely far, what has none says why. */
            for (uint16_t x = 0; x < WIDTH; x++)
                CHECK(row.disparities[x] == 0 || (row.disparities[x] == STEREOPSIS_NONE && row.flags[x] != 0));
            EXPECT(stereopsis_sigma_px(s, sigma, WIDTH), OK);
            for (uint16_t x = 0; x < WIDTH; x++) CHECK((sigma[x] < 1e9f) == (row.disparities[x] != STEREOPSIS_NONE));
        }
        EXPECT(stereopsis_sigma_px(NULL, sigma, WIDTH), NULL);
        EXPECT(stereopsis_sigma_px(s, NULL, WIDTH), NULL);
        EXPECT(stereopsis_sigma_px(s, sigma, WIDTH - 1), LINE_LENGTH);
        EXPECT(stereopsis_sigma_px(s, (float *)(void *)((char *)sigma + 1), WIDTH - 1), MISALIGNED);
        EXPECT(stereopsis_sigma_px(s, (float *)(void *)g.memory, WIDTH), OVERLAP);
        EXPECT(stereopsis_flush(s, &row), FRAME_DONE);
        CHECK(row.width == 0 && row.disparities == NULL);
        EXPECT(stereopsis_flush(s, &row), FRAME_DONE);
    }
    EXPECT(stereopsis_deinit(s), OK);
    EXPECT(stereopsis_push(s, line, line, WIDTH, &row), NOT_INITIALISED);
    EXPECT(stereopsis_flush(s, &row), NOT_INITIALISED);
    EXPECT(stereopsis_sigma_px(s, sigma, WIDTH), NOT_INITIALISED);
    EXPECT(stereopsis_start(s, &c), NOT_INITIALISED);
    release(g);
}

/* A frame with one lost line: which rows have the flag, and what is counted. */
static void lost_lines(void) {
    guarded g = take();
    stereopsis *s;
    stereopsis_config c = config();
    stereopsis_row row, untouched;
    stereopsis_counts counts;
    uint8_t line[WIDTH], seen[WIDTH];
    int damaged = 0, rows = 0;
    int32_t status;
    memset(&row, 0x5A, sizeof row);
    untouched = row;
    for (size_t i = 0; i < WIDTH; i++) line[i] = (uint8_t)(i * 37 % 251);
    c.height = 40;
    EXPECT(stereopsis_init(g.memory, g.size, &s), OK);
    EXPECT(stereopsis_push_lost(s, STEREOPSIS_LOST_TORN, &row), NOT_STARTED);
    EXPECT(stereopsis_start(s, &c), OK);
    EXPECT(stereopsis_push_lost(s, STEREOPSIS_LOST_TORN, &row), NOT_BEGUN);
    EXPECT(stereopsis_begin_frame(s), OK);
    EXPECT(stereopsis_push_lost(NULL, STEREOPSIS_LOST_TORN, &row), NULL);
    EXPECT(stereopsis_push_lost(s, STEREOPSIS_LOST_TORN, NULL), NULL);
    EXPECT(stereopsis_push_lost(s, STEREOPSIS_LOST_TORN, (stereopsis_row *)(void *)g.memory), OVERLAP);
    EXPECT(stereopsis_push_lost(s, -1, &row), FAULT);
    EXPECT(stereopsis_push_lost(s, 4, &row), FAULT);
    EXPECT(stereopsis_mask(s, NULL, NULL, WIDTH), NO_ROW_YET);
    CHECK(memcmp(&row, &untouched, sizeof row) == 0);
    for (int y = 0; y < c.height; y++) {
        status = y == 20 ? stereopsis_push_lost(s, STEREOPSIS_LOST_TORN, &row) : stereopsis_push(s, line, line, WIDTH, &row);
        CHECK(status >= 0);
        if (status == STEREOPSIS_STATUS_OK) damaged += (row.flags[0] & STEREOPSIS_FLAG_DAMAGED) != 0, rows++;
    }
    EXPECT(stereopsis_push_lost(s, STEREOPSIS_LOST_TORN, &row), NO_LINE_LEFT);
    while ((status = stereopsis_flush(s, &row)) == STEREOPSIS_STATUS_OK)
        damaged += (row.flags[0] & STEREOPSIS_FLAG_DAMAGED) != 0, rows++;
    CHECK(status == STEREOPSIS_STATUS_FRAME_DONE && rows == 40 && damaged > 1 && damaged < 40);
    EXPECT(stereopsis_counters(s, NULL), NULL);
    EXPECT(stereopsis_counters(s, (stereopsis_counts *)MISALIGN(&counts)), MISALIGNED);
    EXPECT(stereopsis_counters(NULL, &counts), NULL);
    EXPECT(stereopsis_counters(s, (stereopsis_counts *)(void *)g.memory), OVERLAP);
    EXPECT(stereopsis_counters(s, &counts), OK);
    CHECK(counts.frames == 1 && counts.frames_damaged == 1 && counts.frames_whole == 0 && counts.frames_broken == 0);
    CHECK(counts.lines == 39 && counts.lines_torn == 1 && counts.lines_dropped == 0);
    CHECK(counts.rows == 40 && counts.rows_damaged == (uint32_t)damaged);

    /* A frame without, of which the left half of a row was not seen. */
    EXPECT(stereopsis_begin_frame(s), OK);
    for (int y = 0; y < c.height; y++) CHECK(stereopsis_push(s, line, line, WIDTH, &row) >= 0);
    for (size_t i = 0; i < WIDTH; i++) seen[i] = i >= WIDTH / 2;
    EXPECT(stereopsis_mask(s, seen, NULL, WIDTH - 1), LINE_LENGTH);
    EXPECT(stereopsis_mask(s, g.memory, NULL, WIDTH), OVERLAP);
    EXPECT(stereopsis_mask(NULL, seen, NULL, WIDTH), NULL);
    EXPECT(stereopsis_mask(s, NULL, NULL, WIDTH), OK);
    int answers = 0;
    for (size_t i = 0; i < WIDTH; i++) answers += row.disparities[i] != STEREOPSIS_NONE;
    CHECK(answers > WIDTH / 2);
    EXPECT(stereopsis_mask(s, seen, NULL, WIDTH), OK);
    for (size_t i = 0; i < WIDTH / 2; i++)
        CHECK(row.disparities[i] == STEREOPSIS_NONE && (row.flags[i] & STEREOPSIS_FLAG_OUTSIDE) != 0);
    EXPECT(stereopsis_mask(s, NULL, seen, WIDTH), OK);
    EXPECT(stereopsis_begin_frame(s), OK);
    EXPECT(stereopsis_counters(s, &counts), OK);
    CHECK(counts.frames == 3 && counts.frames_broken == 1);
    EXPECT(stereopsis_deinit(s), OK);
    EXPECT(stereopsis_counters(s, &counts), NOT_INITIALISED);
    EXPECT(stereopsis_mask(s, NULL, NULL, WIDTH), NOT_INITIALISED);
    release(g);
}

static void noise(void) {
    stereopsis_noise_meter meter;
    uint8_t line[WIDTH], level = 9;
    uint16_t sigma = 9;
    uint32_t random = 1;
    memset(&meter, 0xA5, sizeof meter);
    EXPECT(stereopsis_noise_clear(NULL), NULL);
    EXPECT(stereopsis_noise_clear((stereopsis_noise_meter *)(void *)((char *)&meter + 1)), MISALIGNED);
    EXPECT(stereopsis_noise_clear(&meter), OK);
    EXPECT(stereopsis_noise_level(&meter, &level, &sigma), OK);
    CHECK(level == STEREOPSIS_NOISE_NONE && sigma == 0);
    EXPECT(stereopsis_noise_line(NULL, line, WIDTH), NULL);
    EXPECT(stereopsis_noise_line(&meter, NULL, WIDTH), NULL);
    EXPECT(stereopsis_noise_line(&meter, line, SIZE_MAX), TOO_MANY);
    EXPECT(stereopsis_noise_line(&meter, (const uint8_t *)&meter, WIDTH), OVERLAP);
    EXPECT(stereopsis_noise_level(&meter, NULL, &sigma), NULL);
    EXPECT(stereopsis_noise_level(NULL, &level, &sigma), NULL);
    EXPECT(stereopsis_noise_level(&meter, &level, (uint16_t *)MISALIGN(&sigma)), MISALIGNED);
    EXPECT(stereopsis_noise_level(&meter, (uint8_t *)&sigma, &sigma), OVERLAP);
    EXPECT(stereopsis_noise_level(&meter, (uint8_t *)&meter, &sigma), OVERLAP);
    EXPECT(stereopsis_noise_level(&meter, &level, (uint16_t *)(void *)&meter), OVERLAP);
    /* Evenly spread over 16 levels: a deviation of 4.6. */
    for (int y = 0; y < 200; y++) {
        for (size_t i = 0; i < WIDTH; i++) {
            random = random * 1664525u + 1013904223u;
            line[i] = (uint8_t)(100 + (random >> 28));
        }
        EXPECT(stereopsis_noise_line(&meter, line, WIDTH), OK);
    }
    EXPECT(stereopsis_noise_level(&meter, &level, NULL), OK);
    EXPECT(stereopsis_noise_level(&meter, &level, &sigma), OK);
    CHECK(level == STEREOPSIS_NOISE_HIGH && sigma > 56 && sigma < 96);
    EXPECT(stereopsis_noise_clear(&meter), OK);
    for (int y = 0; y < 10; y++) {
        memset(line, 90 + y, WIDTH);
        EXPECT(stereopsis_noise_line(&meter, line, WIDTH), OK);
    }
    EXPECT(stereopsis_noise_level(&meter, &level, &sigma), OK);
    CHECK(level == STEREOPSIS_NOISE_NONE && sigma < 4);
}

static void depths(void) {
    stereopsis_rig rig, wrong;
    uint16_t words[3] = {25 * STEREOPSIS_STEPS_PER_PX, STEREOPSIS_NONE, 0}, depth[3];
    volatile float zero = 0.0f;
    rig.focal_px = 500.0f;
    rig.baseline_m = 0.1f;
    rig.cx = rig.cx_right = 160.0f;
    rig.cy = 120.0f;
    EXPECT(stereopsis_millimetres(&rig, words, depth, 3), OK);
    CHECK(depth[0] == 2000 && depth[1] == 0 && depth[2] == 0);
    EXPECT(stereopsis_millimetres(NULL, words, depth, 3), NULL);
    EXPECT(stereopsis_millimetres((stereopsis_rig *)MISALIGN(&rig), words, depth, 3), MISALIGNED);
    EXPECT(stereopsis_millimetres(&rig, NULL, depth, 3), NULL);
    EXPECT(stereopsis_millimetres(&rig, words, NULL, 3), NULL);
    EXPECT(stereopsis_millimetres(&rig, (uint16_t *)(void *)((char *)words + 1), depth, 2), MISALIGNED);
    EXPECT(stereopsis_millimetres(&rig, words, (uint16_t *)(void *)((char *)depth + 1), 2), MISALIGNED);
    EXPECT(stereopsis_millimetres(&rig, words, depth, SIZE_MAX), TOO_MANY);
#define WRONG(field, value, status)                                     \
    wrong = rig;                                                        \
    wrong.field = (value);                                              \
    EXPECT(stereopsis_millimetres(&wrong, words, depth, 3), status)
    WRONG(focal_px, zero / zero, RIG_NOT_FINITE);
    WRONG(focal_px, 0.0f, RIG_FOCAL_LENGTH);
    WRONG(baseline_m, -0.1f, RIG_BASELINE);
    WRONG(baseline_m, 1e6f, RIG_TOO_LARGE);
    WRONG(baseline_m, 1e-9f, RIG_TOO_SMALL);
    WRONG(cx_right, 40000.0f, RIG_OFFSET);
    CHECK(depth[0] == 2000);
    EXPECT(stereopsis_millimetres(&rig, words, words, 3), OK); /* in place */
    CHECK(words[0] == 2000 && words[1] == 0 && words[2] == 0);
    EXPECT(stereopsis_millimetres(&rig, words, depth, 0), OK);
}

/* Another instance in the program has its own method and size, and takes no handle of this one. */
STEREOPSIS_FUNCTIONS(far_);

static void instances(void) {
    guarded g = take(), far = guard(far_stereopsis_size());
    stereopsis *s, *f;
    stereopsis_config c = config();
    CHECK(far_stereopsis_size() <= STEREOPSIS_SGM_BYTES(160, STEREOPSIS_DISPARITIES));
    CHECK(far_stereopsis_max_width() == 160 && stereopsis_max_width() == 96);
    CHECK(far_stereopsis_latency() != stereopsis_latency());
    EXPECT(stereopsis_init_fresh(g.memory, g.size, &s), OK);
    EXPECT(far_stereopsis_init_fresh(far.memory, far.size, &f), OK);
    EXPECT(far_stereopsis_begin_frame(s), NOT_INITIALISED);
    EXPECT(stereopsis_begin_frame(f), NOT_INITIALISED);
    c.width = 160;
    EXPECT(stereopsis_start(s, &c), WIDTH);
    EXPECT(far_stereopsis_start(f, &c), OK);
    EXPECT(stereopsis_deinit(s), OK);
    EXPECT(far_stereopsis_deinit(f), OK);
    release(g);
    release(far);
}

int main(void) {
    constants();
    instances();
    memory();
    configurations();
    lines();
    lost_lines();
    noise();
    depths();
    printf("%d failures\n", failures);
    return failures > 0;
}
