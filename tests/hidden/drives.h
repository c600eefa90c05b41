/* Forces in the motor coordinate. */
#ifndef HIDDEN_DRIVES_H
#define HIDDEN_DRIVES_H

#include "plant.h"

void dry_bounds(const Plant *p, int j, double q, double v, double load, double heat, double *plus,
                double *minus);
double viscous_force(const Plant *p, int j, double v, double heat);
double presliding(const Plant *p, int j, double v, double h, double bristles[ELEMENTS]);
double ripple_force(const Plant *p, int j, double x, double t);
double transmission_force(const Plant *p, int j, double stretch, double rate);
double motor_force(const Plant *p, int j, double current, double sag);

#endif
