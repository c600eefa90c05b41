"""Effects that the records could not show, whatever is there."""

from __future__ import annotations

from modelgen.description import Arm
from modelgen.diagnosis.candidates import at_links, at_motor, cold
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.selection import Selection
from modelgen.effects import CATALOGUE, Family, Presence, Seen


def not_identifiable(arm: Arm, equations: Equations, selection: Selection) -> tuple[tuple[str, str], ...]:
    """What these records could not show, whatever is there; what concerns all of them first."""
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
    return tuple((e.name, reason) for e in order for reason in e.hidden(arm, seen, e.name in named))
