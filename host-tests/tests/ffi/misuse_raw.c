/* Every misuse of records, rectifiers, points and depths has its status, and leaves everything else as it was. Ends with
   the number of failures; built as misuse.c is. */
#include "check.h"

enum { WIDTH = 64, HEIGHT = 24, WHOLE = STEREOPSIS_RECORD_BYTES };

/* A record of two cameras, the right one half a pixel lower, with its checksum. */
typedef struct {
    uint8_t bytes[WHOLE];
} record;

static void put(record *r, size_t at, double value) {
    memcpy(r->bytes + at, &value, sizeof value);
}

static void seal(record *r) {
    uint32_t crc = UINT32_MAX;
    for (size_t i = 0; i < WHOLE - 4; i++) {
        crc ^= r->bytes[i];
        for (int bit = 0; bit < 8; bit++) crc = (crc >> 1) ^ (0xEDB88320u & (0u - (crc & 1u)));
    }
    crc = ~crc;
    memcpy(r->bytes + WHOLE - 4, &crc, 4);
}

static record valid(void) {
    const uint16_t head[] = {1, WHOLE, WIDTH, HEIGHT, WIDTH, HEIGHT, 0, 0};
    record r;
    memset(&r, 0, sizeof r);
    memcpy(r.bytes, "STRG", 4);
    memcpy(r.bytes + 4, head, sizeof head);
    for (size_t camera = 0; camera < 2; camera++) {
        size_t at = 20 + 104 * camera;
        put(&r, at, 60.0), put(&r, at + 8, 60.0), put(&r, at + 16, 31.5), put(&r, at + 24, 11.5 + 0.5 * (double)camera);
    }
    put(&r, 228, 1.0), put(&r, 260, 1.0), put(&r, 292, 1.0), put(&r, 300, 0.06);
    seal(&r);
    return r;
}

static void records(void) {
    record r = valid();
    stereopsis_cameras cameras, untouched;
    memset(&cameras, 0x5A, sizeof cameras);
    memcpy(&untouched, &cameras, sizeof cameras);
    EXPECT(stereopsis_record_read(NULL, WHOLE, &cameras), NULL);
    EXPECT(stereopsis_record_read(r.bytes, WHOLE, NULL), NULL);
    EXPECT(stereopsis_record_read(r.bytes, WHOLE, (stereopsis_cameras *)MISALIGN(&cameras)), MISALIGNED);
    EXPECT(stereopsis_record_read(r.bytes, 0, &cameras), RECORD_TOO_SHORT);
    EXPECT(stereopsis_record_read(r.bytes, WHOLE - 1, &cameras), RECORD_TOO_SHORT);
    for (size_t i = 0; i < WHOLE; i++) {
        record wrong = r;
        wrong.bytes[i] ^= 0x10;
        int32_t found = stereopsis_record_read(wrong.bytes, WHOLE, &cameras);
        CHECK(found == (i < 4 ? STEREOPSIS_STATUS_NOT_A_RECORD
                        : i < 6 ? STEREOPSIS_STATUS_RECORD_VERSION : STEREOPSIS_STATUS_RECORD_CHECKSUM));
    }
    record lens = r, numbers = r;
    lens.bytes[16] = 9, seal(&lens);
    EXPECT(stereopsis_record_read(lens.bytes, WHOLE, &cameras), RECORD_LENS);
    put(&numbers, 20, 0.0), seal(&numbers);
    EXPECT(stereopsis_record_read(numbers.bytes, WHOLE, &cameras), RECORD_NUMBERS);
    numbers = r, put(&numbers, 300, 0.0), seal(&numbers);
    EXPECT(stereopsis_record_read(numbers.bytes, WHOLE, &cameras), RECORD_NUMBERS);
    CHECK(memcmp(&cameras, &untouched, sizeof cameras) == 0);
    EXPECT(stereopsis_record_read(r.bytes, SIZE_MAX, &cameras), OK);
    CHECK(cameras.width[1] == WIDTH && cameras.height[0] == HEIGHT && cameras.baseline_m > 0.0599f);
}

/* A start that is refused, and leaves the rectifier as it was. */
#define REFUSED(bytes, width, height, alpha, status)                                                              \
    do {                                                                                                          \
        EXPECT(stereopsis_rectifier_start(h, (bytes), WHOLE, (width), (height), (alpha), &rig, &lines), status);  \
        CHECK(rig.focal_px == 1.0f);                                                                              \
    } while (0)

static void starts(guarded g, stereopsis_rectifier *h) {
    record r = valid(), wrong;
    stereopsis_rig rig;
    size_t lines = 0;
    memset(&rig, 0, sizeof rig);
    rig.focal_px = 1.0f;
    EXPECT(stereopsis_rectifier_start(NULL, r.bytes, WHOLE, WIDTH, HEIGHT, 0.0f, &rig, &lines), NULL);
    EXPECT(stereopsis_rectifier_start(h, NULL, WHOLE, WIDTH, HEIGHT, 0.0f, &rig, &lines), NULL);
    EXPECT(stereopsis_rectifier_start(h, r.bytes, WHOLE, WIDTH, HEIGHT, 0.0f, NULL, &lines), NULL);
    EXPECT(stereopsis_rectifier_start(h, r.bytes, WHOLE, WIDTH, HEIGHT, 0.0f, (stereopsis_rig *)MISALIGN(&rig), NULL), MISALIGNED);
    EXPECT(stereopsis_rectifier_start(h, r.bytes, WHOLE, WIDTH, HEIGHT, 0.0f, &rig, (size_t *)MISALIGN(&lines)), MISALIGNED);
    EXPECT(stereopsis_rectifier_start(h, g.memory, WHOLE, WIDTH, HEIGHT, 0.0f, &rig, &lines), OVERLAP);
    EXPECT(stereopsis_rectifier_start(h, r.bytes, WHOLE, WIDTH, HEIGHT, 0.0f, (stereopsis_rig *)(void *)g.memory, NULL), OVERLAP);
    EXPECT(stereopsis_rectifier_start(h, r.bytes, WHOLE, WIDTH, HEIGHT, 0.0f, &rig, (size_t *)(void *)g.memory), OVERLAP);
    union {
        stereopsis_rig rig;
        size_t lines;
    } both;
    EXPECT(stereopsis_rectifier_start(h, r.bytes, WHOLE, WIDTH, HEIGHT, 0.0f, &both.rig, &both.lines), OVERLAP);
    EXPECT(stereopsis_rectifier_start(h, r.bytes, WHOLE - 1, WIDTH, HEIGHT, 0.0f, &rig, &lines), RECORD_TOO_SHORT);
    REFUSED(r.bytes, 1, HEIGHT, 0.0f, RECTIFY_SIZE);
    REFUSED(r.bytes, WIDTH, 1, 0.0f, RECTIFY_SIZE);
    REFUSED(r.bytes, STEREOPSIS_WIDTH + 1, HEIGHT, 0.0f, RECTIFY_SIZE);
    REFUSED(r.bytes, STEREOPSIS_WIDTH, STEREOPSIS_HEIGHT + 32, 0.0f, RECTIFY_SIZE);
    REFUSED(r.bytes, WIDTH, 65535, 0.0f, RECTIFY_SIZE);
    REFUSED(r.bytes, WIDTH, HEIGHT, 1.5f, RECTIFY_ALPHA);
    REFUSED(r.bytes, WIDTH, HEIGHT, -0.5f, RECTIFY_ALPHA);
    volatile float zero = 0.0f;
    REFUSED(r.bytes, WIDTH, HEIGHT, zero / zero, RECTIFY_ALPHA);
    wrong = r, put(&wrong, 300, -0.06), seal(&wrong);
    REFUSED(wrong.bytes, WIDTH, HEIGHT, 0.0f, RECTIFY_SWAPPED);
    wrong = r, put(&wrong, 300, 0.0), put(&wrong, 308, 0.06), seal(&wrong);
    REFUSED(wrong.bytes, WIDTH, HEIGHT, STEREOPSIS_ALPHA_NATURAL, RECTIFY_VERTICAL);
    wrong = r, put(&wrong, 316, 1.0), seal(&wrong);
    REFUSED(wrong.bytes, WIDTH, HEIGHT, 0.0f, RECTIFY_POSE);
    wrong = r, put(&wrong, 140, 5000.0), seal(&wrong);
    REFUSED(wrong.bytes, WIDTH, HEIGHT, 0.0f, RECTIFY_NOTHING);
    wrong = r, put(&wrong, 60, 9.0), seal(&wrong);
    REFUSED(wrong.bytes, WIDTH, HEIGHT, 1.0f, RECTIFY_BENT);
    wrong = r, wrong.bytes[10]++, seal(&wrong);
    REFUSED(wrong.bytes, WIDTH, HEIGHT, 0.0f, RAW_SIZES);
    wrong = r, wrong.bytes[8] = wrong.bytes[12] = STEREOPSIS_WIDTH + 1, seal(&wrong);
    REFUSED(wrong.bytes, WIDTH, HEIGHT, 0.0f, RECTIFY_SIZE);
    /* A right camera 16 rows lower needs more lines than the library holds: it says how many. */
    wrong = r, put(&wrong, 148, 27.5), seal(&wrong);
    EXPECT(stereopsis_rectifier_start(h, wrong.bytes, WHOLE, WIDTH, HEIGHT, STEREOPSIS_ALPHA_NATURAL, &rig, &lines), RECTIFY_LINES);
    CHECK(lines > stereopsis_rectifier_lines() && lines < 30 && rig.focal_px == 1.0f);
    EXPECT(stereopsis_rectifier_begin_frame(h), NOT_STARTED);
    EXPECT(stereopsis_rectifier_start(h, r.bytes, WHOLE, WIDTH, HEIGHT, STEREOPSIS_ALPHA_NATURAL, &rig, &lines), OK);
    CHECK(lines >= 3 && lines <= stereopsis_rectifier_lines() && rig.focal_px > 59.0f && rig.baseline_m > 0.0599f);
}

static void frames(guarded g, stereopsis_rectifier *h) {
    uint8_t left[WIDTH], right[WIDTH], out[2][WIDTH];
    memset(left, 10, WIDTH), memset(right, 200, WIDTH);
    EXPECT(stereopsis_rectifier_push(h, left, right, WIDTH), NOT_BEGUN);
    EXPECT(stereopsis_rectifier_push_lost(h), NOT_BEGUN);
    EXPECT(stereopsis_rectifier_line(h, out[0], out[1], WIDTH), NOT_BEGUN);
    for (int frame = 0; frame < 2; frame++) {
        EXPECT(stereopsis_rectifier_begin_frame(h), OK);
        EXPECT(stereopsis_rectifier_push(NULL, left, right, WIDTH), NULL);
        EXPECT(stereopsis_rectifier_push_lost(NULL), NULL);
        EXPECT(stereopsis_rectifier_push(h, NULL, right, WIDTH), NULL);
        EXPECT(stereopsis_rectifier_push(h, left, NULL, WIDTH), NULL);
        EXPECT(stereopsis_rectifier_push(h, left, right, WIDTH - 1), LINE_LENGTH);
        EXPECT(stereopsis_rectifier_push(h, left, right, 0), LINE_LENGTH);
        EXPECT(stereopsis_rectifier_push(h, g.memory, right, WIDTH), OVERLAP);
        EXPECT(stereopsis_rectifier_push(h, left, g.memory + g.size - 1, WIDTH), OVERLAP);
        EXPECT(stereopsis_rectifier_line(NULL, out[0], out[1], WIDTH), NULL);
        EXPECT(stereopsis_rectifier_line(h, NULL, out[1], WIDTH), NULL);
        EXPECT(stereopsis_rectifier_line(h, out[0], NULL, WIDTH), NULL);
        EXPECT(stereopsis_rectifier_line(h, out[0], out[1], WIDTH - 1), LINE_LENGTH);
        EXPECT(stereopsis_rectifier_line(h, out[0], out[1], SIZE_MAX), LINE_LENGTH);
        EXPECT(stereopsis_rectifier_line(h, out[0], out[0] + 1, WIDTH), OVERLAP);
        EXPECT(stereopsis_rectifier_line(h, out[0], g.memory, WIDTH), OVERLAP);
        EXPECT(stereopsis_rectifier_line(h, out[0], out[1], WIDTH), NO_ROW_YET);
        int rows = 0, waited = 0;
        for (int y = 0; y < HEIGHT; y++) {
            int32_t pushed = stereopsis_rectifier_push(h, left, right, WIDTH), status;
            CHECK(pushed >= 0);
            if (pushed == STEREOPSIS_STATUS_OK) {
                EXPECT(stereopsis_rectifier_push(h, left, right, WIDTH), LINE_WAITING);
                EXPECT(stereopsis_rectifier_push_lost(h), LINE_WAITING);
                waited++;
            }
            while ((status = stereopsis_rectifier_line(h, out[0], out[1], WIDTH)) == STEREOPSIS_STATUS_OK) {
                rows++;
                for (size_t x = 0; x < WIDTH; x++)
                    CHECK((out[0][x] == 10 || out[0][x] == 0) && (out[1][x] == 200 || out[1][x] == 0));
            }
            CHECK(status == (rows == HEIGHT ? STEREOPSIS_STATUS_FRAME_DONE : STEREOPSIS_STATUS_NO_ROW_YET));
        }
        CHECK(rows == HEIGHT && waited > HEIGHT / 2);
        EXPECT(stereopsis_rectifier_push(h, left, right, WIDTH), FRAME_DONE);
        EXPECT(stereopsis_rectifier_push_lost(h), FRAME_DONE);
        EXPECT(stereopsis_rectifier_line(h, out[0], out[1], WIDTH), FRAME_DONE);
    }
    /* A lost raw line loses the rows that need it, and leaves the others in their places. */
    EXPECT(stereopsis_rectifier_begin_frame(h), OK);
    int given = 0, lost = 0;
    for (int y = 0; y < HEIGHT; y++) {
        int32_t pushed =
            y == HEIGHT / 2 ? stereopsis_rectifier_push_lost(h) : stereopsis_rectifier_push(h, left, right, WIDTH);
        int32_t status;
        CHECK(pushed >= 0);
        while ((status = stereopsis_rectifier_line(h, out[0], out[1], WIDTH)) == STEREOPSIS_STATUS_OK ||
               status == STEREOPSIS_STATUS_LOST) {
            given += status == STEREOPSIS_STATUS_OK;
            lost += status == STEREOPSIS_STATUS_LOST;
        }
    }
    CHECK(given + lost == HEIGHT && lost >= 1 && lost <= HEIGHT / 2);
    EXPECT(stereopsis_rectifier_mask(NULL, 0, out[0], out[1], WIDTH), NULL);
    EXPECT(stereopsis_rectifier_mask(h, 0, NULL, out[1], WIDTH), NULL);
    EXPECT(stereopsis_rectifier_mask(h, 0, out[0], NULL, WIDTH), NULL);
    EXPECT(stereopsis_rectifier_mask(h, 0, out[0], out[1], WIDTH + 1), LINE_LENGTH);
    EXPECT(stereopsis_rectifier_mask(h, 0, out[0], out[0], WIDTH), OVERLAP);
    EXPECT(stereopsis_rectifier_mask(h, 0, g.memory, out[1], WIDTH), OVERLAP);
    EXPECT(stereopsis_rectifier_mask(h, HEIGHT, out[0], out[1], WIDTH), ROW);
    EXPECT(stereopsis_rectifier_mask(h, HEIGHT / 2, out[0], out[1], WIDTH), OK);
    for (size_t x = 1; x + 1 < WIDTH; x++) CHECK(out[0][x] == 1 && out[1][x] == 1);
}

static void rectifiers(void) {
    guarded g = guard(stereopsis_rectifier_size());
    size_t stated = STEREOPSIS_RECTIFIER_BYTES(STEREOPSIS_WIDTH, STEREOPSIS_HEIGHT, STEREOPSIS_LINES);
    stereopsis_rectifier *h;
    CHECK(g.size <= stated && g.size + 64 > stated);
    CHECK(stereopsis_rectifier_lines() == STEREOPSIS_LINES);
    EXPECT(stereopsis_rectifier_init(g.memory, g.size, NULL), NULL);
    EXPECT(stereopsis_rectifier_init(g.memory, g.size, (stereopsis_rectifier **)MISALIGN(&h)), MISALIGNED);
    EXPECT(stereopsis_rectifier_init(NULL, g.size, &h), NULL);
    CHECK(h == NULL);
    EXPECT(stereopsis_rectifier_init(g.memory + 1, g.size, &h), MISALIGNED);
    EXPECT(stereopsis_rectifier_init(g.memory, g.size - 1, &h), MEMORY_TOO_SHORT);
    EXPECT(stereopsis_rectifier_init(g.memory, g.size, (stereopsis_rectifier **)(void *)g.memory), OVERLAP);
    for (size_t i = 0; i < g.size; i++) CHECK(g.memory[i] == 0xA5);
    EXPECT(stereopsis_rectifier_begin_frame((stereopsis_rectifier *)(void *)g.memory), NOT_INITIALISED);
    EXPECT(stereopsis_rectifier_init(g.memory, g.size, &h), OK);
    EXPECT(stereopsis_rectifier_begin_frame(h), NOT_STARTED);
    {
        uint8_t line[2][WIDTH] = {{0}, {0}};
        EXPECT(stereopsis_rectifier_push(h, line[0], line[1], WIDTH), NOT_STARTED);
        EXPECT(stereopsis_rectifier_push_lost(h), NOT_STARTED);
        EXPECT(stereopsis_rectifier_line(h, line[0], line[1], WIDTH), NOT_STARTED);
        EXPECT(stereopsis_rectifier_mask(h, 0, line[0], line[1], WIDTH), NOT_STARTED);
    }
    /* A rectifier is no matcher. */
    EXPECT(stereopsis_begin_frame((stereopsis *)(void *)h), NOT_INITIALISED);
    starts(g, h);
    frames(g, h);
    EXPECT(stereopsis_rectifier_deinit(NULL), NULL);
    EXPECT(stereopsis_rectifier_deinit(h), OK);
    EXPECT(stereopsis_rectifier_deinit(h), NOT_INITIALISED);
    release(g);
}

static void depths(void) {
    stereopsis_rig rig = {500.0f, 0.1f, 160.0f, 120.0f, 160.0f}, wrong = rig;
    uint16_t words[3] = {25 * STEREOPSIS_STEPS_PER_PX, STEREOPSIS_NONE, 0};
    float sigma[3] = {0.25f, 0.25f, 0.25f}, depth[3], far[3];
    stereopsis_point points[3];
    EXPECT(stereopsis_metres(NULL, words, sigma, depth, far, 3), NULL);
    EXPECT(stereopsis_metres(&rig, NULL, sigma, depth, far, 3), NULL);
    EXPECT(stereopsis_metres(&rig, words, NULL, depth, far, 3), NULL);
    EXPECT(stereopsis_metres(&rig, words, sigma, NULL, far, 3), NULL);
    EXPECT(stereopsis_metres(&rig, words, sigma, depth, NULL, 3), NULL);
    EXPECT(stereopsis_metres((stereopsis_rig *)MISALIGN(&rig), words, sigma, depth, far, 3), MISALIGNED);
    EXPECT(stereopsis_metres(&rig, (uint16_t *)MISALIGN(words), sigma, depth, far, 2), MISALIGNED);
    EXPECT(stereopsis_metres(&rig, words, (float *)MISALIGN(sigma), depth, far, 2), MISALIGNED);
    EXPECT(stereopsis_metres(&rig, words, sigma, (float *)MISALIGN(depth), far, 2), MISALIGNED);
    EXPECT(stereopsis_metres(&rig, words, sigma, depth, (float *)MISALIGN(far), 2), MISALIGNED);
    EXPECT(stereopsis_metres(&rig, words, sigma, depth, far, SIZE_MAX), TOO_MANY);
    EXPECT(stereopsis_metres(&rig, words, sigma, sigma, far, 3), OVERLAP);
    EXPECT(stereopsis_metres(&rig, words, sigma, depth, depth, 3), OVERLAP);
    EXPECT(stereopsis_metres(&rig, words, sigma, depth, sigma + 1, 2), OVERLAP);
    wrong.baseline_m = 0.0f;
    EXPECT(stereopsis_metres(&wrong, words, sigma, depth, far, 3), RIG_BASELINE);
    EXPECT(stereopsis_metres(&rig, words, sigma, depth, far, 3), OK);
    CHECK(depth[0] == 2.0f && far[0] == 0.02f && depth[1] == 0.0f && far[1] > 1e30f && depth[2] == 0.0f && far[2] > 1e30f);
    EXPECT(stereopsis_metres(&rig, words, sigma, depth, sigma, 3), OK); /* in place */
    CHECK(sigma[0] == 0.02f);
    EXPECT(stereopsis_metres(&rig, words, NULL, depth, NULL, 3), OK);

    EXPECT(stereopsis_points(NULL, 120, words, points, 3), NULL);
    EXPECT(stereopsis_points(&rig, 120, NULL, points, 3), NULL);
    EXPECT(stereopsis_points(&rig, 120, words, NULL, 3), NULL);
    EXPECT(stereopsis_points((stereopsis_rig *)MISALIGN(&rig), 120, words, points, 3), MISALIGNED);
    EXPECT(stereopsis_points(&rig, 120, (uint16_t *)MISALIGN(words), points, 2), MISALIGNED);
    EXPECT(stereopsis_points(&rig, 120, words, (stereopsis_point *)MISALIGN(points), 2), MISALIGNED);
    EXPECT(stereopsis_points(&rig, 120, words, points, 65536), TOO_MANY);
    EXPECT(stereopsis_points(&rig, 120, (uint16_t *)(void *)points, points, 3), OVERLAP);
    EXPECT(stereopsis_points(&wrong, 120, words, points, 3), RIG_BASELINE);
    EXPECT(stereopsis_points(&rig, 120, words, points, 3), OK);
    CHECK(points[0].x_m == -0.64f && points[0].y_m == 0.0f && points[0].z_m == 2.0f);
    CHECK(points[1].z_m == 0.0f && points[2].x_m == 0.0f);
}

int main(void) {
    records();
    rectifiers();
    depths();
    printf("%d failures\n", failures);
    return failures > 0;
}
