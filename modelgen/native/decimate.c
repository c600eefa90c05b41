/*
 * Columns of an arm's regressor, low-passed and decimated, in one pass over the samples.
 *
 * Before this text stand, made for the arm: LANES and the type lanes_t of so many doubles; INPUTS, numbers per
 * sample; COLUMNS, columns of the regressor; MODES, poles of the filter, of each conjugate pair one; and
 * columns(x, out), the regressor of LANES samples.
 *
 * Sums weighted by powers of the poles go from kept sample to kept sample (modelgen/dataset/decimation.py).
 * Each lane has its own part of the record; what it lacks at its ends comes in afterwards, and fades.
 */
enum { SUMS = 4 * MODES, PART = 16, TOGETHER = 2 };

typedef struct {
    lanes_t re, im;
} complex_t;

/* Memory for a run, from outside. */
typedef struct {
    lanes_t tile[PART][COLUMNS + COLUMNS % TOGETHER];
    lanes_t sums[COLUMNS + COLUMNS % TOGETHER][SUMS];
    lanes_t last[COLUMNS];
    lanes_t edge[COLUMNS];
    complex_t carried[COLUMNS][MODES];
} scratch_t;

long scratch_size(void)
{
    return (long)sizeof(scratch_t);
}

static lanes_t all(const double value)
{
    return (lanes_t){0.0} + value;
}

/* The inputs of the samples place[l] + step; beyond the ends the outermost ones, for weights that are zero. */
static void gather(
    const double *const x[INPUTS], const long samples, const long place[LANES], const long step, lanes_t out[INPUTS])
{
    long k[LANES];

    for (int l = 0; l < LANES; l++) {
        k[l] = place[l] + step;
        k[l] = k[l] < 0 ? 0 : k[l] >= samples ? samples - 1 : k[l];
    }
    for (int i = 0; i < INPUTS; i++) {
        const double *const own = x[i];
        out[i] = (lanes_t){
            own[k[0]], own[k[1]], own[k[2]], own[k[3]], own[k[4]], own[k[5]], own[k[6]], own[k[7]]};
    }
}

/* The columns at all samples, row after row; memory for LANES rows from outside. */
void evaluate(const double *const x[INPUTS], const long samples, lanes_t row[COLUMNS], double *const out)
{
    lanes_t given[INPUTS];
    long place[LANES];

    for (int l = 0; l < LANES; l++) {
        place[l] = l;
    }
    for (long k = 0; k < samples; k += LANES) {
        gather(x, samples, place, k, given);
        columns(given, row);
        for (int l = 0; l < LANES && k + l < samples; l++) {
            for (int c = 0; c < COLUMNS; c++) {
                out[(k + l) * COLUMNS + c] = row[c][l];
            }
        }
    }
}

/*
 * Weighted sums over `count` samples from place[l] on, of each lane; weights: count x SUMS. The sums stand in
 * scratch->sums, the columns at the last sample in scratch->last.
 */
void add_up(const double *const x[INPUTS], const long samples, const long place[LANES], const long count,
    const lanes_t weights[], scratch_t *const scratch)
{
    lanes_t given[INPUTS];

    for (long begin = 0; begin < count; begin += PART) {
        const int part = (int)(count - begin < PART ? count - begin : PART);
        const lanes_t *const own = weights + begin * SUMS;
        for (int s = 0; s < part; s++) {
            gather(x, samples, place, begin + s, given);
            columns(given, scratch->tile[s]);
        }
        for (int c = 0; c < COLUMNS; c += TOGETHER) {
            lanes_t sum[TOGETHER][SUMS];
            for (int k = 0; k < TOGETHER; k++) {
                for (int r = 0; r < SUMS; r++) {
                    sum[k][r] = begin == 0 ? all(0.0) : scratch->sums[c + k][r];
                }
            }
            for (int s = 0; s < part; s++) {
                for (int r = 0; r < SUMS; r++) {
                    const lanes_t weight = own[s * SUMS + r];
                    for (int k = 0; k < TOGETHER; k++) {
                        sum[k][r] += weight * scratch->tile[s][c + k];
                    }
                }
            }
            for (int k = 0; k < TOGETHER; k++) {
                for (int r = 0; r < SUMS; r++) {
                    scratch->sums[c + k][r] = sum[k][r];
                }
            }
        }
        for (int c = 0; c < COLUMNS && begin + part == count; c++) {
            scratch->last[c] = scratch->tile[part - 1][c];
        }
    }
}

/* state = turn * state + (re, im); returns the real part of gain * state. */
static inline lanes_t turned(complex_t *const state, const double turn[2], const double gain[2], const lanes_t re, const lanes_t im)
{
    const lanes_t x = turn[0] * state->re - turn[1] * state->im + re;
    const lanes_t y = turn[0] * state->im + turn[1] * state->re + im;
    state->re = x;
    state->im = y;
    return gain[0] * x - gain[1] * y;
}

/* Lane after lane: what stands in a lane's state at its end begins the next one's; `first` that of the outermost. */
static void hand_over(complex_t *const state, const double far[2], const double first[2], const int forwards)
{
    double re = first[0], im = first[1];
    for (int k = 0; k < LANES; k++) {
        const int l = forwards ? k : LANES - 1 - k;
        const double x = far[0] * re - far[1] * im + state->re[l];
        const double y = far[0] * im + far[1] * re + state->im[l];
        state->re[l] = re;
        state->im[l] = im;
        re = x;
        im = y;
    }
}

/*
 * The filtered columns (steps + 1, COLUMNS) at the samples first, first + factor, ...; out[0] already holds
 * what the first sample and those before it give. turn, gain, far: by mode (real, imaginary): the pole's power
 * for a step, its gain, its power for a lane. head, tail: (COLUMNS, MODES, 2), sums before the first and after
 * the last row. fading: steps after which nothing counts. work: length x COLUMNS x 2 MODES; y: length x COLUMNS.
 */
void filtered(const double *const x[INPUTS], const long samples, const long first, const long factor, const long steps,
    const lanes_t weights[], const double direct, const double turn[MODES][2], const double gain[MODES][2],
    const double far[MODES][2], const double head[COLUMNS][MODES][2], const double tail[COLUMNS][MODES][2],
    const long fading, scratch_t *const scratch, lanes_t work[], lanes_t y[], double *const out)
{
    const long length = steps / LANES + 1; /* steps of a lane; the last lane has at least one to spare */
    static const double none[2] = {0.0, 0.0};
    long place[LANES];

    for (int c = 0; c < COLUMNS; c++) {
        for (int m = 0; m < MODES; m++) {
            scratch->carried[c][m] = (complex_t){all(0.0), all(0.0)};
        }
    }
    for (long g = 0; g < length; g++) {
        for (int l = 0; l < LANES; l++) {
            place[l] = first + 1 + (l * length + g) * factor;
        }
        add_up(x, samples, place, factor, weights, scratch);
        for (int l = 0; l < LANES; l++) {
            const long beyond = l * length + g - steps;
            for (int c = 0; c < COLUMNS && beyond >= 0; c++) {
                for (int r = 0; r < SUMS; r++) {
                    scratch->sums[c][r][l] = 0.0;
                }
                for (int m = 0; m < MODES && beyond == 0; m++) {
                    scratch->sums[c][2 * MODES + 2 * m][l] = tail[c][m][0];
                    scratch->sums[c][2 * MODES + 2 * m + 1][l] = tail[c][m][1];
                }
            }
        }
        for (int c = 0; c < COLUMNS; c++) {
            const lanes_t *const sum = scratch->sums[c];
            lanes_t value = direct * scratch->last[c];
            for (int m = 0; m < MODES; m++) {
                value += turned(&scratch->carried[c][m], turn[m], gain[m], sum[2 * m], sum[2 * m + 1]);
            }
            y[g * COLUMNS + c] = value;
            for (int r = 0; r < 2 * MODES; r++) {
                work[(g * COLUMNS + c) * 2 * MODES + r] = sum[2 * MODES + r];
            }
        }
    }
    for (int c = 0; c < COLUMNS; c++) {
        for (int m = 0; m < MODES; m++) {
            hand_over(&scratch->carried[c][m], far[m], head[c][m], 1);
        }
    }
    for (long g = 0; g < length && g < fading; g++) {
        for (int c = 0; c < COLUMNS; c++) {
            for (int m = 0; m < MODES; m++) {
                y[g * COLUMNS + c] += turned(&scratch->carried[c][m], turn[m], gain[m], all(0.0), all(0.0));
            }
        }
    }
    for (int c = 0; c < COLUMNS; c++) {
        for (int m = 0; m < MODES; m++) {
            scratch->carried[c][m] = (complex_t){all(0.0), all(0.0)};
        }
    }
    for (long g = length - 1; g >= 0; g--) {
        for (int c = 0; c < COLUMNS; c++) {
            const lanes_t *const sum = work + (g * COLUMNS + c) * 2 * MODES;
            lanes_t value = all(0.0);
            for (int m = 0; m < MODES; m++) {
                value += turned(&scratch->carried[c][m], turn[m], gain[m], sum[2 * m], sum[2 * m + 1]);
            }
            if (g > 0) {
                y[(g - 1) * COLUMNS + c] += value;
            } else {
                scratch->edge[c] = value;
            }
        }
    }
    for (int c = 0; c < COLUMNS; c++) {
        for (int m = 0; m < MODES; m++) {
            hand_over(&scratch->carried[c][m], far[m], none, 0);
        }
    }
    for (long g = length - 1; g >= 0 && g >= length - fading; g--) {
        for (int c = 0; c < COLUMNS; c++) {
            lanes_t value = all(0.0);
            for (int m = 0; m < MODES; m++) {
                value += turned(&scratch->carried[c][m], turn[m], gain[m], all(0.0), all(0.0));
            }
            if (g > 0) {
                y[(g - 1) * COLUMNS + c] += value;
            } else {
                scratch->edge[c] += value;
            }
        }
    }
    for (long g = 0; g < length; g++) {
        for (int c = 0; c < COLUMNS; c++) {
            const lanes_t value = y[g * COLUMNS + c];
            for (int l = 0; l < LANES; l++) {
                const long j = l * length + g;
                if (j < steps) {
                    out[(j + 1) * COLUMNS + c] = value[l];
                }
            }
        }
    }
    for (int l = 0; l < LANES && l * length <= steps; l++) {
        for (int c = 0; c < COLUMNS; c++) {
            out[l * length * COLUMNS + c] += scratch->edge[c][l];
        }
    }
}
