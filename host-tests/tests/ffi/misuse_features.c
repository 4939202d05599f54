/* Every misuse of detectors, matches, focus maps and odometries has its status, and leaves everything else as it was. Ends
   with the number of failures; built as misuse.c is. */
#include "check.h"

enum { WIDTH = 96, HEIGHT = 80, SLOTS = 15, MOST = 64, POINTS = 32 };

static uint8_t pictures[2][HEIGHT][WIDTH];

/* Squares of different grey, farther left in the right picture. */
static void draw(void) {
    for (int camera = 0; camera < 2; camera++)
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                int across = (x + 6 * camera) / 9, down = y / 7;
                pictures[camera][y][x] = (uint8_t)(40 + (across * 73 + down * 151 + across * down * 37) % 180);
            }
}

static size_t detect(stereopsis_detector *h, int camera, stereopsis_feature *features) {
    stereopsis_detection config;
    size_t count = 0;
    EXPECT(stereopsis_detection_default(WIDTH, HEIGHT, &config), OK);
    EXPECT(stereopsis_detector_start(h, &config), OK);
    for (int y = 0; y < HEIGHT; y++)
        EXPECT(stereopsis_detector_push(h, pictures[camera][y], WIDTH, features, MOST, &count), OK);
    EXPECT(stereopsis_detector_push(h, pictures[camera][0], WIDTH, features, MOST, &count), NO_LINE_LEFT);
    CHECK(count > 8 && count <= MOST);
    return count;
}

static void refused_detectors(void) {
    guarded g = guard(STEREOPSIS_DETECTOR_BYTES(WIDTH, SLOTS));
    stereopsis_detector *h = NULL;
    EXPECT(stereopsis_detector_init(g.memory, g.size, WIDTH, SLOTS, NULL), NULL);
    EXPECT(stereopsis_detector_init(g.memory, g.size, WIDTH, SLOTS, (stereopsis_detector **)MISALIGN(&h)), MISALIGNED);
    EXPECT(stereopsis_detector_init(NULL, g.size, WIDTH, SLOTS, &h), NULL);
    EXPECT(stereopsis_detector_init(g.memory + 1, g.size, WIDTH, SLOTS, &h), MISALIGNED);
    EXPECT(stereopsis_detector_init(g.memory, g.size - WIDTH, WIDTH, SLOTS, &h), MEMORY_TOO_SHORT);
    EXPECT(stereopsis_detector_init(g.memory, 0, WIDTH, SLOTS, &h), MEMORY_TOO_SHORT);
    EXPECT(stereopsis_detector_init(g.memory, g.size, 65535, 65535, &h), MEMORY_TOO_SHORT);
    EXPECT(stereopsis_detector_init(g.memory, g.size, WIDTH, SLOTS, (stereopsis_detector **)(void *)g.memory), OVERLAP);
    CHECK(h == NULL);
    for (size_t i = 0; i < g.size; i++) CHECK(g.memory[i] == 0xA5);
    EXPECT(stereopsis_detector_deinit((stereopsis_detector *)(void *)g.memory), NOT_INITIALISED);
    release(g);
}

static void detectors(stereopsis_feature *left, size_t *left_count, stereopsis_feature *right, size_t *right_count) {
    guarded g = guard(STEREOPSIS_DETECTOR_BYTES(WIDTH, SLOTS));
    stereopsis_detector *h;
    stereopsis_detection config, wrong;
    stereopsis_detection_counts counts;
    size_t count = 0;
    const uint8_t *line = pictures[0][0];
    EXPECT(stereopsis_detector_init(g.memory, g.size, WIDTH, SLOTS, &h), OK);
    EXPECT(stereopsis_detection_default(WIDTH, HEIGHT, NULL), NULL);
    EXPECT(stereopsis_detection_default(WIDTH, HEIGHT, (stereopsis_detection *)MISALIGN(&config)), MISALIGNED);
    EXPECT(stereopsis_detection_default(WIDTH, HEIGHT, &config), OK);
    EXPECT(stereopsis_detector_push(h, line, WIDTH, left, MOST, &count), NOT_STARTED);
    EXPECT(stereopsis_detector_start(NULL, &config), NULL);
    EXPECT(stereopsis_detector_start(h, NULL), NULL);
    EXPECT(stereopsis_detector_start(h, (stereopsis_detection *)MISALIGN(&config)), MISALIGNED);
    wrong = config, wrong.width = WIDTH + 1;
    EXPECT(stereopsis_detector_start(h, &wrong), DETECTOR_WIDTH);
    wrong = config, wrong.cell_px = 15;
    EXPECT(stereopsis_detector_start(h, &wrong), DETECTOR_CELLS);
    wrong = config, wrong.per_cell = 0;
    EXPECT(stereopsis_detector_start(h, &wrong), DETECTOR_CELLS);
    wrong = config, wrong.per_cell = 6;
    EXPECT(stereopsis_detector_start(h, &wrong), DETECTOR_SLOTS);
    EXPECT(stereopsis_detector_start(h, &config), OK);
    EXPECT(stereopsis_detector_push(NULL, line, WIDTH, left, MOST, &count), NULL);
    EXPECT(stereopsis_detector_push(h, NULL, WIDTH, left, MOST, &count), NULL);
    EXPECT(stereopsis_detector_push(h, line, WIDTH, NULL, MOST, &count), NULL);
    EXPECT(stereopsis_detector_push(h, line, WIDTH, left, MOST, NULL), NULL);
    EXPECT(stereopsis_detector_push(h, line, WIDTH, (stereopsis_feature *)MISALIGN(left), MOST - 1, &count), MISALIGNED);
    EXPECT(stereopsis_detector_push(h, line, WIDTH, left, MOST, (size_t *)MISALIGN(&count)), MISALIGNED);
    EXPECT(stereopsis_detector_push(h, line, WIDTH - 1, left, MOST, &count), LINE_LENGTH);
    EXPECT(stereopsis_detector_push(h, line, SIZE_MAX, left, MOST, &count), TOO_MANY);
    EXPECT(stereopsis_detector_push(h, line, WIDTH, left, SIZE_MAX, &count), TOO_MANY);
    EXPECT(stereopsis_detector_push(h, g.memory, WIDTH, left, MOST, &count), OVERLAP);
    EXPECT(stereopsis_detector_push(h, line, WIDTH, (stereopsis_feature *)(void *)g.memory, 1, &count), OVERLAP);
    EXPECT(stereopsis_detector_push(h, line, WIDTH, left, MOST, (size_t *)(void *)g.memory), OVERLAP);
    EXPECT(stereopsis_detector_push(h, line, WIDTH, left, MOST, (size_t *)(void *)left), OVERLAP);
    EXPECT(stereopsis_detector_push(h, (uint8_t *)left, WIDTH, left, MOST, &count), OVERLAP);
    count = MOST + 1;
    EXPECT(stereopsis_detector_push(h, line, WIDTH, left, MOST, &count), TOO_MANY);
    EXPECT(stereopsis_detector_counts(NULL, &counts), NULL);
    EXPECT(stereopsis_detector_counts(h, NULL), NULL);
    EXPECT(stereopsis_detector_counts(h, (stereopsis_detection_counts *)MISALIGN(&counts)), MISALIGNED);
    EXPECT(stereopsis_detector_counts(h, (stereopsis_detection_counts *)(void *)g.memory), OVERLAP);
    EXPECT(stereopsis_begin_frame((stereopsis *)(void *)h), NOT_INITIALISED);
    *left_count = detect(h, 0, left);
    *right_count = detect(h, 1, right);
    EXPECT(stereopsis_detector_counts(h, &counts), OK);
    CHECK(counts.corners == *right_count + counts.crowded_out && counts.dropped == 0);
    /* A list without room: what is lost is counted. */
    EXPECT(stereopsis_detector_start(h, &config), OK);
    count = 2;
    for (int y = 0; y < HEIGHT; y++) EXPECT(stereopsis_detector_push(h, pictures[0][y], WIDTH, left, 2, &count), OK);
    EXPECT(stereopsis_detector_counts(h, &counts), OK);
    CHECK(count == 2 && counts.dropped == *left_count);
    *left_count = detect(h, 0, left);
    /* Pictures without pixels. */
    config.width = 0;
    EXPECT(stereopsis_detector_start(h, &config), OK);
    EXPECT(stereopsis_detector_push(h, line, 0, left, MOST, left_count), OK);
    config.width = WIDTH, config.height = 0;
    EXPECT(stereopsis_detector_start(h, &config), OK);
    EXPECT(stereopsis_detector_push(h, line, WIDTH, left, MOST, left_count), NO_LINE_LEFT);
    EXPECT(stereopsis_detector_deinit(NULL), NULL);
    EXPECT(stereopsis_detector_deinit(h), OK);
    EXPECT(stereopsis_detector_deinit(h), NOT_INITIALISED);
    release(g);
}

/* A match of both lists with one argument that is wrong. */
#define MATCH(s, f, l, ln, r, rn, slots, m, room, n, status)                                                            \
    expect(__LINE__, "a match", stereopsis_match_features(s, f, l, ln, r, rn, slots, m, room, n), STEREOPSIS_STATUS_##status)

static void matching(stereopsis_feature *l, size_t ln, stereopsis_feature *r, size_t rn) {
    static uint16_t slots[5 * MOST];
    stereopsis_match m[MOST], few[1];
    stereopsis_search s, wrong;
    const float level[9] = {0, 0, 0, 0, 0, -1, 0, 1, 0}, none[9] = {0};
    size_t n = 77, same;
    volatile float zero = 0.0f;
    EXPECT(stereopsis_search_default(NULL), NULL);
    EXPECT(stereopsis_search_default((stereopsis_search *)MISALIGN(&s)), MISALIGNED);
    EXPECT(stereopsis_search_default(&s), OK);
    MATCH(NULL, NULL, l, ln, r, rn, slots, m, MOST, &n, NULL);
    MATCH(&s, NULL, NULL, ln, r, rn, slots, m, MOST, &n, NULL);
    MATCH(&s, NULL, l, ln, NULL, rn, slots, m, MOST, &n, NULL);
    MATCH(&s, NULL, l, ln, r, rn, NULL, m, MOST, &n, NULL);
    MATCH(&s, NULL, l, ln, r, rn, slots, NULL, MOST, &n, NULL);
    MATCH(&s, NULL, l, ln, r, rn, slots, m, MOST, NULL, NULL);
    MATCH((stereopsis_search *)MISALIGN(&s), NULL, l, ln, r, rn, slots, m, MOST, &n, MISALIGNED);
    MATCH(&s, (float *)MISALIGN(level), l, ln, r, rn, slots, m, MOST, &n, MISALIGNED);
    MATCH(&s, NULL, (stereopsis_feature *)MISALIGN(l), ln, r, rn, slots, m, MOST, &n, MISALIGNED);
    MATCH(&s, NULL, l, ln, r, rn, (uint16_t *)MISALIGN(slots), m, MOST, &n, MISALIGNED);
    MATCH(&s, NULL, l, ln, r, rn, slots, (stereopsis_match *)MISALIGN(m), MOST - 1, &n, MISALIGNED);
    MATCH(&s, NULL, l, ln, r, rn, slots, m, MOST, (size_t *)MISALIGN(&n), MISALIGNED);
    MATCH(&s, NULL, l, 65535, r, rn, slots, m, MOST, &n, TOO_MANY);
    MATCH(&s, NULL, l, ln, r, SIZE_MAX, slots, m, MOST, &n, TOO_MANY);
    MATCH(&s, NULL, l, ln, r, rn, slots, m, SIZE_MAX, &n, TOO_MANY);
    MATCH(&s, NULL, l, ln, r, rn, (uint16_t *)(void *)l, m, MOST, &n, OVERLAP);
    MATCH(&s, NULL, l, ln, r, rn, slots, (stereopsis_match *)(void *)r, MOST, &n, OVERLAP);
    MATCH(&s, NULL, l, ln, r, rn, slots, m, MOST, (size_t *)(void *)m, OVERLAP);
    MATCH(&s, none, l, ln, r, rn, slots, m, MOST, &n, FUNDAMENTAL_RANK);
    wrong = s, wrong.ratio_percent = 0;
    MATCH(&wrong, NULL, l, ln, r, rn, slots, m, MOST, &n, SEARCH);
    wrong = s, wrong.along_px = -1.0f;
    MATCH(&wrong, NULL, l, ln, r, rn, slots, m, MOST, &n, SEARCH);
    wrong = s, wrong.across_px = zero / zero;
    MATCH(&wrong, NULL, l, ln, r, rn, slots, m, MOST, &n, SEARCH);
    wrong = s, wrong.epipolar_px = -1.0f;
    MATCH(&wrong, level, l, ln, r, rn, slots, m, MOST, &n, SEARCH);
    CHECK(n == 77);
    s.across_px = 1.0f, s.along_px = 16.0f;
    MATCH(&s, level, l, ln, r, rn, slots, m, MOST, &n, OK);
    CHECK(n > 4 && n <= ln);
    for (size_t i = 0; i < n; i++) CHECK(m[i].v - m[i].v2 < 1.0f && m[i].v2 - m[i].v < 1.0f);
    MATCH(&s, level, l, ln, r, rn, slots, few, 1, &same, DROPPED);
    CHECK(same == 1 && few[0].u == m[0].u);
    MATCH(&s, NULL, l, 0, r, 0, slots, m, MOST, &same, OK);
    CHECK(same == 0);
    /* Numbers from nowhere. */
    memset(l, 0xFF, 3 * sizeof *l), memset(r, 0x7F, 3 * sizeof *r);
    MATCH(&s, level, l, ln, r, rn, slots, m, MOST, &same, OK);
}

int main(void) {
    static stereopsis_feature left[MOST], right[MOST];
    size_t left_count = 0, right_count = 0;
    draw();
    refused_detectors();
    detectors(left, &left_count, right, &right_count);
    matching(left, left_count, right, right_count);
    printf("%d failures\n", failures);
    return failures > 0;
}
