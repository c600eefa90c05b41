"""Time and memory of an identification over the length of the log: a table, and docs/identification.svg."""

from __future__ import annotations

import json
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from identification import BEFORE, ROOT, TEST, identified
from long_log import CHUNK, NOISE, RATE, names, period, write
from numpy.typing import NDArray

from modelgen.dataset.objects import Reader, Wanted
from modelgen.dataset.reading import sources
from modelgen.dataset.reading.tables import open_table
from modelgen.figures import COLOURS, figure, svg

Array = NDArray[np.float64]
ON_DISK = 1_000  # samples, beyond which a log is made block by block as it is read
MADE = "made.parquet"


class Made:
    """A log that exists nowhere: made as it is read. The time that this takes goes to standard error."""

    by_column = True
    remarks: tuple[str, ...] = ()

    def __init__(self, samples: int) -> None:
        self.samples, self.names = samples, tuple(names())
        q, _, _, tau = period(1)
        rng = np.random.default_rng(1)
        noise = rng.normal(size=(2, CHUNK, q.shape[1])) * np.array(NOISE)[:, None, None]
        repeated = np.arange(CHUNK) % len(q)  # a whole number of periods
        self.part = np.empty((len(self.names), CHUNK))
        self.part[1:] = np.hstack([q[repeated], tau[repeated]]).T
        self.noise = np.hstack([noise[0], noise[1]]).T
        self.rng = rng

    def blocks(self, wanted: Wanted, rows: int) -> Iterator[Array]:
        """The wanted columns; the noise of every chunk begins elsewhere."""
        for begin in range(0, self.samples, CHUNK):
            start = time.process_time()
            count = min(CHUNK, self.samples - begin)
            self.part[0] = (begin + np.arange(CHUNK)) / RATE
            table = self.part[: len(wanted.names)].copy()
            if len(wanted.names) > 1:
                table[1:] += np.roll(self.noise, int(self.rng.integers(CHUNK)), axis=1)
            print("made", time.process_time() - start, file=sys.stderr)
            for first in range(0, count, rows):
                yield table[:, first : min(count, first + rows)].T


def instead_of_files(samples: int) -> None:
    """Let the file MADE be a log of so many samples."""

    def opened(path: Path) -> Reader:
        return Made(samples) if path.name == MADE else open_table(path)

    vars(sources)["open_table"] = opened


def scale(most: int) -> None:
    """Samples, CPU seconds and peak memory, in steps of ten."""
    table = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        held = folder / "test.parquet"
        write(held, TEST, 2)
        for samples in [10**k for k in range(3, 12) if 10**k <= most]:
            log = folder / (MADE if samples > ON_DISK else "train.parquet")
            if samples > ON_DISK:
                log.touch()
                found = identified(log, held, folder, BEFORE.format(samples=samples))
            else:
                write(log, samples, 1)
                found = identified(log, held, folder)
            table.append((samples, found["cpu"] - found["made"], found["peak"]))
            print(f"{samples:>12,} samples {table[-1][1]:8.1f} s of CPU {found['peak']:6.0f} MiB", flush=True)
    rounded = [(samples, round(seconds, 1), round(peak)) for samples, seconds, peak in table]
    (ROOT / "benchmarks" / "identification.json").write_text(json.dumps(rounded) + "\n", encoding="utf-8")
    (ROOT / "docs" / "identification.svg").write_text(picture(rounded), encoding="utf-8")


def picture(table: Sequence[tuple[int, float, float]]) -> str:
    """CPU time and peak memory over the samples as SVG."""
    samples, seconds, memory = np.array(table).T
    made, axes = figure(1, 2, (8.0, 3.0))
    line = seconds[-1] * samples / samples[-1]
    axes[0, 0].loglog(samples, line, color=COLOURS[4], linestyle="--", label="proportional")
    for axis, values, what in (
        (axes[0, 0], seconds, "CPU time [s]"),
        (axes[0, 1], memory, "peak memory [MiB]"),
    ):
        axis.loglog(samples, values, color=COLOURS[0], marker="o", label="modelgen identify --stream")
        axis.set_xlabel("samples of a six-joint arm")
        axis.set_ylabel(what)
    axes[0, 0].set_ylim(bottom=1.0)
    axes[0, 1].set_ylim(100, 2000)
    axes[0, 0].legend(loc="upper left")
    return svg(made)
