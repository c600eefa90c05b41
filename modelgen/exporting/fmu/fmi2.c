/*
 * FMI 2.0 around a unit (Functional Mock-up Interface 2.0.4). Declarations are those of the standard's headers as
 * far as they are used.
 */
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

static State *of(fmi2Component c) { return &((Instance *)c)->state; }

static fmi2Status answer(fmi2Component c, const char *wrong)
{
    const Instance *x = c;
    if (wrong != NULL && x->call.logger != NULL) {
        x->call.logger(x->call.componentEnvironment, x->name, fmi2Error, "logStatusError", "%s", wrong);
    }
    return wrong == NULL ? fmi2OK : fmi2Error;
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
    (void)type, (void)resources, (void)visible, (void)logging;
    Instance *x = calloc(1, sizeof *x);
    if (x == NULL) {
        return NULL;
    }
    if (functions != NULL) {
        x->call = *functions;
    }
    strncpy(x->name, name == NULL ? "" : name, sizeof x->name - 1);
    if (guid == NULL || strcmp(guid, GUID) != 0) {
        answer(x, ELSEWHERE);
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
    of(c)->t = start;
    return fmi2OK;
}

EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return answer(c, NULL); }
EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return answer(c, initialised(of(c))); }
EXPORT fmi2Status fmi2Terminate(fmi2Component c) { return answer(c, NULL); }

EXPORT fmi2Status fmi2Reset(fmi2Component c)
{
    restart(of(c));
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t count, fmi2Real out[])
{
    return answer(c, get(of(c), r, count, out));
}

EXPORT fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t count, const fmi2Real in[])
{
    return answer(c, set(of(c), r, count, in));
}

EXPORT fmi2Status fmi2DoStep(fmi2Component c, fmi2Real from, fmi2Real h, fmi2Boolean final)
{
    (void)final;
    return answer(c, go(of(c), from, h));
}

/* -- model exchange ------------------------------------------------------------------------- */

EXPORT fmi2Status fmi2SetTime(fmi2Component c, fmi2Real t)
{
    of(c)->t = t;
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real y[], size_t count)
{
    (void)count;
    memcpy(of(c)->y, y, Y * sizeof(double));
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real y[], size_t count)
{
    (void)count;
    memcpy(y, of(c)->y, Y * sizeof(double));
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
    (void)count;
    return answer(c, derivatives(of(c), dy));
}

EXPORT fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real out[], size_t count)
{
    return answer(c, indicators(of(c), out, count));
}

EXPORT fmi2Status fmi2EnterEventMode(fmi2Component c) { return answer(c, NULL); }
EXPORT fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { return answer(c, NULL); }

EXPORT fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info)
{
    memset(info, 0, sizeof *info);
    return answer(c, update(of(c), &info->valuesOfContinuousStatesChanged));
}

EXPORT fmi2Status fmi2CompletedIntegratorStep(
    fmi2Component c, fmi2Boolean final, fmi2Boolean *event, fmi2Boolean *end)
{
    const char *wrong = inside(of(c));
    (void)final;
    *event = 0;
    *end = wrong != NULL;
    return answer(c, wrong);
}

EXPORT fmi2Status fmi2CancelStep(fmi2Component c) { return answer(c, NOT_HERE); }

/* -- the whole state ------------------------------------------------------------------------ */

EXPORT fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *kept) { return answer(c, keep(of(c), kept)); }

EXPORT fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate kept)
{
    memcpy(of(c), kept, sizeof(State));
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
    return answer(c, to_bytes(kept, bytes, size));
}

EXPORT fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *kept)
{
    return answer(c, from_bytes(bytes, size, kept));
}

/* -- what there is none of ------------------------------------------------------------------ */

#define NONE_OF(kind)                                                                                              \
    EXPORT fmi2Status fmi2Get##kind(                                                                               \
        fmi2Component c, const fmi2ValueReference r[], size_t count, fmi2##kind out[])                             \
    {                                                                                                              \
        (void)r, (void)out;                                                                                        \
        return answer(c, count == 0 ? NULL : REAL_ALONE);                                                          \
    }                                                                                                              \
    EXPORT fmi2Status fmi2Set##kind(                                                                               \
        fmi2Component c, const fmi2ValueReference r[], size_t count, const fmi2##kind in[])                        \
    {                                                                                                              \
        (void)r, (void)in;                                                                                         \
        return answer(c, count == 0 ? NULL : REAL_ALONE);                                                          \
    }

NONE_OF(Integer)
NONE_OF(Boolean)
NONE_OF(String)

EXPORT fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t unknowns,
    const fmi2ValueReference known[], size_t knowns, const fmi2Real in[], fmi2Real out[])
{
    (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)in, (void)out;
    return answer(c, NOT_HERE);
}

EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t count,
    const fmi2Integer order[], const fmi2Real in[])
{
    (void)r, (void)count, (void)order, (void)in;
    return answer(c, NOT_HERE);
}

EXPORT fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t count,
    const fmi2Integer order[], fmi2Real out[])
{
    (void)r, (void)count, (void)order, (void)out;
    return answer(c, NOT_HERE);
}

EXPORT fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *out)
{
    (void)kind, (void)out;
    return answer(c, NOT_HERE);
}

EXPORT fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *out)
{
    *out = of(c)->t;
    return answer(c, kind == fmi2LastSuccessfulTime ? NULL : NOT_HERE);
}

EXPORT fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *out)
{
    (void)kind, (void)out;
    return answer(c, NOT_HERE);
}

EXPORT fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *out)
{
    *out = 0;
    return answer(c, kind == fmi2Terminated ? NULL : NOT_HERE);
}

EXPORT fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *out)
{
    (void)kind, (void)out;
    return answer(c, NOT_HERE);
}
