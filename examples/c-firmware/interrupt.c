/* Lines that an interrupt hands over, each as it comes, to the program that matches them: the way of a camera over DMA.

   A timer's interrupt (on a desktop: a thread) is the cameras. At every tick it puts the next line of both pictures into two
   queues; the program takes lines in pairs, and sleeps or works while there are none. left.pgm and right.pgm in the current
   folder are read before. Prints the CRC-32 of all disparities and flags, which is that of `rectified`. */
#include "board/board.h"
#include "files.h"
#include "stereopsis.h"
#include <stdlib.h>
#include <string.h>

#ifndef STEREOPSIS_BYTES /* stereopsis.cmake says what the library was built for */
#define STEREOPSIS_BYTES STEREOPSIS_BLOCK_BYTES
#define STEREOPSIS_WIDTH 320
#define STEREOPSIS_DISPARITIES 64
#endif

enum { WIDTH = 160, HEIGHT = 120, SLOTS = 4, TICK_US = 400 };

static uint64_t memory[STEREOPSIS_BYTES(STEREOPSIS_WIDTH, STEREOPSIS_DISPARITIES) / 8 + 1];
static uint64_t slots[2][STEREOPSIS_LINE_QUEUE_BYTES(WIDTH, SLOTS) / 8];
static uint8_t pictures[2][HEIGHT][WIDTH];
static stereopsis_line_queue *queues[2];
static uint16_t next_row;

/* The cameras: with a full queue they wait for a tick, as no real ones do, so that the sum does not depend on time. */
static void line_came(void) {
    uint8_t *lines[2];
    if (next_row == HEIGHT) return;
    for (int camera = 0; camera < 2; camera++)
        if (stereopsis_line_queue_begin(queues[camera], &lines[camera]) != STEREOPSIS_STATUS_OK) return;
    for (int camera = 0; camera < 2; camera++) {
        memcpy(lines[camera], pictures[camera][next_row], WIDTH); /* here a DMA has written the line */
        stereopsis_line_queue_finish(queues[camera], 0, next_row, (uint64_t)next_row * TICK_US);
    }
    next_row++;
}

static stereopsis_status checked(stereopsis_status status) {
    if (status < 0) fail("stereopsis", stereopsis_status_text(status));
    return status;
}

static void load(const char *name, uint8_t (*picture)[WIDTH]) {
    uint16_t width, height;
    int file = open_pgm(name, &width, &height);
    if (width != WIDTH || height != HEIGHT) fail(name, "is not of 160 x 120 pixels");
    take(name, file, picture, sizeof pictures[0]);
}

int main(void) {
    stereopsis *matcher;
    stereopsis_config config;
    stereopsis_row row;
    stereopsis_line lines[2];
    uint32_t crc = UINT32_MAX;
    load("left.pgm", pictures[0]), load("right.pgm", pictures[1]);
    for (int camera = 0; camera < 2; camera++)
        checked(stereopsis_line_queue_init(slots[camera], sizeof slots[camera], WIDTH, &queues[camera]));
    checked(stereopsis_init_fresh(memory, sizeof memory, &matcher));
    checked(stereopsis_config_default(WIDTH, HEIGHT, STEREOPSIS_DISPARITIES, STEREOPSIS_PRESET_DEFAULT, &config));
    checked(stereopsis_start(matcher, &config));
    checked(stereopsis_begin_frame(matcher));
    board_tick(line_came, TICK_US);
    for (uint16_t lines_taken = 0, is_over = 0; !is_over;) {
        stereopsis_status status;
        if (lines_taken < HEIGHT) {
            /* A line waits until its partner is there; a board would wait for an interrupt (WFI) here. */
            if (checked(stereopsis_line_queue_next(queues[0], &lines[0])) != STEREOPSIS_STATUS_OK) continue;
            if (checked(stereopsis_line_queue_next(queues[1], &lines[1])) != STEREOPSIS_STATUS_OK) continue;
            if (lines[0].row != lines_taken || lines[1].row != lines_taken) fail("interrupt", "a line is missing");
            status = checked(stereopsis_push(matcher, lines[0].bytes, lines[1].bytes, WIDTH, &row));
            checked(stereopsis_line_queue_done(queues[0])), checked(stereopsis_line_queue_done(queues[1]));
            lines_taken++;
        } else {
            status = checked(stereopsis_flush(matcher, &row));
        }
        is_over = status == STEREOPSIS_STATUS_FRAME_DONE;
        for (uint16_t x = 0; status == STEREOPSIS_STATUS_OK && x < row.width; x++) {
            crc = crc32(crc, (uint8_t)(row.disparities[x] & 0xFF));
            crc = crc32(crc, (uint8_t)(row.disparities[x] >> 8));
            crc = crc32(crc, row.flags[x]);
        }
    }
    say_crc(crc);
    return EXIT_SUCCESS;
}
