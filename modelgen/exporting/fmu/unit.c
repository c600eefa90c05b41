/*
 * An arm as a unit, before any version of the standard: for co-simulation the fixed steps themselves, for model
 * exchange their rates, with an indicator for every contact that slides or sticks.
 *
 * The text before this one defines N coordinates, P parameters, Y and Z states, C contacts, begin() and run(),
 *   motors(q, dq, out)   out: N motor coordinates, then their N rates
 *   GUID, STEP           of the model; the longest step [s]
 *   INITIAL[P]           values of the parameters
 *   MIDDLE[N]            coordinates at the beginning, LOW[N], HIGH[N]: where they may be
 * Functions give NULL where all is well, else what is wrong.
 */
#include <stddef.h>
#include <stdlib.h>

#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

/* Value references: blocks one after the other, in the order of modelDescription.xml. */
enum {
    V_INPUT = 0,
    V_Q = V_INPUT + N,
    V_DQ = V_Q + N,
    V_MOTOR = V_DQ + N,
    V_MOTOR_RATE = V_MOTOR + N,
    V_STATE = V_MOTOR_RATE + N,
    V_RATE = V_STATE + Z,
    V_CONTACT = V_RATE + Y,
    V_Q_START = V_CONTACT + C,
    V_DQ_START = V_Q_START + N,
    V_STEP = V_DQ_START + N,
    V_PARAMETER = V_STEP + 1,
    V_TIME = V_PARAMETER + P,
    V_COUNT = V_TIME + 1
};

typedef struct {
    double t, step;
    double y[2 * N + Z], u[N], p[AT_LEAST_1(P)], q_start[N], dq_start[N];
    int mode[AT_LEAST_1(C)];
    int initialised, moving;
} State;

static const char ELSEWHERE[] = "the GUID is that of another unit";
static const char NO_RATES[] = "the accelerations are not finite";
static const char NO_MEMORY[] = "there is no memory";
static const char REAL_ALONE[] = "all variables are real numbers";
static const char NOT_HERE[] = "the unit does not have this";
static const char OUTSIDE[] = "a joint left the stroke of its drive";

static void restart(State *s)
{
    memset(s, 0, sizeof *s);
    memcpy(s->p, INITIAL, sizeof INITIAL);
    memcpy(s->q_start, MIDDLE, sizeof MIDDLE);
    s->step = STEP;
    memcpy(s->y, MIDDLE, sizeof MIDDLE);
}

/* Where a value stands; NULL for what is computed from the state, or does not exist. */
static double *value(State *s, long k)
{
    if (k < V_Q) {
        return &s->u[k - V_INPUT];
    }
    if (k < V_MOTOR) {
        return &s->y[k - V_Q];
    }
    if (k < V_STATE) {
        return NULL;
    }
    if (k < V_RATE) {
        return &s->y[2 * N + k - V_STATE];
    }
    if (k < V_Q_START) {
        return NULL;
    }
    if (k < V_DQ_START) {
        return &s->q_start[k - V_Q_START];
    }
    if (k < V_STEP) {
        return &s->dq_start[k - V_DQ_START];
    }
    if (k == V_STEP) {
        return &s->step;
    }
    if (k < V_TIME) {
        return &s->p[k - V_PARAMETER];
    }
    return k == V_TIME ? &s->t : NULL;
}

static const char *initialised(State *s)
{
    for (int n = 0; n < N; ++n) {
        if (!(s->q_start[n] >= LOW[n] && s->q_start[n] <= HIGH[n])) {
            return "a joint begins outside the stroke of its drive";
        }
    }
    s->initialised = 1;
    return NULL;
}

/* Modes of the contacts, once the beginning is known. */
static int start(State *s)
{
    const int status = s->moving ? DONE : begin(s->t, s->y, s->u, s->p, s->mode);
    s->moving = s->moving || status == DONE;
    return status;
}

static int rates(State *s, Rate *now)
{
    const int status = start(s);
    return status != DONE ? status : evaluate(s->t, s->y, s->u, s->p, s->mode, now);
}

#define SLACK 1e-9 /* of an indicator: what begins to slide has no speed yet */

static double indicator(int c, const State *s, const Rate *now) { return margin(c, s->mode, s->y, now) + SLACK; }

static const char *get(State *s, const unsigned int r[], size_t count, double out[])
{
    for (size_t i = 0; i < count; ++i) {
        const long k = (long)r[i];
        const double *at = value(s, k);
        if (at != NULL) {
            out[i] = *at;
        } else if (k >= V_MOTOR && k < V_STATE) {
            double both[2 * N];
            if (motors(s->y, s->y + N, both) != 0) {
                return "there is no motor coordinate at this place";
            }
            out[i] = both[k - V_MOTOR];
        } else if (k >= V_RATE && k < V_Q_START) {
            Rate now;
            if (rates(s, &now) != DONE) {
                return NO_RATES;
            }
            out[i] = k < V_CONTACT ? now.dy[k - V_RATE] : indicator((int)(k - V_CONTACT), s, &now);
        } else {
            return "there is no such variable";
        }
    }
    return NULL;
}

static const char *set(State *s, const unsigned int r[], size_t count, const double in[])
{
    for (size_t i = 0; i < count; ++i) {
        const long k = (long)r[i];
        double *at = value(s, k);
        const int given = k < V_Q || (k >= V_Q_START && k < V_TIME);
        if (at == NULL || !given || !isfinite(in[i]) || (k == V_STEP && !(in[i] > 0.0))) {
            return "found a value for no input or parameter, or one that it may not have";
        }
        if (k >= V_Q_START && k < V_STEP && s->initialised) {
            return "the beginning is set before the initialization ends";
        }
        *at = in[i];
        if (k >= V_Q_START && k < V_STEP) {
            s->y[k - V_Q_START] = in[i];
        }
    }
    return NULL;
}

static const char *go(State *s, double from, double h)
{
    double path[2 * (2 * N + Z)];
    long done;
    int status;
    if (!(h > 0.0)) {
        return "the step is not above zero";
    }
    s->t = from;
    if (start(s) != DONE) {
        return NO_RATES;
    }
    const double count = ceil(h / s->step - 1e-9);
    const long steps = count < 1.0 ? 1 : (long)count;
    status = run(2, steps, from, h / (double)steps, s->u, N, s->p, LOW, HIGH, s->y, s->mode, path, &done);
    if (status != DONE) {
        return status == LEFT ? OUTSIDE
            : status == NOT_FINITE ? "the state is not finite: the steps are too long, or the motion unstable"
                                   : "dry friction changes its direction without end";
    }
    s->t = from + h;
    return NULL;
}

/* -- model exchange ------------------------------------------------------------------------- */

static const char *derivatives(State *s, double dy[])
{
    Rate now;
    if (rates(s, &now) != DONE) {
        return NO_RATES;
    }
    memcpy(dy, now.dy, Y * sizeof(double));
    return NULL;
}

static const char *indicators(State *s, double out[], size_t count)
{
    Rate now;
    if (rates(s, &now) != DONE) {
        return NO_RATES;
    }
    for (size_t i = 0; i < count && i < C; ++i) {
        out[i] = indicator((int)i, s, &now);
    }
    return NULL;
}

/* Contacts that came to rest stick, those that are pulled beyond their limit slide. */
static const char *update(State *s, int *changed)
{
    Rate now;
    int open[AT_LEAST_1(C)];
    *changed = 0;
    if (rates(s, &now) != DONE) {
        return NO_RATES;
    }
    for (int k = 0; k < C; ++k) {
        const int over = margin(k, s->mode, s->y, &now) <= 0.0;
        open[k] = s->mode[k] == 0;
        if (over && s->mode[k] != 0 && speed(k, s->y + N) * s->mode[k] < 0.0) {
            stop(k, s->y);
            s->mode[k] = 0;
            open[k] = 1;
            *changed = 1;
        } else if (over && s->mode[k] == 0) {
            *changed = 1;
        }
    }
    if (*changed && (slip(s->t, s->y, s->y + N, s->u, s->p, s->y + 2 * N, now.out) != 0
            || settle(now.out, open, s->mode) != DONE)) {
        return "dry friction changes its direction without end";
    }
    return NULL;
}

static const char *inside(const State *s)
{
    for (int n = 0; n < N; ++n) {
        if (!(s->y[n] >= LOW[n] && s->y[n] <= HIGH[n])) {
            return OUTSIDE;
        }
    }
    return NULL;
}

/* -- the whole state ------------------------------------------------------------------------ */

static const char *keep(const void *state, void **kept)
{
    if (*kept == NULL) {
        *kept = malloc(sizeof(State));
    }
    if (*kept == NULL) {
        return NO_MEMORY;
    }
    memcpy(*kept, state, sizeof(State));
    return NULL;
}

static const char *to_bytes(const void *kept, void *bytes, size_t size)
{
    if (size < sizeof(State)) {
        return "there is too little room for the state";
    }
    memcpy(bytes, kept, sizeof(State));
    return NULL;
}

static const char *from_bytes(const void *bytes, size_t size, void **kept)
{
    return size == sizeof(State) ? keep(bytes, kept) : "these bytes are no state of this unit";
}
