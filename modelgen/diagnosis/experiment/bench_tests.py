"""Simple bench tests that tell causes apart, with the evidence to be expected of each.

Motions of one joint, the same trajectory with a payload, and readings of what a cause claims: a reading with
standard deviation s of a value v is worth v^2 / s^2 against a model without it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.charts import sized
from modelgen.dataset import drives_of
from modelgen.diagnosis.experiment.discrimination import Discriminator, Hypothesis
from modelgen.diagnosis.experiment.motions import Setup
from modelgen.diagnosis.experiment.trajectory import Proposal
from modelgen.effects import CATALOGUE, Shows
from modelgen.errors import InputError
from modelgen.excitation.limits import bounds, ranges, speeds
from modelgen.functions.nominal import about_origin, grouped
from modelgen.model.parameters import units_at
from modelgen.numeric import Array
from modelgen.options import ExcitationOptions

PAYLOAD = 0.5  # of the last link's mass


@dataclass(frozen=True)
class Test:
    """text: what to do. evidence: expected delta BIC at least, None where no figure can be given."""

    text: str
    evidence: float | None


def tests(
    stage: Setup, judge: Discriminator, members: Sequence[Hypothesis], proposal: Proposal | None
) -> list[Test]:
    """All that are worth more than nothing."""
    found: list[Test] = []
    joints = sorted({h.candidate.joint for h in members if h.candidate.joint is not None})
    for joint in joints:
        for text, q in _motions(stage, joint - 1):
            rows = stage.rows(q)
            if rows is not None:
                evidence = least(judge.evidence(members, [rows]))
                found += [] if evidence is None else [Test(text, evidence)]
    loaded = _loaded(stage) if any(Shows.LOAD in h.candidate.definition.shows for h in members) else None
    if loaded is not None and proposal is not None:
        heavier = stage.rows(proposal.q, loaded)
        if heavier is not None:
            both = judge.evidence(members, [proposal.rows, heavier], bases=[stage.base, loaded])
            text = "the trajectory twice, without and with half the last link's mass as payload at its centre"
            found.append(Test(text, least(both)))
    return sorted(
        (t for t in found if t.evidence is None or t.evidence > 0), key=lambda t: -(t.evidence or 0.0)
    )


def least(evidence: Array) -> float | None:
    """The least over all pairs; None where one contains the other."""
    known = evidence[np.isfinite(evidence)]
    return float(known.min()) if len(known) else None


def readings(
    stage: Setup, judge: Discriminator, claims: Sequence[tuple[str, int | None, Mapping[str, float]]]
) -> list[Test]:
    """Readings of what causes claim: (effect, joint, values of its parameters)."""
    found = []
    for effect, joint, values in claims:
        reading = CATALOGUE[effect].reading
        if reading is None:
            continue
        place = "" if joint is None else f"{stage.arm.coordinate_names[joint - 1]}: "
        size = float(np.sqrt(sum(values.get(name, 0.0) ** 2 for name in reading.names)))
        if reading.std is not None:
            evidence, unit = (size / reading.std) ** 2, units_at(stage.arm, effect, joint)[reading.names[0]]
        elif joint is None:
            continue
        else:
            size /= drives_of(stage.arm)[joint - 1].torque_constant
            noise = float(np.sqrt(judge.plain[joint - 1])) * float(judge.system.sizes[joint - 1])
            rows = max(1.0, reading.duration * stage.prepared[0].rate * float(judge.shares[joint - 1]))
            evidence, unit = rows * float(np.log1p((size / noise) ** 2)), "A"
        found.append(
            Test(f"{place}read {reading.text} ({reading.claim.format(sized(size, unit, 2))})", evidence)
        )
    return found


def _motions(stage: Setup, k: int) -> Iterator[tuple[str, Array]]:
    """Text and positions (N, n) of motions of coordinate k alone, the others at their middles."""
    try:
        limits, _ = bounds(stage.arm, ExcitationOptions())
        middle, half = ranges(stage.arm, limits, "joint")
        speed = float(speeds(stage.arm, limits, "joint")[k])
    except InputError:
        return
    asked = stage.limits
    half, duration = asked.bench_range_share * half, asked.bench_duration
    t: Array = stage.step * np.arange(round(duration / stage.step), dtype=np.float64)
    amplitude = asked.reversal_amplitude * 2 * half[k]
    waves = {
        "slow reversals": amplitude * np.sin(asked.reversal_speed * speed / amplitude * t),
        "a slow sweep of its whole range there and back": -half[k] * np.cos(2 * np.pi * t / duration),
        "constant speeds in both directions": _staircase(t, speed, half[k], asked.bench_speeds),
    }
    for name, wave in waves.items():
        q = np.tile(middle, (len(t), 1))
        q[:, k] += wave
        yield f"{stage.arm.coordinate_names[k]} alone: {name}, {duration:g} s", q


def _staircase(t: Array, speed: float, half: float, levels: Sequence[float]) -> Array:
    """Positions (N,): each level of speed there and back, with ramps of a tenth of its time."""
    each = t[-1] / len(levels)
    result = np.zeros(len(t))
    step = float(t[1] - t[0])
    for n, level in enumerate(levels):
        part = (t >= n * each) & (t < (n + 1) * each)
        turns = max(1.0, np.ceil(level * speed * each / 2 / (2 * half)))
        phase = (t[part] - n * each) / each * turns
        wave = np.clip(5.0 * np.sin(2 * np.pi * phase), -1.0, 1.0)
        result[part] = level * speed * wave
    path = np.cumsum(result) * step
    return np.asarray(path - (path.max() + path.min()) / 2)


def _loaded(stage: Setup) -> Array | None:
    """Base parameters with a payload at the last link's centre; None without its nominal inertials."""
    arm = stage.model.arm
    last = max(arm.coordinates)
    link = arm.links[last]
    if link is None:
        return None
    own = {f"{name}{last + 1}": PAYLOAD * value for name, value in about_origin(link).items()}
    more = grouped(stage.model, [own.get(p.name, 0.0) for p in stage.model.standard])
    return np.asarray(stage.base + np.array(list(more.values())))
