"""What to measure next where several causes explain the records."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from modelgen.diagnosis.objects import Named
from modelgen.effects import CATALOGUE


def next_experiment(causes: Sequence[Named]) -> Mapping[str, Any] | None:
    """The bench test that separates the first ambiguous cause from its rivals; None where none is needed."""
    for cause in causes:
        rivals = [(effect, joint) for effect, joint, _ in cause.ambiguous_with] + list(cause.aliases)
        if not rivals:
            continue
        tests = [CATALOGUE[cause.effect].experiment]
        tests += [t for effect, _ in rivals if (t := CATALOGUE[effect].experiment) not in tests]
        return {
            "separates": [
                {"effect": cause.effect, "joint": cause.joint},
                *({"effect": effect, "joint": joint} for effect, joint in rivals),
            ],
            "tests": tests,
        }
    return None
