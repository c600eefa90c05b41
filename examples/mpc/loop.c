/**
 * The closed loop: measure, plan, apply the first input to the plant for one period.
 *
 *     loop BEGIN DURATION < parameters of the plant
 *
 * begins on the reference at that time [s] and prints a row for each period: the state after it, the input, CPU time
 * of the plan [s], iterations, 1 where the plan has converged.
 */
#define _POSIX_C_SOURCE 199309L /* clock_gettime */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "ariane4.h"
#include "plan.h"

/* Angles and speeds, as in mpc_loop.py. */
static void reference_at(double t, double state[X])
{
    int j;
    for (j = 0; j < N; ++j) {
        const double rate = 6.283185307179586 / SWING_PERIOD[j], half = (SWING_END[j] - SWING_START[j]) / 2.0;
        state[j] = SWING_START[j] + half * (1.0 - cos(rate * t));
        state[N + j] = half * rate * sin(rate * t);
    }
}

/* The state after one period of constant inputs: Runge-Kutta 4. */
static int advance(double state[X], const double input[N], const double parameters[])
{
    static const double place[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
    const double h = PERIOD / PLANT_STEPS;
    int step, stage, i;
    for (step = 0; step < PLANT_STEPS; ++step) {
        double slope[X] = {0.0}, sum[X] = {0.0};
        for (stage = 0; stage < 4; ++stage) {
            double point[X];
            for (i = 0; i < X; ++i) {
                point[i] = state[i] + place[stage] * h * slope[i];
            }
            if (ariane4_forward_dynamics(point, point + N, input, parameters, slope + N) != ARIANE4_STATUS_OK) {
                return 1;
            }
            memcpy(slope, point + N, N * sizeof slope[0]);
            for (i = 0; i < X; ++i) {
                sum[i] += weight[stage] * slope[i];
            }
        }
        for (i = 0; i < X; ++i) {
            state[i] += h / 6.0 * sum[i];
        }
    }
    return 0;
}

static double cpu(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(int count, char *arguments[])
{
    static plan_t plan;
    double parameters[ARIANE4_N_PARAMETERS], state[X], ahead[STEPS + 1][X], input[N] = {0.0};
    const double started = count == 3 ? strtod(arguments[1], NULL) : 0.0;
    const long periods = count == 3 ? lround(strtod(arguments[2], NULL) / PERIOD) : 0;
    long k;
    int warm = 0, i;
    for (i = 0; i < ARIANE4_N_PARAMETERS; ++i) {
        if (scanf("%lf", &parameters[i]) != 1) {
            fprintf(stderr, "loop: expected %d parameters of the plant on stdin\n", ARIANE4_N_PARAMETERS);
            return 2;
        }
    }
    if (periods < 1) {
        fprintf(stderr, "loop: expected when to begin and for how long [s], at least one period of %g s\n", PERIOD);
        return 2;
    }
    reference_at(started, state);
    plan_begin(&plan);
    for (k = 0; k < periods; ++k) {
        double begin;
        for (i = 0; i <= STEPS; ++i) {
            reference_at(started + (double)(k + i) * PERIOD, ahead[i]);
        }
        begin = cpu();
        warm = plan_solve(&plan, state, ahead, warm);
        begin = cpu() - begin;
        if (warm) { /* without a plan the inputs stay */
            memcpy(input, plan_input(&plan), sizeof input);
        }
        if (advance(state, input, parameters) != 0) {
            fprintf(stderr, "loop: the plant has left its strokes by %g s\n", started + (double)(k + 1) * PERIOD);
            return 1;
        }
        for (i = 0; i < X; ++i) {
            printf("%.17g ", state[i]);
        }
        for (i = 0; i < N; ++i) {
            printf("%.17g ", input[i]);
        }
        printf("%.9f %d %d\n", begin, plan.iterations, plan.converged);
    }
    plan_end(&plan);
    return 0;
}
