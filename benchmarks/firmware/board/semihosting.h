/** Files and the end of the program by way of the emulator (ARM semihosting, also used by RISC-V). */
#ifndef SEMIHOSTING_H
#define SEMIHOSTING_H

#include <stddef.h>
#include <stdint.h>

/** One request: its number and the address of its arguments. */
int32_t semihosting(int32_t request, const void *arguments);

static inline int32_t semihosting_open(const char *name, size_t length, int32_t mode)
{
    const uintptr_t block[3] = {(uintptr_t)name, (uintptr_t)mode, length};
    return semihosting(0x01, block);
}

/** Number of bytes that were not written. */
static inline int32_t semihosting_write(int32_t file, const void *from, size_t size)
{
    const uintptr_t block[3] = {(uintptr_t)file, (uintptr_t)from, size};
    return semihosting(0x05, block);
}

/** Number of bytes that were not read. */
static inline int32_t semihosting_read(int32_t file, void *to, size_t size)
{
    const uintptr_t block[3] = {(uintptr_t)file, (uintptr_t)to, size};
    return semihosting(0x06, block);
}

static inline void semihosting_exit(int code)
{
    const uintptr_t block[2] = {0x20026, (uintptr_t)code};
    for (;;) {
        (void)semihosting(0x20, block);
    }
}

#endif
