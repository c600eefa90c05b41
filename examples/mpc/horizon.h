/** The cost of a motion of the arm, and its model to second order (Gauss and Newton) about the inputs. */
#ifndef HORIZON_H
#define HORIZON_H

#include "ariane4_mpc.h"
#include "values.h"

enum {
    N = ARIANE4_MPC_N_JOINTS,
    X = 2 * N,           /**< state: q, dq */
    U = STEPS * N,       /**< inputs, interval after interval */
    S = (STEPS - 1) * N, /**< places in the strokes at the ends of all intervals but the last */
};

/** The motion under some inputs, and what its cost is nearby. */
typedef struct {
    double input[U];
    double state[STEPS + 1][X];
    double cost;
    double gradient[U];         /**< of the cost without the soft limits */
    double hessian[U * U];      /**< Gauss and Newton's, of the same */
    double place[S];            /**< share of the stroke, 0 to 1 */
    double place_by_input[S * U];
} motion_t;

/**
 * Integrates from `state` under m->input, and fills in the rest of *m.
 *
 * @return status bits of the arm's functions; not 0: the motion leaves the strokes, and *m is not to be used
 */
ariane4_mpc_status_t horizon_motion(const double state[X], double reference[STEPS + 1][X], motion_t *m);

/** What the soft limits cost at a place in a stroke. */
double horizon_penalty(double place);

#endif
