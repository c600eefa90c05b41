"""A drive of a reader's own, as docs/howto/drive.md has one written, and commands run with it.

    python scotch_yoke.py '[["generate", "arms.yaml", ...], ...]'     [[exit code, output, errors], ...]

"evaluate ARMS JSON" is no command: the model's functions in NumPy, for inputs by name, by function.

In a process of its own: the class is then a kind of drive there for good.
"""

from __future__ import annotations

import json
import math
import sys
from dataclasses import dataclass
from typing import Annotated

import numpy as np
import sympy as sp

from modelgen.symbolic import Range, Scalar
from modelgen.transmission import DEAD_CENTRE, NO_LIMITS, Drive, Figure, MotorLimits


@dataclass(frozen=True)
class ScotchYoke(Drive):
    """A pin on a crank slides in the slot of a yoke, which moves along a straight line."""

    name = "scotch_yoke"
    text = "a geared crank whose pin moves a slotted yoke; q_m = ratio times the crank's angle"
    joint_type = "prismatic"
    origin = "offset"

    crank: Annotated[Scalar, Figure("length", "Distance between the crank's axis and its pin [m].")]
    ratio: Annotated[Scalar, Figure("plain", "Turns of the motor per turn of the crank [1].")]
    offset: Annotated[Scalar, Figure("length", "Joint coordinate in mid-stroke [m].")]
    torque_constant: float
    limits: MotorLimits = NO_LIMITS

    def motor_from_joint(self, q: sp.Expr) -> sp.Expr:
        """ratio asin((q - offset) / crank)."""
        return self.ratio * sp.asin((q - self.offset) / self.crank)

    def joint_from_motor(self, q_m: sp.Expr) -> sp.Expr:
        """offset + crank sin(q_m / ratio)."""
        return self.offset + self.crank * sp.sin(q_m / self.ratio)

    def reach(self) -> Range:
        """Where the crank is off the line of the yoke."""
        crank, ratio, offset = self.numbers()
        if crank <= 0 or ratio == 0:
            raise ValueError("expected a crank above 0 and a ratio other than 0")
        end = crank * math.cos(DEAD_CENTRE)
        return offset - end, offset + end


from typer.testing import CliRunner  # noqa: E402 - the kinds of drive are read when these are loaded

from modelgen.backends.numpy import NumpyFunction  # noqa: E402
from modelgen.cli.app import app  # noqa: E402
from modelgen.description import load  # noqa: E402
from modelgen.functions import build_model  # noqa: E402


def evaluated(file: str, given: str) -> str:
    """JSON of what the functions named give, each for its inputs (N, k) by name."""
    (arm,) = load(file).values()
    functions = {f.name: f for f in build_model(arm).functions}
    found = {}
    for name, inputs in json.loads(given).items():
        made = NumpyFunction(functions[name])(**{k: np.array(v) for k, v in inputs.items()})
        found[name] = [np.asarray(x).tolist() for x in (made if isinstance(made, tuple) else (made,))]
    return json.dumps(found)


def main() -> None:
    """Run the commands."""
    answers: list[tuple[int, str, str]] = []
    for words in json.loads(sys.argv[1]):
        if words[0] == "evaluate":
            answers.append((0, evaluated(*words[1:]), ""))
            continue
        done = CliRunner().invoke(app, words)
        if done.exception is not None and not isinstance(done.exception, SystemExit):
            raise done.exception
        answers.append((done.exit_code, done.stdout, done.stderr))
    sys.stdout.write(json.dumps(answers))


if __name__ == "__main__":
    main()
