# RV32IMC, a core without atomic instructions: QEMU's virt with -cpu rv32,a=off.
set(BOARD_ISA rv32imc)
set(STEREOPSIS_RUST_TARGET riscv32imc-unknown-none-elf)
include(${CMAKE_CURRENT_LIST_DIR}/riscv-none-elf.cmake)
