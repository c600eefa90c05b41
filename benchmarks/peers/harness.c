/* harness MODEL STATES N COUNT values          the results of every function in every state
 * harness MODEL STATES N COUNT count           under callgrind: one dump for each function
 * harness MODEL STATES N COUNT heap            bytes allocated by the model and its functions
 * harness MODEL STATES N COUNT time SECONDS    ns per call, blocks of every function in turn
 *
 * STATES: a file of COUNT x 3 N doubles. */
#include "peer.h"

#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <valgrind/callgrind.h>

static double *states;
static int joints, samples;
static volatile double sink;

static __attribute__((noinline)) void pass(const struct peer_function *f)
{
    const double *x = states;
    for (int k = 0; k < samples; k++, x += 3 * joints)
        f->call(x, x + joints, x + 2 * joints);
}

static void values(const struct peer_function *f)
{
    printf("%s %d\n", f->name, f->size);
    const double *x = states;
    for (int k = 0; k < samples; k++, x += 3 * joints) {
        const double *out = f->call(x, x + joints, x + 2 * joints);
        for (int i = 0; i < f->size; i++)
            printf("%.17g ", out[i]);
        printf("\n");
    }
}

static void count(const struct peer_function *f)
{
    pass(f); /* what is bound, allocated or cached at the first call */
    CALLGRIND_ZERO_STATS;
    CALLGRIND_TOGGLE_COLLECT;
    pass(f);
    CALLGRIND_TOGGLE_COLLECT;
    CALLGRIND_DUMP_STATS_AT(f->name);
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static double block(const struct peer_function *f, int passes)
{
    double start = now();
    for (int k = 0; k < passes; k++)
        pass(f);
    return (now() - start) / ((double)passes * samples);
}

int main(int argc, char **argv)
{
    if (argc < 6)
        return 2;
    joints = atoi(argv[3]);
    samples = atoi(argv[4]);
    size_t size = (size_t)samples * 3 * (size_t)joints;
    states = malloc(size * sizeof *states);
    FILE *file = fopen(argv[2], "rb");
    if (!states || !file || fread(states, sizeof *states, size, file) != size)
        return 2;
    fclose(file);
    const struct mallinfo2 before = mallinfo2();
    const struct peer_function *functions = peer_open(argv[1]);
    if (!functions)
        return 2;
    if (!strcmp(argv[5], "heap")) {
        for (const struct peer_function *f = functions; f->name; f++)
            f->call(states, states + joints, states + 2 * joints);
        const struct mallinfo2 after = mallinfo2();
        printf("%zu\n", after.uordblks + after.hblkhd - before.uordblks - before.hblkhd);
        return 0;
    }
    if (!strcmp(argv[5], "values") || !strcmp(argv[5], "count")) {
        for (const struct peer_function *f = functions; f->name; f++)
            argv[5][0] == 'v' ? values(f) : count(f);
    } else {
        double end = now() + 1e9 * atof(argv[6]);
        while (now() < end)
            for (const struct peer_function *f = functions; f->name; f++) {
                int passes = 1 + (int)(2e5 / (block(f, 1) * samples)); /* about 0.2 ms */
                printf("%s %.3f\n", f->name, block(f, passes));
            }
    }
    free(states);
    return 0;
}
