/* Arms of family B: equations of Lagrange in absolute angles, drives with joint loops, step by step.
 *
 * Axes: 0 a vertical column (angle psi; may be locked), 1 shoulder, 2 elbow, both horizontal and parallel. With
 * phi2 = q1, phi3 = q1 + q2 and delta = phi3 - phi2 the energies are
 *   T = a2 phi2'^2 / 2 + a3 phi3'^2 / 2 + c(delta) phi2' phi3' + H(phi2, phi3) psi'^2 / 2
 *   U = -(g_r(psi) R(phi2, phi3) + g_z Z(phi2, phi3)).
 * Time stepping: leapfrog for what is smooth, Moreau's impulses by projected Gauss-Seidel for dry friction, which
 * therefore sticks exactly. All friction of a drive acts at the motor's coordinate. Units: SI, motor angles in rad. */
#include <math.h>
#include <string.h>

enum { AXES = 3, SLIPS = 4, OUT = 9 };

typedef struct {
    double offset, length, column;                    /* shoulder off the column [m], upper link [m], column [kg m^2] */
    double m2, s2x, s2y, zz2, xx2, yy2, xy2;          /* upper link: mass, first moments, inertia about its origin */
    double m3, s3x, s3y, zz3, xx3, yy3, xy3;          /* fore link */
    double w2, w2x, w2y, w3, w3x, w3y;                /* the same masses and moments, less the displaced fluid's */
    double gx, gy, gz;                                /* gravity in the base's frame */
    double drag2, drag3, reach3;                      /* N s^2/m^3 along the links; fore link's length [m] */
    double pair_a, pair_b, pair_ratio, pair_inertia, pair_viscous, pair_dry; /* a part turning with a and b */
    double locked;                                    /* 1: the column does not turn */
} arm_t;

typedef struct {
    double levered, ratio, l1, l2, rev, angle, length0, per_rad;    /* q = rev arccos(...) + angle */
    double inertia, kt, fall, elastic, stiffness, damping, gap;     /* rotor; kt (1 - fall i^2); gap: full width */
    double coulomb, viscous, shift, skew, excess, sped, shape;      /* excess exp(-|v/sped|^shape) */
    double power, power_scale, exponent, load, load_rise, slope, curve;
    double cold_dry, cold_viscous, warm_time, warm_speed;
    double bristle, distance, micro, slip;                          /* slip 0: Dahl with micro damping; 1: Maxwell-slip */
    double ripple_s, ripple_c, waves;                               /* waves per rad of the motor */
    double spring, preload;
    double strange, strange_size, a, b, c;                          /* a law outside every catalogue */
    double kp, kv, ki, limit, resolution, filter;                   /* loops in motor coordinates */
    double resistance, inductance, current_p, current_i, voltage;
} joint_t;

int plant_sizes(int which) { return (int)(which ? sizeof(joint_t) : sizeof(arm_t)) / (int)sizeof(double); }

/* Motor coordinate with its first and second derivative by q. */
static void drive(const joint_t *j, double q, double *m, double *g, double *gg) {
    if (j->levered == 0) { *m = j->ratio * q; *g = j->ratio; *gg = 0; return; }
    double u = j->rev * (q - j->angle), p = j->l1 * j->l2, s = sin(u), c = cos(u);
    double x = sqrt(j->l1 * j->l1 + j->l2 * j->l2 - 2 * p * c);
    *m = (x - j->length0) / j->per_rad;
    *g = j->rev * p * s / x / j->per_rad;
    *gg = (p * c / x - p * p * s * s / (x * x * x)) / j->per_rad;
}

/* Gravity's and the velocities' part of the joint efforts, and the inertia matrix, of the links alone. */
static void links(const arm_t *r, const double q[], const double v[], double mass[3][3], double weight[], double swirl[]) {
    double f2 = q[1], f3 = q[1] + q[2], d2 = v[1], d3 = v[1] + v[2], dp = v[0];
    double c2 = cos(f2), s2 = sin(f2), c3 = cos(f3), s3 = sin(f3), cd = c3 * c2 + s3 * s2, sd = s3 * c2 - c3 * s2;
    double cp = cos(q[0]), sp = sin(q[0]), L = r->length, e = r->offset;
    double a2 = r->zz2 + r->m3 * L * L, a3 = r->zz3;
    double c = L * (r->s3x * cd - r->s3y * sd), dc = L * (-r->s3x * sd - r->s3y * cd);
    double x2 = r->s2x * c2 - r->s2y * s2, z2 = r->s2x * s2 + r->s2y * c2; /* first moments: outwards, upwards */
    double x3 = r->s3x * c3 - r->s3y * s3, z3 = r->s3x * s3 + r->s3y * c3;
    double out = e + L * c2;                                               /* where the elbow is */
    double H = r->column + r->xx2 * s2 * s2 + r->yy2 * c2 * c2 + 2 * r->xy2 * s2 * c2 + r->m2 * e * e + 2 * e * x2
             + r->xx3 * s3 * s3 + r->yy3 * c3 * c3 + 2 * r->xy3 * s3 * c3 + r->m3 * out * out + 2 * out * x3;
    double H2 = 2 * (r->xx2 - r->yy2) * s2 * c2 + 2 * r->xy2 * (c2 * c2 - s2 * s2) - 2 * e * z2
              - 2 * r->m3 * out * L * s2 - 2 * L * s2 * x3;
    double H3 = 2 * (r->xx3 - r->yy3) * s3 * c3 + 2 * r->xy3 * (c3 * c3 - s3 * s3) - 2 * out * z3;
    double wx2 = r->w2x * c2 - r->w2y * s2, wz2 = r->w2x * s2 + r->w2y * c2;
    double wx3 = r->w3x * c3 - r->w3y * s3, wz3 = r->w3x * s3 + r->w3y * c3;
    double gr = r->gx * cp + r->gy * sp, gn = -r->gx * sp + r->gy * cp, gz = r->gz;
    double R = r->w2 * e + wx2 + r->w3 * out + wx3;
    double u2 = -(gr * (-wz2 - r->w3 * L * s2) + gz * (wx2 + r->w3 * L * c2)), u3 = -(gr * -wz3 + gz * wx3);
    memset(mass, 0, 9 * sizeof(double));
    mass[0][0] = H;
    mass[1][1] = a2 + a3 + 2 * c;
    mass[1][2] = mass[2][1] = a3 + c;
    mass[2][2] = a3;
    weight[0] = -gn * R;
    weight[1] = u2 + u3;
    weight[2] = u3;
    double b2 = dc * d3 * d3 - 0.5 * H2 * dp * dp, b3 = -dc * d2 * d2 - 0.5 * H3 * dp * dp;
    swirl[0] = (H2 * d2 + H3 * d3) * dp;
    swirl[1] = b2 + b3;
    swirl[2] = b3;
}

/* Drag on both links, by three points of Gauss each: efforts that brake. */
static void drag(const arm_t *r, const double q[], const double v[], double effort[]) {
    static const double at[3] = {0.1127016653792583, 0.5, 0.8872983346207417}, by[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double f2 = q[1], f3 = q[1] + q[2], d2 = v[1], d3 = v[1] + v[2];
    for (int link = 0; link < 2; link++) {
        double cd = link ? r->drag3 : r->drag2, length = link ? r->reach3 : r->length;
        if (cd == 0) continue;
        for (int k = 0; k < 3; k++) {
            double x = at[k] * length, f = link ? f3 : f2;
            double lever = link ? r->length * cos(f3 - f2) : x;
            double across = link ? lever * d2 + x * d3 : x * d2; /* in the plane, normal to the link */
            double out = r->offset + (link ? r->length * cos(f2) + x * cos(f) : x * cos(f2));
            double side = out * v[0], speed = sqrt(across * across + side * side);
            double w = cd * by[k] * length * speed;
            double e3 = link ? w * across * x : 0, e2 = w * across * lever;
            effort[0] += w * side * out;
            effort[1] += e2 + e3;
            effort[2] += e3;
        }
    }
}

static void solve(double m[3][3], const double b[], double x[]) {
    double d = m[1][1] * m[2][2] - m[1][2] * m[2][1], e = m[1][0] * m[2][2] - m[1][2] * m[2][0];
    double f = m[1][0] * m[2][1] - m[1][1] * m[2][0], det = m[0][0] * d - m[0][1] * e + m[0][2] * f;
    x[0] = (b[0] * d - m[0][1] * (b[1] * m[2][2] - m[1][2] * b[2]) + m[0][2] * (b[1] * m[2][1] - m[1][1] * b[2])) / det;
    x[1] = (m[0][0] * (b[1] * m[2][2] - m[1][2] * b[2]) - b[0] * e + m[0][2] * (m[1][0] * b[2] - b[1] * m[2][0])) / det;
    x[2] = (m[0][0] * (m[1][1] * b[2] - b[1] * m[2][1]) - m[0][1] * (m[1][0] * b[2] - b[1] * m[2][0]) + b[0] * f) / det;
}

static double sign(double x) { return (x > 0) - (x < 0); }

/* Laws outside the catalogue, as joint efforts that brake. memory: two states of the law. */
static double strange(const joint_t *j, double q, double v, double other, double other_v, double h, double memory[]) {
    double size = j->strange_size, a = j->a, b = j->b, c = j->c;
    switch ((int)j->strange) {
    case 1: return size * sin(a * v) * cos(b * q + c);                        /* product of speed and position */
    case 2: return size * sin(a * q + c) * tanh(b * other_v);                 /* another joint's speed, by position */
    case 3: return size * v * other_v * cos(a * q + c) / b;                   /* product of two joints' speeds */
    case 4:                                                                   /* hose: long hysteresis, taut outwards */
        memory[0] += h * v / a * (1 - sign(v) * memory[0]);
        return size * memory[0] * (1 + 0.8 * sin(b * q + c));
    case 5:                                                                   /* Bouc-Wen with a sharp knee, not even */
        memory[0] += h * v / a * (1 - (0.5 * sign(v * memory[0]) + 0.5) * pow(fabs(memory[0]), 3));
        return size * memory[0] * (memory[0] > 0 ? 1 : b);
    case 6: {                                                                 /* hard spot */
        double d = (q - a) / b;
        return size * exp(-d * d) * tanh(v / 0.01);
    }
    case 7: return q > a ? size * pow((q - a) / b, 1.5) : 0;                  /* cushion at the end of the range */
    case 8:                                                                   /* viscoelastic hose: spring and dashpot */
        memory[0] += h * (v - memory[0] / a);
        return size * memory[0];
    case 9: return size * v * sin(a * q + c);                                 /* oil film, thick by place */
    case 10: return size * cos(a * (q + other) + c) * tanh(v / b);            /* bearing squeezed by the pose */
    case 11:                                                                  /* friction that recalls the mean speed */
        memory[0] += h * (fabs(v) - memory[0]) / a;
        return size * tanh(v / 0.01) * memory[0] / b;
    default: return 0;
    }
}

/* Smooth part of the drive's friction, and the level of its dry part, at the motor. state: heat, load, bristles. */
static void friction(const joint_t *j, double q, double m, double v, double load, double h, double state[],
                     double *smooth, double *level) {
    double now = j->load_rise > 0 ? (state[1] += h * (load - state[1]) / j->load_rise) : load;
    double cold = 1 - state[0], speed = fabs(v);
    if (j->warm_time > 0) state[0] += h * (speed / j->warm_speed - state[0]) / j->warm_time;
    *level = j->coulomb + j->load * fabs(now) + j->slope * q + j->curve * q * q + cold * j->cold_dry;
    if (j->excess != 0) *level += j->excess * exp(-pow(speed / j->sped, j->shape));
    *smooth = j->viscous * v + j->shift + j->skew * speed + cold * j->cold_viscous * v;
    if (j->power != 0) *smooth += j->power * pow(speed / j->power_scale, j->exponent) * sign(v);
    if (j->waves != 0) *smooth += j->ripple_s * sin(j->waves * m) + j->ripple_c * cos(j->waves * m);
}

static double bristles(const joint_t *j, double v, double h, double z[]) {
    double step = h * v / j->distance;
    if (j->slip == 0) {
        double before = z[0];
        z[0] = (z[0] + step) / (1 + fabs(step));
        return j->bristle * (z[0] + j->micro * (z[0] - before) / h);
    }
    double sum = 0;
    for (int k = 0; k < SLIPS; k++) { /* elements that yield one after the other */
        z[k] += step * 2.0 / (k + 1);
        z[k] = z[k] > 1 ? 1 : z[k] < -1 ? -1 : z[k];
        sum += z[k] / SLIPS;
    }
    return j->bristle * sum;
}

/* Run: reference [ticks][3 angles, 3 speeds] at the motors, push [ticks][3] joint efforts, gain [ticks] factor of all
 * torque constants; a tick has `per` steps of h. heat is in and out. log [steps][link angles, motor angles, currents].
 * Returns 0, or 1 where the motion is not finite. */
int plant_run(const arm_t *arm, const joint_t joint[], int ticks, int per, double h, int begin, const double *reference,
              const double *push, const double *gain, const double start[], double heat[], double *log) {
    double q[3], v[3], at[3], a[3] = {0}, turn[3], turned[3], turn_a[3] = {0}, state[3][2] = {{0}}, z[3][SLIPS] = {{0}};
    double memory[3][2] = {{0}}, current[3] = {0}, wanted[3] = {0}, sum[3] = {0}, volts[3] = {0}, before[3], rate[3] = {0};
    double impulse[3] = {0}, last[3] = {0};
    for (int j = 0; j < AXES; j++) {
        double g, gg;
        q[j] = start[j]; v[j] = start[3 + j];
        turn[j] = q[j]; turned[j] = v[j];
        drive(&joint[j], q[j], &before[j], &g, &gg);
        state[j][0] = heat[j];
    }
    for (long n = 0; n < (long)ticks * per; n++) {
        long tick = n / per;
        double mass[3][3], weight[3], swirl[3], effort[3] = {0}, level[3], m[3], g[3], gg[3], x[3];
        if (n == (long)begin * per) for (int j = 0; j < AXES; j++) state[j][0] = heat[j];
        for (int j = 0; j < AXES; j++) at[j] = v[j] + 0.5 * h * a[j];
        links(arm, q, at, mass, weight, swirl);
        double slow[3] = {0};
        drag(arm, q, at, slow);
        for (int j = 0; j < AXES; j++) {
            const joint_t *d = &joint[j];
            int k = j == 2 ? 1 : 2; /* the neighbour that some laws look at */
            double angle = d->elastic ? turn[j] : q[j], speed = d->elastic ? turned[j] + 0.5 * h * turn_a[j] : at[j], smooth;
            drive(d, angle, &m[j], &g[j], &gg[j]);
            if (n % per == 0) { /* the joint's loops */
                const double *r = reference + tick * 6;
                double read = d->resolution > 0 ? floor(m[j] / d->resolution + 0.5) * d->resolution : m[j];
                rate[j] += d->filter * ((read - before[j]) / (per * h) - rate[j]);
                before[j] = read;
                double miss = d->kp * (r[j] - read) + r[3 + j] - rate[j], i = d->kv * miss + sum[j];
                if (fabs(i) < d->limit) sum[j] += d->ki * per * h * miss;
                wanted[j] = i > d->limit ? d->limit : i < -d->limit ? -d->limit : i;
            }
            friction(d, q[j], m[j], g[j] * speed, d->load_rise > 0 ? last[j] / g[j] : weight[j] / g[j], h,
                     state[j], &smooth, &level[j]);
            if (d->bristle != 0) smooth += bristles(d, g[j] * speed, h, z[j]);
            double torque = d->kt * gain[tick] * current[j] * (1 - d->fall * current[j] * current[j]) - smooth;
            double extra = d->spring * q[j] + d->preload
                         + strange(d, q[j], at[j], q[k], at[k], h, memory[j]) - push[tick * 3 + j];
            effort[j] = -weight[j] - swirl[j] - slow[j] - extra;
            level[j] = level[j] > 0 ? g[j] * level[j] : 0;
            level[j] = fabs(level[j]);
            if (d->elastic) {
                double bend = turn[j] - q[j], half = 0.5 * d->gap, reach = bend > half ? bend - half : bend < -half ? bend + half : 0;
                double pass = reach == 0 ? 0 : d->stiffness * reach + d->damping * (speed - at[j]);
                double own = d->inertia * g[j] * g[j], free_v = turned[j] + h * (g[j] * torque - pass) / own;
                double stop = free_v * own, most = h * level[j];
                stop = stop > most ? most : stop < -most ? -most : stop;
                double next = free_v - stop / own;
                effort[j] += pass;
                turn_a[j] = (next - turned[j]) / h;
                turned[j] = next;
                level[j] = 0;
            } else {
                mass[j][j] += d->inertia * g[j] * g[j];
                effort[j] += g[j] * torque - d->inertia * g[j] * gg[j] * at[j] * at[j];
            }
            double *out = log + n * OUT;
            out[j] = q[j]; out[3 + j] = m[j]; out[6 + j] = current[j];
            double speed_m = g[j] * speed, miss = wanted[j] - current[j];
            volts[j] += d->current_i * h * miss;
            double u = d->current_p * miss + volts[j];
            if (fabs(u) > d->voltage) { volts[j] -= d->current_i * h * miss; u = sign(u) * d->voltage; }
            current[j] += h * (u - d->resistance * current[j] - d->kt * speed_m) / d->inductance;
        }
        if (arm->pair_ratio != 0) {
            int i = (int)arm->pair_a, k = (int)arm->pair_b;
            double ratio = arm->pair_ratio, w = at[i] + ratio * at[k];
            double brake = arm->pair_viscous * w + arm->pair_dry * tanh(w / 0.005);
            effort[i] -= brake; effort[k] -= ratio * brake;
            mass[i][i] += arm->pair_inertia; mass[k][k] += ratio * ratio * arm->pair_inertia;
            mass[i][k] += ratio * arm->pair_inertia; mass[k][i] += ratio * arm->pair_inertia;
        }
        if (arm->locked != 0) { mass[0][0] = 1; mass[0][1] = mass[0][2] = mass[1][0] = mass[2][0] = 0; effort[0] = 0; level[0] = 0; }
        solve(mass, effort, x);
        double free_v[3], inverse[3][3];
        int dry = 0;
        for (int j = 0; j < AXES; j++) {
            free_v[j] = v[j] + h * x[j];
            dry |= level[j] > 0;
        }
        if (dry) {
            for (int j = 0; j < AXES; j++) {
                double unit[3] = {0};
                unit[j] = 1;
                solve(mass, unit, inverse[j]);
                double most = h * level[j];
                impulse[j] = impulse[j] > most ? most : impulse[j] < -most ? -most : impulse[j];
            }
            for (int j = 0; j < AXES; j++)
                for (int k = 0; k < AXES; k++) free_v[k] -= inverse[j][k] * impulse[j];
            for (int turns = 0; turns < 30; turns++) {
                double moved = 0;
                for (int j = 0; j < AXES; j++) {
                    if (level[j] == 0) { impulse[j] = 0; continue; }
                    double most = h * level[j], p = impulse[j] + free_v[j] / inverse[j][j];
                    p = p > most ? most : p < -most ? -most : p;
                    double change = p - impulse[j];
                    for (int k = 0; k < AXES; k++) free_v[k] -= inverse[j][k] * change;
                    moved += fabs(change) / most;
                    impulse[j] = p;
                }
                if (moved < 1e-9) break;
            }
        }
        for (int j = 0; j < AXES; j++) {
            a[j] = (free_v[j] - v[j]) / h;
            v[j] = free_v[j];
            q[j] += h * v[j];
            turn[j] = joint[j].elastic ? turn[j] + h * turned[j] : q[j];
            if (!(fabs(q[j]) < 1e3)) return 1;
        }
        for (int j = 0; j < AXES; j++) {
            last[j] = weight[j] + swirl[j];
            for (int k = 0; k < AXES; k++) last[j] += (joint[j].elastic || k != j ? mass[j][k] : mass[j][k] - joint[j].inertia * g[j] * g[j]) * a[k];
        }
    }
    for (int j = 0; j < AXES; j++) heat[j] = state[j][0];
    return 0;
}
