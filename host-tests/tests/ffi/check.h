/* What the tests of misuse are written with. */
#ifndef CHECK_H
#define CHECK_H
#include "stereopsis.h"
#include "stereopsis.h" /* twice: the guard holds */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPECT(call, status) expect(__LINE__, #call, (call), STEREOPSIS_STATUS_##status)
/* A pointer one byte further on, which nobody may follow. */
#define MISALIGN(pointer) ((void *)((char *)(pointer) + 1))
#define CHECK(condition) check(__LINE__, #condition, (condition))

enum { GUARD = 64 };
static int failures;

static void check(int line, const char *what, int holds) {
    if (holds) return;
    printf("line %d: %s does not hold\n", line, what);
    failures++;
}

static void expect(int line, const char *call, int32_t found, int32_t expected) {
    if (found == expected) return;
    printf("line %d: %s is %d (%s), expected %d (%s)\n", line, call, (int)found, stereopsis_status_text(found),
           (int)expected, stereopsis_status_text(expected));
    failures++;
}

/* Memory with guards around it, of just the size that is needed, filled with anything but zeros. */
typedef struct {
    unsigned char *all, *memory;
    size_t size;
} guarded;

static guarded guard(size_t size) {
    guarded g;
    g.size = size;
    g.all = (unsigned char *)malloc(g.size + 2 * GUARD);
    if (g.all == NULL) exit(100);
    memset(g.all, 0xA5, g.size + 2 * GUARD);
    g.memory = g.all + GUARD;
    return g;
}

static void release(guarded g) {
    for (size_t i = 0; i < GUARD; i++) CHECK(g.all[i] == 0xA5 && g.memory[g.size + i] == 0xA5);
    free(g.all);
}

#endif
