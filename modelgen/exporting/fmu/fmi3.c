/*
 * FMI 3.0 around a unit (Functional Mock-up Interface 3.0.2). Declarations are those of the standard's headers as
 * far as they are used.
 */
#include <stdbool.h>
#include <stdint.h>

typedef void *fmi3Instance;
typedef void *fmi3InstanceEnvironment;
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean;
typedef char fmi3Char;
typedef const fmi3Char *fmi3String;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte *fmi3Binary;
typedef bool fmi3Clock;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef enum {
    fmi3Independent,
    fmi3Constant,
    fmi3Fixed,
    fmi3Tunable,
    fmi3Discrete,
    fmi3Dependent
} fmi3DependencyKind;
typedef enum { fmi3IntervalNotYetKnown, fmi3IntervalUnchanged, fmi3IntervalChanged } fmi3IntervalQualifier;
typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment, fmi3Status, fmi3String, fmi3String);
typedef void (*fmi3ClockUpdateCallback)(fmi3InstanceEnvironment);
typedef void (*fmi3IntermediateUpdateCallback)(fmi3InstanceEnvironment, fmi3Float64, fmi3Boolean, fmi3Boolean,
    fmi3Boolean, fmi3Boolean, fmi3Boolean *, fmi3Float64 *);
typedef void (*fmi3LockPreemptionCallback)(void);
typedef void (*fmi3UnlockPreemptionCallback)(void);

typedef struct {
    State state;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
} Instance;

static State *of(fmi3Instance c) { return &((Instance *)c)->state; }

static fmi3Status answer(fmi3Instance c, const char *wrong)
{
    const Instance *x = c;
    if (wrong != NULL && x->log != NULL) {
        x->log(x->environment, fmi3Error, "logStatusError", wrong);
    }
    return wrong == NULL ? fmi3OK : fmi3Error;
}

static fmi3Instance instance(
    fmi3String token, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    Instance *x = calloc(1, sizeof *x);
    if (x == NULL) {
        return NULL;
    }
    x->environment = environment;
    x->log = log;
    if (token == NULL || strcmp(token, GUID) != 0) {
        answer(x, ELSEWHERE);
        free(x);
        return NULL;
    }
    restart(&x->state);
    return x;
}

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String names[])
{
    (void)c, (void)on, (void)n, (void)names;
    return fmi3OK;
}

EXPORT fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
    fmi3Boolean visible, fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    (void)name, (void)resources, (void)visible, (void)logging;
    return instance(token, environment, log);
}

EXPORT fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
    fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean events, fmi3Boolean early,
    const fmi3ValueReference between[], size_t count, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update_between)
{
    (void)name, (void)resources, (void)visible, (void)logging, (void)early;
    (void)events, (void)between, (void)count, (void)update_between;
    return instance(token, environment, log);
}

EXPORT fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
    fmi3Boolean visible, fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3ClockUpdateCallback clock, fmi3LockPreemptionCallback lock, fmi3UnlockPreemptionCallback unlock)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)clock, (void)lock, (void)unlock;
    if (log != NULL) {
        log(environment, fmi3Error, "logStatusError", NOT_HERE);
    }
    return NULL;
}

EXPORT void fmi3FreeInstance(fmi3Instance c) { free(c); }

EXPORT fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerance_defined, fmi3Float64 tolerance,
    fmi3Float64 from, fmi3Boolean stop_defined, fmi3Float64 stop_time)
{
    (void)tolerance_defined, (void)tolerance, (void)stop_defined, (void)stop_time;
    of(c)->t = from;
    return fmi3OK;
}

EXPORT fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return answer(c, initialised(of(c))); }
EXPORT fmi3Status fmi3EnterEventMode(fmi3Instance c) { return answer(c, NULL); }
EXPORT fmi3Status fmi3EnterStepMode(fmi3Instance c) { return answer(c, NULL); }
EXPORT fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) { return answer(c, NULL); }
EXPORT fmi3Status fmi3EnterConfigurationMode(fmi3Instance c) { return answer(c, NULL); }
EXPORT fmi3Status fmi3ExitConfigurationMode(fmi3Instance c) { return answer(c, NULL); }
EXPORT fmi3Status fmi3Terminate(fmi3Instance c) { return answer(c, NULL); }

EXPORT fmi3Status fmi3Reset(fmi3Instance c)
{
    restart(of(c));
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetFloat64(
    fmi3Instance c, const fmi3ValueReference r[], size_t count, fmi3Float64 out[], size_t values)
{
    return answer(c, count == values ? get(of(c), r, count, out) : NOT_HERE);
}

EXPORT fmi3Status fmi3SetFloat64(
    fmi3Instance c, const fmi3ValueReference r[], size_t count, const fmi3Float64 in[], size_t values)
{
    return answer(c, count == values ? set(of(c), r, count, in) : NOT_HERE);
}

EXPORT fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 from, fmi3Float64 h, fmi3Boolean final,
    fmi3Boolean *event, fmi3Boolean *end, fmi3Boolean *early, fmi3Float64 *last)
{
    const char *wrong = go(of(c), from, h);
    (void)final;
    *event = *early = false;
    *end = wrong == OUTSIDE;
    *last = of(c)->t;
    return answer(c, wrong);
}

/* -- model exchange ------------------------------------------------------------------------- */

EXPORT fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 t)
{
    of(c)->t = t;
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 y[], size_t count)
{
    (void)count;
    memcpy(of(c)->y, y, Y * sizeof(double));
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 y[], size_t count)
{
    (void)count;
    memcpy(y, of(c)->y, Y * sizeof(double));
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 y[], size_t count)
{
    (void)c;
    for (size_t i = 0; i < count; ++i) {
        y[i] = 1.0;
    }
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *count)
{
    (void)c;
    *count = Y;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *count)
{
    (void)c;
    *count = C;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 dy[], size_t count)
{
    (void)count;
    return answer(c, derivatives(of(c), dy));
}

EXPORT fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 out[], size_t count)
{
    return answer(c, indicators(of(c), out, count));
}

EXPORT fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c) { return answer(c, NULL); }

EXPORT fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *end,
    fmi3Boolean *nominals, fmi3Boolean *values, fmi3Boolean *planned, fmi3Float64 *next)
{
    int changed;
    const char *wrong = update(of(c), &changed);
    *again = *end = *nominals = *planned = false;
    *values = changed != 0;
    *next = 0.0;
    return answer(c, wrong);
}

EXPORT fmi3Status fmi3CompletedIntegratorStep(
    fmi3Instance c, fmi3Boolean final, fmi3Boolean *event, fmi3Boolean *end)
{
    const char *wrong = inside(of(c));
    (void)final;
    *event = false;
    *end = wrong != NULL;
    return answer(c, wrong);
}

/* -- the whole state ------------------------------------------------------------------------ */

EXPORT fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *kept) { return answer(c, keep(of(c), kept)); }

EXPORT fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState kept)
{
    memcpy(of(c), kept, sizeof(State));
    return fmi3OK;
}

EXPORT fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *kept)
{
    (void)c;
    free(*kept);
    *kept = NULL;
    return fmi3OK;
}

EXPORT fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState kept, size_t *size)
{
    (void)c, (void)kept;
    *size = sizeof(State);
    return fmi3OK;
}

EXPORT fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState kept, fmi3Byte bytes[], size_t size)
{
    return answer(c, to_bytes(kept, bytes, size));
}

EXPORT fmi3Status fmi3DeserializeFMUState(
    fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *kept)
{
    return answer(c, from_bytes(bytes, size, kept));
}

/* -- what there is none of ------------------------------------------------------------------ */

#define NONE_OF(kind)                                                                                              \
    EXPORT fmi3Status fmi3Get##kind(                                                                               \
        fmi3Instance c, const fmi3ValueReference r[], size_t count, fmi3##kind out[], size_t values)               \
    {                                                                                                              \
        (void)r, (void)out, (void)values;                                                                          \
        return answer(c, count == 0 ? NULL : REAL_ALONE);                                                          \
    }                                                                                                              \
    EXPORT fmi3Status fmi3Set##kind(                                                                               \
        fmi3Instance c, const fmi3ValueReference r[], size_t count, const fmi3##kind in[], size_t values)          \
    {                                                                                                              \
        (void)r, (void)in, (void)values;                                                                           \
        return answer(c, count == 0 ? NULL : REAL_ALONE);                                                          \
    }

NONE_OF(Float32)
NONE_OF(Int8)
NONE_OF(UInt8)
NONE_OF(Int16)
NONE_OF(UInt16)
NONE_OF(Int32)
NONE_OF(UInt32)
NONE_OF(Int64)
NONE_OF(UInt64)
NONE_OF(Boolean)
NONE_OF(String)

/* A function that has nothing to do where it is called for no variable. */
#define NO_CLOCKS(name, ...)                                                                                       \
    EXPORT fmi3Status name(fmi3Instance c, const fmi3ValueReference r[], size_t count, __VA_ARGS__)                \
    {                                                                                                              \
        (void)r, UNUSED;                                                                                           \
        return answer(c, count == 0 ? NULL : REAL_ALONE);                                                          \
    }

#define UNUSED (void)a, (void)b, (void)d
NO_CLOCKS(fmi3GetBinary, size_t a[], fmi3Binary b[], size_t d)
NO_CLOCKS(fmi3SetBinary, const size_t a[], const fmi3Binary b[], size_t d)
NO_CLOCKS(fmi3GetIntervalFraction, fmi3UInt64 a[], fmi3UInt64 b[], fmi3IntervalQualifier d[])
#undef UNUSED
#define UNUSED (void)a, (void)b
NO_CLOCKS(fmi3GetIntervalDecimal, fmi3Float64 a[], fmi3IntervalQualifier b[])
NO_CLOCKS(fmi3GetShiftFraction, fmi3UInt64 a[], fmi3UInt64 b[])
NO_CLOCKS(fmi3SetIntervalFraction, const fmi3UInt64 a[], const fmi3UInt64 b[])
NO_CLOCKS(fmi3SetShiftFraction, const fmi3UInt64 a[], const fmi3UInt64 b[])
#undef UNUSED
#define UNUSED (void)a
NO_CLOCKS(fmi3GetClock, fmi3Clock a[])
NO_CLOCKS(fmi3SetClock, const fmi3Clock a[])
NO_CLOCKS(fmi3GetShiftDecimal, fmi3Float64 a[])
NO_CLOCKS(fmi3SetIntervalDecimal, const fmi3Float64 a[])
NO_CLOCKS(fmi3SetShiftDecimal, const fmi3Float64 a[])

EXPORT fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference clock, fmi3Float64 t)
{
    (void)clock, (void)t;
    return answer(c, NOT_HERE);
}

EXPORT fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference r, size_t *count)
{
    (void)r, (void)count;
    return answer(c, NOT_HERE);
}

EXPORT fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference r, size_t own[],
    fmi3ValueReference others[], size_t theirs[], fmi3DependencyKind kinds[], size_t count)
{
    (void)r, (void)own, (void)others, (void)theirs, (void)kinds, (void)count;
    return answer(c, NOT_HERE);
}

#define NO_DERIVATIVE(kind)                                                                                        \
    EXPORT fmi3Status fmi3Get##kind##Derivative(fmi3Instance c, const fmi3ValueReference unknown[],                \
        size_t unknowns, const fmi3ValueReference known[], size_t knowns, const fmi3Float64 in[], size_t ins,      \
        fmi3Float64 out[], size_t outs)                                                                            \
    {                                                                                                              \
        (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)in, (void)ins, (void)out, (void)outs;      \
        return answer(c, NOT_HERE);                                                                                \
    }

NO_DERIVATIVE(Directional)
NO_DERIVATIVE(Adjoint)

EXPORT fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference r[], size_t count,
    const fmi3Int32 orders[], fmi3Float64 out[], size_t values)
{
    (void)r, (void)count, (void)orders, (void)out, (void)values;
    return answer(c, NOT_HERE);
}
