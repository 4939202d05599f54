/* Every misuse of the functions that take winners has its status, and leaves everything else as it was; a frame of winners
   gives the rows that they stand for. Ends with the number of failures; built as misuse.c is. */
#include "check.h"

enum { WIDTH = 96, HEIGHT = 30, DISPARITIES = 32, AWAY = 7 };

static stereopsis_winner winners[WIDTH];
static uint8_t line[WIDTH];

/* A row whose pixels are all AWAY px away from their partners, where they can be. */
static void fill(uint16_t y) {
    for (uint16_t x = 0; x < WIDTH; x++) {
        stereopsis_winner winner = {50, 10, 50, AWAY, AWAY, 255, 0, 0};
        if (x < AWAY) winner.disparity = winner.kept = (uint8_t)x;
        /* A single candidate has its own cost beside it. */
        if (x == 0) winner.below = winner.above = winner.cost;
        winners[x] = winner;
    }
    EXPECT(stereopsis_winners_seal(winners, WIDTH, y), OK);
}

static stereopsis_config configuration(void) {
    stereopsis_config config;
    EXPECT(stereopsis_config_default(WIDTH, HEIGHT, DISPARITIES, STEREOPSIS_PRESET_DENSE, &config), OK);
    return config;
}

static void refused(void) {
    guarded g = guard(stereopsis_winners_size());
    stereopsis_winners *h = NULL;
    stereopsis_config config = configuration(), wrong = config;
    stereopsis_row row;
    uint8_t lines = 9, second = 9;
    uint16_t due = 999;
    float sigma[WIDTH];
    CHECK(stereopsis_winners_size() <= STEREOPSIS_WINNERS_BYTES(WIDTH, DISPARITIES));
    EXPECT(stereopsis_winners_init(NULL, g.size, &h), NULL);
    EXPECT(stereopsis_winners_init(g.memory, g.size, NULL), NULL);
    EXPECT(stereopsis_winners_init(g.memory, g.size - 1, &h), MEMORY_TOO_SHORT);
    EXPECT(stereopsis_winners_init(g.memory + 1, g.size, &h), MISALIGNED);
    EXPECT(stereopsis_winners_init(g.memory, g.size, (stereopsis_winners **)(void *)g.memory), OVERLAP);
    EXPECT(stereopsis_winners_begin_frame((stereopsis_winners *)(void *)g.memory), NOT_INITIALISED);
    CHECK(h == NULL);
    EXPECT(stereopsis_winners_init(g.memory, g.size, &h), OK);
    /* It is no matcher. */
    EXPECT(stereopsis_begin_frame((stereopsis *)(void *)h), NOT_INITIALISED);
    EXPECT(stereopsis_winners_begin_frame(NULL), NULL);
    EXPECT(stereopsis_winners_begin_frame(h), NOT_STARTED);
    EXPECT(stereopsis_winners_due(h, &due), NOT_STARTED);
    EXPECT(stereopsis_winners_push(h, line, WIDTH, NULL, 0, &row), NOT_STARTED);
    EXPECT(stereopsis_winners_sigma_px(h, sigma, WIDTH), NOT_STARTED);
    EXPECT(stereopsis_winners_start(NULL, &config, &lines, &second), NULL);
    EXPECT(stereopsis_winners_start(h, NULL, &lines, &second), NULL);
    EXPECT(stereopsis_winners_start(h, &config, NULL, &second), NULL);
    EXPECT(stereopsis_winners_start(h, &config, &lines, NULL), NULL);
    EXPECT(stereopsis_winners_start(h, (stereopsis_config *)MISALIGN(&config), &lines, &second), MISALIGNED);
    EXPECT(stereopsis_winners_start(h, &config, g.memory, &second), OVERLAP);
    EXPECT(stereopsis_winners_start(h, &config, &second, &second), OVERLAP);
    wrong.width = WIDTH + 1;
    EXPECT(stereopsis_winners_start(h, &wrong, &lines, &second), WIDTH);
    wrong = config, wrong.disparities = 15;
    EXPECT(stereopsis_winners_start(h, &wrong, &lines, &second), DISPARITIES);
    CHECK(lines == 9 && second == 9);
    EXPECT(stereopsis_winners_start(h, &config, &lines, &second), OK);
    CHECK(lines == 0 && second == 0);
    wrong = config, wrong.uniqueness_percent = 20, wrong.fattening_slope = 16;
    EXPECT(stereopsis_winners_start(h, &wrong, &lines, &second), OK);
    CHECK(lines == 1 && second == 1);
    EXPECT(stereopsis_winners_due(h, &due), NOT_BEGUN);
    EXPECT(stereopsis_winners_begin_frame(h), OK);
    EXPECT(stereopsis_winners_push(h, NULL, WIDTH, NULL, 0, &row), NULL);
    EXPECT(stereopsis_winners_seal(NULL, 1, 0), NULL);
    EXPECT(stereopsis_winners_seal(winners, 65536, 0), TOO_MANY);
    EXPECT(stereopsis_winners_deinit(NULL), NULL);
    EXPECT(stereopsis_winners_deinit(h), OK);
    EXPECT(stereopsis_winners_deinit(h), NOT_INITIALISED);
    release(g);
}

/* One step: refuses what is wrong with it, then takes it. */
static stereopsis_status step(stereopsis_winners *h, unsigned char *memory, uint16_t *line_of, stereopsis_row *row) {
    uint16_t due = 999;
    stereopsis_status status = stereopsis_winners_due(h, &due);
    if (*line_of < HEIGHT) {
        EXPECT(stereopsis_winners_flush(h, NULL, 0, row), LINES_MISSING);
        EXPECT(stereopsis_winners_push(h, line, WIDTH - 1, NULL, 0, row), LINE_LENGTH);
        EXPECT(stereopsis_winners_push(h, memory, WIDTH, NULL, 0, row), OVERLAP);
        EXPECT(stereopsis_winners_push(h, line, WIDTH, NULL, 0, NULL), NULL);
        EXPECT(stereopsis_winners_push(h, line, WIDTH, NULL, 0, (stereopsis_row *)(void *)memory), OVERLAP);
    }
    if (status == STEREOPSIS_STATUS_NO_ROW_YET) {
        CHECK(due == 999);
        if (*line_of == HEIGHT) return stereopsis_winners_flush(h, NULL, 0, row);
        EXPECT(stereopsis_winners_push(h, line, WIDTH, winners, WIDTH, row), WINNERS);
        (*line_of)++;
        return stereopsis_winners_push(h, line, WIDTH, NULL, 0, row);
    }
    EXPECT(status, OK);
    fill(due);
    if (*line_of == HEIGHT) return stereopsis_winners_flush(h, winners, WIDTH, row);
    EXPECT(stereopsis_winners_push(h, line, WIDTH, winners, WIDTH - 1, row), WINNERS);
    EXPECT(stereopsis_winners_push(h, line, WIDTH, winners, SIZE_MAX, row), WINNERS);
    EXPECT(stereopsis_winners_push(h, line, WIDTH, (stereopsis_winner *)(void *)memory, WIDTH, row), OVERLAP);
    winners[40].cost ^= 1u;
    EXPECT(stereopsis_winners_push(h, line, WIDTH, winners, WIDTH, row), WINNER_DAMAGED);
    winners[40].cost ^= 1u;
    EXPECT(stereopsis_winners_seal(winners, WIDTH, (uint16_t)(due + 1)), OK);
    EXPECT(stereopsis_winners_push(h, line, WIDTH, winners, WIDTH, row), WINNER_DAMAGED);
    winners[40].disparity = DISPARITIES;
    EXPECT(stereopsis_winners_seal(winners, WIDTH, due), OK);
    EXPECT(stereopsis_winners_push(h, line, WIDTH, winners, WIDTH, row), WINNER_REFUSED);
    fill(due);
    (*line_of)++;
    return stereopsis_winners_push(h, line, WIDTH, winners, WIDTH, row);
}

static void frames(void) {
    guarded g = guard(stereopsis_winners_size());
    stereopsis_winners *h = NULL;
    stereopsis_config config = configuration();
    uint8_t lines, second;
    config.smoothing_radius = 0;
    EXPECT(stereopsis_winners_init(g.memory, g.size, &h), OK);
    EXPECT(stereopsis_winners_start(h, &config, &lines, &second), OK);
    for (int frame = 0; frame < 2; frame++) {
        stereopsis_row row;
        uint16_t line_of = 0, next = 0;
        stereopsis_status status;
        EXPECT(stereopsis_winners_begin_frame(h), OK);
        while ((status = step(h, g.memory, &line_of, &row)) != STEREOPSIS_STATUS_FRAME_DONE) {
            float sigma[WIDTH];
            if (status == STEREOPSIS_STATUS_NO_ROW_YET) {
                CHECK(row.disparities == NULL);
                continue;
            }
            EXPECT(status, OK);
            CHECK(row.index == next && row.width == WIDTH);
            CHECK(line_of == HEIGHT || line_of == next + stereopsis_winners_latency() + 1);
            for (int x = AWAY; x < WIDTH; x++) CHECK(row.disparities[x] == AWAY * STEREOPSIS_STEPS_PER_PX);
            EXPECT(stereopsis_winners_sigma_px(h, sigma, WIDTH - 1), LINE_LENGTH);
            EXPECT(stereopsis_winners_sigma_px(h, (float *)(void *)g.memory, WIDTH), OVERLAP);
            EXPECT(stereopsis_winners_sigma_px(h, sigma, WIDTH), OK);
            CHECK(sigma[AWAY] > 0.0f && sigma[AWAY] < 2.0f);
            next++;
        }
        CHECK(next == HEIGHT);
    }
    EXPECT(stereopsis_winners_deinit(h), OK);
    release(g);
}

int main(void) {
    refused();
    frames();
    printf("%d failures\n", failures);
    return failures > 0;
}
