/* Every misuse of line queues, balance, decimation and the filter over frames has its status, and leaves everything else
   as it was. Ends with the number of failures; built as misuse.c is. */
#include "check.h"

enum { LINE = 50, SLOTS = 3 };

static void refused_queues(void) {
    guarded g = guard(STEREOPSIS_LINE_QUEUE_BYTES(LINE, SLOTS));
    stereopsis_line_queue *h = NULL;
    EXPECT(stereopsis_line_queue_init(g.memory, g.size, LINE, NULL), NULL);
    EXPECT(stereopsis_line_queue_init(g.memory, g.size, LINE, (stereopsis_line_queue **)MISALIGN(&h)), MISALIGNED);
    EXPECT(stereopsis_line_queue_init(NULL, g.size, LINE, &h), NULL);
    EXPECT(stereopsis_line_queue_init(NULL, SIZE_MAX, LINE, &h), NULL);
    EXPECT(stereopsis_line_queue_init(g.memory + 1, g.size, LINE, &h), MISALIGNED);
    EXPECT(stereopsis_line_queue_init(g.memory, 0, LINE, &h), MEMORY_TOO_SHORT);
    EXPECT(stereopsis_line_queue_init(g.memory, STEREOPSIS_LINE_QUEUE_BYTES(LINE, 1), LINE, &h), MEMORY_TOO_SHORT);
    EXPECT(stereopsis_line_queue_init(g.memory, g.size, 0, &h), LINE_BYTES);
    EXPECT(stereopsis_line_queue_init(g.memory, g.size, 65536, &h), LINE_BYTES);
    EXPECT(stereopsis_line_queue_init(g.memory, g.size, SIZE_MAX, &h), LINE_BYTES);
    EXPECT(stereopsis_line_queue_init(g.memory, g.size, LINE, (stereopsis_line_queue **)(void *)g.memory), OVERLAP);
    CHECK(h == NULL);
    for (size_t i = 0; i < g.size; i++) CHECK(g.memory[i] == 0xA5);
    EXPECT(stereopsis_line_queue_done((stereopsis_line_queue *)(void *)g.memory), NOT_INITIALISED);
    release(g);
}

/* Takes the line that has to wait next. */
static void taken(stereopsis_line_queue *h, uint32_t frame, uint16_t row, uint32_t overruns) {
    stereopsis_line line, again;
    EXPECT(stereopsis_line_queue_next(h, &line), OK);
    EXPECT(stereopsis_line_queue_next(h, &again), OK);
    CHECK(line.bytes == again.bytes && line.row == row && line.frame == frame && line.overruns == overruns);
    CHECK(line.timestamp_us == 0x100000000u + row);
    for (size_t i = 0; i < LINE; i++) CHECK(line.bytes[i] == (uint8_t)row);
    EXPECT(stereopsis_line_queue_done(h), OK);
    EXPECT(stereopsis_line_queue_done(h), LINE_NOT_TAKEN);
}

static void queues(void) {
    guarded g = guard(STEREOPSIS_LINE_QUEUE_BYTES(LINE, SLOTS));
    stereopsis_line_queue *h;
    stereopsis_line line;
    uint8_t *bytes = NULL, *first;
    uint32_t overruns = 7;
    EXPECT(stereopsis_line_queue_init(g.memory, g.size, LINE, &h), OK);
    EXPECT(stereopsis_line_queue_begin(NULL, &bytes), NULL);
    EXPECT(stereopsis_line_queue_begin(h, NULL), NULL);
    EXPECT(stereopsis_line_queue_begin(h, (uint8_t **)MISALIGN(&bytes)), MISALIGNED);
    EXPECT(stereopsis_line_queue_begin(h, (uint8_t **)(void *)(g.memory + 48)), OVERLAP);
    EXPECT(stereopsis_line_queue_finish(NULL, 0, 0, 0), NULL);
    EXPECT(stereopsis_line_queue_finish(h, 0, 0, 0), LINE_NOT_BEGUN);
    EXPECT(stereopsis_line_queue_next(NULL, &line), NULL);
    EXPECT(stereopsis_line_queue_next(h, NULL), NULL);
    EXPECT(stereopsis_line_queue_next(h, (stereopsis_line *)MISALIGN(&line)), MISALIGNED);
    EXPECT(stereopsis_line_queue_next(h, (stereopsis_line *)(void *)(g.memory + 48)), OVERLAP);
    EXPECT(stereopsis_line_queue_done(NULL), NULL);
    EXPECT(stereopsis_line_queue_done(h), LINE_NOT_TAKEN);
    EXPECT(stereopsis_line_queue_overruns(NULL, &overruns), NULL);
    EXPECT(stereopsis_line_queue_overruns(h, NULL), NULL);
    EXPECT(stereopsis_line_queue_overruns(h, (uint32_t *)MISALIGN(&overruns)), MISALIGNED);
    EXPECT(stereopsis_line_queue_overruns(h, (uint32_t *)(void *)g.memory), OVERLAP);
    memset(&line, 0x5A, sizeof line);
    EXPECT(stereopsis_line_queue_next(h, &line), NO_LINE_YET);
    CHECK(line.row == 0x5A5A);
    /* A queue is no matcher, and no rectifier. */
    EXPECT(stereopsis_begin_frame((stereopsis *)(void *)h), NOT_INITIALISED);
    EXPECT(stereopsis_rectifier_begin_frame((stereopsis_rectifier *)(void *)h), NOT_INITIALISED);
    /* A slot that is not finished is given once more. */
    EXPECT(stereopsis_line_queue_begin(h, &first), OK);
    EXPECT(stereopsis_line_queue_begin(h, &bytes), OK);
    CHECK(first == bytes && (uintptr_t)bytes % 8 == 0 && bytes >= g.memory && bytes + LINE <= g.memory + g.size);
    /* Two of three slots may wait; what comes then is lost, and counted. */
    for (uint16_t row = 0; row < 60; row++) {
        int32_t status = stereopsis_line_queue_begin(h, &bytes);
        CHECK(status == (row % 3 < 2 ? STEREOPSIS_STATUS_OK : STEREOPSIS_STATUS_NO_SLOT));
        if (status == STEREOPSIS_STATUS_OK) {
            memset(bytes, (uint8_t)row, LINE);
            EXPECT(stereopsis_line_queue_finish(h, row / 3u, row, 0x100000000u + row), OK);
        } else {
            EXPECT(stereopsis_line_queue_finish(h, 0, 0, 0), LINE_NOT_BEGUN);
            taken(h, row / 3u, (uint16_t)(row - 2), row / 3u);
            taken(h, row / 3u, (uint16_t)(row - 1), row / 3u);
            EXPECT(stereopsis_line_queue_next(h, &line), NO_LINE_YET);
        }
    }
    EXPECT(stereopsis_line_queue_overruns(h, &overruns), OK);
    CHECK(overruns == 20);
    EXPECT(stereopsis_line_queue_deinit(NULL), NULL);
    EXPECT(stereopsis_line_queue_deinit(h), OK);
    EXPECT(stereopsis_line_queue_deinit(h), NOT_INITIALISED);
    EXPECT(stereopsis_line_queue_begin(h, &bytes), NOT_INITIALISED);
    release(g);
}

static void balances(void) {
    stereopsis_histogram left, right;
    stereopsis_balance balance = {0, 0};
    uint8_t line[256];
    EXPECT(stereopsis_histogram_clear(NULL), NULL);
    EXPECT(stereopsis_histogram_clear((stereopsis_histogram *)MISALIGN(&left)), MISALIGNED);
    EXPECT(stereopsis_histogram_clear(&left), OK);
    EXPECT(stereopsis_histogram_clear(&right), OK);
    EXPECT(stereopsis_histogram_line(NULL, 0, line, 256), NULL);
    EXPECT(stereopsis_histogram_line(&left, 0, NULL, 256), NULL);
    EXPECT(stereopsis_histogram_line((stereopsis_histogram *)MISALIGN(&left), 0, line, 256), MISALIGNED);
    EXPECT(stereopsis_histogram_line(&left, 0, line, 65536), TOO_MANY);
    EXPECT(stereopsis_histogram_line(&left, 0, line, SIZE_MAX), TOO_MANY);
    EXPECT(stereopsis_histogram_line(&left, 0, (uint8_t *)&left, 8), OVERLAP);
    EXPECT(stereopsis_balance_between(NULL, &right, &balance), NULL);
    EXPECT(stereopsis_balance_between(&left, NULL, &balance), NULL);
    EXPECT(stereopsis_balance_between(&left, &right, NULL), NULL);
    EXPECT(stereopsis_balance_between((stereopsis_histogram *)MISALIGN(&left), &right, &balance), MISALIGNED);
    EXPECT(stereopsis_balance_between(&left, &right, (stereopsis_balance *)MISALIGN(&balance)), MISALIGNED);
    CHECK(balance.gain_256ths == 0);
    EXPECT(stereopsis_balance_between(&left, &right, &balance), OK); /* nothing was seen */
    CHECK(balance.gain_256ths == 256 && balance.offset_256ths == 0);
    for (uint16_t row = 0; row < 8; row++) {
        for (size_t x = 0; x < 256; x++) line[x] = (uint8_t)x;
        EXPECT(stereopsis_histogram_line(&left, row, line, 256), OK);
        for (size_t x = 0; x < 256; x++) line[x] = (uint8_t)(x / 2);
        EXPECT(stereopsis_histogram_line(&right, row, line, 256), OK);
    }
    EXPECT(stereopsis_balance_between(&left, &right, &balance), OK);
    CHECK(balance.gain_256ths == 512 && balance.offset_256ths == 0);
    EXPECT(stereopsis_balance_line(NULL, line, 256), NULL);
    EXPECT(stereopsis_balance_line(&balance, NULL, 256), NULL);
    EXPECT(stereopsis_balance_line((stereopsis_balance *)MISALIGN(&balance), line, 256), MISALIGNED);
    EXPECT(stereopsis_balance_line(&balance, line, SIZE_MAX), TOO_MANY);
    EXPECT(stereopsis_balance_line(&balance, (uint8_t *)&balance, 4), OVERLAP);
    CHECK(line[255] == 127);
    EXPECT(stereopsis_balance_line(&balance, line, 256), OK);
    CHECK(line[255] == 254 && line[0] == 0 && line[2] == 2);
    /* Whatever the bytes of histograms and balances are, nothing overflows. */
    memset(&left, 0xFF, sizeof left), memset(&right, 0x7F, sizeof right), memset(&balance, 0xFF, sizeof balance);
    EXPECT(stereopsis_histogram_line(&left, 65535, line, 256), OK);
    EXPECT(stereopsis_balance_between(&left, &right, &balance), OK);
    EXPECT(stereopsis_balance_between(&right, &left, &balance), OK);
    balance.offset_256ths = INT32_MAX, balance.gain_256ths = 65535;
    EXPECT(stereopsis_balance_line(&balance, line, 256), OK);
    balance.offset_256ths = INT32_MIN;
    EXPECT(stereopsis_balance_line(&balance, line, 256), OK);
}

static void decimation(void) {
    enum { COUNT = 7, BLOCK = 3 };
    uint16_t rows[BLOCK * COUNT], row[COUNT], smaller[4] = {1, 1, 1, 1};
    for (size_t x = 0; x < COUNT; x++) row[x] = (uint16_t)(32 * x);
    row[4] = row[5] = STEREOPSIS_NONE;
    EXPECT(stereopsis_decimate(NULL, BLOCK, 0, row, COUNT, smaller), NULL);
    EXPECT(stereopsis_decimate(rows, BLOCK, 0, NULL, COUNT, smaller), NULL);
    EXPECT(stereopsis_decimate(rows, BLOCK, 0, row, COUNT, NULL), NULL);
    EXPECT(stereopsis_decimate((uint16_t *)MISALIGN(rows), BLOCK, 0, row, COUNT, smaller), MISALIGNED);
    EXPECT(stereopsis_decimate(rows, BLOCK, 0, (uint16_t *)MISALIGN(row), COUNT, smaller), MISALIGNED);
    EXPECT(stereopsis_decimate(rows, BLOCK, 0, row, COUNT, (uint16_t *)MISALIGN(smaller)), MISALIGNED);
    EXPECT(stereopsis_decimate(rows, 0, 0, row, COUNT, smaller), BLOCK);
    EXPECT(stereopsis_decimate(rows, 1, 0, row, COUNT, smaller), BLOCK);
    EXPECT(stereopsis_decimate(rows, 9, 0, row, COUNT, smaller), BLOCK);
    EXPECT(stereopsis_decimate(rows, BLOCK, 0, row, 65536, smaller), TOO_MANY);
    EXPECT(stereopsis_decimate(rows, BLOCK, 0, row, SIZE_MAX, smaller), TOO_MANY);
    EXPECT(stereopsis_decimate(rows, BLOCK, 0, rows, COUNT, smaller), OVERLAP);
    EXPECT(stereopsis_decimate(rows, BLOCK, 0, row, COUNT, rows + 8), OVERLAP);
    EXPECT(stereopsis_decimate(rows, BLOCK, 0, row, COUNT, row + 6), OVERLAP);
    EXPECT(stereopsis_decimate(rows, BLOCK, 0, row, COUNT, smaller), NO_ROW_YET);
    EXPECT(stereopsis_decimate(rows, BLOCK, 1, row, COUNT, smaller), NO_ROW_YET);
    CHECK(smaller[0] == 1);
    EXPECT(stereopsis_decimate(rows, BLOCK, 2, row, COUNT, smaller), OK);
    CHECK(smaller[0] == 32 && smaller[1] == STEREOPSIS_NONE && smaller[2] == 1);
    EXPECT(stereopsis_decimate(rows, BLOCK, 65535, row, 0, smaller), NO_ROW_YET);
}

static void filters(void) {
    enum { COUNT = 3 };
    stereopsis_temporal config, wrong;
    uint16_t averages[COUNT], row[COUNT] = {320, STEREOPSIS_NONE, 64}, filtered[COUNT] = {9, 9, 9};
    uint8_t ages[COUNT], origins[COUNT] = {9, 9, 9};
    EXPECT(stereopsis_temporal_default(NULL), NULL);
    EXPECT(stereopsis_temporal_default((stereopsis_temporal *)MISALIGN(&config)), MISALIGNED);
    EXPECT(stereopsis_temporal_default(&config), OK);
    CHECK(config.most_step == STEREOPSIS_STEPS_PER_PX && config.shift == 2 && config.most_held == 2);
    EXPECT(stereopsis_temporal_forget(NULL, ages, COUNT), NULL);
    EXPECT(stereopsis_temporal_forget(averages, NULL, COUNT), NULL);
    EXPECT(stereopsis_temporal_forget((uint16_t *)MISALIGN(averages), ages, COUNT), MISALIGNED);
    EXPECT(stereopsis_temporal_forget(averages, ages, SIZE_MAX), TOO_MANY);
    EXPECT(stereopsis_temporal_forget(averages, (uint8_t *)&averages[1], COUNT), OVERLAP);
    EXPECT(stereopsis_temporal_forget(averages, ages, COUNT), OK);
    wrong = config, wrong.shift = 5;
    EXPECT(stereopsis_temporal_row(NULL, averages, ages, row, filtered, origins, COUNT), NULL);
    EXPECT(stereopsis_temporal_row(&config, NULL, ages, row, filtered, origins, COUNT), NULL);
    EXPECT(stereopsis_temporal_row(&config, averages, NULL, row, filtered, origins, COUNT), NULL);
    EXPECT(stereopsis_temporal_row(&config, averages, ages, NULL, filtered, origins, COUNT), NULL);
    EXPECT(stereopsis_temporal_row(&config, averages, ages, row, NULL, origins, COUNT), NULL);
    EXPECT(stereopsis_temporal_row(&config, averages, ages, row, filtered, NULL, COUNT), NULL);
    EXPECT(stereopsis_temporal_row((stereopsis_temporal *)MISALIGN(&config), averages, ages, row, filtered, origins, COUNT), MISALIGNED);
    EXPECT(stereopsis_temporal_row(&config, (uint16_t *)MISALIGN(averages), ages, row, filtered, origins, COUNT), MISALIGNED);
    EXPECT(stereopsis_temporal_row(&config, averages, ages, (uint16_t *)MISALIGN(row), filtered, origins, COUNT), MISALIGNED);
    EXPECT(stereopsis_temporal_row(&config, averages, ages, row, (uint16_t *)MISALIGN(filtered), origins, COUNT), MISALIGNED);
    EXPECT(stereopsis_temporal_row(&wrong, averages, ages, row, filtered, origins, COUNT), SHIFT);
    EXPECT(stereopsis_temporal_row(&config, averages, ages, row, filtered, origins, SIZE_MAX), TOO_MANY);
    EXPECT(stereopsis_temporal_row(&config, averages, ages, averages, filtered, origins, COUNT), OVERLAP);
    EXPECT(stereopsis_temporal_row(&config, averages, ages, row, row, origins, COUNT), OVERLAP);
    EXPECT(stereopsis_temporal_row(&config, averages, ages, row, averages, origins, COUNT), OVERLAP);
    EXPECT(stereopsis_temporal_row(&config, averages, ages, row, filtered, ages, COUNT), OVERLAP);
    EXPECT(stereopsis_temporal_row(&config, averages, (uint8_t *)filtered, row, filtered, origins, COUNT), OVERLAP);
    EXPECT(stereopsis_temporal_row(&config, averages, ages, row, filtered, (uint8_t *)&row[2], COUNT), OVERLAP);
    CHECK(filtered[0] == 9 && origins[0] == 9);
    EXPECT(stereopsis_temporal_row(&config, averages, ages, row, filtered, origins, COUNT), OK);
    CHECK(filtered[0] == 320 && origins[0] == STEREOPSIS_ORIGIN_NEW);
    CHECK(filtered[1] == STEREOPSIS_NONE && origins[1] == STEREOPSIS_ORIGIN_NOTHING);
    row[0] = 328, row[2] = STEREOPSIS_NONE;
    EXPECT(stereopsis_temporal_row(&config, averages, ages, row, filtered, origins, COUNT), OK);
    CHECK(filtered[0] == 322 && origins[0] == STEREOPSIS_ORIGIN_AVERAGED);
    CHECK(filtered[2] == 64 && origins[2] == STEREOPSIS_ORIGIN_HELD);
}

int main(void) {
    refused_queues();
    queues();
    balances();
    decimation();
    filters();
    printf("%d failures\n", failures);
    return failures > 0;
}
