/* Drives and what friction and transmission do. Dry friction is a bound on a set-valued force: the
 * stepper finds the force. */
#include "drives.h"

#include <math.h>

#define PI 3.14159265358979323846

void drive(const Plant *p, int j, double q, double *x, double *slope, double *bend)
{
    if (p->kind[j] < 0.5) {
        *x = q, *slope = 1.0, *bend = 0.0;
    } else if (p->kind[j] < 1.5) {
        *x = p->ratio[j] * q, *slope = p->ratio[j], *bend = 0.0;
    } else {
        const double inner = p->rev[j] * (q - p->offset[j]), area = p->l1[j] * p->l2[j];
        const double L = sqrt(p->l1[j] * p->l1[j] + p->l2[j] * p->l2[j] - 2.0 * area * cos(inner));
        const double units = (p->motor[j][1] - p->motor[j][0]) / (p->length[j][1] - p->length[j][0]);
        const double dL = area * sin(inner) / L;
        *x = p->motor[j][0] + units * (L - p->length[j][0]);
        *slope = units * p->rev[j] * dL;
        *bend = units * (area * cos(inner) - dL * dL) / L;
    }
}

double joint_from_motor(const Plant *p, int j, double x)
{
    if (p->kind[j] < 0.5) return x;
    if (p->kind[j] < 1.5) return x / p->ratio[j];
    const double units = (p->motor[j][1] - p->motor[j][0]) / (p->length[j][1] - p->length[j][0]);
    const double L = p->length[j][0] + (x - p->motor[j][0]) / units;
    double c = (p->l1[j] * p->l1[j] + p->l2[j] * p->l2[j] - L * L) / (2.0 * p->l1[j] * p->l2[j]);
    c = c > 1.0 ? 1.0 : c < -1.0 ? -1.0 : c;
    return p->offset[j] + p->rev[j] * acos(c);
}

/* Bounds of the dry force against motion at speed v, in both directions; `load` is what it carries. */
void dry_bounds(const Plant *p, int j, double q, double v, double load, double heat, double *plus, double *minus)
{
    const double s = fabs(v);
    double common = p->slip_distance[j] > 0.0 ? 0.0 : p->dry[j];
    if (p->stribeck[j] > 0.0)
        common += p->stribeck[j] * exp(-pow(s / p->stribeck_speed[j], p->stribeck_exponent[j]));
    common += p->load_friction[j] * fabs(load);
    if (p->power_friction[j] > 0.0)
        common += p->power_friction[j] * pow(s / p->power_speed[j], p->power_exponent[j]);
    if (p->wave_friction[j] != 0.0) {
        const double at = q + p->wave_phase[j];
        common += p->wave_friction[j] * (0.8 * sin(1.3 * at) + 0.25 * sin(2.9 * at + 1.0));
    }
    common += p->warm_up[j] * p->dry[j] * (1.0 - heat);
    *plus = common + p->dry_asymmetry[j];
    *minus = common - p->dry_asymmetry[j];
    if (*plus < 0.0) *plus = 0.0;
    if (*minus < 0.0) *minus = 0.0;
}

double viscous_force(const Plant *p, int j, double v, double heat)
{
    const double coefficient = p->viscous[j] * (1.0 + 0.7 * p->warm_up[j] * (1.0 - heat));
    return coefficient * v + p->viscous_asymmetry[j] * fabs(v);
}

/* Friction that builds up over a distance, and what it leaves behind for the next step. */
double presliding(const Plant *p, int j, double v, double h, double bristles[ELEMENTS])
{
    if (!(p->slip_distance[j] > 0.0)) return 0.0;
    if (p->slip_bristles[j] > 0.5) { /* LuGre, dz/dt = v - |v| z / distance: exact over the step */
        const double end = v > 0.0 ? p->slip_distance[j] : -p->slip_distance[j];
        const double kept = exp(-fabs(v) * h / p->slip_distance[j]), before = bristles[0];
        bristles[0] = end + (before - end) * kept;
        const double middle = 0.5 * (before + bristles[0]);
        return p->dry[j] * middle / p->slip_distance[j];
    }
    double force = 0.0; /* elements in parallel that slip one after the other */
    for (int e = 0; e < ELEMENTS; ++e) {
        const double reach = p->slip_distance[j] * (0.4 + 0.6 * e), before = bristles[e];
        double z = before + v * h;
        z = z > reach ? reach : z < -reach ? -reach : z;
        bristles[e] = z;
        force += p->dry[j] / ELEMENTS * 0.5 * (before + z) / reach;
    }
    return force;
}

double ripple_force(const Plant *p, int j, double x, double t)
{
    if (p->ripple[j] == 0.0) return 0.0;
    const double turn = 2.0 * PI * x / p->revolution[j];
    return p->ripple[j] * cos(p->ripple_order[j] * turn + p->ripple_phase[j]
                              + p->ripple_drift[j] * sin(2.0 * PI * t / 43.0));
}

/* Through a gap with Hunt and Crossley's contact, or an elastic that hardens a little. */
double transmission_force(const Plant *p, int j, double stretch, double rate)
{
    if (p->gap[j] > 0.0) {
        const double half = 0.5 * p->gap[j];
        const double deep = stretch > half ? stretch - half : stretch < -half ? -stretch - half : 0.0;
        if (deep <= 0.0) return 0.0;
        const double side = stretch > 0.0 ? 1.0 : -1.0;
        const double force = p->stiffness[j] * pow(deep, 1.5) * (1.0 + p->damping[j] * side * rate);
        return force > 0.0 ? side * force : 0.0;
    }
    return p->stiffness[j] * stretch + p->damping[j] * rate;
}

double motor_force(const Plant *p, int j, double current, double sag)
{
    if (p->saturation[j] > 0.0) current = p->saturation[j] * tanh(current / p->saturation[j]);
    return p->torque_constant[j] * current * sag;
}
