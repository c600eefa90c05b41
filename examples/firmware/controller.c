/** Feedback of a position controller, with gravity or the whole inverse dynamics fed forward. */
#include "controller.h"

#include <string.h>

#include "values.h"

static float limited(float x, float low, float high)
{
    return x < low ? low : (x > high ? high : x);
}

/* The nearest reference within the strokes; at an end it stands still. */
static void keep_within_strokes(controller_input_t *in)
{
    int j;
    for (j = 0; j < JOINTS; ++j) {
        const float q = limited(in->q[j], values_low[j], values_high[j]);
        if (q < in->q[j] || q > in->q[j]) {
            in->q[j] = q;
            in->dq[j] = 0.0f;
            in->ddq[j] = 0.0f;
        }
    }
}

/** given: a controller_input_t; result: a controller_output_t. */
int controller_step(const float given[], float result[])
{
    static const float still[JOINTS] = {0.0f};
    controller_input_t in;
    controller_output_t out;
    float q[JOINTS], dq[JOINTS], ddq[JOINTS], wanted[JOINTS], model[JOINTS] = {0.0f};
    ariane4_status_t status;
    int j;

    memcpy(&in, given, sizeof in);
    memset(&out, 0, sizeof out);
    status = ariane4_joint_from_motor(in.motor, in.motor_speed, still, q, dq, ddq);
    keep_within_strokes(&in);
    for (j = 0; j < JOINTS; ++j) {
        wanted[j] = values_kp * (in.q[j] - q[j]) + values_kd * (in.dq[j] - dq[j]);
        out.q[j] = in.q[j];
    }
    if (in.mode >= (float)COMPUTED_TORQUE) {
        /* Friction at the reference's speed: the measured one would make its sign chatter at rest. */
        for (j = 0; j < JOINTS; ++j) {
            wanted[j] += in.ddq[j];
        }
        status |= ariane4_inverse_dynamics(q, in.dq, wanted, values_parameters, out.current);
    } else {
        if (in.mode >= (float)GRAVITY) {
            status |= ariane4_gravity(q, values_parameters, model);
        }
        for (j = 0; j < JOINTS; ++j) {
            out.current[j] = model[j] + values_current_per_acceleration[j] * wanted[j];
        }
    }
    for (j = 0; j < JOINTS; ++j) {
        out.current[j] = status == ARIANE4_STATUS_OK
                             ? limited(out.current[j], -values_current_limit, values_current_limit)
                             : 0.0f;
    }
    out.status = (float)status;
    memcpy(result, &out, sizeof out);
    return (int)status;
}
