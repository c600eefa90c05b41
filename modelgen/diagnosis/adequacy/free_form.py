"""Whether a free function of a joint's position and speed explains as much as the causes there.

The function is a Gaussian process with a jump where the speed changes its sign (Rasmussen and Williams 2006):
whatever a friction or a force over the joint does, it can. A law that is there explains as much at the price
of its few parameters; one that is not ahead of the function has nothing but the function's shape for itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.diagnosis.adequacy.smooth_functions import (
    SmoothFunction,
    Worth,
    functions,
    log_evidence,
    spots,
)
from modelgen.diagnosis.candidates import FittedCandidate, system_of
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.selection import Selection, together


@dataclass(frozen=True)
class FreeForm:
    """ahead: delta BIC by which the function is ahead of a joint's causes; most: by which it may be."""

    ahead: float
    most: float

    @property
    def as_good(self) -> bool:
        """Whether nothing speaks for the laws that the function does not have."""
        return self.ahead > self.most


def free_forms(
    selection: Selection, equations: Equations, terms: Mapping[int, Worth]
) -> dict[int | None, FreeForm]:
    """Find, for each joint with causes, the free function that is ahead of them by most.

    Asked for all causes of a joint together; a cause whose law is the first terms of a series counts with the
    function that the series would come to. Not of elastic joints and play, whose own laws are none of the
    joint's motion, of causes of the whole arm, or of free motions. terms: by joint, see `further_terms`.
    """
    if equations.free:
        return {}
    limits = equations.thresholds.adequacy
    found: dict[int | None, FreeForm] = {}
    for joint in sorted({c.trial.candidate.joint or 0 for c in selection.causes} - {0}):
        own = [c.trial for c in selection.causes if c.trial.candidate.joint == joint]
        if any(t.candidate.elastic for t in own):
            continue
        others = [c.trial for c in selection.causes if c.trial.candidate.joint != joint]
        without = system_of(equations, others, selection.system)
        rest = 0.0  # of the series, which is no other cause
        if any(t.candidate.definition.series for t in own):
            rest = max(rest, terms[joint].evidence)
        known = selection.system.noise_known
        most = 0.0 if known else limits.max_free_form_ahead
        shapes = [*functions_of(joint - 1, equations), spots(joint - 1, equations)]
        found[joint] = FreeForm(ahead(shapes, own, without) - rest, most)
    return found


def ahead(shapes: Iterable[SmoothFunction], own: Sequence[FittedCandidate], without: System) -> float:
    """Delta BIC by which the best of these functions is ahead of all causes `own`, beside the others.

    without: the system of the others, with the noise that all causes leave: what they explain is none.
    """
    return max(log_evidence(shape, without).evidence for shape in shapes) - together(own, without, fair=True)


def further_terms(selection: Selection) -> dict[int, Worth]:
    """Find, for each joint with a law that is the first terms of a series, what further ones are worth.

    Beside all causes, of the functions of the joint's position times its direction the best one. None of a
    free motion.
    """
    system = selection.system
    joints = {c.trial.candidate.joint for c in selection.causes if c.trial.candidate.definition.series}
    if system.equations.free:
        return {}
    return {
        joint: max(
            (log_evidence(shape, system) for shape in functions_of(joint - 1, system.equations, series=True)),
            key=lambda worth: worth.evidence,
        )
        for joint in sorted(j for j in joints if j is not None)
    }


def functions_of(j: int, equations: Equations, series: bool = False) -> Iterator[SmoothFunction]:
    """Functions of position and speed of joint j (from 0), of every bend length.

    series: of the position, times the direction.
    """
    name = f"a force at {equations.arm.coordinate_names[j]} over its position and speed"
    positions = [r.prepared.q[:, [j]] for r in equations.rows]
    speeds = [r.prepared.dq[:, [j]] for r in equations.rows]
    over = positions if series else [np.hstack(state) for state in zip(positions, speeds, strict=True)]
    for bend in equations.thresholds.adequacy.bend_lengths:
        tables = []
        for r, x, speed in zip(equations.rows, functions(over, bend), speeds, strict=True):
            turned = x * np.sign(speed)
            tables.append(r.equation(j, turned if series else np.hstack([x, turned])))
        yield SmoothFunction(name, {j: tables})
