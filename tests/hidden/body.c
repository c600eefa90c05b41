/* Rigid bodies: Jacobians of the centres of mass in base axes, Newton and Euler projected on them.
 * Bodies that are no links (cylinders, strips in a fluid) come in through their kinetic energy, whose
 * Christoffel terms are differences of their mass matrix. */
#include "body.h"

#include <math.h>
#include <string.h>

static void cross(const double *a, const double *b, double *c)
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void turn(const double R[9], const double *a, double *b)
{
    for (int i = 0; i < 3; ++i) b[i] = R[3 * i] * a[0] + R[3 * i + 1] * a[1] + R[3 * i + 2] * a[2];
}

void place(const Plant *p, const double *q, Frames *f)
{
    double R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, o[3] = {0, 0, 0};
    for (int j = 0; j < p->n; ++j) {
        const double ca = cos(p->alpha[j]), sa = sin(p->alpha[j]);
        const double c = cos(q[j] + p->theta[j]), s = sin(q[j] + p->theta[j]);
        const double L[9] = {c, -s, 0, ca * s, ca * c, -sa, sa * s, sa * c, ca};
        const double step[3] = {p->d[j], -sa * p->r[j], ca * p->r[j]};
        double N[9], moved[3];
        turn(R, step, moved);
        for (int i = 0; i < 3; ++i) o[i] += moved[i];
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k)
                N[3 * i + k] = R[3 * i] * L[k] + R[3 * i + 1] * L[3 + k] + R[3 * i + 2] * L[6 + k];
        memcpy(R, N, sizeof R);
        memcpy(f->R[j], R, sizeof R);
        memcpy(f->o[j], o, sizeof o);
        for (int i = 0; i < 3; ++i) f->z[j][i] = R[3 * i + 2];
    }
}

void point_of(const Frames *f, int link, const double *local, double *world)
{
    if (link < 0) {
        memcpy(world, local, 3 * sizeof(double));
        return;
    }
    turn(f->R[link], local, world);
    for (int i = 0; i < 3; ++i) world[i] += f->o[link][i];
}

void jacobian(const Frames *f, int link, const double *world, double J[JOINTS][3])
{
    memset(J, 0, JOINTS * sizeof *J);
    for (int j = 0; j <= link; ++j) {
        const double arm[3] = {world[0] - f->o[j][0], world[1] - f->o[j][1], world[2] - f->o[j][2]};
        cross(f->z[j], arm, J[j]);
    }
}

/* Base-axes motion of every link: w, dw/dt and the origin's acceleration, for given ddq (may be 0). */
static void motion(const Plant *p, const Frames *f, const double *dq, const double *ddq, double w[][3],
                   double dw[][3], double a[][3])
{
    double W[3] = {0}, DW[3] = {0}, A[3] = {0}, before[3] = {0};
    for (int j = 0; j < p->n; ++j) {
        double arm[3], t1[3], t2[3], t3[3];
        for (int i = 0; i < 3; ++i) arm[i] = f->o[j][i] - before[i];
        cross(DW, arm, t1);
        cross(W, arm, t2);
        cross(W, t2, t3);
        for (int i = 0; i < 3; ++i) A[i] += t1[i] + t3[i];
        cross(W, f->z[j], t1);
        for (int i = 0; i < 3; ++i) {
            DW[i] += t1[i] * dq[j] + f->z[j][i] * (ddq ? ddq[j] : 0.0);
            W[i] += f->z[j][i] * dq[j];
        }
        memcpy(w[j], W, sizeof W);
        memcpy(dw[j], DW, sizeof DW);
        memcpy(a[j], A, sizeof A);
        memcpy(before, f->o[j], sizeof before);
    }
}

static void world_inertia(const double R[9], const double *s, double I[9])
{
    const double L[9] = {s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5]};
    double T[9];
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            T[3 * i + k] = R[3 * i] * L[k] + R[3 * i + 1] * L[3 + k] + R[3 * i + 2] * L[6 + k];
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            I[3 * i + k] = T[3 * i] * R[3 * k] + T[3 * i + 1] * R[3 * k + 1] + T[3 * i + 2] * R[3 * k + 2];
}

/* Of the links alone; bias holds Coriolis, centrifugal and gravity torques. */
void links(const Plant *p, const Frames *f, const double *dq, double M[JOINTS][JOINTS], double *bias)
{
    const int n = p->n;
    double w[JOINTS][3], dw[JOINTS][3], a[JOINTS][3];
    motion(p, f, dq, NULL, w, dw, a);
    memset(M, 0, JOINTS * sizeof *M);
    memset(bias, 0, JOINTS * sizeof *bias);
    for (int b = 0; b < n; ++b) {
        double c[3], J[JOINTS][3], I[9], arm[3], t1[3], t2[3], force[3], moment[3], Iw[3], IJ[3];
        point_of(f, b, p->com[b], c);
        jacobian(f, b, c, J);
        world_inertia(f->R[b], p->inertia[b], I);
        for (int i = 0; i < 3; ++i) arm[i] = c[i] - f->o[b][i];
        cross(w[b], arm, t1);
        cross(w[b], t1, t2);
        cross(dw[b], arm, t1);
        for (int i = 0; i < 3; ++i) force[i] = p->mass[b] * (a[b][i] + t1[i] + t2[i] - p->gravity[i]);
        turn(I, w[b], Iw);
        cross(w[b], Iw, t1);
        turn(I, dw[b], moment);
        for (int i = 0; i < 3; ++i) moment[i] += t1[i];
        for (int j = 0; j <= b; ++j) {
            bias[j] += dot(J[j], force) + dot(f->z[j], moment);
            turn(I, f->z[j], IJ);
            for (int k = 0; k <= j; ++k) M[j][k] += p->mass[b] * dot(J[j], J[k]) + dot(IJ, f->z[k]);
        }
    }
    for (int j = 0; j < n; ++j)
        for (int k = 0; k < j; ++k) M[k][j] = M[j][k];
}

/* Cylinders that swing about an anchor on the link before, the rod's end on the link itself, and the
 * fluid that strips of a link carry along across their axis. Returns their potential energy. */
static double extras(const Plant *p, const double *q, double M[JOINTS][JOINTS], double *gravity)
{
    Frames f;
    place(p, q, &f);
    double potential = 0.0;
    memset(M, 0, JOINTS * sizeof *M);
    if (gravity) memset(gravity, 0, JOINTS * sizeof *gravity);
    for (int j = 0; j < p->n; ++j) {
        if (p->cylinder_mass[j] > 0.0) {
            double A[3], B[3], JA[JOINTS][3], JB[JOINTS][3], u[3], J[JOINTS][3];
            /* The anchor turns with the link before: undo the joint's own turn. */
            const double inner = p->rev[j] * (q[j] - p->offset[j]);
            const double back = p->cylinder_anchor[j] - p->rev[j] * inner;
            const double local_a[3] = {p->l1[j] * cos(back), p->l1[j] * sin(back), 0};
            const double local_b[3] = {p->l2[j] * cos(p->cylinder_anchor[j]),
                                       p->l2[j] * sin(p->cylinder_anchor[j]), 0};
            point_of(&f, j, local_a, A);
            point_of(&f, j, local_b, B);
            jacobian(&f, j - 1, A, JA);
            jacobian(&f, j, B, JB);
            double L = 0.0;
            for (int i = 0; i < 3; ++i) u[i] = B[i] - A[i], L += u[i] * u[i];
            L = sqrt(L);
            for (int i = 0; i < 3; ++i) u[i] /= L;
            /* Two half masses about the centre stand for the body of the cylinder. */
            for (int side = -1; side <= 1; side += 2) {
                const double at = p->cylinder_centre[j] * (1.0 + 0.55 * side), m = 0.5 * p->cylinder_mass[j];
                for (int k = 0; k < p->n; ++k) {
                    double r[3];
                    for (int i = 0; i < 3; ++i) r[i] = JB[k][i] - JA[k][i];
                    const double along = dot(u, r);
                    for (int i = 0; i < 3; ++i) J[k][i] = JA[k][i] + at / L * (r[i] - along * u[i]);
                }
                for (int k = 0; k < p->n; ++k) {
                    for (int l = 0; l < p->n; ++l) M[k][l] += m * dot(J[k], J[l]);
                    if (gravity) gravity[k] -= m * dot(J[k], p->gravity);
                }
                for (int i = 0; i < 3; ++i) potential -= m * (A[i] + at * u[i]) * p->gravity[i];
            }
        }
        if (p->added_mass[j] > 0.0) {
            Strip strips[STRIPS];
            strips_of(p, &f, j, strips);
            for (int s = 0; s < STRIPS; ++s) {
                double across[JOINTS][3];
                for (int k = 0; k < p->n; ++k) {
                    const double along = dot(strips[s].J[k], strips[s].axis);
                    for (int i = 0; i < 3; ++i) across[k][i] = strips[s].J[k][i] - along * strips[s].axis[i];
                }
                const double m = p->added_mass[j] * strips[s].width;
                for (int k = 0; k < p->n; ++k)
                    for (int l = 0; l < p->n; ++l) M[k][l] += m * dot(across[k], across[l]);
            }
        }
    }
    return potential;
}

void strips_of(const Plant *p, const Frames *f, int link, Strip *strips)
{
    double begin[3], end[3], axis[3], length = 0.0;
    memcpy(begin, f->o[link], sizeof begin);
    if (link + 1 < p->n) memcpy(end, f->o[link + 1], sizeof end);
    else point_of(f, link, p->tip, end);
    for (int i = 0; i < 3; ++i) axis[i] = end[i] - begin[i], length += axis[i] * axis[i];
    length = sqrt(length);
    for (int s = 0; s < STRIPS; ++s) {
        double at[3];
        for (int i = 0; i < 3; ++i) at[i] = begin[i] + (s + 0.5) / STRIPS * axis[i];
        jacobian(f, link, at, strips[s].J);
        for (int i = 0; i < 3; ++i) strips[s].axis[i] = length > 0.0 ? axis[i] / length : 0.0;
        strips[s].width = length / STRIPS;
    }
}

int has_extras(const Plant *p)
{
    for (int j = 0; j < p->n; ++j)
        if (p->cylinder_mass[j] > 0.0 || p->added_mass[j] > 0.0) return 1;
    return 0;
}

double add_extras(const Plant *p, const double *q, const double *dq, double M[JOINTS][JOINTS], double *bias)
{
    const double step = 1e-4;
    double X[JOINTS][JOINTS], G[JOINTS], up[JOINTS][JOINTS], down[JOINTS][JOINTS], moved[JOINTS];
    const double potential = extras(p, q, X, G);
    for (int k = 0; k < p->n; ++k) {
        bias[k] += G[k];
        for (int l = 0; l < p->n; ++l) M[k][l] += X[k][l];
    }
    for (int k = 0; k < p->n; ++k) { /* dM/dq_k */
        memcpy(moved, q, sizeof moved);
        moved[k] = q[k] + step;
        extras(p, moved, up, NULL);
        moved[k] = q[k] - step;
        extras(p, moved, down, NULL);
        for (int i = 0; i < p->n; ++i)
            for (int l = 0; l < p->n; ++l) {
                const double slope = (up[i][l] - down[i][l]) / (2.0 * step);
                bias[i] += slope * dq[k] * dq[l];
                bias[k] -= 0.5 * slope * dq[i] * dq[l];
            }
    }
    return potential;
}

void mass_and_bias(const Plant *p, const double *q, const double *dq, double *mass, double *bias)
{
    Frames f;
    double M[JOINTS][JOINTS], b[JOINTS], full[JOINTS] = {0};
    memcpy(full, q, (size_t)p->n * sizeof *full);
    place(p, full, &f);
    links(p, &f, dq, M, b);
    if (has_extras(p)) (void)add_extras(p, full, dq, M, b);
    for (int j = 0; j < p->n; ++j) {
        bias[j] = b[j];
        for (int k = 0; k < p->n; ++k) mass[j * p->n + k] = M[j][k];
    }
}

void regressor(const Plant *p, int rows, const double *q, const double *dq, const double *ddq, double *out)
{
    const int n = p->n, columns = 13 * n;
    memset(out, 0, (size_t)rows * n * columns * sizeof *out);
    for (int row = 0; row < rows; ++row, q += n, dq += n, ddq += n, out += n * columns) {
        Frames f;
        double w[JOINTS][3], dw[JOINTS][3], a[JOINTS][3];
        place(p, q, &f);
        motion(p, &f, dq, ddq, w, dw, a);
        for (int b = 0; b < n; ++b) {
            double origin[3];
            for (int i = 0; i < 3; ++i) origin[i] = a[b][i] - p->gravity[i];
            for (int c = 0; c < 10; ++c) {
                double force[3] = {0}, moment[3] = {0}, t1[3], t2[3];
                if (c == 0) {
                    memcpy(force, origin, sizeof force);
                } else if (c < 4) { /* first moment along axis c - 1 of the link */
                    const double s[3] = {f.R[b][c - 1], f.R[b][3 + c - 1], f.R[b][6 + c - 1]};
                    cross(w[b], s, t1);
                    cross(w[b], t1, force);
                    cross(dw[b], s, t1);
                    for (int i = 0; i < 3; ++i) force[i] += t1[i];
                    cross(s, origin, moment);
                } else {
                    double unit[6] = {0}, I[9];
                    unit[c - 4] = 1.0;
                    world_inertia(f.R[b], unit, I);
                    turn(I, w[b], t1);
                    cross(w[b], t1, t2);
                    turn(I, dw[b], moment);
                    for (int i = 0; i < 3; ++i) moment[i] += t2[i];
                }
                for (int j = 0; j <= b; ++j) {
                    const double arm[3] = {f.o[b][0] - f.o[j][0], f.o[b][1] - f.o[j][1], f.o[b][2] - f.o[j][2]};
                    cross(arm, force, t1);
                    out[j * columns + 10 * b + c] = dot(f.z[j], t1) + dot(f.z[j], moment);
                }
            }
        }
        for (int j = 0; j < n; ++j) {
            double x, slope, bend, *line = out + j * columns, *own = line + 10 * n + 3 * j;
            drive(p, j, q[j], &x, &slope, &bend);
            const double speed = slope * dq[j];
            for (int c = 0; c < 10 * n; ++c) line[c] /= slope * p->torque_constant[j];
            own[0] = (slope * ddq[j] + bend * dq[j] * dq[j]) / p->torque_constant[j];
            own[1] = speed / p->torque_constant[j];
            own[2] = ((speed > 0.0) - (speed < 0.0)) / p->torque_constant[j];
        }
    }
}
