"""What the controller knows of an arm: CasADi functions, nominal parameters, limits of the drives."""

from __future__ import annotations

import importlib.util
import sys
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import casadi as ca
import numpy as np

from modelgen.description import Arm, LeveredDrive, load
from modelgen.effects import known_effects
from modelgen.functions import Options, build_model, nominal_base
from modelgen.generation import generate

FloatArray = np.ndarray


@dataclass(frozen=True)
class Drives:
    """Limits of levered drives: currents [A], strokes and speeds in the motors' units."""

    current: FloatArray
    low: FloatArray
    high: FloatArray
    speed: FloatArray


@dataclass(frozen=True)
class ControlledArm:
    """CasADi functions by their names without the arm's; nominal base parameters; limits.

    `effort` limits the inputs, A for a driven joint and N m for an undriven one; `drives` is None for an
    arm without strokes.
    """

    name: str
    functions: dict[str, ca.Function]
    parameters: FloatArray
    effort: FloatArray
    drives: Drives | None

    @property
    def n(self) -> int:
        """Number of joints."""
        return int(self.functions["gravity"].numel_out(0))


def described(file: Path, name: str) -> Arm:
    """One arm of a description. Raises InputError for a description with a mistake."""
    return load(file, known_effects())[name]


def controlled(arm: Arm, folder: Path, effort: FloatArray | None = None) -> ControlledArm:
    """Generate the arm below `folder` and load its CasADi functions.

    The limits of the inputs are those of the drives unless `effort` gives them.
    """
    generate([arm], folder, Options(), processes=1)
    module = imported(folder / arm.name / f"{arm.name}_casadi.py")
    prefix = f"{arm.name}_"
    drives = _drives(arm) if effort is None else None
    return ControlledArm(
        name=arm.name,
        functions={name.removeprefix(prefix): f for name, f in module.functions().items()},
        parameters=np.array(list(nominal_base(build_model(arm)).values())),
        effort=drives.current if drives is not None else np.asarray(effort, dtype=float),
        drives=drives,
    )


def perturbed(arm: ControlledArm, seed: int, share: float = 0.1) -> FloatArray:
    """Base parameters that are wrong by up to `share`, each by its own amount.

    Raises ValueError where the mass matrix they give is not positive definite all over the strokes.
    """
    rng = np.random.default_rng(seed)
    wrong = arm.parameters * (1 + rng.uniform(-share, share, arm.parameters.size))
    smallest = smallest_eigenvalue(arm, wrong)
    if smallest <= 0:
        raise ValueError(
            f"seed {seed}: the mass matrix has the eigenvalue {smallest:.3g} kg m^2 inside the strokes, "
            "expected positive ones; try another seed"
        )
    return wrong


def smallest_eigenvalue(arm: ControlledArm, parameters: FloatArray, points: int = 9) -> float:
    """Of the mass matrix [kg m^2], on a grid over the strokes."""
    assert arm.drives is not None
    to_joint = arm.functions["joint_from_motor"]
    ends = [
        to_joint(m, np.zeros(arm.n), np.zeros(arm.n))[0].full().ravel()
        for m in (arm.drives.low, arm.drives.high)
    ]
    axes = [np.linspace(a, b, points) for a, b in zip(*ends, strict=True)]
    grid = np.stack(np.meshgrid(*axes), -1).reshape(-1, arm.n)
    mass = arm.functions["mass_matrix"]
    return min(float(np.linalg.eigvalsh(mass(q, parameters).full())[0]) for q in grid)


def _drives(arm: Arm) -> Drives:
    drives = [arm.joints[i].drive for i in arm.coordinates]
    levers = [d for d in drives if isinstance(d, LeveredDrive)]
    limits = [(d.limits.current, d.limits.velocity) for d in levers]
    if len(levers) < len(drives) or any(value is None for pair in limits for value in pair):
        raise ValueError(f"{arm.name}: every joint needs a levered drive with current and motor_velocity")
    return Drives(
        current=np.array([current for current, _ in limits], dtype=float),
        low=np.array([min(d.motor) for d in levers]),
        high=np.array([max(d.motor) for d in levers]),
        speed=np.array([speed for _, speed in limits], dtype=float),
    )


def imported(file: Path) -> ModuleType:
    """The module of a file, of which nothing is left on the disk."""
    spec = importlib.util.spec_from_file_location(file.stem, file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    writes, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        spec.loader.exec_module(module)
    finally:
        sys.dont_write_bytecode = writes
    return module
