#include "plan.h"

#include <math.h>
#include <string.h>

#include "utils.h" /* DAQP: daqp_update_ldp */

enum { ITERATIONS = 50, HALVINGS = 10 };

static const double DESCENT = 1e-4; /* share of the model's descent that a step must reach */

static double within(double limit, double value)
{
    return fmax(-limit, fmin(limit, value));
}

/* The quadratic program of the step from a motion: bounds of the inputs, then the soft limits of the strokes. */
static void pose(plan_t *p, motion_t *m)
{
    int i;
    for (i = 0; i < U; ++i) {
        p->lower[i] = -EFFORT[i % N] - m->input[i];
        p->upper[i] = EFFORT[i % N] - m->input[i];
    }
    for (i = 0; i < S; ++i) {
        p->lower[U + i] = MARGIN - m->place[i];
        p->upper[U + i] = 1.0 - MARGIN - m->place[i];
    }
    p->problem.H = m->hessian;
    p->problem.f = m->gradient;
    p->problem.A = m->place_by_input;
}

/* The step that solves it, 1 where there is one. The search begins at the active set of the program before. */
static int solved(plan_t *p, motion_t *m, double step[U])
{
    const int changed = DAQP_UPDATE_Rinv | DAQP_UPDATE_M | DAQP_UPDATE_v | DAQP_UPDATE_d;
    double multipliers[U + S];
    DAQPResult result;
    int flag;
    pose(p, m);
    memset(&result, 0, sizeof result);
    result.x = step;
    result.lam = multipliers;
    flag = p->allocated ? daqp_update_ldp(changed, &p->workspace, &p->problem)
                        : setup_daqp(&p->problem, &p->workspace, NULL);
    if (flag < 0) {
        return 0;
    }
    p->allocated = 1;
    daqp_solve(&result, &p->workspace);
    return result.exitflag > 0;
}

/* By how much the model of the cost falls over a step. */
static double descent(const motion_t *m, const double step[U])
{
    double change = 0.0;
    int i, j;
    for (i = 0; i < U; ++i) {
        double row = 0.0;
        for (j = 0; j < U; ++j) {
            row += m->hessian[i * U + j] * step[j];
        }
        change += (m->gradient[i] + 0.5 * row) * step[i];
    }
    for (i = 0; i < S; ++i) {
        double place = m->place[i];
        for (j = 0; j < U; ++j) {
            place += m->place_by_input[i * U + j] * step[j];
        }
        change += horizon_penalty(place) - horizon_penalty(m->place[i]);
    }
    return -change;
}

/* The last plan one interval on, its last inputs twice; or else what holds the arm against gravity where it is. */
static int begun(plan_t *p, const double state[X], double reference[STEPS + 1][X], int warm)
{
    motion_t *m = &p->motion[p->best];
    int i;
    if (warm) {
        memmove(m->input, m->input + N, (U - N) * sizeof m->input[0]);
        if (horizon_motion(state, reference, m) == ARIANE4_MPC_STATUS_OK) {
            return 1;
        }
    }
    if (ariane4_mpc_gravity(state, PARAMETERS, m->input) != ARIANE4_MPC_STATUS_OK) {
        return 0;
    }
    for (i = 0; i < U; ++i) {
        m->input[i] = within(EFFORT[i % N], m->input[i % N]);
    }
    return horizon_motion(state, reference, m) == ARIANE4_MPC_STATUS_OK;
}

void plan_begin(plan_t *p)
{
    int i;
    memset(p, 0, sizeof *p);
    daqp_default_settings(&p->settings);
    /* A soft limit that is passed by s costs w_soft s + s^2 / (2 rho_soft). */
    p->settings.w_soft = SOFT;
    p->settings.rho_soft = 0.5 / SOFT_SQUARE;
    for (i = 0; i < S; ++i) {
        p->sense[U + i] = DAQP_SOFT;
    }
    p->problem.n = U;
    p->problem.m = U + S;
    p->problem.ms = U;
    p->problem.bupper = p->upper;
    p->problem.blower = p->lower;
    p->problem.sense = p->sense;
    p->workspace.settings = &p->settings;
}

void plan_end(plan_t *p)
{
    if (p->allocated) {
        p->workspace.settings = NULL; /* it is not on the heap */
        free_daqp_workspace(&p->workspace);
        free_daqp_ldp(&p->workspace);
        p->allocated = 0;
    }
}

int plan_solve(plan_t *p, const double state[X], double reference[STEPS + 1][X], int warm)
{
    p->iterations = 0;
    p->converged = 0;
    if (!begun(p, state, reference, warm)) {
        return 0;
    }
    while (p->iterations < ITERATIONS) {
        motion_t *now = &p->motion[p->best], *next = &p->motion[1 - p->best];
        double step[U], length = 1.0, expected;
        int halvings, better = 0, i;
        if (!solved(p, now, step)) {
            break;
        }
        ++p->iterations;
        expected = descent(now, step);
        if (expected <= LEAST_DESCENT * (1.0 + now->cost)) {
            p->converged = 1;
            break;
        }
        for (halvings = 0; halvings < HALVINGS && !better; ++halvings) {
            for (i = 0; i < U; ++i) {
                next->input[i] = within(EFFORT[i % N], now->input[i] + length * step[i]);
            }
            better = horizon_motion(state, reference, next) == ARIANE4_MPC_STATUS_OK
                && next->cost <= now->cost - DESCENT * length * expected;
            length /= 2.0;
        }
        if (!better) {
            break;
        }
        p->best = 1 - p->best;
    }
    return 1;
}

const double *plan_input(const plan_t *p)
{
    return p->motion[p->best].input;
}
