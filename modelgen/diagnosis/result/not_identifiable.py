"""Effects that the records could not show, whatever is there."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.description import Arm
from modelgen.diagnosis.candidates import at_links, at_motor, cold
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.extended import NamedCause
from modelgen.diagnosis.selection import Selection
from modelgen.effects import CATALOGUE, Family, Presence, Seen


def not_identifiable(
    arm: Arm, equations: Equations, selection: Selection, causes: Sequence[NamedCause] = ()
) -> tuple[tuple[str, str], ...]:
    """What these records could not show, whatever is there: of the causes, then what concerns all records."""
    rows, n, coarse = equations.rows, equations.n, equations.coarse
    moved = any(r.prepared.input is not None for r in rows)
    unsided = [
        j for j in range(1, n + 1) if moved and not at_motor(j, rows) and (coarse or not at_links(j, rows))
    ]
    still = [j + 1 for j in range(n) if not any(r.moving[:, j].any() for r in rows)]
    seen = Seen(cold(equations), tuple(still), tuple(unsided), coarse)
    named = {c.trial.candidate.effect for c in selection.causes}
    presences = [Presence.SOME, Presence.FADING, Presence.ALWAYS]
    order = sorted(
        CATALOGUE.values(),
        key=lambda e: (
            presences.index(e.presence),
            not e.exact,
            e.family is not Family.ELASTIC,
            e.simpler is not None,
        ),
    )
    hidden = ((e.name, reason) for e in order for reason in e.hidden(arm, seen, e.name in named))
    return (*_unseparated(causes), *hidden)


def _unseparated(causes: Sequence[NamedCause]) -> list[tuple[str, str]]:
    return [
        (
            c.effect,
            f"its {name}{'' if c.joint_name is None else f' at {c.joint_name}'} acts as the arm's own "
            "parameters do, which hold it: they are off by it, and the model is right with both",
        )
        for c in causes
        for name, e in c.parameters.items()
        if not e.separate
    ]
