"""What sticks and what slides, for accelerations free + dry @ s."""

from __future__ import annotations

import numpy as np

from modelgen.errors import InputError
from modelgen.numeric import Array

Modes = tuple[int, ...]  # of every contact: 1 or -1 sliding, 0 sticking


def hold(free: Array, dry: Array, rows: Array, modes: Modes) -> Array:
    """s (c,): the directions of sliding contacts, and what keeps the sticking ones from accelerating.

    free: (n,), dry: (n, c), rows: (c, n). Raises InputError where sticking contacts have no friction.
    """
    s = np.array(modes, dtype=float)
    stuck = [k for k, mode in enumerate(modes) if mode == 0]
    if stuck:
        pull = rows[stuck] @ (free + dry @ s)
        try:
            s[stuck] = -np.linalg.solve(rows[stuck] @ dry[:, stuck], pull)
        except np.linalg.LinAlgError:
            raise InputError(
                "a joint with dry friction in its description has none among its parameters; "
                "expected a positive value, or the effect left out"
            ) from None
    return s


def accelerated(free: Array, dry: Array, s: Array, modes: Modes, own: list[int]) -> Array:
    """Accelerations (n,): exactly zero where a joint sticks."""
    ddq = free + dry @ s
    for k, mode in enumerate(modes):
        if mode == 0 and own[k] >= 0:
            ddq[own[k]] = 0.0
    return ddq


def settled(free: Array, dry: Array, rows: Array, modes: Modes, at_rest: list[int]) -> Modes:
    """Modes of the contacts `at_rest`, which have no speed; those of the others stay.

    A complementarity problem: a contact that would have to pull beyond its limits slides, and one that
    slides has an acceleration of its own direction. Its matrix is that of a positive definite form times
    positive magnitudes, so that the solution is one (Cottle, Pang and Stone 1992); found by pivoting.
    """
    found = list(modes)
    able = [k for k in at_rest if rows[k] @ dry[:, k] < 0.0]
    for k in at_rest:
        # Without friction of its own a contact cannot stick.
        found[k] = 0 if k in able else (1 if rows[k] @ free >= 0.0 else -1)
    for _ in range(40 * max(1, len(found))):
        now = tuple(found)
        s = hold(free, dry, rows, now)
        a = rows @ (free + dry @ s)
        back = [k for k in able if found[k] and a[k] * found[k] < 0.0]
        if back:
            found[back[0]] = 0
            continue
        over = [k for k in able if not found[k] and abs(s[k]) > 1.0]
        if not over:
            break
        k = max(over, key=lambda k: abs(s[k]))
        found[k] = 1 if s[k] > 0 else -1
    return tuple(found)
