/*
 * Fixed steps of an arm with dry friction, around the arm's generated functions.
 *
 * The text before this one defines N coordinates, C contacts and Z states (C and Z may be 0), ROWS, and
 *   slip(t, q, dq, u, p, z, out)        out: N free accelerations, then N x C of the directions
 *   drift(t, q, dq, ddq, u, p, z, out)  out: Z time derivatives of the states
 * A contact's mode is 1 or -1 while it slides, 0 while it sticks. Steps end where a mode does.
 */
#include <math.h>
#include <string.h>

#define AT_LEAST_1(x) ((x) > 0 ? (x) : 1)
#define Y (2 * N + Z)
#define EVENTS_A_STEP 64
#define HELD 1e-10 /* of a contact's own compliance, which others leave it where they hold it too */

enum { DONE = 0, LEFT = 1, NOT_FINITE = 2, NO_CONTACT = 3, CHATTER = 4 };

typedef struct {
    double out[N + N * AT_LEAST_1(C)];
    double s[AT_LEAST_1(C)];
    double dy[Y];
} Rate;

static double speed(int c, const double *dq)
{
    double v = 0.0;
    for (int n = 0; n < N; ++n) {
        v += ROWS[c][n] * dq[n];
    }
    return v;
}

/* x of the eliminated equations, right times their right side; x is given where a column has no pivot. */
static void backwards(int k, const int *at, double m[][AT_LEAST_1(C) + 1], double right, double *x)
{
    for (int i = k - 1; i >= 0; --i) {
        if (at[i] >= 0) {
            const double *r = m[at[i]];
            x[i] = right * r[k];
            for (int j = i + 1; j < k; ++j) {
                x[i] -= r[j] * x[j];
            }
            x[i] /= r[i];
        }
    }
}

static double largest(int k, const double *x, double t, const double *z)
{
    double most = 0.0;
    for (int i = 0; i < k; ++i) {
        most = fmax(most, fabs(x[i] + t * z[i]));
    }
    return most;
}

/* x + t z whose largest element is least: where two are alike, or one vanishes. */
static void share(int k, const double *z, double *x)
{
    double best = 0.0, least = largest(k, x, 0.0, z);
    for (int a = 0; a < k; ++a) {
        for (int b = 0; b <= a; ++b) {
            for (int sign = -1; sign <= 1; sign += 2) {
                const double slope = b == a ? z[a] : z[a] + sign * z[b];
                const double t = slope == 0.0 ? 0.0 : -(b == a ? x[a] : x[a] + sign * x[b]) / slope;
                const double most = largest(k, x, t, z);
                if (most < least) {
                    least = most;
                    best = t;
                }
            }
        }
    }
    for (int i = 0; i < k; ++i) {
        x[i] += best * z[i];
    }
}

/*
 * s of the contacts of mode 0, so that they do not move; 0 where there are none such. Where more contacts stick
 * than can move (two joints, and what turns with both), they share the load as evenly as can be.
 */
static int hold(const double *out, const int *mode, double *s)
{
    int stuck[AT_LEAST_1(C)], k = 0;
    double m[AT_LEAST_1(C)][AT_LEAST_1(C) + 1], own[AT_LEAST_1(C)];
    for (int c = 0; c < C; ++c) {
        s[c] = mode[c];
        if (mode[c] == 0) {
            stuck[k++] = c;
        }
    }
    for (int i = 0; i < k; ++i) {
        const double *row = ROWS[stuck[i]];
        double right = 0.0;
        for (int n = 0; n < N; ++n) {
            double x = out[n];
            for (int c = 0; c < C; ++c) {
                x += out[N + n * C + c] * s[c];
            }
            right -= row[n] * x;
        }
        for (int j = 0; j < k; ++j) {
            m[i][j] = 0.0;
            for (int n = 0; n < N; ++n) {
                m[i][j] += row[n] * out[N + n * C + stuck[j]];
            }
        }
        m[i][k] = right;
        own[i] = fabs(m[i][i]);
    }
    int at[AT_LEAST_1(C)], row = 0; /* row of the pivot of each column, -1 where others hold it already */
    for (int i = 0; i < k; ++i) {
        int best = row;
        at[i] = -1;
        if (!(own[i] > 0.0)) {
            return NO_CONTACT;
        }
        for (int r = row + 1; r < k; ++r) {
            if (fabs(m[r][i]) > fabs(m[best][i])) {
                best = r;
            }
        }
        if (row >= k || !(fabs(m[best][i]) > HELD * own[i])) {
            continue;
        }
        for (int j = i; j <= k && best != row; ++j) {
            const double x = m[row][j];
            m[row][j] = m[best][j];
            m[best][j] = x;
        }
        for (int r = row + 1; r < k; ++r) {
            const double f = m[r][i] / m[row][i];
            for (int j = i; j <= k; ++j) {
                m[r][j] -= f * m[row][j];
            }
        }
        at[i] = row++;
    }
    double x[AT_LEAST_1(C)] = {0.0};
    backwards(k, at, m, 1.0, x);
    for (int i = 0; i < k; ++i) {
        if (at[i] < 0) {
            double z[AT_LEAST_1(C)] = {0.0};
            z[i] = 1.0;
            backwards(k, at, m, 0.0, z);
            share(k, z, x);
        }
    }
    for (int i = 0; i < k; ++i) {
        s[stuck[i]] = x[i];
    }
    return DONE;
}

static void accelerate(const double *out, const int *mode, const double *s, double *ddq)
{
    for (int n = 0; n < N; ++n) {
        ddq[n] = out[n];
        for (int c = 0; c < C; ++c) {
            ddq[n] += out[N + n * C + c] * s[c];
        }
    }
    for (int c = 0; c < C; ++c) { /* what sticks does not creep, not even by rounding */
        if (mode[c] == 0 && OWN[c] >= 0) {
            ddq[OWN[c]] = 0.0;
        }
    }
}

static int evaluate(double t, const double *y, const double *u, const double *p, const int *mode, Rate *r)
{
    if (slip(t, y, y + N, u, p, y + 2 * N, r->out) != 0) {
        return NOT_FINITE;
    }
    const int status = hold(r->out, mode, r->s);
    if (status != DONE) {
        return status;
    }
    memcpy(r->dy, y + N, N * sizeof(double));
    accelerate(r->out, mode, r->s, r->dy + N);
    return drift(t, y, y + N, r->dy + N, u, p, y + 2 * N, r->dy + 2 * N) != 0 ? NOT_FINITE : DONE;
}

/*
 * Modes of the contacts without speed (open[c]); those of the others are given. One that pulls beyond its
 * limit slides that way, one that slides against its own acceleration sticks again.
 */
static int settle(const double *out, const int *open, int *mode)
{
    double s[AT_LEAST_1(C)], ddq[N];
    int able[AT_LEAST_1(C)];
    for (int c = 0; c < C; ++c) {
        double own = 0.0, pull = 0.0;
        for (int n = 0; n < N; ++n) {
            own += ROWS[c][n] * out[N + n * C + c];
            pull += ROWS[c][n] * out[n];
        }
        able[c] = open[c] && own < 0.0;
        if (open[c]) { /* without friction of its own a contact cannot stick */
            mode[c] = able[c] ? 0 : (pull >= 0.0 ? 1 : -1);
        }
    }
    for (int turn = 0; turn < 40 * AT_LEAST_1(C); ++turn) {
        int worst = -1;
        double most = 1.0;
        if (hold(out, mode, s) != DONE) {
            return NO_CONTACT;
        }
        accelerate(out, mode, s, ddq);
        for (int c = 0; c < C; ++c) {
            if (able[c] && mode[c] != 0 && speed(c, ddq) * mode[c] < 0.0) {
                mode[c] = 0;
                worst = -2;
                break;
            }
            if (able[c] && mode[c] == 0 && fabs(s[c]) > most) {
                most = fabs(s[c]);
                worst = c;
            }
        }
        if (worst == -1) {
            return DONE;
        }
        if (worst >= 0) {
            mode[worst] = s[worst] > 0.0 ? 1 : -1;
        }
    }
    return DONE;
}

static void ahead(const double *y, double h, const double *dy, double *next)
{
    for (int i = 0; i < Y; ++i) {
        next[i] = y[i] + h * dy[i];
    }
}

/* One step of the classical Runge-Kutta method; `first` holds the rate at its beginning. */
static int step(double t, double h, const double *y, const double *u, const double *p, const int *mode,
    const Rate *first, double *next)
{
    Rate b, c, d;
    double middle[Y];
    int status;
    ahead(y, h / 2, first->dy, middle);
    if ((status = evaluate(t + h / 2, middle, u, p, mode, &b)) != DONE) {
        return status;
    }
    ahead(y, h / 2, b.dy, middle);
    if ((status = evaluate(t + h / 2, middle, u, p, mode, &c)) != DONE) {
        return status;
    }
    ahead(y, h, c.dy, middle);
    if ((status = evaluate(t + h, middle, u, p, mode, &d)) != DONE) {
        return status;
    }
    for (int i = 0; i < Y; ++i) {
        next[i] = y[i] + h / 6 * (first->dy[i] + 2 * b.dy[i] + 2 * c.dy[i] + d.dy[i]);
    }
    return DONE;
}

/* Positive while contact c keeps its mode. */
static double margin(int c, const int *mode, const double *y, const Rate *r)
{
    return mode[c] ? mode[c] * speed(c, y + N) : 1.0 - fabs(r->s[c]);
}

static void stop(int c, double *y)
{
    if (OWN[c] >= 0) {
        y[N + OWN[c]] = 0.0;
    }
}

/* When within (0, h] contact c leaves its mode, by the regula falsi of Illinois. */
static int crossing(int c, double t, double h, const double *y, const double *u, const double *p,
    const int *mode, const Rate *now, const double *next, const Rate *then, double *when)
{
    double a = 0.0, b = h, fa = margin(c, mode, y, now), fb = margin(c, mode, next, then);
    int side = 0;
    for (int i = 0; i < 60 && b - a > 1e-15 * (t + h); ++i) {
        double x = fa > 0.0 ? (a * fb - b * fa) / (fb - fa) : (a + b) / 2, trial[Y];
        Rate at;
        int status;
        if (!(x > a && x < b)) {
            x = (a + b) / 2;
        }
        if ((status = step(t, x, y, u, p, mode, now, trial)) != DONE
            || (status = evaluate(t + x, trial, u, p, mode, &at)) != DONE) {
            return status;
        }
        const double fx = margin(c, mode, trial, &at);
        if (fx < 0.0) {
            b = x;
            fb = fx;
            fa *= side < 0 ? 0.5 : 1.0;
            side = -1;
        } else {
            a = x;
            fa = fx;
            fb *= side > 0 ? 0.5 : 1.0;
            side = 1;
        }
        if (fabs(fx) < 1e-15) {
            b = x;
            break;
        }
    }
    *when = b;
    return DONE;
}

/* From t to t + h with constant input. */
static int advance(double t, double h, double *y, const double *u, const double *p, int *mode)
{
    Rate now, then;
    double next[Y], best[Y];
    int open[AT_LEAST_1(C)], status;
    double left = h;
    if ((status = evaluate(t, y, u, p, mode, &now)) != DONE) {
        return status;
    }
    for (int c = 0; c < C; ++c) { /* the input may have jumped */
        open[c] = mode[c] == 0;
    }
    for (int event = 0; event < EVENTS_A_STEP; ++event) {
        int any = 0;
        for (int c = 0; c < C; ++c) {
            any |= mode[c] == 0 && fabs(now.s[c]) > 1.0;
        }
        if (any && (status = settle(now.out, open, mode)) != DONE) {
            return status;
        }
        if (any && (status = evaluate(t, y, u, p, mode, &now)) != DONE) {
            return status;
        }
        if ((status = step(t, left, y, u, p, mode, &now, next)) != DONE
            || (status = evaluate(t + left, next, u, p, mode, &then)) != DONE) {
            return status;
        }
        double early = left;
        int which = -1;
        for (int c = 0; c < C; ++c) {
            double x;
            if (margin(c, mode, next, &then) >= 0.0) {
                continue;
            }
            if ((status = crossing(c, t, left, y, u, p, mode, &now, next, &then, &x)) != DONE) {
                return status;
            }
            if (which < 0 || x < early) {
                early = x;
                which = c;
            }
        }
        if (which < 0) {
            memcpy(y, next, sizeof next);
            return DONE;
        }
        if ((status = step(t, early, y, u, p, mode, &now, best)) != DONE) {
            return status;
        }
        memcpy(y, best, sizeof best);
        t += early;
        left -= early;
        for (int c = 0; c < C; ++c) {
            open[c] = mode[c] == 0;
        }
        if (slip(t, y, y + N, u, p, y + 2 * N, now.out) != 0) {
            return NOT_FINITE;
        }
        if (mode[which] != 0) { /* come to rest */
            stop(which, y);
            mode[which] = 0;
            open[which] = 1;
        } else { /* torn loose */
            if ((status = hold(now.out, mode, now.s)) != DONE) {
                return status;
            }
            mode[which] = now.s[which] > 0.0 ? 1 : -1;
            open[which] = 0;
        }
        if ((status = settle(now.out, open, mode)) != DONE
            || (status = evaluate(t, y, u, p, mode, &now)) != DONE) {
            return status;
        }
        for (int c = 0; c < C; ++c) {
            open[c] = mode[c] == 0;
        }
        if (left <= 0.0) {
            return DONE;
        }
    }
    return CHATTER;
}

/* Modes at the beginning: the sign of the speed, or what the forces at rest make of it. */
int begin(double t, const double *y, const double *u, const double *p, int *mode)
{
    int open[AT_LEAST_1(C)];
    Rate now;
    for (int c = 0; c < C; ++c) {
        const double v = speed(c, y + N);
        open[c] = v == 0.0;
        mode[c] = (v > 0.0) - (v < 0.0);
    }
    memset(&now, 0, sizeof now);
    if (slip(t, y, y + N, u, p, y + 2 * N, now.out) != 0) {
        return NOT_FINITE;
    }
    return settle(now.out, open, mode);
}

/*
 * `samples` samples that lie `substeps` steps of h apart; sample 0 is the beginning. u: an input per sample,
 * `stride` doubles apart (0: one for all). y: begin and end. path: Y per sample, sample 0 included.
 * low, high: where q may be. done: samples that are whole. Returns how it ended.
 */
int run(long samples, long substeps, double t, double h, const double *u, long stride, const double *p,
    const double *low, const double *high, double *y, int *mode, double *path, long *done)
{
    memcpy(path, y, Y * sizeof(double));
    for (*done = 1; *done < samples; ++*done) {
        for (long k = 0; k < substeps; ++k) {
            const double at = t + (double)((*done - 1) * substeps + k) * h;
            const int status = advance(at, h, y, u + (*done - 1) * stride, p, mode);
            if (status != DONE) {
                return status;
            }
            for (int i = 0; i < Y; ++i) {
                if (!isfinite(y[i])) {
                    return NOT_FINITE;
                }
            }
            for (int n = 0; n < N; ++n) {
                if (y[n] < low[n] || y[n] > high[n]) {
                    return LEFT;
                }
            }
        }
        memcpy(path + *done * Y, y, Y * sizeof(double));
    }
    return DONE;
}
