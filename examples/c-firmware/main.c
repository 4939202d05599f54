/* Depth rows from a pair of 8-bit PGM pictures, line by line, without malloc: for a board and for a desktop.

   Usage: depth [LEFT.pgm RIGHT.pgm]; without arguments, as on a board, left.pgm and right.pgm in the current folder.
   Prints the CRC-32 of all disparities and flags. In a product the lines come from the cameras' DMA instead. */
#define _POSIX_C_SOURCE 200809L
#include "stereopsis.h"
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifndef STEREOPSIS_BYTES /* stereopsis.cmake says what the library was built for */
#define STEREOPSIS_BYTES STEREOPSIS_BLOCK_BYTES
#define STEREOPSIS_WIDTH 320
#define STEREOPSIS_DISPARITIES 64
#endif

static uint64_t memory[STEREOPSIS_BYTES(STEREOPSIS_WIDTH, STEREOPSIS_DISPARITIES) / 8 + 1];
static uint8_t left[STEREOPSIS_WIDTH], right[STEREOPSIS_WIDTH];

static void say(int file, const char *text) {
    if (write(file, text, strlen(text)) < 0) _exit(EXIT_FAILURE);
}

static void fail(const char *what, const char *why) {
    say(STDERR_FILENO, what), say(STDERR_FILENO, ": "), say(STDERR_FILENO, why), say(STDERR_FILENO, "\n");
    _exit(EXIT_FAILURE);
}

static void take(const char *name, int file, void *bytes, size_t length) {
    ssize_t taken = read(file, bytes, length);
    if (taken != (ssize_t)length) fail(name, taken < 0 ? "cannot be read" : "the picture ends early");
}

/* The next number of a PGM's head, 65535 for all from 65530 on; 0 for anything else, such as a comment. */
static uint16_t number(const char *name, int file) {
    uint32_t value = 0;
    uint8_t c = ' ';
    while (c <= ' ') take(name, file, &c, 1);
    for (; c >= '0' && c <= '9'; take(name, file, &c, 1))
        value = value < 6553 ? value * 10 + (uint32_t)(c - '0') : UINT16_MAX;
    return c <= ' ' ? (uint16_t)value : 0;
}

static int open_pgm(const char *name, uint16_t *width, uint16_t *height) {
    char magic[2];
    int file = open(name, O_RDONLY);
    if (file < 0) fail(name, "cannot be opened");
    take(name, file, magic, sizeof magic);
    if (magic[0] != 'P' || magic[1] != '5') fail(name, "is not a binary PGM");
    *width = number(name, file), *height = *width != 0 ? number(name, file) : 0;
    if (*height == 0) fail(name, "has no size, or a comment in its head");
    if (number(name, file) != 255) fail(name, "is not of 8 bits");
    if (*width > STEREOPSIS_WIDTH) fail(name, "is wider than the library was built for");
    return file;
}

/* CRC-32 as in Ethernet and PNG, bit by bit. */
static uint32_t crc32(uint32_t crc, uint8_t byte) {
    crc ^= byte;
    for (int bit = 0; bit < 8; bit++) crc = (crc >> 1) ^ (0xEDB88320u & (0u - (crc & 1u)));
    return crc;
}

int main(int count, char **names) {
    if (count == 2 || count > 3) fail("usage", "depth [LEFT.pgm RIGHT.pgm]");
    const char *left_name = count == 3 ? names[1] : "left.pgm", *right_name = count == 3 ? names[2] : "right.pgm";
    uint16_t width, height, right_width, right_height;
    int left_file = open_pgm(left_name, &width, &height), right_file = open_pgm(right_name, &right_width, &right_height);
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
    char text[] = "crc32 00000000\n";
    for (int digit = 0; digit < 8; digit++) text[13 - digit] = "0123456789abcdef"[(~crc >> (4 * digit)) & 15];
    say(STDOUT_FILENO, text);
    return EXIT_SUCCESS;
}
