/*
 * FMI 2.0 around the fixed steps of an arm (Functional Mock-up Interface 2.0.4): for co-simulation the steps
 * themselves, for model exchange their rates, with an indicator for every contact that slides or sticks.
 *
 * The text before this one defines N coordinates, P parameters, Y and Z states, C contacts, begin() and run(),
 *   motors(q, dq, out)   out: N motor coordinates, then their N rates
 *   GUID, STEP           of the model; the longest step [s]
 *   INITIAL[P]           values of the parameters
 *   MIDDLE[N]            coordinates at the beginning, LOW[N], HIGH[N]: where they may be
 * Declarations are those of the standard's headers as far as they are used.
 */
#include <stddef.h>
#include <stdlib.h>

#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef void *fmi2Component;
typedef void *fmi2ComponentEnvironment;
typedef void *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef char fmi2Char;
typedef char fmi2Byte;
typedef const fmi2Char *fmi2String;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated } fmi2StatusKind;
typedef struct {
    void (*logger)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
    void *(*allocateMemory)(size_t, size_t);
    void (*freeMemory)(void *);
    void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
    fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;

/* Value references: blocks one after the other, in the order of modelDescription.xml. */
enum {
    V_INPUT = 0,
    V_Q = V_INPUT + N,
    V_DQ = V_Q + N,
    V_MOTOR = V_DQ + N,
    V_MOTOR_RATE = V_MOTOR + N,
    V_STATE = V_MOTOR_RATE + N,
    V_RATE = V_STATE + Z,
    V_Q_START = V_RATE + Y,
    V_DQ_START = V_Q_START + N,
    V_STEP = V_DQ_START + N,
    V_PARAMETER = V_STEP + 1,
    V_COUNT = V_PARAMETER + P
};

typedef struct {
    double t, step;
    double y[2 * N + Z], u[N], p[AT_LEAST_1(P)], q_start[N], dq_start[N];
    int mode[AT_LEAST_1(C)];
    int initialised, moving;
} State;

typedef struct {
    fmi2Boolean newDiscreteStatesNeeded;
    fmi2Boolean terminateSimulation;
    fmi2Boolean nominalsOfContinuousStatesChanged;
    fmi2Boolean valuesOfContinuousStatesChanged;
    fmi2Boolean nextEventTimeDefined;
    fmi2Real nextEventTime;
} fmi2EventInfo;

typedef struct {
    State state;
    fmi2CallbackFunctions call;
    char name[128];
} Instance;

static fmi2Status complain(const Instance *x, const char *text)
{
    if (x->call.logger != NULL) {
        x->call.logger(x->call.componentEnvironment, x->name, fmi2Error, "logStatusError", "%s", text);
    }
    return fmi2Error;
}

static void restart(State *s)
{
    memset(s, 0, sizeof *s);
    memcpy(s->p, INITIAL, sizeof INITIAL);
    memcpy(s->q_start, MIDDLE, sizeof MIDDLE);
    s->step = STEP;
    memcpy(s->y, MIDDLE, sizeof MIDDLE);
}

/* Where a value stands; NULL for what is computed from the state, or does not exist. */
static double *value(State *s, fmi2ValueReference r)
{
    const long k = (long)r;
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
    return k < V_COUNT ? &s->p[k - V_PARAMETER] : NULL;
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

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

EXPORT fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String names[])
{
    (void)c, (void)on, (void)n, (void)names;
    return fmi2OK;
}

EXPORT fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
    const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging)
{
    (void)resources, (void)visible, (void)logging;
    Instance *x = calloc(1, sizeof *x);
    if (x == NULL) {
        return NULL;
    }
    if (functions != NULL) {
        x->call = *functions;
    }
    strncpy(x->name, name == NULL ? "" : name, sizeof x->name - 1);
    (void)type;
    if (guid == NULL || strcmp(guid, GUID) != 0) {
        complain(x, "the GUID is that of another unit");
        free(x);
        return NULL;
    }
    restart(&x->state);
    return x;
}

EXPORT void fmi2FreeInstance(fmi2Component c) { free(c); }

EXPORT fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance,
    fmi2Real start, fmi2Boolean stop_defined, fmi2Real stop)
{
    (void)tolerance_defined, (void)tolerance, (void)stop_defined, (void)stop;
    ((Instance *)c)->state.t = start;
    return fmi2OK;
}

EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    Instance *x = c;
    State *s = &x->state;
    for (int n = 0; n < N; ++n) {
        if (!(s->q_start[n] >= LOW[n] && s->q_start[n] <= HIGH[n])) {
            return complain(x, "a joint begins outside the stroke of its drive");
        }
    }
    s->initialised = 1;
    return fmi2OK;
}

EXPORT fmi2Status fmi2Terminate(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

EXPORT fmi2Status fmi2Reset(fmi2Component c)
{
    restart(&((Instance *)c)->state);
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t count, fmi2Real out[])
{
    Instance *x = c;
    for (size_t i = 0; i < count; ++i) {
        const double *at = value(&x->state, r[i]);
        if (at != NULL) {
            out[i] = *at;
        } else if ((long)r[i] >= V_MOTOR && (long)r[i] < V_STATE) {
            double both[2 * N];
            if (motors(x->state.y, x->state.y + N, both) != 0) {
                return complain(x, "there is no motor coordinate at this place");
            }
            out[i] = both[(long)r[i] - V_MOTOR];
        } else if ((long)r[i] >= V_RATE && (long)r[i] < V_Q_START) {
            Rate now;
            if (rates(&x->state, &now) != DONE) {
                return complain(x, "the accelerations are not finite");
            }
            out[i] = now.dy[(long)r[i] - V_RATE];
        } else {
            return complain(x, "there is no such variable");
        }
    }
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t count, const fmi2Real in[])
{
    Instance *x = c;
    State *s = &x->state;
    for (size_t i = 0; i < count; ++i) {
        const long k = (long)r[i];
        double *at = value(s, r[i]);
        const int given = k < V_Q || k >= V_Q_START;
        if (at == NULL || !given || !isfinite(in[i]) || (k == V_STEP && !(in[i] > 0.0))) {
            return complain(x, "found a value for no input or parameter, or one that it may not have");
        }
        if (k >= V_Q_START && k < V_STEP && s->initialised) {
            return complain(x, "the beginning is set before the initialization ends");
        }
        *at = in[i];
        if (k >= V_Q_START && k < V_STEP) {
            s->y[k - V_Q_START] = in[i];
        }
    }
    return fmi2OK;
}

EXPORT fmi2Status fmi2DoStep(fmi2Component c, fmi2Real from, fmi2Real h, fmi2Boolean final)
{
    Instance *x = c;
    State *s = &x->state;
    double path[2 * (2 * N + Z)];
    long done;
    int status;
    (void)final;
    if (!(h > 0.0)) {
        return complain(x, "the step is not above zero");
    }
    s->t = from;
    if (start(s) != DONE) {
        return complain(x, "the accelerations at the beginning are not finite");
    }
    const double count = ceil(h / s->step - 1e-9);
    const long steps = count < 1.0 ? 1 : (long)count;
    status = run(2, steps, from, h / (double)steps, s->u, N, s->p, LOW, HIGH, s->y, s->mode, path, &done);
    if (status != DONE) {
        return complain(x, status == LEFT ? "a joint left the stroke of its drive"
                : status == NOT_FINITE    ? "the state is not finite: the steps are too long, or the motion unstable"
                                          : "dry friction changes its direction without end");
    }
    s->t = from + h;
    return fmi2OK;
}

/* -- model exchange ------------------------------------------------------------------------- */

#define SLACK 1e-9 /* of an indicator: what begins to slide has no speed yet */

EXPORT fmi2Status fmi2SetTime(fmi2Component c, fmi2Real t)
{
    ((Instance *)c)->state.t = t;
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real y[], size_t count)
{
    (void)count;
    memcpy(((Instance *)c)->state.y, y, Y * sizeof(double));
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real y[], size_t count)
{
    (void)count;
    memcpy(y, ((Instance *)c)->state.y, Y * sizeof(double));
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real y[], size_t count)
{
    (void)c;
    for (size_t i = 0; i < count; ++i) {
        y[i] = 1.0;
    }
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real dy[], size_t count)
{
    Instance *x = c;
    Rate now;
    (void)count;
    if (rates(&x->state, &now) != DONE) {
        return complain(x, "the accelerations are not finite");
    }
    memcpy(dy, now.dy, Y * sizeof(double));
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real out[], size_t count)
{
    Instance *x = c;
    State *s = &x->state;
    Rate now;
    if (rates(s, &now) != DONE) {
        return complain(x, "the accelerations are not finite");
    }
    for (size_t i = 0; i < count && i < C; ++i) {
        out[i] = margin((int)i, s->mode, s->y, &now) + SLACK;
    }
    return fmi2OK;
}

EXPORT fmi2Status fmi2EnterEventMode(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

EXPORT fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

/* Contacts that came to rest stick, those that are pulled beyond their limit slide. */
EXPORT fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info)
{
    Instance *x = c;
    State *s = &x->state;
    Rate now;
    int open[AT_LEAST_1(C)], changed = 0;
    memset(info, 0, sizeof *info);
    if (rates(s, &now) != DONE) {
        return complain(x, "the accelerations are not finite");
    }
    for (int k = 0; k < C; ++k) {
        const int over = margin(k, s->mode, s->y, &now) <= 0.0;
        open[k] = s->mode[k] == 0;
        if (over && s->mode[k] != 0 && speed(k, s->y + N) * s->mode[k] < 0.0) {
            stop(k, s->y);
            s->mode[k] = 0;
            open[k] = 1;
            changed = 1;
        } else if (over && s->mode[k] == 0) {
            changed = 1;
        }
    }
    if (changed && (slip(s->t, s->y, s->y + N, s->u, s->p, s->y + 2 * N, now.out) != 0
            || settle(now.out, open, s->mode) != DONE)) {
        return complain(x, "dry friction changes its direction without end");
    }
    info->valuesOfContinuousStatesChanged = changed;
    return fmi2OK;
}

EXPORT fmi2Status fmi2CompletedIntegratorStep(
    fmi2Component c, fmi2Boolean final, fmi2Boolean *event, fmi2Boolean *end)
{
    const State *s = &((Instance *)c)->state;
    (void)final;
    *event = *end = 0;
    for (int n = 0; n < N; ++n) {
        *end |= !(s->y[n] >= LOW[n] && s->y[n] <= HIGH[n]);
    }
    return *end ? complain(c, "a joint left the stroke of its drive") : fmi2OK;
}

EXPORT fmi2Status fmi2CancelStep(fmi2Component c) { return complain(c, "no step is pending"); }

/* -- the whole state ------------------------------------------------------------------------ */

EXPORT fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *kept)
{
    Instance *x = c;
    if (*kept == NULL) {
        *kept = malloc(sizeof(State));
    }
    if (*kept == NULL) {
        return complain(x, "there is no memory");
    }
    memcpy(*kept, &x->state, sizeof(State));
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate kept)
{
    memcpy(&((Instance *)c)->state, kept, sizeof(State));
    return fmi2OK;
}

EXPORT fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *kept)
{
    (void)c;
    free(*kept);
    *kept = NULL;
    return fmi2OK;
}

EXPORT fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate kept, size_t *size)
{
    (void)c, (void)kept;
    *size = sizeof(State);
    return fmi2OK;
}

EXPORT fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate kept, fmi2Byte bytes[], size_t size)
{
    if (size < sizeof(State)) {
        return complain(c, "there is too little room for the state");
    }
    memcpy(bytes, kept, sizeof(State));
    return fmi2OK;
}

EXPORT fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *kept)
{
    if (size != sizeof(State)) {
        return complain(c, "these bytes are no state of this unit");
    }
    if (*kept == NULL) {
        *kept = malloc(sizeof(State));
    }
    if (*kept == NULL) {
        return complain(c, "there is no memory");
    }
    memcpy(*kept, bytes, sizeof(State));
    return fmi2OK;
}

/* -- what there is none of ------------------------------------------------------------------ */

#define NONE_OF(kind)                                                                                              \
    EXPORT fmi2Status fmi2Get##kind(                                                                               \
        fmi2Component c, const fmi2ValueReference r[], size_t count, fmi2##kind out[])                             \
    {                                                                                                              \
        (void)r, (void)out;                                                                                        \
        return count == 0 ? fmi2OK : complain(c, "all variables are real numbers");                                \
    }                                                                                                              \
    EXPORT fmi2Status fmi2Set##kind(                                                                               \
        fmi2Component c, const fmi2ValueReference r[], size_t count, const fmi2##kind in[])                        \
    {                                                                                                              \
        (void)r, (void)in;                                                                                         \
        return count == 0 ? fmi2OK : complain(c, "all variables are real numbers");                                \
    }

NONE_OF(Integer)
NONE_OF(Boolean)
NONE_OF(String)

EXPORT fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t unknowns,
    const fmi2ValueReference known[], size_t knowns, const fmi2Real in[], fmi2Real out[])
{
    (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)in, (void)out;
    return complain(c, "there are no directional derivatives");
}

EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t count,
    const fmi2Integer order[], const fmi2Real in[])
{
    (void)r, (void)count, (void)order, (void)in;
    return complain(c, "inputs are held over a step");
}

EXPORT fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t count,
    const fmi2Integer order[], fmi2Real out[])
{
    (void)r, (void)count, (void)order, (void)out;
    return complain(c, "there are no derivatives of outputs");
}

EXPORT fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *out)
{
    (void)kind, (void)out;
    return complain(c, "no step is pending");
}

EXPORT fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *out)
{
    if (kind != fmi2LastSuccessfulTime) {
        return complain(c, "no step is pending");
    }
    *out = ((Instance *)c)->state.t;
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *out)
{
    (void)kind, (void)out;
    return complain(c, "no step is pending");
}

EXPORT fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *out)
{
    if (kind != fmi2Terminated) {
        return complain(c, "no step is pending");
    }
    *out = 0;
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *out)
{
    (void)kind, (void)out;
    return complain(c, "no step is pending");
}
