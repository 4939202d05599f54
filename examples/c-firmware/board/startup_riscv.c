/* From reset to main on a 32-bit RISC-V core: the stack, the trap handler, the memory's first content. */
#include "board.h"
#include <stdint.h>
#include <string.h>
#include <unistd.h>

extern uint8_t data_start[], data_end[], data_load[], bss_start[], bss_end[];
int main(int count, char **names);

static void (*tick)(void);
static uint32_t period;

/* The timer of QEMU's virt counts at 10 MHz. */
static volatile uint32_t *const mtimecmp = (volatile uint32_t *)0x02004000u;
static volatile const uint32_t *const mtime = (volatile const uint32_t *)0x0200BFF8u;

static void set_timer(void) {
    uint32_t high = mtime[1], low = mtime[0];
    if (mtime[1] != high) high = mtime[1], low = 0;
    uint64_t next = ((uint64_t)high << 32 | low) + period;
    mtimecmp[1] = UINT32_MAX; /* no tick between the two words */
    mtimecmp[0] = (uint32_t)next, mtimecmp[1] = (uint32_t)(next >> 32);
}

/* The timer's interrupts; anything unforeseen ends the emulation. */
__attribute__((interrupt, aligned(4))) static void trap(void) {
    uint32_t cause;
    __asm volatile(".option push\n .option arch, +zicsr\n csrr %0, mcause\n .option pop" : "=r"(cause));
    if (cause != 0x80000007u) _exit(3);
    set_timer();
    tick();
}

void board_tick(void (*handler)(void), uint32_t microseconds) {
    tick = handler, period = 10 * microseconds;
    set_timer();
    __asm volatile(".option push\n .option arch, +zicsr\n csrs mie, %0\n csrsi mstatus, 8\n .option pop"
                   ::"r"(1u << 7) : "memory");
}

__attribute__((used)) static void start(void) {
    memcpy(data_start, data_load, (size_t)(data_end - data_start));
    memset(bss_start, 0, (size_t)(bss_end - bss_start));
    _exit(main(0, NULL));
}

__attribute__((naked, section(".vectors"), used)) void reset(void) {
    __asm volatile(".option push\n .option arch, +zicsr\n la sp, stack_top\n la t0, %0\n csrw mtvec, t0\n"
                   " j %1\n .option pop" ::"i"(trap), "i"(start));
}
