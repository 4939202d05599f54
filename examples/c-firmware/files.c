/* Pictures, checksums and lines of text, without malloc. */
#define _POSIX_C_SOURCE 200809L
#include "files.h"
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void say(int file, const char *text) {
    if (write(file, text, strlen(text)) < 0) _exit(EXIT_FAILURE);
}

void fail(const char *what, const char *why) {
    say(STDERR_FILENO, what), say(STDERR_FILENO, ": "), say(STDERR_FILENO, why), say(STDERR_FILENO, "\n");
    _exit(EXIT_FAILURE);
}

void take(const char *name, int file, void *bytes, size_t length) {
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

int open_pgm(const char *name, uint16_t *width, uint16_t *height) {
    char magic[2];
    int file = open(name, O_RDONLY);
    if (file < 0) fail(name, "cannot be opened");
    take(name, file, magic, sizeof magic);
    if (magic[0] != 'P' || magic[1] != '5') fail(name, "is not a binary PGM");
    *width = number(name, file), *height = *width != 0 ? number(name, file) : 0;
    if (*height == 0) fail(name, "has no size, or a comment in its head");
    if (number(name, file) != 255) fail(name, "is not of 8 bits");
    return file;
}

int is_there(const char *name) {
    int file = open(name, O_RDONLY);
    if (file >= 0) close(file);
    return file >= 0;
}

void say_number(int file, int32_t number) {
    char text[13];
    char *first = text + sizeof text - 1;
    uint32_t rest = number < 0 ? 0u - (uint32_t)number : (uint32_t)number;
    for (*first = 0; rest != 0 || *first == 0; rest /= 10) *--first = (char)('0' + rest % 10);
    if (number < 0) *--first = '-';
    *--first = ' ';
    say(file, first);
}

/* CRC-32 as in Ethernet and PNG, bit by bit. */
uint32_t crc32(uint32_t crc, uint8_t byte) {
    crc ^= byte;
    for (int bit = 0; bit < 8; bit++) crc = (crc >> 1) ^ (0xEDB88320u & (0u - (crc & 1u)));
    return crc;
}

void say_crc(uint32_t crc) {
    char text[] = "crc32 00000000\n";
    for (int digit = 0; digit < 8; digit++) text[13 - digit] = "0123456789abcdef"[(~crc >> (4 * digit)) & 15];
    say(STDOUT_FILENO, text);
}
