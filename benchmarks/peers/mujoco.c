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

/* The equations of motion alone, without what the pipelines do besides. */
static void positions(const double *q, const double *dq)
{
    set(q, dq);
    mj_kinematics(model, data);
    mj_comPos(model, data);
}

static const double *inverse_dynamics_alone(const double *q, const double *dq, const double *ddq)
{
    positions(q, dq);
    memcpy(data->qacc, ddq, (size_t)model->nv * sizeof *ddq);
    mj_comVel(model, data);
    mj_rne(model, data, 1, data->qfrc_inverse);
    return data->qfrc_inverse;
}

static const double *forward_dynamics_alone(const double *q, const double *dq, const double *effort)
{
    positions(q, dq);
    mj_makeM(model, data);
    mj_factorM(model, data);
    mj_comVel(model, data);
    mj_rne(model, data, 0, data->qfrc_bias);
    for (int i = 0; i < model->nv; i++)
        data->qfrc_smooth[i] = effort[i] - data->qfrc_bias[i];
    mj_solveM(model, data, data->qacc, data->qfrc_smooth, 1);
    return data->qacc;
}

const struct peer_function *peer_open(const char *path)
{
    static struct peer_function functions[] = {
        {"inverse_dynamics", 0, inverse_dynamics},
        {"forward_dynamics", 0, forward_dynamics},
        {"inverse_dynamics_alone", 0, inverse_dynamics_alone},
        {"forward_dynamics_alone", 0, forward_dynamics_alone},
        {0, 0, 0}};
    model = mj_loadModel(path, 0);
    if (!model)
        return 0;
    data = mj_makeData(model);
    for (struct peer_function *f = functions; f->name; f++)
        f->size = model->nv;
    return functions;
}
