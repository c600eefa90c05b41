/** Start of a Cortex-M with a floating-point unit, for QEMU's mps2 boards. */
#include <stdint.h>

#include "semihosting.h"

extern uint32_t data_source, data_begin, data_end, bss_begin, bss_end, stack_end;
int main(void);

int32_t semihosting(int32_t request, const void *arguments)
{
    register int32_t r0 __asm__("r0") = request;
    register const void *r1 __asm__("r1") = arguments;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

void reset(void);
void reset(void)
{
    const uint32_t *from = &data_source;
    uint32_t *to;
    /* Before the first floating-point instruction: access to coprocessors 10 and 11. */
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20;
    __asm__ volatile("dsb\n\tisb" ::: "memory");
    for (to = &data_begin; to < &data_end; ++to) {
        *to = *from++;
    }
    for (to = &bss_begin; to < &bss_end; ++to) {
        *to = 0;
    }
    semihosting_exit(main());
}

static void fault(void)
{
    semihosting_exit(70);
}

typedef void (*handler_t)(void);
__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    handler_t handlers[15];
} vectors = {&stack_end, {reset, fault, fault, fault, fault, fault, 0, 0, 0, 0, fault, fault, 0, fault, fault}};
