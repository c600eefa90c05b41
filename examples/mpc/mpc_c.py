"""The same MPC from C alone: plan.c and loop.c with the arm's generated C and the solver DAQP, in C as well.

DAQP (Arnström, Bemporad and Axehill, "A dual active-set solver for embedded quadratic programming using
recursive LDL^T updates", IEEE Transactions on Automatic Control 67(8), 2022) comes from PyPI, as source.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

import mpc_horizon as problem
import mpc_loop as loop
import numpy as np
from mpc_arm import ControlledArm
from mpc_plant import STEP

FloatArray = np.ndarray

HERE = Path(__file__).resolve().parent
REQUIREMENT = HERE / "daqp.txt"
SOURCES = ("horizon.c", "plan.c", "loop.c")
# What of the arm in the optimiser, and of the plant, they call.
CALLED = (
    ("forward_dynamics_derivatives", "motor_from_joint", "gravity", "sincos"),
    ("forward_dynamics", "sincos"),
)
FLAGS = ("-std=c99", "-O3", "-march=native", "-fno-math-errno")
STEPS, STEP_TIME, SUBSTEPS = 20, 0.05, 4  # as Horizon has them: intervals, s, steps of Runge-Kutta 4 in one
LEAST_DESCENT = 1e-8  # of the cost and one: a plan that a step would better by less is done


def daqp(folder: Path) -> Path:
    """DAQP's C sources in `folder`, downloaded with pip where they are not there yet.

    Raises RuntimeError where pip cannot download them.
    """
    pinned = re.search(r"^daqp==(\S+)", REQUIREMENT.read_text(encoding="utf-8"), re.MULTILINE)
    assert pinned is not None
    sources = folder / f"daqp-{pinned[1]}" / "csrc"
    if not sources.is_dir():
        command = [
            sys.executable,
            "-m",
            "pip",
            "download",
            "--quiet",
            "--disable-pip-version-check",
            "--no-deps",
        ]
        command += ["--no-binary", "daqp", "--require-hashes", "--requirement", str(REQUIREMENT)]
        with tempfile.TemporaryDirectory() as name:
            done = subprocess.run([*command, "--dest", name], capture_output=True, text=True, check=False)
            if done.returncode != 0:
                why = (done.stderr.strip() or "no message").splitlines()[-1]
                raise RuntimeError(f"DAQP's sources cannot be downloaded from PyPI: {why}")
            (archive,) = Path(name).glob("daqp-*.tar.gz")
            with tarfile.open(archive) as opened:
                opened.extractall(folder, filter="data")
    return sources


def values(arm: ControlledArm, least_descent: float = LEAST_DESCENT) -> str:
    """Text of values.h: horizon, weights, limits, parameters, reference."""
    assert arm.drives is not None
    numbers = {
        "STEPS": STEPS,
        "PERIOD": STEP_TIME,
        "SUBSTEPS": SUBSTEPS,
        "PLANT_STEPS": max(1, round(STEP_TIME / STEP)),
        "POSITION": problem.POSITION,
        "VELOCITY": problem.VELOCITY,
        "CONTROL": problem.CONTROL,
        "SOFT": problem.SOFT,
        "SOFT_SQUARE": problem.SOFT_SQUARE,
        "MARGIN": problem.MARGIN,
        "LEAST_DESCENT": least_descent,
    }
    vectors = {
        "EFFORT": arm.effort,
        "STROKE_LOW": arm.drives.low,
        "STROKE_HIGH": arm.drives.high,
        "SWING_START": np.deg2rad(loop.START),
        "SWING_END": np.deg2rad(loop.END),
        "SWING_PERIOD": loop.PERIOD,
        "PARAMETERS": arm.parameters,
    }
    lines = ["/** Written by mpc_c.py. */", "#ifndef VALUES_H", "#define VALUES_H", ""]
    lines += [f"#define {name} {value!r}" for name, value in numbers.items()]
    for name, vector in vectors.items():
        listed = ", ".join(repr(float(v)) for v in vector)
        lines += ["", f"static const double {name}[] = {{{listed}}};"]
    return "\n".join([*lines, "", "#endif", ""])


def built(
    arm: ControlledArm,
    generated: tuple[Path, Path],
    sources: Path,
    build: Path,
    least_descent: float = LEAST_DESCENT,
) -> Path:
    """Compile the closed loop.

    generated: the folders of the arm in the optimiser and of ariane4, the plant; sources: of DAQP. Raises
    RuntimeError without a compiler.
    """
    compiler = shutil.which("cc")
    if compiler is None:
        raise RuntimeError("no C compiler: expected cc on the PATH (Debian: apt-get install build-essential)")
    build.mkdir(parents=True, exist_ok=True)
    (build / "values.h").write_text(values(arm, least_descent), encoding="utf-8")
    includes = [HERE, build, *(folder / "include" for folder in (*generated, sources))]
    files = [*(HERE / name for name in SOURCES), *sorted((sources / "src").glob("*.c"))]
    for folder, names in zip(generated, CALLED, strict=True):
        files += [folder / "src" / f"{folder.name}_{name}.c" for name in names]
    program = build / "loop"
    command = [compiler, *FLAGS, *(f"-I{folder}" for folder in includes), *map(str, files)]
    subprocess.run([*command, "-lm", "-o", str(program)], check=True)
    return program


def closed_loop_in_c(
    program: Path, arm: ControlledArm, parameters: FloatArray, duration: float, begin: float = 0.0
) -> loop.Run:
    """What mpc_loop.closed_loop does, by the program alone.

    parameters: base parameters of the plant. Raises RuntimeError where the program ends with an error.
    """
    given = " ".join(repr(float(p)) for p in parameters)
    command = [str(program), str(begin), str(duration)]
    done = subprocess.run(command, input=given, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    rows = np.loadtxt(done.stdout.splitlines(), ndmin=2)
    n = arm.n
    t = begin + np.arange(len(rows) + 1) * STEP_TIME
    states = np.vstack([loop.reference(np.array([begin])), rows[:, : 2 * n]])
    inputs, rest = rows[:, 2 * n : 3 * n], rows[:, 3 * n :]
    return loop.Run(
        t,
        loop.reference(t),
        states,
        inputs,
        *loop.motors(arm, states),
        cpu=rest[:, 0],
        iterations=rest[:, 1],
        failures=int((rest[:, 2] == 0).sum()),
    )
