"""One arm computed by everyone: built, compared, measured."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from time import process_time

import numpy as np
from numpy.typing import NDArray

from modelgen.description.objects import Arm
from modelgen.functions import Model, nominal_base
from peers import build, mujoco_model, ours, sympy_kane
from peers.arms import BENCH, Subject, links_alone, subject
from peers.measure import Call, code_size, instructions, nanoseconds, values

Array = NDArray[np.float64]
OURS, RUN_TIME = "modelgen", "modelgen, parameters at run time"
PINOCCHIO, TRACED = "Pinocchio, C++", "Pinocchio, traced with CasADi"
MUJOCO, KANE = "MuJoCo", "SymPy, Kane"
FUNCTIONS = tuple(ours.FUNCTIONS)
_ROUNDS, _SECONDS = 3, 0.3
_AGREEMENT = 1e-9


@dataclass
class Peer:
    """Figures of one way to compute, by function. `generation` [s CPU]: description to C, all functions."""

    call: Call
    instructions: dict[str, float] = field(default_factory=dict)
    nanoseconds: dict[str, list[float]] = field(default_factory=dict)
    bytes: dict[str, int] = field(default_factory=dict)
    generation: float | None = None


@dataclass(frozen=True)
class Shared:
    """Programs that serve every arm; None where the packages are missing."""

    pinocchio: Path | None
    tracer: Path | None
    mujoco: Path | None


def shared(folder: Path) -> Shared:
    """Build them."""
    mujoco = mujoco_model.harness(folder) if build.package("mujoco") else None
    return Shared(build.pinocchio(folder), build.tracer(folder), mujoco)


def measured(name: str, common: Shared, folder: Path) -> dict[str, Peer]:
    """Everyone's figures for one arm. Raises RuntimeError where results differ."""
    folder.mkdir(parents=True, exist_ok=True)
    case = subject(name)
    found = _built(case, common, folder)
    _agree(case, links_alone(case.arm), {peer: values(made.call) for peer, made in found.items()})
    for made in found.values():
        made.instructions = instructions(made.call)
    for _ in range(_ROUNDS):
        for made in found.values():
            for function, times in nanoseconds(made.call, _SECONDS).items():
                made.nanoseconds.setdefault(function, []).extend(times.tolist())
    return _split(found)


def _built(case: Subject, common: Shared, folder: Path) -> dict[str, Peer]:
    start = process_time()
    model = links_alone(case.arm)
    program, objects = ours.generated(model, folder)
    found = {OURS: Peer(Call(program, folder, case), generation=process_time() - start)}
    found[OURS].bytes = {key: code_size(path) for key, path in objects.items()}
    if common.pinocchio:
        found[PINOCCHIO] = Peer(Call(common.pinocchio, folder, case))
    if common.tracer:
        source = folder / "traced.c"
        model_file = found[OURS].call.command()[1]
        seconds, _ = build.cost([str(common.tracer), model_file, str(source)])
        program, compiled = ours.traced(source, case.joints, folder)
        found[TRACED] = Peer(Call(program, folder, case), generation=seconds)
        found[TRACED].bytes = {"all": code_size(compiled)}
    if common.mujoco:
        mujoco_model.save(case.arm, folder / "model.mjb")
        found[MUJOCO] = Peer(Call(common.mujoco, folder, case, folder / "model.mjb"))
    if case.arm.name in BENCH[:2]:  # minutes from seven joints on
        source = folder / "kane.c"
        command = [sys.executable, "-m", sympy_kane.__name__, case.arm.name, str(source)]
        seconds, _ = build.cost(command)
        made = ours.kane(source, case.joints, folder)
        found[KANE] = Peer(Call(made, folder, case), generation=seconds)
    return found


def _agree(case: Subject, model: Model, results: Mapping[str, Mapping[str, Array]]) -> None:
    """Everyone's results of a function are ours, to 1e-9 of the largest; regressors by their efforts."""
    reference, n = results[OURS], case.joints
    for peer, found in results.items():
        for function, value in found.items():
            key = function.removesuffix("_run_time").removesuffix("_world")
            mine, theirs = reference[key], value
            if key == "mass_matrix":  # Pinocchio fills the upper triangle, by columns
                square = theirs.reshape(-1, n, n)
                theirs = np.where(square != 0, square, square.transpose(0, 2, 1)).reshape(len(mine), -1)
            elif key == "regressor":
                mine = reference["inverse_dynamics"]
                if peer == OURS:
                    theirs = value.reshape(len(mine), n, -1) @ np.array(list(nominal_base(model).values()))
                else:  # by columns
                    theirs = np.einsum("spn,p->sn", value.reshape(len(mine), -1, n), _pinocchio(case.arm))
            difference = np.abs(mine - theirs).max() / np.abs(mine).max()
            if not difference < _AGREEMENT:
                name = case.arm.name
                raise RuntimeError(f"{name}: {peer} and modelgen differ by {difference:.1e} in {function}")


def _pinocchio(arm: Arm) -> Array:
    """Parameters in Pinocchio's order: m, first moments, xx, xy, yy, xz, yz, zz about the joint's frame."""
    found: list[float] = []
    for link in arm.links:
        assert link is not None
        m, c = link.mass, np.array(link.com)
        xx, xy, xz, yy, yz, zz = link.inertia
        t = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        t += m * (c @ c * np.eye(3) - np.outer(c, c))
        found += [m, *(m * c), t[0, 0], t[0, 1], t[1, 1], t[0, 2], t[1, 2], t[2, 2]]
    return np.array(found)


def _split(found: dict[str, Peer]) -> dict[str, Peer]:
    """Parameters at run time as a peer of its own; of Pinocchio's two conventions the one with fewer
    instructions."""
    result: dict[str, Peer] = {}
    for name, made in found.items():
        best = dict.fromkeys(FUNCTIONS, "")
        for function in made.instructions:
            key = function.removesuffix("_world")
            if key in best:
                now = best[key]
                if not now or made.instructions[function] < made.instructions[now]:
                    best[key] = function
        chosen = {key: value for key, value in best.items() if value}
        result[name] = _renamed(made, chosen)
        run_time = {f: f"{f}_run_time" for f in FUNCTIONS if f"{f}_run_time" in made.instructions}
        if run_time:
            result[RUN_TIME] = replace(_renamed(made, run_time), generation=None)
    return result


def _renamed(made: Peer, names: Mapping[str, str]) -> Peer:
    return replace(
        made,
        instructions={key: made.instructions[name] for key, name in names.items()},
        nanoseconds={key: made.nanoseconds[name] for key, name in names.items()},
    )
