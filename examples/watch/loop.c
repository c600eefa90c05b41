/** The arm under control on the host: plant and controller in double, the watch in single precision beside it. */
#include "loop.h"

#include <math.h>
#include <string.h>

#if WATCHING
int watch_step(const float given[], float result[]);
#else
static int watch_step(const float given[], float result[])
{
    (void)given;
    (void)result;
    return 1;
}
#endif

#define N ARIANE4_N_JOINTS
#define P ARIANE4_N_PARAMETERS
#define STATES (N + ARIANE4_N_MONITOR_STATES)
#define GIVEN (4 * N + 2 + STATES)
#define RESULT (STATES + N + 3)

static double uniform(unsigned long long *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    return ((double)(*seed >> 11) + 0.5) / 9007199254740992.0;
}

static double normal(unsigned long long *seed)
{
    const double radius = sqrt(-2.0 * log(uniform(seed)));
    return radius * cos(6.283185307179586 * uniform(seed));
}

/* Two sines for each joint. */
static void reference(const loop_t *s, double t, double q[], double dq[], double ddq[])
{
    int j, k;
    for (j = 0; j < N; ++j) {
        q[j] = s->centre[j];
        dq[j] = ddq[j] = 0.0;
        for (k = 0; k < 2; ++k) {
            const double a = s->amplitude[j][k], w = s->frequency[j][k];
            q[j] += a * sin(w * t + j);
            dq[j] += a * w * cos(w * t + j);
            ddq[j] -= a * w * w * sin(w * t + j);
        }
    }
}

/* Semi-implicit Euler; an end stop of joint 1 pushes back. */
static int advance(const loop_t *s, double t, double q[], double dq[], const double current[], double parameters[])
{
    double gain[N], input[N], ddq[N];
    int i, j;
    for (j = 0; j < P; ++j) {
        const double since = t < s->drift_time ? t : s->drift_time;
        parameters[j] = s->parameters[j] + s->drift[j] * since / s->drift_time + (t >= s->jump_time ? s->jump[j] : 0.0);
    }
    for (i = 0; i < s->substeps; ++i) {
        memcpy(input, current, sizeof input);
        if (q[0] > s->stop && t >= s->stop_time) {
            if (ariane4_drive_gain(q, gain) != ARIANE4_STATUS_OK) {
                return 1;
            }
            input[0] -= s->stiffness * (q[0] - s->stop) / gain[0];
        }
        if (ariane4_forward_dynamics(q, dq, input, parameters, ddq) != ARIANE4_STATUS_OK) {
            return 1;
        }
        for (j = 0; j < N; ++j) {
            dq[j] += s->dt / s->substeps * ddq[j];
            q[j] += s->dt / s->substeps * dq[j];
        }
    }
    return 0;
}

int loop(loop_t *s, double log[], float last[])
{
    static const double zero[N] = {0.0};
    const double keep = exp(-s->dt / s->noise_time), kick = sqrt(1.0 - keep * keep);
    double q[N], dq[N], noise[N] = {0.0}, wanted[N], current[N], qr[N], dqr[N], ddqr[N], parameters[P];
    double q_m[N], dq_m[N], ddq_m[N], seen[N], speed[N], unused[N];
    float given[GIVEN], result[RESULT], states[STATES] = {0.0f};
    unsigned long long seed = s->seed;
    int before = 0, j;
    long k;
    s->outside_time = s->changed_time = s->touched_time = -1.0;
    s->outside = s->changed = 0;
    s->alarms = 0;
    for (j = 0; j < 3; ++j) {
        s->named_time[j] = -1.0;
    }
    reference(s, 0.0, q, dq, ddqr);
    for (k = 0; k < s->steps; ++k) {
        const double t = (double)k * s->dt;
        int alarm;
        reference(s, t, qr, dqr, ddqr);
        if (ariane4_motor_from_joint(q, dq, zero, q_m, dq_m, ddq_m) != ARIANE4_STATUS_OK) {
            return 1;
        }
        for (j = 0; j < N; ++j) {
            q_m[j] = floor(q_m[j] + 0.5); /* encoders in whole increments */
            dq_m[j] = floor(dq_m[j] + 0.5);
        }
        if (ariane4_joint_from_motor(q_m, dq_m, zero, seen, speed, unused) != ARIANE4_STATUS_OK) {
            return 2;
        }
        for (j = 0; j < N; ++j) {
            wanted[j] = ddqr[j] + s->kp * (qr[j] - seen[j]) + s->kd * (dqr[j] - speed[j]);
        }
        if (ariane4_inverse_dynamics(seen, dqr, wanted, s->assumed, current) != ARIANE4_STATUS_OK) {
            return 3;
        }
        for (j = 0; j < N; ++j) {
            noise[j] = keep * noise[j] + kick * s->noise[j] * normal(&seed);
            given[j] = (float)seen[j];
            given[N + j] = (float)speed[j];
            given[2 * N + j] = (float)ddqr[j];
            given[3 * N + j] = (float)(current[j] + noise[j]);
            if (log != NULL) {
                log[k * (1 + 2 * N) + 1 + j] = q_m[j];
                log[k * (1 + 2 * N) + 1 + N + j] = current[j] + noise[j];
            }
        }
        if (log != NULL) {
            log[k * (1 + 2 * N)] = t;
        }
        if (s->watching) {
            given[4 * N] = (float)s->dt;
            given[4 * N + 1] = k % s->slow == 0 ? 1.0f : 0.0f;
            memcpy(given + 4 * N + 2, states, sizeof states);
            if (watch_step(given, result) != 0) {
                return 4;
            }
            memcpy(states, result, sizeof states);
            if (last != NULL && s->outside_time < 0.0 && s->changed_time < 0.0) {
                memcpy(last + (k % s->kept) * GIVEN, given, sizeof given);
                s->step = k;
            }
            if (t < 1.0) { /* the observer begins at rest, the arm does not */
                result[STATES + N] = 0.0f;
            }
            for (j = 0; j < N && t >= 1.0; ++j) {
                const double size = fabs((double)result[STATES + j]);
                s->largest[j] = size > s->largest[j] ? size : s->largest[j];
            }
            alarm = result[STATES + N] > 0.0f || result[STATES + N + 1] > 0.0f;
            if (result[STATES + N] > 0.0f && s->outside_time < 0.0) {
                s->outside_time = t;
                s->outside = (int)result[STATES + N];
            }
            if (result[STATES + N + 1] > 0.0f && s->changed_time < 0.0) {
                s->changed_time = t;
                s->changed = (int)result[STATES + N + 1];
            }
            for (j = 0; j < 3; ++j) {
                if ((((unsigned int)result[STATES + N + 1] >> j) & 1U) != 0U && s->named_time[j] < 0.0) {
                    s->named_time[j] = t;
                }
            }
            s->alarms += alarm && !before;
            before = alarm || (before && k % s->slow != 0);
            if (alarm && s->until_alarm) {
                return 0;
            }
        }
        if (q[0] > s->stop && t >= s->stop_time && s->touched_time < 0.0) {
            s->touched_time = t;
        }
        if (advance(s, t, q, dq, current, parameters) != 0) {
            return 5;
        }
    }
    memcpy(s->estimates, states + N, sizeof s->estimates);
    return 0;
}
