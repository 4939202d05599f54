/* The tick of a desktop: a thread in place of a timer's interrupt. */
#define _POSIX_C_SOURCE 200809L
#include "board.h"
#include <pthread.h>
#include <stdlib.h>
#include <time.h>

static void (*tick)(void);
static struct timespec period;

static void *run(void *unused) {
    (void)unused;
    for (;;) nanosleep(&period, NULL), tick();
    return NULL;
}

void board_tick(void (*handler)(void), uint32_t microseconds) {
    pthread_t thread;
    tick = handler, period.tv_sec = microseconds / 1000000u, period.tv_nsec = (long)(microseconds % 1000000u) * 1000;
    if (pthread_create(&thread, NULL, run, NULL) != 0) abort();
}
