/* What a program needs of its board beside files. */
#ifndef BOARD_H
#define BOARD_H
#include <stdint.h>

/* Calls a handler every so many microseconds: from an interrupt on a board, from a thread on a desktop. */
void board_tick(void (*handler)(void), uint32_t microseconds);
#endif
