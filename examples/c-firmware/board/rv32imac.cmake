# RV32IMAC: QEMU's virt.
set(BOARD_ISA rv32imac)
set(STEREOPSIS_RUST_TARGET riscv32imac-unknown-none-elf)
include(${CMAKE_CURRENT_LIST_DIR}/riscv-none-elf.cmake)
