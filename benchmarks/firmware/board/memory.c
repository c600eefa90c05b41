/** What compilers call by themselves, for programs without a C library; memset comes from elsewhere. */
#include <stddef.h>

void *memcpy(void *restrict to, const void *restrict from, size_t size);

void *memcpy(void *restrict to, const void *restrict from, size_t size)
{
    unsigned char *t = to;
    const unsigned char *f = from;
    while (size-- > 0) {
        *t++ = *f++;
    }
    return to;
}
