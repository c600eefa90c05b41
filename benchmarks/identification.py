"""Identification of long logs: throughput beside Pinocchio's regressor in a Python loop, and growth.

    python benchmarks/identification.py [SAMPLES]     both, in one run, one thread; ten million by default
    python benchmarks/identification.py --scale MOST  a thousand samples and more; docs/identification.svg

The log of a six-joint arm (ur10e) is written as Parquet, identified by `modelgen identify --stream` in a
process of its own, and its beginning by pinocchio_job.py: the same filters, differences, decimation and
least squares. Reports; asserts no time. Needs pin and pyarrow.
"""

from __future__ import annotations

import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

THREADS = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
os.environ |= THREADS  # before the libraries are loaded

import numpy as np  # noqa: E402

ROOT = Path(__file__).resolve().parents[1]
PATH = ROOT / "benchmarks", ROOT / "tests"
sys.path.insert(0, str(PATH[1]))
CODE = (
    "import sys, resource; from modelgen.cli.app import app\n{before}\n"
    "try:\n    app(sys.argv[1:], standalone_mode=False)\n"
    "finally:\n"
    "    used = resource.getrusage(resource.RUSAGE_SELF)\n"
    "    print('used', used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, file=sys.stderr)"
)
BEFORE = "from identification_scale import instead_of_files; instead_of_files({samples})"
TEST = 20_000  # samples of the record that validates
PEER = 40_000  # samples that the loop gets


def identified(log: Path, held: Path, folder: Path, before: str = "") -> dict[str, Any]:
    """identification.json of `modelgen identify --stream`, with its seconds (wall and CPU) and MiB.

    before: what the process runs first. `made`: CPU seconds that it spent on making the log.
    """
    words = ["identify", "--arm", "ur10e", "--stream", "--train", str(log), "--test", str(held)]
    begin = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", CODE.format(before=before), *words, "--out", str(folder / "out"), "--json"],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"PYTHONPATH": os.pathsep.join([*map(str, PATH), *sys.path])},
    )
    wall = time.perf_counter() - begin
    if done.returncode:
        raise SystemExit(done.stderr)
    cpu, peak = (float(x) for x in done.stderr.split("used")[1].split())
    made = sum(float(x) for x in re.findall(r"^made (.*)$", done.stderr, re.MULTILINE))
    result: dict[str, Any] = json.loads(done.stdout)
    return result | {"wall": wall, "cpu": cpu, "peak": peak, "made": made}


def side_by_side(samples: int) -> None:
    """Both, on the same log."""
    from long_log import RATE, write  # noqa: PLC0415 - needs the tests' folder
    from pinocchio_job import Job  # noqa: PLC0415

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        log, short, held = folder / "train.parquet", folder / "short.parquet", folder / "test.parquet"
        write(log, samples, 1)
        write(short, 100_000, 1)
        write(held, TEST, 2)
        identified(short, held, folder)  # compiles what is not compiled yet
        small, ours = identified(short, held, folder), identified(log, held, folder)
        own = (samples - 100_000) / (ours["cpu"] - small["cpu"])
        whole = samples / ours["cpu"]
        print(
            f"modelgen: {samples:,} samples in {ours['cpu']:.1f} s of CPU ({ours['wall']:.1f} s), of which "
            f"{small['cpu']:.1f} s for a log of 100,000; peak {ours['peak']:.0f} MiB\n"
            f"  {whole:,.0f} samples a second in all, {own:,.0f} beyond the first 100,000"
        )
        words = " ".join(ours["processing"])
        position, cutoff = (float(x) for x in re.findall(r"order 4, ([0-9.]+) Hz", words))
        factor = int(re.findall(r"every ([0-9]+)", words)[0])
        trim = float(re.findall(r"([0-9.]+) s cut off", words)[0])
        for sparse in (False, True):
            job = Job(cutoff, position, 4, factor, round(trim * RATE), sparse)
            begin = time.process_time()
            theta = job.run(log, PEER)
            theirs = PEER / (time.process_time() - begin)
            what = "columns of zeros left out" if sparse else "all base columns filtered"
            print(f"Pinocchio in a loop, {what}: {theirs:,.0f} samples a second")
            print(f"  ratio {whole / theirs:.1f}, beyond the first 100,000 {own / theirs:.1f}")
            print("  us a sample: " + ", ".join(f"{k} {1e6 * v / PEER:.2f}" for k, v in job.seconds.items()))
        effort, columns = job.rows(held_table(held))
        rmse = np.sqrt(np.mean((effort - columns @ theta) ** 2, axis=0))
        print("RMSE on the test record [N m]: modelgen " + " ".join(f"{x:.4f}" for x in ours["test"]["rmse"]))
        print("                               Pinocchio " + " ".join(f"{x:.4f}" for x in rmse))


def regressor_alone() -> None:
    """Rows of the regressor per second of CPU: compiled C, NumPy, Pinocchio in a loop."""
    import pinocchio as pin  # noqa: PLC0415
    from long_log import arm, links, period  # noqa: PLC0415 - needs the tests' folder

    from modelgen.backends.compiled import RegressorColumns  # noqa: PLC0415
    from modelgen.backends.numpy import NumpyFunction  # noqa: PLC0415
    from modelgen.functions import Options, build_model  # noqa: PLC0415

    own = build_model(arm(), Options(without=frozenset({"drives", "effects"})))
    (function,) = [f for f in own.functions if f.name == "regressor"]
    states = period(1)[:3]
    model, data = links().model, links().model.createData()

    def loop() -> None:
        for q, dq, ddq in zip(*states, strict=True):
            pin.computeJointTorqueRegressor(model, data, q, dq, ddq)

    columns, numpy = RegressorColumns(function), NumpyFunction(function)
    found = {}
    for name, call in {
        "compiled C": lambda: columns.values(states),
        "NumPy": lambda: numpy(*states),
        "Pinocchio in a loop": loop,
    }.items():
        times = []
        for _ in range(8):
            begin = time.process_time()
            call()
            times.append(time.process_time() - begin)
        found[name] = states[0].size / float(np.median(times[1:]))
    last = found["Pinocchio in a loop"]
    print("regressor alone, thousand rows a second (ratio to the loop):")
    print("  " + ", ".join(f"{name} {x / 1e3:,.0f} ({x / last:.1f})" for name, x in found.items()))


def held_table(path: Path) -> Any:
    """t, q, tau of a log."""
    import pyarrow.parquet as pq  # noqa: PLC0415

    return np.column_stack([column.to_numpy() for column in pq.read_table(path).columns])


if __name__ == "__main__":
    words = sys.argv[1:]
    if words[:1] == ["--scale"]:
        from identification_scale import scale

        scale(int(float(words[1])) if len(words) > 1 else 10_000_000)
    else:
        regressor_alone()
        side_by_side(int(float(words[0])) if words else 10_000_000)
    print(f"this process: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB")
