/* A robot arm with drives, friction and one or more hidden effects. SI units, radians.
 * `motor` quantities belong to the motor coordinate x of a drive; all others to the joint. */
#ifndef HIDDEN_PLANT_H
#define HIDDEN_PLANT_H

#define JOINTS 6
#define HARMONICS 5
#define ELEMENTS 5 /* of the Maxwell-slip friction */

typedef struct {
    int n;
    double gravity[3];
    /* Frame j in frame j-1: Rot(x, alpha) Trans(x, d) Rot(z, theta + q) Trans(z, r). */
    double alpha[JOINTS], d[JOINTS], r[JOINTS], theta[JOINTS];
    double mass[JOINTS], com[JOINTS][3];
    double inertia[JOINTS][6]; /* about the centre of mass: xx xy xz yy yz zz */
    double tip[3];             /* end of the last link, in its frame */

    double kind[JOINTS]; /* 0 no drive, 1 direct, 2 lever */
    double ratio[JOINTS];
    double l1[JOINTS], l2[JOINTS], rev[JOINTS], offset[JOINTS], length[JOINTS][2], motor[JOINTS][2];
    double torque_constant[JOINTS], rotor[JOINTS], viscous[JOINTS], dry[JOINTS];
    double revolution[JOINTS]; /* motor units in one turn */
    double count[JOINTS];      /* one step of the encoder: motor units, or rad where joint_side */
    double joint_side[JOINTS];

    /* Hidden effects; zero is none. */
    double dry_asymmetry[JOINTS], viscous_asymmetry[JOINTS];
    double stribeck[JOINTS], stribeck_speed[JOINTS], stribeck_exponent[JOINTS];
    double load_friction[JOINTS];
    double load_carried[JOINTS]; /* 1: by all that moves the links, 0: by their weight */
    double power_friction[JOINTS], power_speed[JOINTS], power_exponent[JOINTS];
    double wave_friction[JOINTS], wave_phase[JOINTS];
    double warm_up[JOINTS], warm_time[JOINTS], warm_power[JOINTS];
    double slip_distance[JOINTS], slip_bristles[JOINTS]; /* motor distance; 1: LuGre, 0: Maxwell slip */
    double ripple[JOINTS], ripple_order[JOINTS], ripple_phase[JOINTS], ripple_drift[JOINTS];
    double gap[JOINTS];                      /* whole width, motor coordinate */
    double stiffness[JOINTS], damping[JOINTS]; /* of the transmission, motor coordinate */
    double coupled_to[JOINTS];               /* 1 + index of the other joint */
    double coupling_ratio[JOINTS], coupling_inertia[JOINTS], coupling_viscous[JOINTS],
        coupling_dry[JOINTS];
    double cylinder_mass[JOINTS], cylinder_centre[JOINTS], cylinder_anchor[JOINTS];
    double spring[JOINTS], spring_rest[JOINTS], spring_cubic[JOINTS];
    double drag[JOINTS], added_mass[JOINTS]; /* per length of link: N s^2/m^3, kg/m */
    double saturation[JOINTS];               /* current at which tanh bends [A] */
    double delay[JOINTS];                    /* from command to torque [s] */
    double spot[JOINTS], spot_place[JOINTS], spot_width[JOINTS]; /* Gaussian torque [N m] */
    double hose[JOINTS], hose_side[JOINTS], hose_slack[JOINTS], hose_to[JOINTS]; /* N m/rad, +-1, rad, 1 + index */
    double reading_offset[JOINTS];           /* added to what is logged, not to what is controlled */
    double sag, sag_power;                   /* of the supply, per watt above sag_power */
    double floor_stiffness, floor_height;

    /* Controller and reference. */
    double centre[JOINTS], sine[JOINTS][HARMONICS], cosine[JOINTS][HARMONICS], frequency;
    double current_limit[JOINTS];
    double position_gain, speed_gain, integral_gain; /* 1/s, 1/s, 1/s^2 */
    double model_mass; /* what the feedforward takes the mass for, over the true one */
    double free;       /* 1: no current, released at q0, dq0 */
    double q0[JOINTS], dq0[JOINTS];
} Plant;

/* rows x (3 n): joint coordinate, encoder reading, current. 0, or 1 where the motion left its bounds. */
int simulate(const Plant *p, double period, int substeps, int warmup, int rows, double *out,
             double *energy);
/* rows x n x (13 n) regressor of the input: per link m, m c (3), I about the origin (6), then per
 * joint rotor, viscous, dry. */
void regressor(const Plant *p, int rows, const double *q, const double *dq, const double *ddq,
               double *out);
void reference(const Plant *p, double t, double *q, double *dq, double *ddq);
void mass_and_bias(const Plant *p, const double *q, const double *dq, double *mass, double *bias);
void drive(const Plant *p, int j, double q, double *x, double *slope, double *bend);
double joint_from_motor(const Plant *p, int j, double x);

#endif
