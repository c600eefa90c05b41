#include "horizon.h"

#include <string.h>

/* The next state after an interval of Runge-Kutta 4, and its derivatives by the state and by the input. */
static ariane4_mpc_status_t interval(const double x[X], const double u[N], double next[X], double by[X][X + N])
{
    static const double place[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
    const double h = PERIOD / SUBSTEPS;
    double slope[X] = {0.0}, slope_by[X][X + N], sum[X], sum_by[X][X + N];
    int step, stage, i, j, k;
    memcpy(next, x, X * sizeof x[0]);
    for (i = 0; i < X; ++i) {
        for (j = 0; j < X + N; ++j) {
            by[i][j] = i == j ? 1.0 : 0.0;
            slope_by[i][j] = 0.0;
        }
    }
    for (step = 0; step < SUBSTEPS; ++step) {
        memset(sum, 0, sizeof sum);
        memset(sum_by, 0, sizeof sum_by);
        for (stage = 0; stage < 4; ++stage) {
            const double a = place[stage] * h, b = weight[stage] * h / 6.0;
            double point[X], point_by[X][X + N], ddq_by_q[N * N], ddq_by_dq[N * N], ddq_by_input[N * N];
            ariane4_mpc_status_t status;
            for (i = 0; i < X; ++i) {
                point[i] = next[i] + a * slope[i];
                for (j = 0; j < X + N; ++j) {
                    point_by[i][j] = by[i][j] + a * slope_by[i][j];
                }
            }
            status = ariane4_mpc_forward_dynamics_derivatives(
                point, point + N, u, PARAMETERS, slope + N, ddq_by_q, ddq_by_dq, ddq_by_input);
            if (status != ARIANE4_MPC_STATUS_OK) {
                return status;
            }
            for (i = 0; i < N; ++i) {
                double *row = slope_by[N + i];
                slope[i] = point[N + i];
                memcpy(slope_by[i], point_by[N + i], sizeof slope_by[i]);
                memset(row, 0, sizeof slope_by[i]);
                for (k = 0; k < N; ++k) {
                    for (j = 0; j < X + N; ++j) {
                        row[j] += ddq_by_q[i * N + k] * point_by[k][j] + ddq_by_dq[i * N + k] * point_by[N + k][j];
                    }
                    row[X + k] += ddq_by_input[i * N + k];
                }
            }
            for (i = 0; i < X; ++i) {
                sum[i] += b * slope[i];
                for (j = 0; j < X + N; ++j) {
                    sum_by[i][j] += b * slope_by[i][j];
                }
            }
        }
        for (i = 0; i < X; ++i) {
            next[i] += sum[i];
            for (j = 0; j < X + N; ++j) {
                by[i][j] += sum_by[i][j];
            }
        }
    }
    return ARIANE4_MPC_STATUS_OK;
}

/* Places in the strokes, and what an angle changes of them. */
static ariane4_mpc_status_t places(const double q[N], double place[N], double slope[N])
{
    static const double one[N] = {1.0, 1.0, 1.0}, zero[N] = {0.0};
    double motor[N], acceleration[N];
    const ariane4_mpc_status_t status = ariane4_mpc_motor_from_joint(q, one, zero, motor, slope, acceleration);
    int i;
    for (i = 0; i < N; ++i) {
        place[i] = (motor[i] - STROKE_LOW[i]) / (STROKE_HIGH[i] - STROKE_LOW[i]);
        slope[i] /= STROKE_HIGH[i] - STROKE_LOW[i];
    }
    return status;
}

double horizon_penalty(double place)
{
    const double below = MARGIN - place, above = place - (1.0 - MARGIN);
    const double beyond = below > above ? below : above;
    return beyond > 0.0 ? SOFT * beyond + SOFT_SQUARE * beyond * beyond : 0.0;
}

ariane4_mpc_status_t horizon_motion(const double state[X], double reference[STEPS + 1][X], motion_t *m)
{
    /* by_input[i]: derivative of the state's element by the inputs so far. */
    double by_input[X][U], moved[X][U], by[X][X + N], slope[N];
    int step, i, j, k;
    memcpy(m->state[0], state, sizeof m->state[0]);
    memset(m->hessian, 0, sizeof m->hessian);
    memset(m->place_by_input, 0, sizeof m->place_by_input);
    m->cost = 0.0;
    for (i = 0; i < U; ++i) {
        m->cost += CONTROL * m->input[i] * m->input[i];
        m->gradient[i] = 2.0 * CONTROL * m->input[i];
        m->hessian[i * U + i] = 2.0 * CONTROL;
    }
    for (step = 0; step < STEPS; ++step) {
        const int before = step * N, now = before + N;
        ariane4_mpc_status_t status = interval(m->state[step], m->input + before, m->state[step + 1], by);
        if (status != ARIANE4_MPC_STATUS_OK) {
            return status;
        }
        for (i = 0; i < X; ++i) {
            memset(moved[i], 0, (size_t)before * sizeof moved[i][0]);
            for (k = 0; k < X; ++k) {
                for (j = 0; j < before; ++j) {
                    moved[i][j] += by[i][k] * by_input[k][j];
                }
            }
            memcpy(moved[i] + before, by[i] + X, N * sizeof by[i][0]);
        }
        memcpy(by_input, moved, sizeof by_input);
        for (i = 0; i < X; ++i) {
            const double weight = i < N ? POSITION : VELOCITY;
            const double error = m->state[step + 1][i] - reference[step + 1][i];
            m->cost += weight * error * error;
            for (j = 0; j < now; ++j) {
                const double twice = 2.0 * weight * by_input[i][j];
                m->gradient[j] += twice * error;
                for (k = 0; k <= j; ++k) {
                    m->hessian[j * U + k] += twice * by_input[i][k];
                }
            }
        }
        if (step < STEPS - 1) {
            status = places(m->state[step + 1], m->place + before, slope);
            if (status != ARIANE4_MPC_STATUS_OK) {
                return status;
            }
            for (i = 0; i < N; ++i) {
                m->cost += horizon_penalty(m->place[before + i]);
                for (j = 0; j < now; ++j) {
                    m->place_by_input[(before + i) * U + j] = slope[i] * by_input[i][j];
                }
            }
        }
    }
    for (j = 0; j < U; ++j) {
        for (k = 0; k < j; ++k) {
            m->hessian[k * U + j] = m->hessian[j * U + k];
        }
    }
    return ARIANE4_MPC_STATUS_OK;
}
