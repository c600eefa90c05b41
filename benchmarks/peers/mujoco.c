/* MuJoCo's pipelines on a compiled model. */
#include <mujoco/mujoco.h>

#include <string.h>

#include "peer.h"

static mjModel *model;
static mjData *data;

static void set(const double *q, const double *dq)
{
    memcpy(data->qpos, q, (size_t)model->nv * sizeof *q);
    memcpy(data->qvel, dq, (size_t)model->nv * sizeof *dq);
}

static const double *inverse_dynamics(const double *q, const double *dq, const double *ddq)
{
    set(q, dq);
    memcpy(data->qacc, ddq, (size_t)model->nv * sizeof *ddq);
    mj_inverse(model, data);
    return data->qfrc_inverse;
}

static const double *forward_dynamics(const double *q, const double *dq, const double *effort)
{
    set(q, dq);
    memcpy(data->qfrc_applied, effort, (size_t)model->nv * sizeof *effort);
    mj_forward(model, data);
    return data->qacc;
}

const struct peer_function *peer_open(const char *path)
{
    static struct peer_function functions[] = {
        {"inverse_dynamics", 0, inverse_dynamics}, {"forward_dynamics", 0, forward_dynamics}, {0, 0, 0}};
    model = mj_loadModel(path, 0);
    if (!model)
        return 0;
    data = mj_makeData(model);
    functions[0].size = functions[1].size = model->nv;
    return functions;
}
