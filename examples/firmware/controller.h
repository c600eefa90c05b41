/** Controller of the arm ariane4: one call per millisecond. */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#include "ariane4.h"

enum { JOINTS = ARIANE4_N_JOINTS };

/** What is fed forward beside the feedback. */
enum { FEEDBACK_ONLY, GRAVITY, COMPUTED_TORQUE };

/** What the controller is given: the actuators' own encoders, and where the arm should be. */
typedef struct {
    float motor[JOINTS];       /**< motor coordinates [increments] */
    float motor_speed[JOINTS]; /**< [increments/s] */
    float q[JOINTS];           /**< reference [rad] */
    float dq[JOINTS];          /**< [rad/s] */
    float ddq[JOINTS];         /**< [rad/s^2] */
    float mode;                /**< FEEDBACK_ONLY, GRAVITY or COMPUTED_TORQUE */
} controller_input_t;

typedef struct {
    float current[JOINTS]; /**< [A], within its limit */
    float q[JOINTS];       /**< reference after the limits of the stroke [rad] */
    float status;          /**< ARIANE4_STATUS_ bits; the currents are zero where one is set */
} controller_output_t;

int controller_step(const float given[], float result[]);

#endif
