/** Start of a 32-bit RISC-V with a floating-point unit, for QEMU's virt board. */
#include "semihosting.h"

int main(void);
void enter(void);

__asm__(".section .text.start\n"
        ".global start\n"
        "start:\n"
        "    la sp, stack_end\n"
        "    li t0, 0x2000\n" /* mstatus.FS = initial */
        "    csrs mstatus, t0\n"
        "    call enter\n"
        ".global semihosting\n"
        "semihosting:\n"
        /* The three instructions that the emulator looks for: uncompressed, on one page. */
        "    .option push\n"
        "    .option norvc\n"
        "    .balign 16\n"
        "    slli x0, x0, 0x1f\n"
        "    ebreak\n"
        "    srai x0, x0, 7\n"
        "    .option pop\n"
        "    ret\n"
        ".text\n");

void enter(void)
{
    semihosting_exit(main());
}
