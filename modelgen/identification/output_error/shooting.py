"""The least-squares problem of a refinement, by multiple shooting: linearised, condensed, solved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from modelgen.errors import InputError
from modelgen.identification.output_error.effort_noise import scatter
from modelgen.identification.output_error.parts import Guess, Part
from modelgen.identification.output_error.sensitivities import Sensitive
from modelgen.numeric import Array
from modelgen.simulation.metrics import Scores, scores

SINGULAR = 1e7  # condition of the scaled columns, beyond which values are not separated


@dataclass(frozen=True)
class Step:
    """Changes of the parameters (f,) and, by part, of the states at the beginnings of its intervals.

    promised: cost where everything is as linear as is assumed.
    """

    parameters: Array
    states: list[Array]
    promised: float


@dataclass(frozen=True)
class Linear:
    """Parts: errors (K, n), their columns by parameters (K, n, f) and by initial state (K, n, 2n), gaps
    of the intervals (W - 1, 2n), and how the states of the intervals follow: W times (offset, matrix)."""

    errors: list[Array]
    columns: list[Array]
    initial: list[Array]
    raw: list[Array]
    gaps: list[Array]
    follow: list[list[tuple[Array, Array]]]
    spread: Array

    def weights(self) -> Array:
        """One over the errors' RMS by joint, (n,)."""
        e = np.concatenate(self.raw)
        return np.asarray(1.0 / np.maximum(np.sqrt((e**2).mean(axis=0)), 1e-9))

    def cost(self, weights: Array) -> float:
        """Errors and gaps."""
        return total(self.raw, self.gaps, weights, self.spread)

    def _projected(self, weights: Array) -> tuple[list[Array], list[Array], list[Array]]:
        """Errors and columns with the initial states' share taken off, and the bases of that share."""
        errors, columns, bases = [], [], []
        for e, c, x in zip(self.errors, self.columns, self.initial, strict=True):
            own, rhs = ((a * weights.reshape(-1, *[1] * (a.ndim - 2))) for a in (x, e))
            size = len(e) * e.shape[1]
            u, s, _ = np.linalg.svd(own.reshape(size, -1), full_matrices=False)
            u = u[:, s > 1e-9 * s.max()]
            rhs, c2 = rhs.reshape(size), (c * weights[:, None]).reshape(size, c.shape[2])
            errors.append((rhs - u @ (u.T @ rhs)).reshape(e.shape))
            columns.append((c2 - u @ (u.T @ c2)).reshape(c.shape))
            bases.append(u)
        return errors, columns, bases

    def step(self, weights: Array, names: Sequence[str], free: NDArray[np.bool_]) -> Step:
        """Gauss-Newton, over the parameters `free` (f,) alone.

        Raises InputError where those of the parameters `names` are not separated.
        """
        errors, columns, _ = self._projected(weights)
        a = np.concatenate([c.reshape(-1, c.shape[2]) for c in columns])[:, free]
        size = np.linalg.norm(a, axis=0)
        _, s, v = np.linalg.svd(a / np.where(size > 0, size, 1.0), full_matrices=False)
        if len(s) and s[-1] * SINGULAR < s[0]:
            left = [name for name, wanted in zip(names, free, strict=True) if wanted]
            weak = [name for name, x in zip(left, v[-1], strict=True) if abs(x) > 0.1]
            raise InputError(
                f"these motions do not tell {', '.join(weak)} apart: hold one of them (--free names those "
                "that are tuned); without efforts the links' inertias must give the scale"
            )
        b = np.concatenate([e.ravel() for e in errors])
        change, states = np.zeros(len(names)), []
        change[free] = np.linalg.lstsq(a / size, b, rcond=None)[0] / size
        promised = float(np.sum((b - a @ change[free]) ** 2))
        for e, c, x, follow in zip(self.errors, self.columns, self.initial, self.follow, strict=True):
            rest = ((e - c @ change) * weights).ravel()
            own = (x * weights[:, None]).reshape(len(rest), -1)
            first = np.linalg.lstsq(own, rest, rcond=1e-9)[0]
            z = np.concatenate([first, change])
            states.append(np.array([offset + matrix @ z for offset, matrix in follow]))
        return Step(change, states, promised)

    def deviations(self, weights: Array, steps: Sequence[Array]) -> Array:
        """Standard deviations of the parameters (f,): B M B, B the inverse of X' X.

        M is the sum over joints of V_j X_j' X_j, V_j the joint's spectral density at zero, 1 + 2 sum of its
        autocorrelations times its variance; or, of driven motions, what noise of the efforts makes it. Of
        the two the larger one counts for each parameter. steps: as of `Sensitive.disturbed`, by part; none of
        free motions.
        """
        errors, columns, bases = self._projected(weights)
        f = columns[0].shape[2]
        normal, spectral = np.zeros((f, f)), np.zeros((f, f))
        for j in range(len(weights)):
            own = sum((c[:, j].T @ c[:, j] for c in columns), np.zeros((f, f)))
            normal += own
            spectral += _long_run([e[:, j] for e in errors]) * own
        size = np.sqrt(np.diag(normal))
        inverse = np.linalg.inv(normal / np.outer(size, size)) / np.outer(size, size)
        meats = [spectral, scatter(errors, columns, bases, steps, weights)] if steps else [spectral]
        return np.asarray(np.sqrt(np.max([np.diag(inverse @ x @ inverse) for x in meats], axis=0)))


@dataclass(frozen=True)
class Fit:
    """The parts of all records under the model."""

    model: Sensitive
    parts: Sequence[Part]

    def linear(self, p: Array, guesses: Sequence[Guess]) -> Linear:
        """Everything about p and the states, condensed. Raises InputError where the simulation ends."""
        n, f = self.model.plant.n, len(self.model.free)
        made = Linear([], [], [], [], [], [], self.spread())
        for part, guess in zip(self.parts, guesses, strict=True):
            offset, matrix = np.zeros(2 * n), np.eye(2 * n, 2 * n + f)
            rows, raw, gaps, follow = [], [], [], []
            for w, (begin, end) in enumerate(part.intervals):
                follow.append((offset, matrix))
                take = slice(begin, end + 1)
                path, s = self.model.run(guess.states[w], part.t[take], part.input[take], p)
                if not np.isfinite(path).all():
                    raise InputError(f"{part.name}: the simulation from {part.t[begin]:.6g} s is not finite")
                last = w == len(part.intervals) - 1
                kept = slice(None) if last else slice(0, -1)
                whole = np.concatenate([matrix, np.eye(f, 2 * n + f, 2 * n)])
                e = part.q[take] - path[:, :n]
                raw.append(e[kept])
                rows.append(((e - s[:, :n, : 2 * n] @ offset)[kept], (s[:, :n] @ whole)[kept]))
                if not last:
                    gap = path[-1] - guess.states[w + 1]
                    gaps.append(gap)
                    offset, matrix = s[-1, :, : 2 * n] @ offset + gap, s[-1] @ whole
            columns = np.concatenate([c for _, c in rows])
            made.errors.append(np.concatenate([e for e, _ in rows]))
            made.initial.append(columns[:, :, : 2 * n])
            made.columns.append(columns[:, :, 2 * n :])
            made.raw.append(np.concatenate(raw))
            made.gaps.append(np.array(gaps).reshape(-1, 2 * n))
            made.follow.append(follow)
        return made

    def cost(self, p: Array, guesses: Sequence[Guess], weights: Array) -> float:
        """Infinite where the simulation ends."""
        raw, gaps = [], []
        n = self.model.plant.n
        for part, guess in zip(self.parts, guesses, strict=True):
            for w, (begin, end) in enumerate(part.intervals):
                take = slice(begin, end + 1)
                path = self.model.run(guess.states[w], part.t[take], part.input[take], p)[0]
                last = w == len(part.intervals) - 1
                raw.append((part.q[take] - path[:, :n])[: None if last else -1])
                if not last:
                    gaps.append((path[-1] - guess.states[w + 1])[None])
        found = total(raw, gaps, weights, self.spread())
        return found if np.isfinite(found) else np.inf

    def spread(self) -> Array:
        """Weight of a gap of the states, (2n,): speeds in terms of positions."""
        q = np.concatenate([part.q - part.q.mean(axis=0) for part in self.parts])
        dq = np.concatenate([part.dq for part in self.parts])
        ratio = np.sqrt((q**2).mean(axis=0) / np.maximum((dq**2).mean(axis=0), 1e-12))
        return np.concatenate([np.ones(len(ratio)), ratio])

    def steps(self, p: Array, guesses: Sequence[Guess]) -> list[Array]:
        """What every interval between samples of every part does, as of `Sensitive.disturbed`."""
        pairs = zip(guesses, self.parts, strict=True)
        return [self.model.disturbed(g.states[0], part.t, part.input, p) for g, part in pairs]

    def runs(self, p: Array, guesses: Sequence[Guess]) -> list[Array]:
        """Positions (K, n) of every part, simulated from its initial state alone."""
        n, run = self.model.plant.n, self.model.run
        pairs = zip(guesses, self.parts, strict=True)
        return [run(g.states[0], part.t, part.input, p)[0][:, :n] for g, part in pairs]


def scored(every: Sequence[Part], runs: Sequence[Array]) -> Scores:
    """Scores of all parts as one record."""
    return scores(np.concatenate([part.q for part in every]), np.concatenate(runs))


def total(raw: Sequence[Array], gaps: Sequence[Array], weights: Array, spread: Array) -> float:
    """Squares of the weighted errors; a gap counts as the errors of some ten samples would."""
    found = sum(float(((e * weights) ** 2).sum()) for e in raw)
    return found + 10.0 * sum(float(((g * spread * np.tile(weights, 2)) ** 2).sum()) for g in gaps)


def _long_run(parts: Sequence[Array]) -> float:
    """Variance times the time that errors hang together: autocovariances by pairs of lags, up to the first
    pair whose sum is negative (Geyer 1992, section 3.3)."""
    count, size = sum(len(e) for e in parts), min(len(e) for e in parts)

    def lag(k: int) -> float:
        return sum(float(e[: len(e) - k] @ e[k:]) for e in parts) / count

    total = -lag(0)
    for k in range(0, size // 2 - 1, 2):
        pair = lag(k) + lag(k + 1)
        if pair <= 0.0:
            break
        total += 2.0 * pair
    return max(total, lag(0))
