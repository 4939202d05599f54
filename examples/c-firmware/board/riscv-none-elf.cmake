# GCC with picolibc for a 32-bit RISC-V core without an FPU: QEMU's virt.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR riscv)
set(CMAKE_C_COMPILER riscv64-unknown-elf-gcc)
set(CMAKE_C_FLAGS_INIT "-march=${BOARD_ISA} -mabi=ilp32 -mcmodel=medany --specs=picolibc.specs")
# The compiler is tried on a library: a program would need the board's start-up code.
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
# Where the linker's script puts flash and RAM.
set(BOARD_LINK_OPTIONS -Wl,--defsym=flash_start=0x80000000,--defsym=ram_start=0x80400000)
