/** The simulated arm: forward dynamics in double, with a step far below the controller's. */
#include "ariane4.h"

int plant_advance(double q[], double dq[], const double current[], const double parameters[], double dt, int steps);

/** Semi-implicit Euler. Returns the status of the first step that fails. */
int plant_advance(double q[], double dq[], const double current[], const double parameters[], double dt, int steps)
{
    double ddq[ARIANE4_N_JOINTS];
    int i, j;
    for (i = 0; i < steps; ++i) {
        const ariane4_status_t status = ariane4_forward_dynamics(q, dq, current, parameters, ddq);
        if (status != ARIANE4_STATUS_OK) {
            return (int)status;
        }
        for (j = 0; j < ARIANE4_N_JOINTS; ++j) {
            dq[j] += dt * ddq[j];
            q[j] += dt * dq[j];
        }
    }
    return (int)ARIANE4_STATUS_OK;
}
