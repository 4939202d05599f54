# Cortex-M7 with a single-precision FPU: QEMU's mps2-an500.
set(BOARD_CPU "-mcpu=cortex-m7 -mfpu=fpv5-sp-d16")
include(${CMAKE_CURRENT_LIST_DIR}/arm-none-eabi.cmake)
