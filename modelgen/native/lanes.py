"""A function of a model in C for several samples at a time: vectors of doubles, one sample in each lane."""

from __future__ import annotations

LANES = 8
# Vectors are an extension of C that gcc and clang share. Sine and cosine: the angle less the nearest multiple
# of pi/2 in parts (Cody and Waite, 1980), the polynomials of FreeBSD's msun; to 2.1e-16 where |x| <= 1e5.
_HEAD = """\
#include <math.h>
enum { LANES = 8 };
typedef double lanes_t __attribute__((vector_size(64), aligned(8)));
typedef long long bits_t __attribute__((vector_size(64), aligned(8)));
#define K(x) ((lanes_t){x, x, x, x, x, x, x, x})
#define EACH(f, value) \\
    lanes_t out; for (int l = 0; l < LANES; l++) { out[l] = f(value); } return out
static inline lanes_t m_choice(bits_t yes, lanes_t a, lanes_t b)
{
    return (lanes_t)((yes & (bits_t)a) | (~yes & (bits_t)b));
}
static inline lanes_t m_quarter(lanes_t x, int add)
{
    const lanes_t big = K(6755399441055744.0);
    const lanes_t turns = x * K(0.63661977236758134) + big;
    const bits_t quarter = (bits_t)turns + add;
    const lanes_t k = turns - big;
    const lanes_t r = x - k * K(1.57079632673412561417) - k * K(6.07710050630396597660e-11)
        - k * K(2.02226624879595063154e-21);
    const lanes_t z = r * r;
    const lanes_t s = r + r * z * (K(-1.66666666666666324348e-1) + z * (K(8.33333333332248946124e-3)
        + z * (K(-1.98412698298579493134e-4) + z * (K(2.75573137070700676789e-6)
        + z * (K(-2.50507602534068634195e-8) + z * K(1.58969099521155010221e-10))))));
    const lanes_t c = K(1.0) - K(0.5) * z + z * z * (K(4.16666666666666019037e-2)
        + z * (K(-1.38888888888741095749e-3) + z * (K(2.48015872894767294178e-5)
        + z * (K(-2.75573143513906633035e-7) + z * (K(2.08757232129817482790e-9)
        - z * K(1.13596475577881948265e-11))))));
    const lanes_t value = m_choice((quarter & 1) != 0, c, s);
    return m_choice((quarter & 2) != 0, -value, value);
}
static inline lanes_t m_sin(lanes_t x) { return m_quarter(x, 0); }
static inline lanes_t m_cos(lanes_t x) { return m_quarter(x, 1); }
static inline lanes_t m_abs(lanes_t x) { return m_choice(x < 0.0, -x, x); }
static inline lanes_t m_sign(lanes_t x) { return m_choice(x > 0.0, K(1.0), m_choice(x < 0.0, K(-1.0), x)); }
static inline lanes_t m_min(lanes_t x, lanes_t y) { return m_choice(x < y, x, y); }
static inline lanes_t m_max(lanes_t x, lanes_t y) { return m_choice(x > y, x, y); }
static inline lanes_t m_select(lanes_t x, lanes_t y, lanes_t z) { return m_choice(x > 0.0, y, z); }
static inline lanes_t m_sqrt(lanes_t x) { EACH(sqrt, x[l]); }
static inline lanes_t m_tan(lanes_t x) { EACH(tan, x[l]); }
static inline lanes_t m_asin(lanes_t x) { EACH(asin, x[l]); }
static inline lanes_t m_acos(lanes_t x) { EACH(acos, x[l]); }
static inline lanes_t m_atan(lanes_t x) { EACH(atan, x[l]); }
static inline lanes_t m_exp(lanes_t x) { EACH(exp, x[l]); }
static inline lanes_t m_log(lanes_t x) { EACH(log, x[l]); }
static inline lanes_t m_tanh(lanes_t x) { EACH(tanh, x[l]); }
#define BOTH x[l], y[l]
static inline lanes_t m_atan2(lanes_t x, lanes_t y) { EACH(atan2, BOTH); }
static inline lanes_t m_pow(lanes_t x, lanes_t y) { EACH(pow, BOTH); }
"""


def plain_text(count: int) -> str:
    """Text for `count` columns that are given."""
    return (
        f"{_HEAD}enum {{ INPUTS = {count}, COLUMNS = {count} }};\n"
        "static void columns(const lanes_t x[], lanes_t out[])\n{\n"
        "    for (int i = 0; i < COLUMNS; i++) {\n        out[i] = x[i];\n    }\n}\n"
    )
