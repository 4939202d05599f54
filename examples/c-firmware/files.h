/* Pictures, checksums and lines of text, without malloc: what the programs need beside the library. */
#ifndef FILES_H
#define FILES_H
#include <stddef.h>
#include <stdint.h>

/* Writes a text to a file: STDOUT_FILENO or STDERR_FILENO. */
void say(int file, const char *text);
/* Ends the program with a line on the standard error. */
void fail(const char *what, const char *why);
/* Reads exactly `length` bytes, or fails. */
void take(const char *name, int file, void *bytes, size_t length);
/* Opens an 8-bit PGM picture and reads its head, or fails. */
int open_pgm(const char *name, uint16_t *width, uint16_t *height);
/* Whether a file can be opened. */
int is_there(const char *name);
/* Writes a whole number with a blank before it. */
void say_number(int file, int32_t number);
/* CRC-32 as in Ethernet and PNG, bit by bit: begins with UINT32_MAX, and say_crc prints it. */
uint32_t crc32(uint32_t crc, uint8_t byte);
void say_crc(uint32_t crc);
#endif
