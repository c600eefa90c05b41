/** One step of the watch: efforts from outside at every step, friction and payload at every SLOW-th. */
#ifndef WATCH_H
#define WATCH_H

#include "ariane4.h"

#if !ARIANE4_SINGLE
#error "compile with -DARIANE4_REAL=float"
#endif

#define SLOW 4        /**< steps of the observer in one of the monitor */
#define PARAMETERS 3  /**< FC2, FV2, M4: friction of joint 2, mass at the origin of link 4 */

typedef struct {
    float q[ARIANE4_N_JOINTS];       /**< [rad] */
    float dq[ARIANE4_N_JOINTS];      /**< [rad/s] */
    float ddq[ARIANE4_N_JOINTS];     /**< of the reference [rad/s^2] */
    float current[ARIANE4_N_JOINTS]; /**< [A] */
    float dt;                        /**< [s] */
    float slow;                      /**< 1 where the monitor takes a step, 0 elsewhere */
    float observer[ARIANE4_N_OBSERVER_STATES];
    float monitor[ARIANE4_N_MONITOR_STATES];
} watch_input_t;

typedef struct {
    float observer[ARIANE4_N_OBSERVER_STATES];
    float monitor[ARIANE4_N_MONITOR_STATES];
    float external[ARIANE4_N_JOINTS]; /**< [N m] */
    float outside;                    /**< alarms: joints that something pushes at, bit by bit */
    float changed;                    /**< alarms: parameters that have changed, bit by bit */
    float status;                     /**< ARIANE4_STATUS_ bits; the states are kept where one is set */
} watch_output_t;

/** given: a watch_input_t; result: a watch_output_t. */
int watch_step(const float given[], float result[]);

#endif
