/* From reset to main on a Cortex-M4F or M7: the vector table, the FPU, the memory's first content. */
#include "board.h"
#include <stdint.h>
#include <string.h>
#include <unistd.h>

extern uint8_t data_start[], data_end[], data_load[], bss_start[], bss_end[], stack_top[];
int main(int count, char **names);

static void (*tick)(void);

/* Anything unforeseen ends the emulation. */
static void fault(void) {
    _exit(3);
}

static void systick(void) {
    tick();
}

void board_tick(void (*handler)(void), uint32_t microseconds) {
    tick = handler;
    *(volatile uint32_t *)0xE000E014u = 25u * microseconds - 1u; /* SYST_RVR: the boards run at 25 MHz */
    *(volatile uint32_t *)0xE000E018u = 0;                       /* SYST_CVR */
    *(volatile uint32_t *)0xE000E010u = 7;                       /* SYST_CSR: on, with an interrupt, processor clock */
}

void reset(void) {
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20; /* CPACR: full access to the FPU */
    __asm volatile("dsb\n isb" ::: "memory");
    memcpy(data_start, data_load, (size_t)(data_end - data_start));
    memset(bss_start, 0, (size_t)(bss_end - bss_start));
    _exit(main(0, NULL));
}

__attribute__((section(".vectors"), used)) static const struct {
    uint8_t *stack;
    void (*handlers[15])(void);
} vectors = {stack_top, {reset, fault, fault, fault, fault, fault, 0, 0, 0, 0, 0, 0, 0, 0, systick}};
