/** Inputs and outputs of the closed loop. */
#ifndef LOOP_H
#define LOOP_H

#include <stddef.h>

#include "ariane4.h"

#define JOINTS 3

typedef struct {
    double dt, centre[JOINTS], amplitude[JOINTS][2], frequency[JOINTS][2];
    double kp, kd;
    double parameters[ARIANE4_N_PARAMETERS];         /**< of the plant */
    double assumed[ARIANE4_N_PARAMETERS];            /**< of the controller */
    double drift[ARIANE4_N_PARAMETERS], drift_time;  /**< what they change by until then [s] */
    double jump[ARIANE4_N_PARAMETERS], jump_time;    /**< what they change by at that time [s] */
    double stop, stop_time, stiffness;               /**< end stop of joint 1 [rad], from when [s], [N m/rad] */
    double noise[JOINTS], noise_time;                /**< of the measured currents [A]; correlation [s] */
    long steps;
    unsigned long long seed;
    int substeps, slow, watching, until_alarm;
    long kept;                                       /**< steps before an alarm that are kept */
    double outside_time, changed_time, touched_time; /**< first alarms and contact [s], -1: none */
    long step, alarms;
    int outside, changed;
    double named_time[3];   /**< first alarm of each parameter [s], -1: none */
    double largest[JOINTS]; /**< efforts from outside that the observer gave [N m] */
    float estimates[2 * 3]; /**< of the monitor at the end, and their deviations */
} loop_t;

/** log: time, encoders and currents by step, or NULL; last: inputs of the watch before an alarm, or NULL. */
int loop(loop_t *s, double log[], float last[]);

#endif
