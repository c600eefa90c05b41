"""Jobs that other processes can import, and a Dask cluster of two workers on this machine."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

DEADLY = 3


def square(x: int) -> int:
    return x * x


def deadly(x: int) -> int:
    """The square, except where it ends the process as the kernel does when memory is out, by when another job
    waits behind it.
    """
    if x == DEADLY:
        time.sleep(0.2)
        os.kill(os.getpid(), signal.SIGKILL)
    return x * x


def refused(x: int) -> int:
    raise ValueError(f"no {x}")


def lost(x: int) -> int:
    return -x


def process(x: int) -> tuple[int, str | None]:
    time.sleep(0.2)
    return os.getpid(), os.environ.get("OPENBLAS_NUM_THREADS")


@contextmanager
def cluster(folder: Path, workers: int = 2, failures: int = 3) -> Iterator[str]:
    """Address of a scheduler with that many workers of one thread each, which end with the context.

    failures: ends of workers that a job may have part in.
    """
    file = folder / "scheduler.json"
    tests = Path(__file__).resolve().parents[1]
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(map(str, (tests.parent, tests, tests / "support"))),
        "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": str(failures),
    }
    dask = [sys.executable, "-m", "dask"]
    commands = [
        [*dask, "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--no-show"],
        *[[*dask, "worker", "--nthreads", "1", "--no-dashboard", "--local-directory", str(folder)]] * workers,
    ]
    with (folder / "cluster.log").open("w", encoding="utf-8") as log:
        started = [
            subprocess.Popen(
                [*command, "--scheduler-file", str(file)],
                cwd=folder,
                env=environment,
                stdout=log,
                stderr=subprocess.STDOUT,
            )
            for command in commands
        ]
        try:
            yield _address(file, folder / "cluster.log")
        finally:
            # The scheduler last: workers that lose it try to find it again.
            for group in (started[1:], started[:1]):
                for one in group:
                    one.terminate()
                for one in group:
                    one.wait(timeout=60)


def _address(file: Path, log: Path) -> str:
    for _ in range(300):
        if file.exists() and file.stat().st_size:
            return str(json.loads(file.read_text(encoding="utf-8"))["address"])
        time.sleep(0.1)
    raise RuntimeError(f"no scheduler after 30 s: {log.read_text(encoding='utf-8')[-2000:]}")
