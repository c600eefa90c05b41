/* Steps of MuJoCo, with drives, their loops, and what MuJoCo has no model of.
 *
 * MuJoCo has the links, the rotors (armature of a tendon for each drive), dry friction (friction loss of the same
 * tendons, whose level is set anew at every step) and the integration. A drive's tendon is as long as its joint's
 * coordinate, or as its linear actuator; the motor turns by `scale` for each unit of it. SI, motors in rad.
 * ARM_NUMBERS and JOINT_NUMBERS are defined when this is compiled: the names in arms.py. */
#include <math.h>
#include <mujoco/mujoco.h>

enum { MOST = 6, ELEMENTS = 10, STRIPS = 6 };
typedef struct { double ARM_NUMBERS; } arm_t;
typedef struct { double JOINT_NUMBERS; } joint_t;
typedef struct { double current, wanted, sum, seen, rate, z, y[ELEMENTS], travelled; int way; } state_t;

static double way(double x) { return (x > 0) - (x < 0); }
static double clip(double x, double most) { return x > most ? most : x < -most ? -most : x; }

/* Effort that the weight of all that a joint carries has at it. */
static double weight(const mjModel *m, const mjData *d, int k) {
    const double *axis = d->xaxis + 3 * k, *at = d->xanchor + 3 * k, *com = d->subtree_com + 3 * (k + 1);
    const double *g = m->opt.gravity;
    double mass = m->body_subtreemass[k + 1], r[3], turned[3];
    if (m->jnt_type[k] == mjJNT_SLIDE) return mass * (axis[0] * g[0] + axis[1] * g[1] + axis[2] * g[2]);
    for (int i = 0; i < 3; i++) r[i] = com[i] - at[i];
    mju_cross(turned, r, g);
    return mass * mju_dot3(axis, turned);
}

static void push_at(const mjData *d, int body, const double point[3], const double force[3]) {
    double *w = d->xfrc_applied + 6 * body, arm[3], moment[3];
    for (int i = 0; i < 3; i++) { arm[i] = point[i] - d->xipos[3 * body + i]; w[i] += force[i]; }
    mju_cross(moment, arm, force);
    for (int i = 0; i < 3; i++) w[3 + i] += moment[i];
}

static void tip(const arm_t *arm, const mjData *d, int body, double point[3]) {
    double local[3] = {arm->tip_x, arm->tip_y, arm->tip_z};
    mju_mulMatVec3(point, d->xmat + 9 * body, local);
    mju_addTo3(point, d->xpos + 3 * body);
}

/* Forces in space: drag of the links, a spinning tool, a magnet, a tether. */
static void in_space(const mjModel *m, const mjData *d, const arm_t *arm, int n) {
    mju_zero(d->xfrc_applied, 6 * m->nbody);
    double end[3];
    tip(arm, d, n, end);
    for (int body = 1; arm->drag != 0 && body <= n; body++) {
        const double *from = d->xpos + 3 * body, *to = body < n ? d->xpos + 3 * (body + 1) : end;
        double line[3], speed[6], length;
        mju_sub3(line, to, from);
        length = mju_normalize3(line);
        if (length < 1e-6) continue;
        mj_objectVelocity(m, d, mjOBJ_XBODY, body, speed, 0);
        for (int s = 0; s < STRIPS; s++) {
            double r[3], point[3], v[3], force[3];
            mju_scl3(r, line, length * (s + 0.5) / STRIPS);
            mju_add3(point, from, r);
            mju_cross(v, speed, r);
            mju_addTo3(v, speed + 3);
            mju_addToScl3(v, line, -mju_dot3(v, line));
            mju_scl3(force, v, -arm->drag * length / STRIPS * mju_norm3(v));
            push_at(d, body, point, force);
        }
    }
    if (arm->spin != 0) { /* a wheel that keeps its momentum, along x of the last link */
        double speed[6], momentum[3], moment[3];
        for (int i = 0; i < 3; i++) momentum[i] = arm->spin * d->xmat[9 * n + 3 * i];
        mj_objectVelocity(m, d, mjOBJ_XBODY, n, speed, 0);
        mju_cross(moment, momentum, speed);
        for (int i = 0; i < 3; i++) d->xfrc_applied[6 * n + 3 + i] += moment[i];
    }
    if (arm->magnet != 0 || arm->tether != 0) {
        double anchor[3] = {arm->anchor_x, arm->anchor_y, arm->anchor_z}, to[3], force[3];
        mju_sub3(to, anchor, end);
        double far = mju_normalize3(to), near = 1 + far * far / (arm->span * arm->span);
        double stretch = far > arm->span ? far - arm->span : 0;
        mju_scl3(force, to, arm->magnet * far / arm->span / (near * near) + arm->tether * stretch * stretch);
        push_at(d, n, end, force);
    }
}

/* Friction of a drive: the part that is smooth, and the level of the dry part. All at the motor. */
static void friction(const joint_t *j, state_t *s, double q, double x, double v, double load, double h, double *heat,
                     double *smooth, double *level) {
    double speed = fabs(v), cold = exp(-*heat);
    *level = j->coulomb + j->cold_dry * cold + j->worn * tanh(0.5 * (q - j->middle) / j->wide)
           + j->by_load * sqrt(load * load + j->load_floor * j->load_floor);
    if (j->excess != 0) *level += j->excess / (1 + v * v / (j->sped * j->sped));
    *smooth = j->viscous * v + j->bias + j->cold_viscous * cold * v
            + j->skew * (sqrt(v * v + j->skew_floor * j->skew_floor) - j->skew_floor);
    if (j->warm_time > 0) *heat += h * (speed / j->warm_speed - *heat) / j->warm_time;
    if (j->bent != 0) {
        double u = v / j->bent_speed;
        *smooth += j->bent * (j->bent_form == 0 ? asinh(4 * u) / asinh(4) : j->bent_form == 1 ? u * fabs(u) : u * u * u);
    }
    if (j->bristle != 0 && j->elements == 0) { /* Dahl, integrated exactly over the step */
        s->z = way(v) + (s->z - way(v)) * exp(-speed * h / j->distance);
        *smooth += j->bristle * s->z;
    } else if (j->bristle != 0) { /* Iwan: elements in parallel that slip at distances from a fifth to thrice */
        double sum = 0;
        for (int e = 0; e < ELEMENTS; e++) {
            double yields = j->distance * 0.2 * pow(15, e / (ELEMENTS - 1.0));
            s->y[e] = clip(s->y[e] + h * v / yields, 1);
            sum += s->y[e];
        }
        *smooth += j->bristle * sum / ELEMENTS;
    }
    if (j->order != 0) *smooth += j->wave * (sin(j->order * x + j->phase) + 0.1 * sin(2 * j->order * x));
}

/* Laws that no catalogue has, as joint efforts that are added to the load. w: speed of the joint. */
static double strange(const joint_t *j, state_t *s, double q, double w, double other, double load, double h) {
    double size = j->strange_size, a = j->a, b = j->b, c = j->c;
    switch ((int)j->strange) {
    case 1: /* friction that is high after a reversal and wears off over a distance */
        if (s->way * w < 0 || s->way == 0) { s->way = w < 0 ? -1 : 1; s->travelled = 0; }
        s->travelled += fabs(w) * h;
        return size * tanh(w / b) * exp(-s->travelled / a);
    case 2: return size * other / a;                                       /* one is dragged by another, not back */
    case 3: s->z += h * a * fabs(w) * (sin(c * q + b) - s->z);             /* Duhem: a wave that trails the place */
        return size * s->z;
    case 4: return size * tanh(w / b) * other * other / (a * a);           /* clutch squeezed by another's speed */
    case 5: return size * w / a * load * load / (b * b);                   /* oil that thickens under load */
    case 6: return size * sin(q * a + c) * w * fabs(w) / (b * b);          /* fan that stands in its own wake */
    default: return 0;
    }
}

static void loop(const joint_t *j, state_t *s, const double ref[3], double x, double tick) {
    double read = floor(x / j->grain + 0.5) * j->grain;
    s->rate += j->filter * ((read - s->seen) / tick - s->rate);
    s->seen = read;
    double miss = ref[0] - read;
    double i = j->kp * miss + j->kd * (ref[1] - s->rate) + s->sum + j->forward * ref[2];
    if (fabs(i) < j->limit) s->sum += j->ki * tick * miss;
    s->wanted = clip(i, j->limit);
}

int plant_sizes(int which) { return (int)((which ? sizeof(joint_t) : sizeof(arm_t)) / sizeof(double)); }

/* ref (ticks, n, 3): motors' angles, speeds, accelerations; push (ticks, n): joint efforts from outside; gain (ticks, n):
 * factors of the torque constants; elastic: number of the joint whose rotor is the extra coordinate n, or -1;
 * begin: tick before which nothing warms up; log (ticks * per, 3 n): joints, motors, currents. Returns 1 where it ran
 * away. The state in d is where the motion begins. */
int plant_run(const mjModel *m, mjData *d, const arm_t *arm, const joint_t *joints, int n, int elastic, long ticks,
              int per, long begin, const double *ref, const double *push, const double *gain, double *log) {
    state_t states[MOST] = {{0}};
    double heat[MOST] = {0}, h = m->opt.timestep;
    int space = arm->drag != 0 || arm->spin != 0 || arm->magnet != 0 || arm->tether != 0;
    mj_forward(m, d);
    for (int k = 0; k < n; k++) states[k].seen = joints[k].scale * (d->ten_length[k] - joints[k].length0);
    for (long step = 0; step < ticks * per; step++) {
        long tick = step / per;
        double level[MOST];
        mj_step1(m, d);
        if (space) in_space(m, d, arm, n);
        for (int k = 0; k < n; k++) {
            const joint_t *j = joints + k;
            state_t *s = states + k;
            double q = d->qpos[k], w = d->qvel[k], other = d->qvel[k ? k - 1 : 1];
            double x = j->scale * (d->ten_length[k] - j->length0), v = j->scale * d->ten_velocity[k];
            double load = weight(m, d, k), none = 0, smooth, *out = log + step * 3 * n;
            if (step % per == 0) loop(j, s, ref + (tick * n + k) * 3, x, per * h);
            friction(j, s, q, x, v, load / j->scale, h, tick < begin ? &none : heat + k, &smooth, level + k);
            out[k] = q;
            out[n + k] = x;
            out[2 * n + k] = s->current;
            double full = j->knee > 0 ? j->knee * tanh(s->current / j->knee) : s->current;
            double place = 1 + j->gain_wave * sin(j->gain_order * q + j->phase);
            d->ctrl[k] = j->scale * (j->kt * gain[tick * n + k] * place * full - smooth);
            double from = q - j->rest, spring = j->spring * from * (1 + 0.1 * from * from);
            d->qfrc_applied[k] = push[tick * n + k] - spring - strange(j, s, q, w, other, load, h);
            s->current += h / j->lag * (s->wanted - s->current);
            if (k == elastic) {
                double bend = d->qpos[n] - q, half = 0.5 * j->gap;
                double reach = bend - clip(bend, half), pass = 0;
                if (half == 0 || reach != 0) pass = j->stiffness * reach + j->damping * (d->qvel[n] - w);
                if (half > 0 && pass * reach < 0) pass = 0; /* a contact does not pull */
                d->qfrc_applied[k] += pass;
                d->qfrc_applied[n] = -pass;
            }
        }
        for (int r = 0; r < d->nefc; r++)
            if (d->efc_type[r] == mjCNSTR_FRICTION_TENDON && d->efc_id[r] < n) {
                int k = d->efc_id[r];
                d->efc_frictionloss[r] = level[k] > 0 ? joints[k].scale * level[k] : 0;
            }
        mj_step2(m, d);
        for (int k = 0; k < n; k++)
            if (!(fabs(d->qpos[k]) < 1e2)) return 1;
    }
    return 0;
}
