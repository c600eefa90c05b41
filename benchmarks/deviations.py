"""How often the true values lie within the 95 % intervals of `modelgen identify`, by encoder and log.

    python benchmarks/deviations.py [--seeds 50] [--first 0] [--bits 8,10,12,14,16] [--repeats 0,6,20]
                                    [--current 0] [--limit 1] [--scale 1]

A planar arm of two joints moves along random Fourier series for 10 s, 500 rows a second. Positions are
rounded to turns of 2^bits; readings stand there `repeats` times, so that 20 is a source of 25 Hz; currents,
`scale` times those of the arm, have noise of 20 mA, end at `limit` times what each joint needs at most, and
are rounded to `current` [A]. Seeds are those from `first` on: some to choose by, others for the proof. Prints
intervals that hold the truth [%], over all parameters and for the worst one, and how many logs are refused.
Intervals are 1.96 standard deviations.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects
from modelgen.numeric import Array

ARM = """
schema: 1
convention: khalil_kleinfinger
arms:
  two:
    gravity: [0, -9.81, 0]
    joints:
      - {name: shoulder, drive: {type: direct, ratio: 100, torque_constant: 0.05},
         effects: [viscous_friction: {coefficient: 5.0e-5}, coulomb_friction: {magnitude: 0.02},
           drive_inertia: {inertia: 3.0e-5}]}
      - {name: elbow, d: 0.4, drive: {type: direct, ratio: 80, torque_constant: 0.05},
         effects: [viscous_friction: {coefficient: 4.0e-5}, coulomb_friction: {magnitude: 0.01},
           drive_inertia: {inertia: 2.0e-5}]}
    links:
      shoulder: {mass: 3, com: [0.2, 0.01, 0], inertia: [0.01, 0, 0, 0.05, 0, 0.05]}
      elbow: {mass: 1.5, com: [0.15, 0, 0], inertia: [0.003, 0, 0, 0.02, 0, 0.02]}
"""
ROWS, SECONDS = 500.0, 10.0
NOISE = 0.02  # A


@dataclass(frozen=True)
class Encoder:
    """bits: of a turn of the joint. repeats: rows per reading; 0 and 1: one. current: step of it [A].

    limit: of the largest current of each joint, where it is cut off.
    """

    bits: int
    repeats: int = 0
    current: float = 0.0
    limit: float = 1.0


@dataclass(frozen=True)
class Covered:
    """hits: (S, p) intervals that hold the truth, of the logs that were not refused. refused: why not."""

    hits: Array
    cutoffs: tuple[float, ...]
    refused: tuple[str, ...]


def arm(scale: float = 1.0) -> mg.Arm:
    """The arm that made the logs. scale: of its currents, by the constants of its motors."""
    text = ARM.replace("torque_constant: 0.05", f"torque_constant: {0.05 / scale:.6g}")
    return loads(text, "arm.yaml", known_effects())["two"]


def log(model: mg.Model, encoder: Encoder, seed: int) -> dict[str, Array]:
    """A log as `modelgen identify` takes it: t, q1, q2, i1, i2."""
    assert model.nominal is not None
    random, truth = np.random.default_rng(seed), np.array(list(model.nominal.values()))
    harmonics = np.arange(1, 6)[:, None] * np.ones((1, 2))
    w = 2 * np.pi * harmonics / SECONDS
    size, phase = random.uniform(0.1, 0.35, w.shape) / np.sqrt(harmonics), random.uniform(0, 6.28, w.shape)
    every = max(1, encoder.repeats)
    t = np.arange(int(ROWS * SECONDS / every)) * every / ROWS

    def motion(t: Array) -> list[Array]:
        angle = t[:, None, None] * w + phase
        return [(size * w**k * np.sin(angle + k * np.pi / 2)).sum(axis=1) for k in range(3)]

    # A hold over the row that follows; readings that are new together were read together.
    q, dq, ddq = motion(t + 0.5 / ROWS) if every == 1 else motion(t)
    function = model.functions["inverse_dynamics"]
    current = np.asarray(function(q=q, dq=dq, ddq=ddq, parameters=truth))
    most = encoder.limit * np.abs(current).max(axis=0)
    current = current + NOISE * random.normal(size=current.shape)
    if encoder.limit < 1.0:
        current = np.clip(current, -most, most)
    if encoder.current:
        current = encoder.current * np.rint(current / encoder.current)
    step = 2 * np.pi / 2**encoder.bits
    table = np.column_stack([step * np.rint(motion(t)[0] / step), current])[
        np.arange(len(t) * every) // every
    ]
    return {"t": np.arange(len(table)) / ROWS} | dict(zip(("q1", "q2", "i1", "i2"), table.T, strict=True))


def covered(encoder: Encoder, seeds: Sequence[int], scale: float = 1.0) -> Covered:
    """Intervals that hold the truth, over logs of these seeds. scale: as for `arm`."""
    subject = arm(scale)
    model = mg.build_model(subject)
    assert model.nominal is not None
    hits, cutoffs, refused = [], [], []
    for seed in seeds:
        train, test = log(model, encoder, seed), log(model, encoder, seed + 100_000)
        try:
            found = mg.identify(subject, train, test)
        except mg.InputError as error:
            refused.append(str(error))
            continue
        cutoffs.append(float(found.to_json()["cutoff_hz"]))
        hits.append(
            [
                e.std is not None and abs(e.value - model.nominal[name]) < 1.96 * e.std
                for name, e in found.parameters.items()
            ]
        )
    return Covered(np.array(hits, dtype=np.float64), tuple(cutoffs), tuple(refused))


def _numbers(text: str) -> list[int]:
    return [int(x) for x in text.split(",")]


def main() -> int:
    """Exit status 1 where intervals hold the truth in less than 90 % or more than 99 %."""
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--bits", type=_numbers, default=[8, 9, 10, 11, 12, 14, 16])
    parser.add_argument("--repeats", type=_numbers, default=[0, 6, 20])
    parser.add_argument("--current", type=float, default=0.0)
    parser.add_argument("--limit", type=float, default=1.0)
    parser.add_argument("--scale", type=float, default=1.0)
    given = parser.parse_args()
    good = True
    sys.stdout.write("bits  repeats  logs  refused  cut-off [Hz]   within 95 % intervals [%]   worst\n")
    for bits in given.bits:
        for repeats in given.repeats:
            encoder = Encoder(bits, repeats, given.current, given.limit)
            found = covered(encoder, range(given.first, given.first + given.seeds), given.scale)
            head = f"{bits:4}  {repeats:7}  {len(found.hits):4}  {len(found.refused):7}"
            if len(found.hits):
                share, worst = 100 * found.hits.mean(), 100 * found.hits.mean(axis=0).min()
                head += f"  {min(found.cutoffs):5.2f}-{max(found.cutoffs):5.2f}  {share:26.1f}  {worst:6.0f}"
                good &= 90.0 <= share <= 99.0
            sys.stdout.write(head + "\n")
            sys.stdout.flush()
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
