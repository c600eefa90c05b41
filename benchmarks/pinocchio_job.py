"""An identification as one writes it in Python around Pinocchio's regressor.

Positions through a Butterworth filter forwards and backwards, central differences, the regressor sample by
sample in a loop, friction and rotor columns, the columns of a base (Gautier 1991), one low-pass filter for
efforts and columns, decimation, triangles of blocks, weights by joint. One thread.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pyarrow.parquet as pq
from long_log import RATE, links, names
from numpy.typing import NDArray
from scipy import linalg, ndimage, signal

Array = NDArray[np.float64]
BLOCK = 20_000  # samples
TAPS = (np.array([-1, 9, -45, 0, 45, -9, 1]) / 60, np.array([2, -27, 270, -490, 270, -27, 2]) / 180)
DEPENDENT = 1e-8


@dataclass
class Job:
    """The settings are those that modelgen has chosen. sparse: columns that are zero are not filtered."""

    cutoff: float
    position_cutoff: float
    order: int
    factor: int
    trim: int
    sparse: bool
    seconds: dict[str, float] = field(default_factory=dict)
    base: NDArray[np.intp] | None = None

    @contextmanager
    def timed(self, part: str) -> Iterator[None]:
        """CPU time of a part of the work."""
        begin = time.process_time()
        yield
        self.seconds[part] = self.seconds.get(part, 0.0) + time.process_time() - begin

    def rows(self, table: Array) -> tuple[Array, Array]:
        """Filtered and decimated efforts (M, n) and base columns (M, n, p) of a block of the log."""
        n = (table.shape[1] - 1) // 2
        with self.timed("positions"):
            sos = signal.butter(self.order, self.position_cutoff, fs=RATE, output="sos")
            q = signal.sosfiltfilt(sos, table[:, 1 : n + 1], axis=0)
            dq, ddq = (
                ndimage.correlate1d(q, taps * RATE**k, axis=0, mode="nearest")
                for k, taps in enumerate(TAPS, 1)
            )
            for x in (dq, ddq):  # the outermost samples have no neighbours
                x[:3], x[-3:] = x[3], x[-4]
        with self.timed("regressor"):
            own = links()
            model, data = own.model, own.model.createData()
            standard = np.empty((len(q), n, 10 * n))
            for i in range(len(q)):
                standard[i] = pin.computeJointTorqueRegressor(model, data, q[i], dq[i], ddq[i])
        with self.timed("columns"):
            more = np.zeros((len(q), n, 3 * n))
            for j in range(n):
                more[:, j, 3 * j : 3 * j + 3] = np.column_stack([dq[:, j], np.sign(dq[:, j]), ddq[:, j]])
            columns = np.concatenate([standard, more], axis=2)
            if self.base is None:
                self.base = independent(columns[:: len(columns) // 500].reshape(-1, columns.shape[2]))
            columns = columns[:, :, self.base]
        with self.timed("low-pass"):
            sos = signal.butter(self.order, self.cutoff, fs=RATE, output="sos")
            kept = slice(self.trim, len(q) - self.trim, self.factor)
            effort = signal.sosfiltfilt(sos, table[:, n + 1 :], axis=0)[kept]
            found = np.zeros((len(effort), *columns.shape[1:]))
            for j in range(n):
                some = columns[0, j] != 0 if self.sparse else slice(None)
                found[:, j, some] = signal.sosfiltfilt(sos, columns[:, j, some], axis=0)[kept]
        return effort, found

    def run(self, log: Path, samples: int) -> Array:
        """Base parameters (p,) from the first samples of the log."""
        n, done = 6, 0
        triangles: dict[int, Array] = {}
        blocks = pq.ParquetFile(log).iter_batches(BLOCK, columns=names(), use_threads=False)
        while done < samples:
            with self.timed("reading"):
                batch = next(blocks)
                table = np.column_stack([batch.column(name).to_numpy() for name in names()])
            done += len(table)
            if len(table) < 4 * self.trim:
                continue
            effort, columns = self.rows(table)
            with self.timed("triangles"):
                for j in range(n):
                    rows = np.column_stack([columns[:, j], effort[:, j]])
                    both = np.vstack([triangles[j], rows]) if j in triangles else rows
                    triangles[j] = np.asarray(np.linalg.qr(both, mode="r"))
        with self.timed("solution"):
            sigma = np.ones(n)
            for _ in range(5):
                whole = np.vstack([triangles[j] / sigma[j] for j in range(n)])
                theta = linalg.lstsq(whole[:, :-1], whole[:, -1])[0]
                left = [np.linalg.norm(triangles[j] @ [*-theta, 1.0]) for j in range(n)]
                sigma = np.array(left) / np.sqrt(done / self.factor)
        return np.asarray(theta)


def independent(rows: Array) -> NDArray[np.intp]:
    """Columns of a base, by a QR decomposition with pivoting."""
    scaled = rows / np.maximum(np.linalg.norm(rows, axis=0), 1e-12)
    result: Any = linalg.qr(scaled, mode="r", pivoting=True)
    size = np.abs(np.diag(result[0]))
    return np.sort(result[1][: int(np.sum(size > DEPENDENT))])
