/* Moreau's midpoint stepping: positions half a step ahead, velocities and the impulses of dry friction
 * together over the whole step (projected Gauss-Seidel), positions the other half. */
#include <math.h>
#include <string.h>

#include "body.h"
#include "drives.h"

#define DOFS (2 * JOINTS)
#define ROWS (2 * JOINTS)
#define SWEEPS 60
#define DELAY_LINE 4096

typedef struct {
    double q[DOFS], v[DOFS], before[DOFS]; /* links, then the motors that are not rigidly joined */
    int own[JOINTS], dofs;                 /* own: the motor's place, or -1 */
    double bristles[JOINTS][ELEMENTS], heat[JOINTS], impulse[ROWS];
    double friction_power[JOINTS];
} State;

/* In place: A = L L^T, lower. */
static int factor(int n, double A[DOFS][DOFS])
{
    for (int i = 0; i < n; ++i)
        for (int j = 0; j <= i; ++j) {
            double s = A[i][j];
            for (int k = 0; k < j; ++k) s -= A[i][k] * A[j][k];
            if (i == j) {
                if (!(s > 0.0)) return 1;
                A[i][i] = sqrt(s);
            } else A[i][j] = s / A[j][j];
        }
    return 0;
}

static void solve(int n, double L[DOFS][DOFS], double *b)
{
    for (int i = 0; i < n; ++i) {
        for (int k = 0; k < i; ++k) b[i] -= L[i][k] * b[k];
        b[i] /= L[i][i];
    }
    for (int i = n - 1; i >= 0; --i) {
        for (int k = i + 1; k < n; ++k) b[i] -= L[k][i] * b[k];
        b[i] /= L[i][i];
    }
}

static int compliant(const Plant *p, int j) { return p->stiffness[j] > 0.0; }

static void add_drag(const Plant *p, const Frames *f, const double *v, double *force)
{
    for (int b = 0; b < p->n; ++b) {
        if (!(p->drag[b] > 0.0)) continue;
        Strip strips[STRIPS];
        strips_of(p, f, b, strips);
        for (int s = 0; s < STRIPS; ++s) {
            double u[3] = {0}, along = 0.0, speed = 0.0;
            for (int j = 0; j <= b; ++j)
                for (int i = 0; i < 3; ++i) u[i] += strips[s].J[j][i] * v[j];
            for (int i = 0; i < 3; ++i) along += u[i] * strips[s].axis[i];
            for (int i = 0; i < 3; ++i) u[i] -= along * strips[s].axis[i], speed += u[i] * u[i];
            speed = sqrt(speed) * p->drag[b] * strips[s].width;
            for (int j = 0; j <= b; ++j)
                for (int i = 0; i < 3; ++i) force[j] -= speed * u[i] * strips[s].J[j][i];
        }
    }
}

static void add_floor(const Plant *p, const Frames *f, const double *v, double *force)
{
    double at[3], J[JOINTS][3], sink = 0.0;
    if (!(p->floor_stiffness > 0.0)) return;
    point_of(f, p->n - 1, p->tip, at);
    const double deep = p->floor_height - at[2];
    if (deep <= 0.0) return;
    jacobian(f, p->n - 1, at, J);
    for (int j = 0; j < p->n; ++j) sink -= J[j][2] * v[j];
    for (int j = 0; j < p->n; ++j) force[j] += p->floor_stiffness * deep * (1.0 + 0.5 * sink) * J[j][2];
}

/* A hose over two joints pulls at both once it is taut, the harder the further. */
static void add_hoses(const Plant *p, const double *q, double *force)
{
    for (int j = 0; j < p->n; ++j) {
        if (!(p->hose[j] > 0.0)) continue;
        const int other = (int)p->hose_to[j] - 1;
        const double taut = q[j] + p->hose_side[j] * q[other] - p->hose_slack[j];
        if (taut <= 0.0) continue;
        force[j] -= p->hose[j] * taut;
        force[other] -= p->hose[j] * p->hose_side[j] * taut;
    }
}

static double gravity_load(const Plant *p, const Frames *f, int j)
{
    double load = 0.0;
    for (int b = j; b < p->n; ++b) {
        double c[3], J[JOINTS][3];
        point_of(f, b, p->com[b], c);
        jacobian(f, b, c, J);
        for (int i = 0; i < 3; ++i) load -= p->mass[b] * p->gravity[i] * J[j][i];
    }
    return load;
}

/* Effort that moved the links over the step before, their weight included. */
static double carried_load(const Plant *p, const State *s, double h, double M[JOINTS][JOINTS], const double *bias, int j)
{
    double load = bias[j];
    for (int k = 0; k < p->n; ++k) load += M[j][k] * (s->v[k] - s->before[k]) / h;
    return load;
}

static int advance(const Plant *p, State *s, double t, double h, const double *current, double sag)
{
    const int n = p->n, dofs = s->dofs;
    double q[DOFS], v[DOFS], M[JOINTS][JOINTS], bias[JOINTS], A[DOFS][DOFS] = {{0}}, force[DOFS] = {0};
    double C[ROWS][DOFS] = {{0}}, solved[ROWS][DOFS], high[ROWS], low[ROWS], weight[ROWS];
    int rows = 0;
    Frames f;
    for (int i = 0; i < dofs; ++i) {
        q[i] = s->q[i] + 0.5 * h * s->v[i];
        v[i] = s->v[i] + 0.5 * (s->v[i] - s->before[i]);
    }
    place(p, q, &f);
    links(p, &f, v, M, bias);
    if (has_extras(p)) (void)add_extras(p, q, v, M, bias);
    for (int j = 0; j < n; ++j) {
        force[j] -= bias[j];
        for (int k = 0; k < n; ++k) A[j][k] = M[j][k];
    }
    add_drag(p, &f, v, force);
    add_floor(p, &f, v, force);
    add_hoses(p, q, force);
    for (int j = 0; j < n; ++j) {
        double x, slope, bend, plus, minus;
        const double lift = q[j] - p->spring_rest[j];
        force[j] -= p->spring[j] * lift + p->spring_cubic[j] * lift * lift * lift;
        if (p->spot[j] != 0.0) {
            const double z = (q[j] - p->spot_place[j]) / p->spot_width[j];
            force[j] -= p->spot[j] * exp(-0.5 * z * z);
        }
        drive(p, j, q[j], &x, &slope, &bend);
        const int own = s->own[j];
        const double speed = own < 0 ? slope * v[j] : v[own], shaft = own < 0 ? x : q[own];
        double load = 0.0;
        if (p->load_friction[j] > 0.0)
            load = (p->load_carried[j] > 0.5 ? carried_load(p, s, h, M, bias, j) : gravity_load(p, &f, j)) / slope;
        double push = motor_force(p, j, current[j], sag) - viscous_force(p, j, speed, s->heat[j])
                      - presliding(p, j, speed, h, s->bristles[j]) - ripple_force(p, j, shaft, t);
        dry_bounds(p, j, q[j], speed, load, s->heat[j], &plus, &minus);
        if (own < 0) {
            A[j][j] += slope * slope * p->rotor[j];
            force[j] += slope * (push - p->rotor[j] * bend * v[j] * v[j]);
            C[rows][j] = slope;
        } else {
            const double through = transmission_force(p, j, q[own] - x, v[own] - slope * v[j]);
            A[own][own] = p->rotor[j];
            force[own] += push - through;
            force[j] += slope * through;
            C[rows][own] = 1.0;
        }
        high[rows] = h * plus, low[rows] = -h * minus, ++rows;
        if (p->coupled_to[j] > 0.5) {
            const int other = (int)(p->coupled_to[j] + 0.5) - 1;
            const double c[2] = {1.0, p->coupling_ratio[j]};
            const int at[2] = {j, other};
            const double turn = v[j] + c[1] * v[other];
            for (int a = 0; a < 2; ++a) {
                force[at[a]] -= c[a] * p->coupling_viscous[j] * turn;
                C[rows][at[a]] = c[a];
                for (int b = 0; b < 2; ++b) A[at[a]][at[b]] += c[a] * c[b] * p->coupling_inertia[j];
            }
            high[rows] = h * p->coupling_dry[j], low[rows] = -high[rows], ++rows;
        }
    }
    if (factor(dofs, A)) return 1;
    solve(dofs, A, force);
    for (int i = 0; i < dofs; ++i) v[i] = s->v[i] + h * force[i];
    for (int r = 0; r < rows; ++r) {
        memcpy(solved[r], C[r], sizeof C[r]);
        solve(dofs, A, solved[r]);
        weight[r] = 0.0;
        for (int i = 0; i < dofs; ++i) weight[r] += C[r][i] * solved[r][i];
        const double start = fmin(fmax(s->impulse[r], low[r]), high[r]);
        s->impulse[r] = start;
        for (int i = 0; i < dofs; ++i) v[i] -= solved[r][i] * start;
    }
    for (int sweep = 0; sweep < SWEEPS; ++sweep) {
        double change = 0.0;
        for (int r = 0; r < rows; ++r) {
            double slip = 0.0;
            for (int i = 0; i < dofs; ++i) slip += C[r][i] * v[i];
            const double wanted = s->impulse[r] + slip / weight[r];
            const double next = fmin(fmax(wanted, low[r]), high[r]), step = next - s->impulse[r];
            if (step == 0.0) continue;
            s->impulse[r] = next;
            for (int i = 0; i < dofs; ++i) v[i] -= solved[r][i] * step;
            change = fmax(change, fabs(step) / (high[r] + 1e-12));
        }
        if (change < 1e-10) break;
    }
    for (int i = 0; i < dofs; ++i) {
        s->before[i] = s->v[i];
        s->v[i] = v[i];
        s->q[i] = q[i] + 0.5 * h * v[i];
        if (!(fabs(s->q[i]) < 1e9)) return 1;
    }
    for (int j = 0; j < n; ++j) { /* the drive warms by what its friction burns */
        double x, slope, bend;
        if (p->warm_up[j] == 0.0) continue;
        drive(p, j, s->q[j], &x, &slope, &bend);
        const double speed = slope * s->v[j];
        const double burnt = p->dry[j] * fabs(speed) + p->viscous[j] * speed * speed;
        s->heat[j] += h * (burnt / p->warm_power[j] - s->heat[j]) / p->warm_time[j];
    }
    return 0;
}

static double energy_of(const Plant *p, const State *s)
{
    double M[JOINTS * JOINTS], b[JOINTS], kinetic = 0.0, potential = 0.0;
    Frames f;
    place(p, s->q, &f);
    mass_and_bias(p, s->q, s->v, M, b);
    for (int j = 0; j < p->n; ++j) {
        double c[3], x, slope, bend;
        for (int k = 0; k < p->n; ++k) kinetic += 0.5 * M[j * p->n + k] * s->v[j] * s->v[k];
        drive(p, j, s->q[j], &x, &slope, &bend);
        kinetic += 0.5 * p->rotor[j] * slope * slope * s->v[j] * s->v[j];
        point_of(&f, j, p->com[j], c);
        for (int i = 0; i < 3; ++i) potential -= p->mass[j] * p->gravity[i] * c[i];
    }
    return kinetic + potential;
}

void reference(const Plant *p, double t, double *q, double *dq, double *ddq)
{
    for (int j = 0; j < p->n; ++j) {
        q[j] = p->centre[j], dq[j] = 0.0, ddq[j] = 0.0;
        for (int k = 0; k < HARMONICS; ++k) {
            const double w = 6.283185307179586 * p->frequency * (k + 1), c = cos(w * t), s = sin(w * t);
            q[j] += p->sine[j][k] * s + p->cosine[j][k] * c;
            dq[j] += w * (p->sine[j][k] * c - p->cosine[j][k] * s);
            ddq[j] -= w * w * (p->sine[j][k] * s + p->cosine[j][k] * c);
        }
    }
}

int simulate(const Plant *p, double period, int substeps, int warmup, int rows, double *out, double *energy)
{
    const int n = p->n;
    const double h = period / substeps;
    double integral[JOINTS] = {0}, filtered[JOINTS], last[JOINTS], line[DELAY_LINE][JOINTS] = {{0}};
    long tick = 0;
    State s;
    memset(&s, 0, sizeof s);
    s.dofs = n;
    double q[JOINTS], dq[JOINTS], ddq[JOINTS];
    reference(p, -warmup * period, q, dq, ddq);
    for (int j = 0; j < n; ++j) {
        double x, slope, bend;
        if (p->free > 0.5) q[j] = p->q0[j], dq[j] = p->dq0[j];
        s.q[j] = q[j], s.v[j] = s.before[j] = dq[j];
        last[j] = q[j], filtered[j] = dq[j];
        s.own[j] = -1;
        if (!compliant(p, j)) continue;
        drive(p, j, q[j], &x, &slope, &bend);
        s.own[j] = s.dofs;
        s.q[s.dofs] = x, s.v[s.dofs] = s.before[s.dofs] = slope * dq[j];
        ++s.dofs;
    }
    for (int row = -warmup; row < rows; ++row) {
        double mass[JOINTS * JOINTS], bias[JOINTS], command[JOINTS] = {0}, zero[JOINTS] = {0};
        double reading[JOINTS];
        reference(p, row * period, q, dq, ddq);
        if (p->free < 0.5) mass_and_bias(p, q, dq, mass, bias);
        for (int j = 0; j < n; ++j) {
            double x, slope, bend;
            drive(p, j, s.q[j], &x, &slope, &bend);
            const double side = p->joint_side[j] > 0.5 ? s.q[j] : s.own[j] < 0 ? x : s.q[s.own[j]];
            reading[j] = p->count[j] > 0.0 ? p->count[j] * floor(side / p->count[j] + 0.5) : side;
            if (p->free > 0.5) continue;
            const double measured = p->joint_side[j] > 0.5 ? reading[j] : joint_from_motor(p, j, reading[j]);
            filtered[j] += 0.4 * ((measured - last[j]) / period - filtered[j]);
            last[j] = measured;
            drive(p, j, q[j], &x, &slope, &bend);
            const double inertia = p->model_mass * mass[j * n + j] + slope * slope * p->rotor[j];
            double effort = p->model_mass * bias[j] + slope * slope * p->rotor[j] * ddq[j];
            for (int k = 0; k < n; ++k) effort += p->model_mass * mass[j * n + k] * ddq[k];
            effort += fabs(slope) * p->dry[j] * tanh(150.0 * dq[j]) + slope * slope * p->viscous[j] * dq[j];
            const double want = dq[j] + p->position_gain * (q[j] - measured);
            integral[j] += period * (want - filtered[j]);
            effort += inertia * (p->speed_gain * (want - filtered[j]) + p->integral_gain * integral[j]);
            command[j] = effort / (slope * p->torque_constant[j]);
            command[j] = fmin(fmax(command[j], -p->current_limit[j]), p->current_limit[j]);
        }
        if (row >= 0) {
            double *line_out = out + (long)row * 3 * n;
            for (int j = 0; j < n; ++j) {
                line_out[j] = s.q[j];
                line_out[n + j] = reading[j];
                line_out[2 * n + j] = command[j];
            }
            if (energy) energy[row] = energy_of(p, &s);
        }
        for (int sub = 0; sub < substeps; ++sub, ++tick) {
            double applied[JOINTS], power = 0.0;
            memcpy(line[tick % DELAY_LINE], command, sizeof command);
            for (int j = 0; j < n; ++j) {
                const double back = p->delay[j] / h;
                const long whole = (long)back;
                const double part = back - (double)whole;
                const double *near = tick >= whole ? line[(tick - whole) % DELAY_LINE] : zero;
                const double *far = tick > whole ? line[(tick - whole - 1) % DELAY_LINE] : zero;
                applied[j] = (1.0 - part) * near[j] + part * far[j];
                double x, slope, bend;
                drive(p, j, s.q[j], &x, &slope, &bend);
                power += fabs(p->torque_constant[j] * applied[j] * slope * s.v[j]);
            }
            const double over = power - p->sag_power;
            const double sag = p->sag > 0.0 && over > 0.0 ? 1.0 / (1.0 + p->sag * over) : 1.0;
            if (advance(p, &s, row * period + sub * h, h, applied, sag)) return 1;
        }
    }
    return 0;
}
