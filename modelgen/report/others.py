"""What might be missing as well, or instead: suspects, and rivals of the causes."""

from __future__ import annotations

from modelgen.diagnosis.extended import NamedCause
from modelgen.diagnosis.result import Diagnosis
from modelgen.effects.placement import titled
from modelgen.report.diagnosis_sentences import cause_title, checked, perhaps
from modelgen.report.words import sentence


def suspicions(d: Diagnosis) -> list[str]:
    """What has evidence and is not named, each with the check that it failed."""
    said = []
    for c in d.suspects:
        failed = (f"{name}: {text}" for name, mark, text in map(checked, c.checks) if mark == "no")
        known = (
            f"{cause_title(d, c)} has evidence of {c.delta_bic:z.1f} and is not named: {'; '.join(failed)}."
        )
        said.append(f"{suspected(d, c)}{known}")
    return said


def suspected(d: Diagnosis, c: NamedCause) -> str:
    """A suspect in words, before its name; empty where the headline has them."""
    return f"{sentence(f'perhaps {perhaps(d, c)}')} " if d.causes else ""


def rivals(d: Diagnosis) -> list[tuple[str, str, str]]:
    """Cause, rival and why it is not named, of every cause."""
    found = []
    further = "" if d.next_experiment is None else "; the next experiment separates them"
    for c in d.causes:
        own = cause_title(d, c)
        found += [
            (own, titled(d.arm, e, j), "no motion of this arm separates the two: it is named by convention")
            for e, j in c.aliases
        ]
        found += [
            (
                own,
                titled(d.arm, e, j),
                f"delta BIC {behind:z.1f} behind: nearly as good{further}",
            )
            for e, j, behind in c.ambiguous_with
        ]
    return found


def near(d: Diagnosis) -> str:
    """The nearest rival of every cause that has one, in a sentence; empty where none has."""
    said = []
    for c in d.causes:
        if c.ambiguous_with:
            effect, joint, behind = min(c.ambiguous_with, key=lambda other: other[2])
            own = f" instead of {cause_title(d, c)}" if len(d.causes) > 1 else ""
            said.append(f"{titled(d.arm, effect, joint)}{own}, {behind:z.1f} of delta BIC behind")
    return sentence(f"nearly as good: {'; '.join(said)}") if said else ""
