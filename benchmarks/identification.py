"""Identification of a long log of ur10e: python benchmarks/identification.py [samples].

Writes a Parquet log of a periodic motion with noise (ten million samples by default), identifies it block by
block in a process of its own, and prints its peak memory and samples per second; beside it, in the same run
and on one core, the regressor of Pinocchio called in a loop from Python over noise-free samples in memory,
summed and solved, without a file, filters, derivatives or uncertainties. Needs pin and pyarrow.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pinocchio as pin
import pyarrow as pa
import pyarrow.parquet as pq

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from witness.bodies import Body, random_bodies
from witness.rigid_bodies import RigidBodies

from modelgen.description import Arm, load
from modelgen.effects import known_effects
from modelgen.functions import Options
from modelgen.functions.options import prepared
from modelgen.resources import shipped_arms

RATE = 1000.0
CHUNK = 200_000


def main(samples: int) -> None:
    """Both."""
    arm = prepared(
        load(shipped_arms(), known_effects())["ur10e"], Options(without=frozenset({"drives", "effects"}))
    )
    bodies = random_bodies(arm, np.random.default_rng(1))
    with tempfile.TemporaryDirectory() as folder:
        log, held = Path(folder) / "train.parquet", Path(folder) / "test.parquet"
        write(log, samples, arm, bodies, 1)
        write(held, 20_000, arm, bodies, 2)
        code = (
            "import sys, resource; from modelgen.cli.app import app\n"
            "try:\n    app(sys.argv[1:], standalone_mode=False)\n"
            "finally:\n    print('peak', resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, file=sys.stderr)"
        )
        words = ["identify", "--arm", "ur10e", "--without", "effects", "--stream"]
        words += ["--train", str(log), "--test", str(held), "--out", str(Path(folder) / "out"), "--json"]
        one = os.environ | dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
        begin = time.perf_counter()
        done = subprocess.run(
            [sys.executable, "-c", code, *words], capture_output=True, text=True, check=False, env=one
        )
        ours = time.perf_counter() - begin
        if done.returncode:
            raise SystemExit(done.stderr)
        peak = int(done.stderr.split("peak")[1]) / 1024
        speed = samples / ours
        print(f"modelgen: {samples:,} samples in {ours:.1f} s, {speed:,.0f} a second, peak {peak:.0f} MiB")
        theirs = loop(arm, bodies, min(samples, 50_000))
        print(
            f"Pinocchio in a Python loop: {theirs:,.0f} samples a second; ratio {samples / ours / theirs:.1f}"
        )
    print(f"this process: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB")


def write(path: Path, samples: int, arm: Arm, bodies: list[Body], seed: int) -> None:
    """t, q, tau: periods of ten seconds, the same ones with noise of their own."""
    rng = np.random.default_rng(seed)
    q, _, _, tau = period(arm, bodies, rng)
    n = q.shape[1]
    names = ["t", *(f"q{k + 1}" for k in range(n)), *(f"tau{k + 1}" for k in range(n))]
    schema = pa.schema([(name, pa.float64()) for name in names])
    with pq.ParquetWriter(path, schema) as writer:
        for begin in range(0, samples, CHUNK):
            k = np.arange(begin, min(samples, begin + CHUNK))
            noisy = tau[k % len(tau)] + 0.5 * rng.normal(size=(len(k), n))
            table = np.column_stack([k / RATE, q[k % len(q)] + 1e-5 * rng.normal(size=(len(k), n)), noisy])
            writer.write_table(pa.Table.from_arrays([pa.array(x) for x in table.T], schema=schema))


def period(arm: Arm, bodies: list[Body], rng: np.random.Generator) -> tuple[np.ndarray, ...]:
    """q, dq, ddq, tau (10 s)."""
    t = np.arange(round(10 * RATE)) / RATE
    n = len(arm.coordinates)
    q, dq, ddq = np.zeros((len(t), n)), np.zeros((len(t), n)), np.zeros((len(t), n))
    for k in range(1, 6):
        a, b = rng.uniform(-0.3, 0.3, (2, n))
        w = 2 * np.pi * 0.1 * k
        s, c = np.sin(w * t)[:, None], np.cos(w * t)[:, None]
        q, dq, ddq = q + a * s + b * c, dq + w * (a * c - b * s), ddq - w * w * (a * s + b * c)
    links = RigidBodies(arm, bodies)
    return q, dq, ddq, np.array([links.effort(*x) for x in zip(q, dq, ddq, strict=True)])


def loop(arm: Arm, bodies: list[Body], samples: int) -> float:
    """Samples a second of the plain loop: no filter, no uncertainty; regressor, normal matrix, solution."""
    q, dq, ddq, tau = period(arm, bodies, np.random.default_rng(1))
    links = RigidBodies(arm, bodies)
    model, data = links.model, links.model.createData()
    size = 10 * model.nv
    normal, right = np.zeros((size, size)), np.zeros(size)
    begin = time.perf_counter()
    done = 0
    while done < samples:
        rows = np.empty((1000, model.nv, size))
        part = np.arange(done, done + 1000) % len(q)
        for i, k in enumerate(part):
            rows[i] = pin.computeJointTorqueRegressor(model, data, q[k], dq[k], ddq[k])
        table = rows.reshape(-1, size)
        normal += table.T @ table
        right += table.T @ tau[part].ravel()
        done += 1000
    np.linalg.lstsq(normal, right, rcond=None)
    return done / (time.perf_counter() - begin)


if __name__ == "__main__":
    main(int(float(sys.argv[1])) if len(sys.argv) > 1 else 10_000_000)
