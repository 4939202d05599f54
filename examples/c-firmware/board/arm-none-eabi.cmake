# GCC for a Cortex-M with an FPU, as Rust's target has it.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_C_FLAGS_INIT "${BOARD_CPU} -mthumb -mfloat-abi=hard")
# The compiler is tried on a library: a program would need the board's start-up code.
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(STEREOPSIS_RUST_TARGET thumbv7em-none-eabihf)
# Where the linker's script puts flash and RAM.
set(BOARD_LINK_OPTIONS -Wl,--defsym=flash_start=0x00000000,--defsym=ram_start=0x20000000)
