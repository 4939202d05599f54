/* Files on the machine that emulates or debugs the board, by semihosting as Arm and RISC-V have it: the calls that the
   programs make. newlib's own (rdimon.specs) bring malloc along, these bring nothing. */
#include <fcntl.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

enum { SYS_OPEN = 0x01, SYS_CLOSE = 0x02, SYS_WRITE = 0x05, SYS_READ = 0x06, SYS_EXIT_EXTENDED = 0x20 };
enum { MODE_READ = 1, MODE_WRITE = 4, MODE_APPEND = 8 }; /* "rb"; ":tt" with "w" is the output, with "a" the errors */
enum { FIRST_FILE = 3 };                                 /* as everywhere: 0 to 2 are input, output, errors */
enum { APPLICATION_EXIT = 0x20026 };

static int call(uintptr_t operation, const uintptr_t *block) {
#ifdef __riscv
    register uintptr_t a0 __asm("a0") = operation;
    register const uintptr_t *a1 __asm("a1") = block;
    /* The three instructions are a sign, uncompressed and in one page. */
    __asm volatile(".balign 16\n .option push\n .option norvc\n slli zero, zero, 0x1f\n ebreak\n srai zero, zero, 7\n"
                   " .option pop" : "+r"(a0) : "r"(a1) : "memory");
    return (int)a0;
#else
    register uintptr_t r0 __asm("r0") = operation;
    register const uintptr_t *r1 __asm("r1") = block;
    __asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
    return (int)r0;
#endif
}

static int open_mode(const char *name, uintptr_t mode) {
    return call(SYS_OPEN, (const uintptr_t[]){(uintptr_t)name, mode, strlen(name)});
}

int open(const char *name, int flags, ...) {
    int handle = flags == O_RDONLY ? open_mode(name, MODE_READ) : -1;
    return handle < 0 ? -1 : handle + FIRST_FILE;
}

int close(int file) {
    return call(SYS_CLOSE, (const uintptr_t[]){(uintptr_t)(file - FIRST_FILE)});
}

_ssize_t read(int file, void *bytes, size_t length) {
    if (file < FIRST_FILE) return -1;
    int left = call(SYS_READ, (const uintptr_t[]){(uintptr_t)(file - FIRST_FILE), (uintptr_t)bytes, length});
    return left < 0 ? -1 : (_ssize_t)length - left;
}

_ssize_t write(int file, const void *bytes, size_t length) {
    if (file != STDOUT_FILENO && file != STDERR_FILENO) return -1;
    static int consoles[3];
    int *console = &consoles[file]; /* handles are not 0 */
    if (*console == 0) *console = open_mode(":tt", file == STDOUT_FILENO ? MODE_WRITE : MODE_APPEND);
    int left = call(SYS_WRITE, (const uintptr_t[]){(uintptr_t)*console, (uintptr_t)bytes, length});
    return left < 0 ? -1 : (_ssize_t)length - left;
}

void _exit(int status) {
    for (;;) call(SYS_EXIT_EXTENDED, (const uintptr_t[]){APPLICATION_EXIT, (uintptr_t)status});
}
