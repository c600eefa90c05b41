/** The watch beside a controller: generated functions and the states that they carry along. */
#include "watch.h"

#include <string.h>

int watch_step(const float given[], float result[])
{
    watch_input_t in;
    watch_output_t out;
    ariane4_status_t status;
    float step[ARIANE4_N_MONITOR_STATES];
    float slow_dt, forgetting;

    memcpy(&in, given, sizeof in);
    memset(&out, 0, sizeof out);
    memcpy(out.observer, in.observer, sizeof out.observer);
    memcpy(out.monitor, in.monitor, sizeof out.monitor);
    status = ariane4_momentum_observer_step_identified(
        in.q, in.dq, in.current, &in.dt, ariane4_observer_gain, in.observer, step, out.external);
    if (status == ARIANE4_STATUS_OK) {
        memcpy(out.observer, step, sizeof out.observer);
        out.outside = (float)ariane4_observer_alarms(out.external);
    }
    if (in.slow > 0.0f) {
        slow_dt = (float)SLOW * in.dt;
        forgetting = 1.0f - slow_dt / (float)ARIANE4_MONITOR_MEMORY;
        if (ariane4_monitor_step_identified(in.q, in.dq, in.ddq, in.current, &forgetting, in.monitor, step)
            == ARIANE4_STATUS_OK) {
            memcpy(out.monitor, step, sizeof out.monitor);
            out.changed = (float)ariane4_monitor_alarms(out.monitor, &slow_dt);
        }
    }
    out.status = (float)status;
    memcpy(result, &out, sizeof out);
    return (int)status;
}
