"""Logs of any length of an arm with random links, drives and friction: periods of ten seconds with noise."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray
from witness.bodies import random_bodies
from witness.rigid_bodies import RigidBodies

from modelgen.description import Arm, load
from modelgen.effects import known_effects
from modelgen.resources import shipped_arms

Array = NDArray[np.float64]
NAME = "ur10e"
RATE = 1000.0  # Hz
PERIOD = 10.0  # s
CHUNK = 200_000  # samples
NOISE = 1e-5, 0.5  # rad, N m
# At the joints: viscous and Coulomb friction, rotor inertia.
VISCOUS, DRY, ROTOR = 8.0, 5.0, 0.6


@cache
def arm() -> Arm:
    """The arm as shipped."""
    return load(shipped_arms(), known_effects())[NAME]


@cache
def links() -> RigidBodies:
    """Its links, with random inertias."""
    own = arm()
    return RigidBodies(own, random_bodies(own, np.random.default_rng(1)))


def period(seed: int) -> tuple[Array, ...]:
    """q, dq, ddq, tau (10 s): a Fourier series, and the efforts that Pinocchio finds for it."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(PERIOD * RATE)) / RATE
    n = len(arm().coordinates)
    q, dq, ddq = np.zeros((len(t), n)), np.zeros((len(t), n)), np.zeros((len(t), n))
    for k in range(1, 6):
        a, b = rng.uniform(-0.3, 0.3, (2, n))
        w = 2 * np.pi * k / PERIOD
        s, c = np.sin(w * t)[:, None], np.cos(w * t)[:, None]
        q, dq, ddq = q + a * s + b * c, dq + w * (a * c - b * s), ddq - w * w * (a * s + b * c)
    own = links()
    rigid = np.array([own.effort(*x) for x in zip(q, dq, ddq, strict=True)])
    return q, dq, ddq, rigid + VISCOUS * dq + DRY * np.sign(dq) + ROTOR * ddq


def chunks(samples: int, seed: int, size: int = CHUNK) -> Iterator[Array]:
    """t, q, tau of so many samples, a chunk (size, 1 + 2 n) at a time; noise of its own in every period."""
    rng = np.random.default_rng(seed)
    q, _, _, tau = period(seed)
    for begin in range(0, samples, size):
        k = np.arange(begin, min(samples, begin + size))
        noise = rng.normal(size=(2, len(k), q.shape[1])) * np.array(NOISE)[:, None, None]
        yield np.column_stack([k / RATE, q[k % len(q)] + noise[0], tau[k % len(q)] + noise[1]])


@cache
def names() -> list[str]:
    """Columns of the log."""
    n = len(arm().coordinates)
    return ["t", *(f"q{k + 1}" for k in range(n)), *(f"tau{k + 1}" for k in range(n))]


def write(path: Path, samples: int, seed: int) -> None:
    """The log as Parquet, as pyarrow writes it by default."""
    schema = pa.schema([(name, pa.float64()) for name in names()])
    with pq.ParquetWriter(path, schema) as writer:
        for table in chunks(samples, seed):
            writer.write_table(pa.Table.from_arrays([pa.array(x) for x in table.T], schema=schema))
