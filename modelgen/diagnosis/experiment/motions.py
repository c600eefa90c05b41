"""Motions that could be run next, within the limits of the arm, and the equations of their logs to be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.dataset import Prepared, Record, drives_of, prepare
from modelgen.description import Arm
from modelgen.diagnosis.equations import Equations, Rows, rows_of
from modelgen.diagnosis.options.thresholds import ExperimentThresholds
from modelgen.effects import CATALOGUE
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator, Motion
from modelgen.excitation.limits import bounds
from modelgen.functions import Model
from modelgen.numeric import Array
from modelgen.options import ExcitationOptions


@dataclass(frozen=True)
class Setup:
    """The arm with the processing of its training records.

    arm: with a limit wherever the description has none, and without effects that have states. equations: of
    the training records. base: base parameters (p,) of their model. assumed: limits that come from the
    records. every: sampling periods of the records between two samples of a motion; where there are several
    it must be slow, and its positions are not filtered.
    """

    arm: Arm
    equations: Equations
    base: Array
    assumed: tuple[str, ...]
    every: int = 1

    @property
    def model(self) -> Model:
        """Model of the arm as described."""
        return self.equations.model

    @property
    def evaluator(self) -> Evaluator:
        """Evaluator of the inputs that motions need."""
        return self.equations.evaluator

    @property
    def prepared(self) -> list[Prepared]:
        """The training records."""
        return [r.prepared for r in self.equations.rows]

    @property
    def limits(self) -> ExperimentThresholds:
        """Thresholds by which an experiment is chosen."""
        return self.equations.thresholds.experiment

    @property
    def step(self) -> float:
        """Sampling period [s]."""
        return self.prepared[0].record.step

    def times(self, count: int) -> Array:
        """Times (N,) of so many samples of a motion [s]."""
        return np.asarray(self.every * self.step * np.arange(count), dtype=np.float64)

    @property
    def coarse(self) -> Setup:
        """Set-up with as few samples as the same rows of a slow motion follow from."""
        factor = self.prepared[0].settings.factor
        fewest = min(self.limits.min_samples_per_row, factor)
        rest = next(k for k in range(fewest, factor + 1) if factor % k == 0)
        return replace(self, every=factor // rest)

    def settings(self, period: int | None, seed: int = 0) -> ExcitationOptions:
        """Settings of the excitation. period: samples in that of the training records."""
        rate = 1.0 / self.step
        length = self.limits.usual_period if period is None else period * self.step
        shortest, longest = self.limits.period_range
        samples = round(float(np.clip(length, shortest, longest)) * rate)
        return ExcitationOptions(period=samples / rate, harmonics=self.limits.harmonics, rate=rate, seed=seed)

    def rows(self, q: Array, parameters: Array | None = None) -> Rows | None:
        """Equations of a motion q (N, n) [rad, m]; None where it cannot be logged."""
        first = self.prepared[0]
        settings = replace(first.settings, spacing=None)
        if self.every > 1:
            settings = replace(settings, factor=settings.factor // self.every, position_cutoff=0.0)
        motor = np.column_stack([d.motor(q[:, k]) for k, d in enumerate(drives_of(self.evaluator.arm))])
        if not np.isfinite(motor).all():
            return None
        nothing = np.zeros(q.shape)
        record = Record(
            "next", self.times(len(q)), q, motor, nothing, nothing + 1.0,
            motor_side=first.record.motor_side, arm=first.record.arm, held=first.record.held,
        )  # fmt: skip
        try:
            prepared = prepare(record, settings)
        except InputError:
            return None
        if len(prepared.rows) < self.equations.thresholds.evidence.min_rows:
            return None
        base = self.base if parameters is None else parameters
        return rows_of(self.evaluator, self.model, prepared, base, self.equations.baseline)

    def overload(self, q: Array, dq: Array, ddq: Array) -> float:
        """Largest share of a limit of an input or an effort that the motion (N, n) needs; 0 without one."""
        limits = [b for b in bounds(self.arm, ExcitationOptions())[0] if b.signal in ("input", "effort")]
        if not limits:
            return 0.0
        given = self.evaluator.inputs(Motion(self.times(len(q)), q, dq, ddq), self.base)
        drives, most = drives_of(self.evaluator.arm), 0.0
        for b in limits:
            x = given[:, b.coordinate]
            if b.signal == "effort":
                x = x * drives[b.coordinate].gain(q[:, b.coordinate])
            most = max(most, float(np.abs(x).max()) / b.high)
        return most


def setup(arm: Arm, equations: Equations, base: Array) -> Setup:
    """Prepare what motions are planned on. Where the description has no limit, that of the records counts."""
    joints, assumed, prepared = list(arm.joints), [], [r.prepared for r in equations.rows]
    for n, i in enumerate(arm.coordinates):
        own = joints[i].limits
        effects = tuple(u for u in joints[i].effects if not CATALOGUE[u.name].held(u.values))
        q = np.concatenate([p.q[p.rows, n] for p in prepared])
        missing = {
            "position": None if own.position else (float(q.min()), float(q.max())),
            "velocity": own.velocity or _largest([p.dq[p.rows, n] for p in prepared]),
            "acceleration": own.acceleration or _largest([p.ddq[p.rows, n] for p in prepared]),
        }
        given = {name: value for name, value in missing.items() if not getattr(own, name) and value}
        assumed += [f"{name} of {joints[i].name}" for name in given]
        joints[i] = replace(joints[i], limits=replace(own, **given), effects=effects)  # type: ignore[arg-type]
    kept = tuple(u for u in arm.effects if not CATALOGUE[u.name].held(u.values))
    return Setup(replace(arm, joints=tuple(joints), effects=kept), equations, base, tuple(assumed))


def _largest(values: Sequence[Array]) -> float:
    return float(np.abs(np.concatenate(values)).max())
