"""The generated C put together in other ways."""

from __future__ import annotations

from pathlib import Path

from peers.ours import FUNCTIONS

_INLINED = """\
#include "src/{arm}_private.h"
__attribute__((always_inline)) extern inline {arm}_pair_t {arm}_sincos({arm}_real_t x);
{sources}
"""
_CALLS = """\
#include "{arm}.h"

int {arm}_forward_dynamics{suffix}(const double q[], const double dq[], const double input[],
    {parameters}double out[])
{{
    double m[{n}][{n}], x[{n}], bias[{n}];
    {arm}_status_t status = {arm}_mass_matrix{suffix}(q, {given}&m[0][0]);
    status |= {arm}_bias{suffix}(q, dq, {given}bias);
    for (int i = 0; i < {n}; i++)
        x[i] = input[i] - bias[i];
    for (int k = {n} - 1; k >= 0; k--) {{
        const double inverse = 1.0 / m[k][k];
        for (int i = k - 1; i >= 0; i--) {{
            const double a = m[k][i] * inverse;
            for (int j = 0; j <= i; j++)
                m[i][j] -= a * m[k][j];
            x[i] -= a * x[k];
            m[k][i] = a;
        }}
        x[k] *= inverse;
    }}
    for (int k = 0; k < {n}; k++) {{
        for (int i = 0; i < k; i++)
            x[k] -= m[k][i] * x[i];
        out[k] = x[k];
    }}
    return status;
}}
"""


def _sources(arm: str, folder: Path) -> list[Path]:
    """The measured functions' C with parameters folded in and at run time, sine and cosine first."""
    names = ["sincos"]
    for key, (_, parametric) in FUNCTIONS.items():
        names += [key, f"{key}_identified"] if parametric else [key]
    return [folder / "src" / f"{arm}_{name}.c" for name in names]


def inlined(arm: str, folder: Path) -> Path:
    """All of them in one translation unit with sine and cosine expanded where they are called."""
    sources = "\n".join(f'#include "{path}"' for path in _sources(arm, folder))
    unit = folder / "unit.c"
    unit.write_text(_INLINED.format(arm=arm, sources=sources), encoding="utf-8")
    return unit


def calls(arm: str, joints: int, folder: Path) -> list[str]:
    """Forward dynamics that calls mass_matrix and bias and solves in loops, in place of the straight line."""
    units = [str(path) for path in _sources(arm, folder) if "forward_dynamics" not in path.name]
    units += [str(folder / "src" / f"{arm}_bias{suffix}.c") for suffix in ("", "_identified")]
    for suffix, parameters, given in (
        ("", "const double parameters[], ", "parameters, "),
        ("_identified", "", ""),
    ):
        unit = folder / f"calls{suffix}.c"
        text = _CALLS.format(arm=arm, n=joints, suffix=suffix, parameters=parameters, given=given)
        unit.write_text(text, encoding="utf-8")
        units.append(str(unit))
    return units


def library(arm: str) -> list[str]:
    """Flags that take sine and cosine from the C library."""
    return [f"-D{arm.upper()}_SIN=sin", f"-D{arm.upper()}_COS=cos"]
