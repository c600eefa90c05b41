/* What a program that is measured offers. Inputs: q, dq, third (n each; third is ddq, or the effort of forward
 * dynamics). Each function returns where its result is, so that no peer pays for a copy. */
#ifndef PEER_H
#define PEER_H

#ifdef __cplusplus
extern "C" {
#endif

typedef const double *(*peer_call)(const double *q, const double *dq, const double *third);

struct peer_function {
    const char *name;
    int size; /* of the result */
    peer_call call;
};

/* Reads a model, where one is needed. Returns the functions, the last one without a name. */
const struct peer_function *peer_open(const char *model);

#ifdef __cplusplus
}
#endif
#endif
