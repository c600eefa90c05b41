/* What the files of the plant share. */
#ifndef HIDDEN_BODY_H
#define HIDDEN_BODY_H

#include "plant.h"

#define STRIPS 16

typedef struct {
    double R[JOINTS][9], o[JOINTS][3], z[JOINTS][3]; /* base axes, row-major */
} Frames;

typedef struct {
    double J[JOINTS][3], axis[3], width;
} Strip;

void place(const Plant *p, const double *q, Frames *f);
void point_of(const Frames *f, int link, const double *local, double *world);
void jacobian(const Frames *f, int link, const double *world, double J[JOINTS][3]);
void links(const Plant *p, const Frames *f, const double *dq, double M[JOINTS][JOINTS], double *bias);
void strips_of(const Plant *p, const Frames *f, int link, Strip *strips);
int has_extras(const Plant *p);
double add_extras(const Plant *p, const double *q, const double *dq, double M[JOINTS][JOINTS], double *bias);

#endif
