# Cortex-M4F: QEMU's mps2-an386.
set(BOARD_CPU "-mcpu=cortex-m4 -mfpu=fpv4-sp-d16")
include(${CMAKE_CURRENT_LIST_DIR}/arm-none-eabi.cmake)
