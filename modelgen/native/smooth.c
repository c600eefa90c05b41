/*
 * Columns through a filter forwards and backwards, and their central differences.
 *
 * A cascade of second-order sections in transposed direct form II, as scipy.signal.sosfiltfilt has it: an odd
 * extension of `padding` samples at both ends, states as for a constant before it. Columns lie in the lanes.
 */
enum { LANES = 8, WIDEST = 8 };

typedef double lanes_t __attribute__((vector_size(64), aligned(8)));

/* One pass over y in place, from `place` on by `step` for `count` samples. */
static void pass(const long sections, const double sos[][6], const double zi[][2], lanes_t y[], const long place,
    const long step, const long count)
{
    lanes_t z[WIDEST][2];

    for (long s = 0; s < sections; s++) {
        z[s][0] = zi[s][0] * y[place];
        z[s][1] = zi[s][1] * y[place];
    }
    for (long i = 0; i < count; i++) {
        lanes_t x = y[place + i * step];
        for (long s = 0; s < sections; s++) {
            const lanes_t u = x;
            x = sos[s][0] * u + z[s][0];
            z[s][0] = sos[s][1] * u - sos[s][4] * x + z[s][1];
            z[s][1] = sos[s][2] * u - sos[s][5] * x;
        }
        y[place + i * step] = x;
    }
}

/* x, out: at most LANES columns of `samples`, one after the other; work: samples + 2 padding vectors. */
void both_ways(const double x[], const long columns, const long samples, const long padding, const long sections,
    const double sos[][6], const double zi[][2], lanes_t work[], double out[])
{
    const long all = samples + 2 * padding;

    for (long l = 0; l < LANES; l++) {
        const double *const own = x + (l < columns ? l : 0) * samples;
        for (long i = 0; i < padding; i++) {
            work[i][l] = 2 * own[0] - own[padding - i];
            work[padding + samples + i][l] = 2 * own[samples - 1] - own[samples - 2 - i];
        }
    }
    for (long i = 0; i < samples; i++) {
        for (long l = 0; l < LANES; l++) {
            work[padding + i][l] = x[(l < columns ? l : 0) * samples + i];
        }
    }
    pass(sections, sos, zi, work, 0, 1, all);
    pass(sections, sos, zi, work, all - 1, -1, all);
    for (long i = 0; i < samples; i++) {
        for (long l = 0; l < columns; l++) {
            out[l * samples + i] = work[padding + i][l];
        }
    }
}

/* Derivatives by the taps first[k] of x[i+k] - x[i-k] and second[k] of x[i+k] - 2 x[i] + x[i-k], k = 1 to half. */
void central(const double x[], const long columns, const long samples, const long half, const double first[],
    const double second[], double d[restrict], double dd[restrict])
{
    for (long c = 0; c < columns; c++) {
        const double *const own = x + c * samples;
        double *const one = d + c * samples, *const two = dd + c * samples;
        for (long i = half; i < samples - half; i++) {
            double a = 0.0, b = 0.0;
            for (long k = 1; k <= half; k++) {
                a += first[k - 1] * (own[i + k] - own[i - k]);
                b += second[k - 1] * (own[i + k] - 2.0 * own[i] + own[i - k]);
            }
            one[i] = a;
            two[i] = b;
        }
        for (long i = 0; i < half; i++) {
            one[i] = one[half];
            two[i] = two[half];
            one[samples - 1 - i] = one[samples - 1 - half];
            two[samples - 1 - i] = two[samples - 1 - half];
        }
    }
}
