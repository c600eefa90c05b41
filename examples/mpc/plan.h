/** Sequential quadratic programming (Gauss-Newton) over the inputs of a horizon. */
#ifndef PLAN_H
#define PLAN_H

#include "api.h" /* DAQP */
#include "horizon.h"

typedef struct {
    int iterations; /**< quadratic programs solved */
    int converged;  /**< the plan is one that no step of the quadratic program betters */
    motion_t motion[2];
    int best; /**< which of the two */
    double lower[U + S], upper[U + S];
    int sense[U + S];
    DAQPProblem problem;
    DAQPSettings settings;
    DAQPWorkspace workspace;
    int allocated;
} plan_t;

/** Before the first plan. */
void plan_begin(plan_t *p);

/** Frees what the solver of the quadratic programs has allocated at the first of them. */
void plan_end(plan_t *p);

/**
 * Plans from the state measured along the reference.
 *
 * @param warm  the last plan was made one interval ago: its inputs are where the search begins
 * @return 0 where there is no plan: the arm would leave its strokes even if it were held where it is
 */
int plan_solve(plan_t *p, const double state[X], double reference[STEPS + 1][X], int warm);

/** Inputs of the first interval, [N]. */
const double *plan_input(const plan_t *p);

#endif
