/* Rows of disparities from a rectified pair of 8-bit PGM pictures, line by line, without malloc: for a board and for a desktop.

   Usage: rectified [LEFT.pgm RIGHT.pgm]; without arguments, as on a board, left.pgm and right.pgm in the current folder.
   Prints the CRC-32 of all disparities and flags. In a product the lines come from the cameras' DMA instead. */
#include "files.h"
#include "stereopsis.h"
#include <stdlib.h>

#ifndef STEREOPSIS_BYTES /* stereopsis.cmake says what the library was built for */
#define STEREOPSIS_BYTES STEREOPSIS_BLOCK_BYTES
#define STEREOPSIS_WIDTH 320
#define STEREOPSIS_DISPARITIES 64
#endif

static uint64_t memory[STEREOPSIS_BYTES(STEREOPSIS_WIDTH, STEREOPSIS_DISPARITIES) / 8 + 1];
static uint8_t left[STEREOPSIS_WIDTH], right[STEREOPSIS_WIDTH];

int main(int count, char **names) {
    if (count == 2 || count > 3) fail("usage", "rectified [LEFT.pgm RIGHT.pgm]");
    const char *left_name = count == 3 ? names[1] : "left.pgm", *right_name = count == 3 ? names[2] : "right.pgm";
    uint16_t width, height, right_width, right_height;
    int left_file = open_pgm(left_name, &width, &height), right_file = open_pgm(right_name, &right_width, &right_height);
    if (width > STEREOPSIS_WIDTH) fail(left_name, "is wider than the library was built for");
    if (right_width != width || right_height != height) fail(right_name, "is not of the left picture's size");
    stereopsis *matcher;
    stereopsis_config config;
    stereopsis_row row;
    stereopsis_status status = stereopsis_init(memory, sizeof memory, &matcher);
    if (status >= 0)
        status = stereopsis_config_default(width, height, STEREOPSIS_DISPARITIES, STEREOPSIS_PRESET_DEFAULT, &config);
    if (status >= 0) status = stereopsis_start(matcher, &config);
    if (status >= 0) status = stereopsis_begin_frame(matcher);
    uint32_t crc = UINT32_MAX;
    for (uint32_t lines = 0; status >= 0 && status != STEREOPSIS_STATUS_FRAME_DONE;) {
        if (lines++ < height) {
            take(left_name, left_file, left, width);
            take(right_name, right_file, right, width);
            status = stereopsis_push(matcher, left, right, width, &row);
        } else {
            status = stereopsis_flush(matcher, &row);
        }
        for (uint16_t x = 0; status == STEREOPSIS_STATUS_OK && x < row.width; x++) {
            crc = crc32(crc, (uint8_t)(row.disparities[x] & 0xFF));
            crc = crc32(crc, (uint8_t)(row.disparities[x] >> 8));
            crc = crc32(crc, row.flags[x]);
        }
    }
    if (status < 0) fail("stereopsis", stereopsis_status_text(status));
    say_crc(crc);
    return EXIT_SUCCESS;
}
