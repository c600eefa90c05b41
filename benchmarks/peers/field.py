"""One arm computed by everyone: built, compared, measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from modelgen.functions import Model, nominal_base
from peers import build, cost, mujoco_model, operations, ours, symbolic, sympy_kane
from peers.arms import BENCH, Subject, links_alone, subject
from peers.bodies import Body
from peers.build import Built
from peers.measure import Call, heap, instructions, nanoseconds, values

Array = NDArray[np.float64]
OURS, RUN_TIME = "modelgen", "modelgen, parameters at run time"
MUJOCO_ALONE = "MuJoCo, dynamics alone"
PINOCCHIO, MUJOCO, KANE, SYMFORCE = "Pinocchio, C++", "MuJoCo", "SymPy, Kane", "SymForce"
TRACED, TRACED_DEFAULT = "Pinocchio, traced with CasADi", "the same in Pinocchio's default convention"
FUNCTIONS = tuple(ours.FUNCTIONS)
_ROUNDS, _SECONDS = 5, 0.2
_AGREEMENT = 1e-9


@dataclass
class Peer:
    """Figures of one way to compute, by function.

    nanoseconds: one array of blocks for each round. costs: generation [s CPU, MB], code, tables, stack and
    heap [bytes], where they apply.
    """

    call: Call
    operations: dict[str, dict[str, int]] = field(default_factory=dict)
    instructions: dict[str, float] = field(default_factory=dict)
    nanoseconds: dict[str, list[Array]] = field(default_factory=dict)
    costs: dict[str, float] = field(default_factory=dict)


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
    case = subject(name)
    model = links_alone(case.arm)
    found = _built(case, model, common, folder)
    _agree(case, model, {peer: values(made.call) for peer, made in found.items()})
    for made in found.values():
        made.instructions = instructions(made.call)
        made.costs["heap"] = heap(made.call)
    for _ in range(_ROUNDS):
        for made in found.values():
            for function, times in nanoseconds(made.call, _SECONDS).items():
                made.nanoseconds.setdefault(function, []).append(times)
    return _split(found)


def _built(case: Subject, model: Model, common: Shared, folder: Path) -> dict[str, Peer]:
    def place(peer: str) -> Path:
        (folder / peer).mkdir(parents=True, exist_ok=True)
        return folder / peer

    def add(peer: str, made: Built, counts: dict[str, dict[str, int]], generation: dict[str, float]) -> None:
        bytes_of = [cost.sections(path) for path in made.objects]
        sizes = {key: sum(one[key] for one in bytes_of) for key in bytes_of[0]}
        sizes["stack"] = cost.stack(made.objects)
        called = Call(made.program, folder, case)
        found[peer] = Peer(called, counts, costs=generation | {k: float(v) for k, v in sizes.items()})

    found: dict[str, Peer] = {}
    name = case.arm.name
    spent = cost.generated(ours.__name__, name, str(place("modelgen")))
    add(OURS, ours.built(model, place("modelgen")), ours.operations(model), spent)
    if common.pinocchio:
        found[PINOCCHIO] = Peer(Call(common.pinocchio, folder, case))
    if common.tracer:
        sources = [place("traced") / name for name in ("traced.c", "besides.c")]
        model_file = found[OURS].call.command()[1]
        counts: dict[str, dict[str, int]] = {}
        spent = {}
        for source, names in zip(sources, (symbolic.TRACED, symbolic.TRACED_BESIDES), strict=True):
            command = [str(common.tracer), model_file, str(source), ",".join(names)]
            seconds, memory, _ = cost.launched(command)
            counts |= operations.traced(source.read_text(encoding="utf-8"))
            spent = spent or {"seconds": seconds, "memory": memory}
        add(TRACED, symbolic.traced(sources, case.joints), counts, spent)
    if build.package("symforce") and build.pinocchio_flags():
        where = place("symforce")
        spent = cost.generated("peers.symforce_newton", name, str(where))
        texts = {key: (where / f"{key}.h").read_text(encoding="utf-8") for key in FUNCTIONS}
        counts = {key: operations.symforce(text) for key, text in texts.items()}
        add(SYMFORCE, symbolic.symforce(where, case.joints), counts, spent)
    if name in BENCH[:2]:  # minutes from seven joints on
        source = place("kane") / "kane.c"
        spent = cost.generated(sympy_kane.__name__, name, str(source))
        counts = operations.kane(source.read_text(encoding="utf-8"))
        add(KANE, symbolic.kane(source, case.joints), counts, spent)
    if common.mujoco:
        mujoco_model.save(case, folder / "model.mjb")
        found[MUJOCO] = Peer(Call(common.mujoco, folder, case, folder / "model.mjb"))
    return found


def _agree(case: Subject, model: Model, results: Mapping[str, Mapping[str, Array]]) -> None:
    """Everyone's results of a function are ours, to 1e-9 of the largest; regressors by their efforts."""
    reference, n = results[OURS], case.joints
    for peer, found in results.items():
        for function, value in found.items():
            key = function.removesuffix("_run_time").removesuffix("_world").removesuffix("_alone")
            mine, theirs = reference[key], value
            if key == "mass_matrix":  # Pinocchio fills the upper triangle, by columns
                square = theirs.reshape(-1, n, n)
                theirs = np.where(square != 0, square, square.transpose(0, 2, 1)).reshape(len(mine), -1)
            elif key == "regressor":
                mine = reference["inverse_dynamics"]
                if peer == OURS:
                    theirs = value.reshape(len(mine), n, -1) @ np.array(list(nominal_base(model).values()))
                else:  # by columns
                    parameters = np.concatenate([pinocchio_parameters(body) for body in case.bodies])
                    theirs = np.einsum("spn,p->sn", value.reshape(len(mine), -1, n), parameters)
            difference = np.abs(mine - theirs).max() / np.abs(mine).max()
            if not difference < _AGREEMENT:
                name = case.arm.name
                raise RuntimeError(f"{name}: {peer} and modelgen differ by {difference:.1e} in {function}")


def pinocchio_parameters(body: Body) -> Array:
    """Parameters in Pinocchio's order: m, first moments, xx, xy, yy, xz, yz, zz about the joint's frame."""
    t = body.tensor
    return np.array([body.mass, *body.first, t[0, 0], t[0, 1], t[1, 1], t[0, 2], t[1, 2], t[2, 2]])


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
        if name == TRACED:
            default = {f: f"{f}_world" for f in ("mass_matrix", "forward_dynamics")}
            result[TRACED_DEFAULT] = replace(_renamed(made, default), costs={})
        if name == MUJOCO:
            alone = {f: f"{f}_alone" for f in ("inverse_dynamics", "forward_dynamics")}
            result[MUJOCO_ALONE] = replace(_renamed(made, alone), costs={})
        if run_time:
            result[RUN_TIME] = replace(_renamed(made, run_time), costs={})
    return result


def _renamed(made: Peer, names: Mapping[str, str]) -> Peer:
    return replace(
        made,
        operations={key: made.operations[name] for key, name in names.items() if name in made.operations},
        instructions={key: made.instructions[name] for key, name in names.items()},
        nanoseconds={key: made.nanoseconds[name] for key, name in names.items()},
    )
