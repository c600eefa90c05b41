"""A C program that calls every function of an arm with any bits as inputs and checks what comes back.

What holds for every call, whatever its inputs:

- every output is written and finite;
- a status other than 0 comes with zeros;
- an input vector that is not finite, or whose norm is beyond its bound, sets the status INPUT, and one
  within its bounds does not.

The text serves two drivers: a seeded generator of inputs (`PROGRAM`: main(rounds)), and libFuzzer
(-DFUZZER).
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from modelgen.backends.c.dialect import arrays
from modelgen.functions import STATUS_INPUT, Function, Model

SANITIZERS = "-fsanitize=address,undefined,float-divide-by-zero,float-cast-overflow"

_PROGRAM = r"""
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
@SOURCES@

typedef @REAL@ real;
#define LARGEST @LARGEST@

typedef struct {
    const char *name;
    int size;
    double bound;
    int ranged;
    const double *low, *high;
} input;
typedef struct {
    const char *name;
    int inputs;
    const input *input;
    int outputs;
    const int *sizes;
    int stricter;
} function;

@TABLES@

static int call(int k, real *const x[], real *const y[])
{
    switch (k) {
@CALLS@
    default: abort();
    }
}

static void wrong(const function *f, real *const x[], int status, const char *what)
{
    int a, i;
    fprintf(stderr, "%s: %s, status %d\n", f->name, what, status);
    for (a = 0; a < f->inputs; ++a) {
        fprintf(stderr, "  %s:", f->input[a].name);
        for (i = 0; i < f->input[a].size; ++i) {
            fprintf(stderr, " %.17g", (double)x[a][i]);
        }
        fprintf(stderr, "\n");
    }
    abort();
}

/* Call function k and check what it promises. The arrays have their exact sizes, for the sanitizer. */
static int check(int k, real *const x[])
{
    const function *f = &functions[k];
    real *y[8];
    int a, i, status, refused = 0, accepted = 1;
    for (a = 0; a < f->outputs; ++a) {
        y[a] = malloc(sizeof(real) * (size_t)f->sizes[a]);
        memset(y[a], 0xFF, sizeof(real) * (size_t)f->sizes[a]); /* not a number: what is not written shows */
    }
    for (a = 0; a < f->inputs; ++a) {
        const double bound = f->input[a].bound;
        double sum = 0.0;
        for (i = 0; i < f->input[a].size; ++i) {
            const double value = (double)x[a][i] / bound;
            sum += value * value;
        }
        refused |= !(sum <= 1.00001); /* not a number is beyond every bound */
        accepted &= sum < 0.99999;
    }
    status = call(k, x, y);
    if (refused && !(status & 4)) {
        wrong(f, x, status, "an input beyond its bound is accepted");
    }
    if (accepted && !f->stricter && (status & 4)) {
        wrong(f, x, status, "inputs within their bounds are refused");
    }
    for (a = 0; a < f->outputs; ++a) {
        for (i = 0; i < f->sizes[a]; ++i) {
            if (!isfinite(y[a][i])) {
                wrong(f, x, status, "an output is not finite");
            }
            if (status != 0 && y[a][i] != 0) {
                wrong(f, x, status, "a status without zeros");
            }
        }
        free(y[a]);
    }
    return status;
}

static real **vectors(const function *f)
{
    real **x = malloc(sizeof(real *) * (size_t)(f->inputs ? f->inputs : 1));
    int a;
    for (a = 0; a < f->inputs; ++a) {
        x[a] = calloc((size_t)f->input[a].size, sizeof(real));
    }
    return x;
}

static void release(const function *f, real **x)
{
    int a;
    for (a = 0; a < f->inputs; ++a) {
        free(x[a]);
    }
    free(x);
}

#ifdef FUZZER
/* The first byte is the function, the second says which vectors are brought into their ranges. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int k, a, i, tame;
    real **x;
    if (size < 2) {
        return 0;
    }
    k = data[0] % N_FUNCTIONS;
    tame = data[1];
    data += 2;
    size -= 2;
    x = vectors(&functions[k]);
    for (a = 0; a < functions[k].inputs; ++a) {
        const input *in = &functions[k].input[a];
        for (i = 0; i < in->size; ++i) {
            const size_t n = size < sizeof(real) ? size : sizeof(real);
            memcpy(&x[a][i], data, n);
            data += n;
            size -= n;
            if ((tame >> (a % 8)) & 1) {
                double low = in->ranged ? in->low[i] : -in->bound / in->size;
                double high = in->ranged ? in->high[i] : in->bound / in->size;
                if (!(x[a][i] >= low && x[a][i] <= high)) {
                    const double part = isfinite(x[a][i]) ? fmod(fabs((double)x[a][i]), 1.0) : 0.0;
                    x[a][i] = (real)(low + part * (high - low));
                }
            }
        }
    }
    check(k, x);
    release(&functions[k], x);
    return 0;
}
#else
static uint64_t seed = 0x9E3779B97F4A7C15u;

static uint64_t bits(void)
{
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return seed;
}

static double uniform(double low, double high)
{
    return low + (high - low) * (double)(bits() >> 11) / 9007199254740992.0;
}

static real pattern(void)
{
    const uint64_t b = bits();
    real r;
    memcpy(&r, &b, sizeof r);
    return r;
}

static real special(const input *in, int i)
{
    const double bound = in->bound / sqrt(in->size);
    const double values[] = {
        0.0, -0.0, NAN, INFINITY, -INFINITY, LARGEST, -LARGEST, 1e-40, -5e-324, DBL_MIN, FLT_MIN, 1.0, -1.0,
        in->bound, -in->bound, bound, -bound, bound * 0.9999, bound * 1.0001, in->bound * 1e3,
        1.5707963267948966, 3.141592653589793, 1e-8, 1e19, -1e19,
        in->ranged ? in->low[i] : 0.5, in->ranged ? in->high[i] : -0.5,
        in->ranged ? in->low[i] - 1e-4 : 0.25, in->ranged ? in->high[i] + 1e-4 : -0.25};
    return (real)values[bits() % (sizeof values / sizeof *values)];
}

/* An element within its range, of any magnitude. */
static real ordinary(const input *in, int i, int scale)
{
    const double bound = in->bound / in->size;
    if (in->ranged) {
        return (real)uniform(in->low[i], in->high[i]);
    }
    switch (scale) {
    case 0: return (real)uniform(-1.0, 1.0);
    case 1: return (real)uniform(-bound, bound);
    case 2: return (real)(bound * (bits() & 1 ? 1.0 : -1.0));
    case 3: return (real)uniform(0.0, 1.0);
    default: return (real)(pow(10.0, uniform(-44.0, log10(bound))) * (bits() & 1 ? 1.0 : -1.0));
    }
}

int main(int count, char **arguments)
{
    const long rounds = count > 1 ? strtol(arguments[1], NULL, 10) : 1000;
    long round, done = 0, ok = 0;
    int k, a, i;
    for (k = 0; k < N_FUNCTIONS; ++k) {
        const function *f = &functions[k];
        real **x = vectors(f);
        for (round = 0; round < rounds; ++round) {
            const int mode = (int)(bits() % 4);
            for (a = 0; a < f->inputs; ++a) {
                const int scale = (int)(bits() % 5);
                for (i = 0; i < f->input[a].size; ++i) {
                    const input *in = &f->input[a];
                    /* All any bits, a few special values among ordinary ones, or all ordinary. */
                    const int odd = mode == 1 && bits() % 16 == 0;
                    x[a][i] = mode == 0 ? pattern() : odd ? special(in, i) : ordinary(in, i, scale);
                }
            }
            ok += check(k, x) == 0;
            ++done;
        }
        release(f, x);
    }
    printf("%ld calls, %ld of them computed\n", done, ok);
    return 0;
}
#endif
"""


def program(model: Model, real: str, sources: Sequence[str]) -> str:
    """The program's text; `sources` are the C files that it includes."""
    included = "\n".join(f'#include "{source}"' for source in sources)
    text = _PROGRAM.replace("@SOURCES@", included).replace("@REAL@", real)
    text = text.replace("@LARGEST@", "FLT_MAX" if real == "float" else "DBL_MAX")
    text = text.replace("@TABLES@", _tables(model))
    return text.replace("@CALLS@", "\n".join(_call(model, k, f) for k, f in enumerate(model.functions)))


def _tables(model: Model) -> str:
    lines = []
    rows = []
    for k, f in enumerate(model.functions):
        inputs = []
        for a in f.arguments:
            ranges = {r.index: (r.low, r.high) for r in f.ranges if r.argument == a.name}
            low = high = "NULL"
            if ranges:
                low, high = f"low_{k}_{a.name}", f"high_{k}_{a.name}"
                spans = [ranges.get(i, (-3.1, 3.1)) for i in range(a.size)]
                for name, values in ((low, [s[0] for s in spans]), (high, [s[1] for s in spans])):
                    lines.append(f"static const double {name}[] = {{{', '.join(map(repr, values))}}};")
            inputs.append(f'{{"{a.name}", {a.size}, {a.bound!r}, {int(bool(ranges))}, {low}, {high}}}')
        lines.append(f"static const input inputs_{k}[] = {{{', '.join(inputs)}}};")
        sizes = list(arrays(f).values())
        lines.append(f"static const int sizes_{k}[] = {{{', '.join(map(str, sizes))}}};")
        rows.append(
            f'    {{"{f.name}", {len(f.arguments)}, inputs_{k}, {len(sizes)}, sizes_{k}, '
            f"{int(_stricter(f))}}}"
        )
    listed = ",\n".join(rows)
    return "\n".join(
        [*lines, f"#define N_FUNCTIONS {len(rows)}", f"static const function functions[] = {{\n{listed}}};"]
    )


def _stricter(f: Function) -> bool:
    """Whether it refuses inputs within their bounds: some have ranges, or what it adds up has a bound."""
    ranges = any(r.status == STATUS_INPUT for r in f.ranges)
    return ranges or any(output.checked for output in f.outputs)


def _call(model: Model, k: int, f: Function) -> str:
    given = [f"x[{i}]" for i in range(len(f.arguments))] + [f"y[{i}]" for i in range(len(arrays(f)))]
    return f"    case {k}: return (int){model.arm.name}_{f.name}({', '.join(given)});"


def write(model: Model, real: str, folder: Path) -> Path:
    """The program beside the arm's C files in `folder`."""
    path = folder / f"exercise_{real}.c"
    sources = sorted(p.name for p in (folder / "src").glob("*.c"))
    path.write_text(program(model, real, sources), encoding="utf-8")
    return path


def flags(model: Model, real: str, folder: Path) -> list[str]:
    """Compiler options that the program needs."""
    return [
        f"-D{model.arm.name.upper()}_REAL={real}",
        "-I",
        str(folder / "include"),
        "-I",
        str(folder / "src"),
    ]
