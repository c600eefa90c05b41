"""An identification in words: what is known well, what is not, what would help."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.functions.nominal import known_base
from modelgen.identification.impossible import driven, impossible_at
from modelgen.identification.objects import MATTERS, POOR, Estimate, Identification

CLEARLY = 3.0  # standard deviations
_NAMED = 4  # parameters beside the worst
_WORST = 5  # poorly determined parameters that are named with their effort
# What shows a parameter, by the letters that its standard parameter begins with; the first that fits.
_SHOWN_BY = (
    (("FV", "FA", "FN"), "a wider range of speeds"),
    (("FC", "FO", "FS"), "slow turns in both directions, with reversals"),
    (("MX", "MY", "MZ", "V"), "more of the range of positions, slowly, for the weight"),
    (("XX", "XY", "XZ", "YY", "YZ", "ZZ", "I", "J", "M"), "larger accelerations"),
)


def verdict(found: Identification) -> str:
    """Which parameters are well determined, which are not, and what experiment would help."""
    worse, lost = found.poor(), _lost(found)
    text = [*impossible(found), *questions(found), determined(found)]
    if worse:
        worst = sorted(worse, key=lambda pair: -_moved(found, *pair))
        named = ", ".join(_doubtful(found, k) for k, _ in worst[:_WORST])
        left = ", ".join(e.name for _, e in worst[_WORST:])
        text.append(f"Poorly determined: {named}{f'; less in the effort: {left}' if left else ''}.")
    if lost:
        text.append(f"Not determined by these records, set to zero: {', '.join(e.name for e in lost)}.")
    return " ".join([*text, *remarks(found), *helpful(found)])


def impossible(found: Identification) -> list[str]:
    """The sentence that comes first where something was found that no arm has; none where nothing was."""
    said = impossible_at(questions(found), found.arm.coordinate_names)
    return [said] if said else []


def determined(found: Identification) -> str:
    """How many parameters are well determined."""
    dropped = sum(e.dropped for e in found.estimates)
    good = len(found.estimates) - len(_lost(found)) - len(found.poor()) - dropped
    enough = f", or to {MATTERS:g} % of the effort" if found.test is not None else ""
    return f"{good} of {len(found.estimates)} parameters are determined to {POOR:g} %{enough}, or better."


def questions(found: Identification) -> list[str]:
    """What makes the description or the records doubtful."""
    names = found.arm.coordinate_names
    return [*driven(found.estimates, names, signs_tried=found.signs_tried), *found.doubts]


def remarks(found: Identification) -> list[str]:
    """What else there is to know of the parameters, and of how they were found."""
    text, dropped = contradicting(found), [e.name for e in found.estimates if e.dropped]
    if dropped:
        text.append(f"Left out, since the records do not support them: {', '.join(dropped)}.")
    if biased(found):
        text.append(
            "Errors of the positions bias least squares (test of Durbin, Wu and Hausman)"
            + ("; these are by instruments." if found.method == "iv" else ": use --method iv.")
        )
    if found.consistent is not None:
        wrong = found.consistent.violated
        text.append(
            f"Physically consistent; the plain solution closest to the prior is not: {'; '.join(wrong)}."
            if wrong
            else "Physically consistent, as the plain solution is."
        )
    if found.gains:
        names = found.arm.coordinate_names
        gains = ", ".join(f"{names[g.joint - 1]} {g.value / g.described:.3f}" for g in found.gains)
        text.append(f"Torque constants over those of the description: {gains}.")
    return text


def biased(found: Identification) -> bool:
    """Whether errors of the positions bias least squares, by what matters in the effort.

    Without a test record nothing says what matters: what is clear counts.
    """
    both, test = found.comparison, found.test
    if both is None or not both.biased or both.weak:
        return False
    if test is None or test.sizes is None or found.method == "iv":
        return True
    moved = [test.in_effort(k, both.solution.theta[k] - e.value)[1] for k, e in enumerate(found.estimates)]
    return max(moved) > MATTERS


def contradicting(found: Identification) -> list[str]:
    """The parameters that are clearly not the nominal ones, and differ by what matters in the effort.

    Without a test record nothing says what matters: each that differs clearly counts.
    """
    nominal = known_base(found.model)
    apart = list[tuple[float, str, str]]()
    for k, e in enumerate(found.estimates):
        if not e.std or e.dropped or e.name not in nominal:
            continue
        away = e.value - nominal[e.name]
        times = abs(away) / e.std
        share, size = _in_effort(found, k, away)
        if times > CLEARLY and (not size or share > MATTERS):
            apart.append((share if size else times, e.name, f"{times:.0f} standard deviations{size}"))
    if not apart:
        return []
    (_, name, worst), *rest = sorted(apart, reverse=True)
    if not rest:
        return [f"{name} differs from its nominal value by {worst}."]
    others = ", ".join(other for _, other, _ in rest[:_NAMED])
    more = f" and {len(rest) - _NAMED} more" if len(rest) > _NAMED else ""
    against = "" if found.test is None else "against the effort of its joint "
    return [
        f"{len(apart)} of the {len(nominal)} parameters with nominal values differ from these clearly: "
        f"{against}{name} most, by {worst}; then {others}{more}."
    ]


def _in_effort(found: Identification, k: int, value: float) -> tuple[float, str]:
    """Share of the effort in % that `value` of parameter k makes, and the words for it; none where no test
    record says so.
    """
    test = found.test
    if test is None or test.sizes is None:
        return 0.0, ""
    j = test.shown_by(k)
    if j is None:
        return 0.0, " in no effort"
    size, share = test.in_effort(k, value)
    of = f"{share:.2g} % of the effort of {found.arm.coordinate_names[j]}"
    return share, f" or {size:.2g} {test.unit[j]}, {of}"


def helpful(found: Identification) -> list[str]:
    """What would determine the parameters that are not."""
    wanting = [*_lost(found), *(e for _, e in found.poor())]
    advice = experiment(wanting, found.arm.coordinate_names)
    return [f"What would help: {'; '.join(advice)}. See modelgen excite."] if advice else []


def _lost(found: Identification) -> list[Estimate]:
    return [e for e in found.estimates if e.std is None and not e.dropped]


def _moved(found: Identification, k: int, e: Estimate) -> float:
    """Share of the effort in % that a standard deviation moves, zero where no test record says so."""
    return 0.0 if found.test is None else found.test.in_effort(k, e.std or 0.0)[1]


def _doubtful(found: Identification, k: int) -> str:
    """A parameter with the effort that its standard deviation stands for, where a test record says so."""
    e, test = found.estimates[k], found.test
    j = None if test is None else test.shown_by(k)
    if test is None or j is None or e.std is None:
        return e.name
    size, share = test.in_effort(k, e.std)
    name = found.arm.joints[found.arm.coordinates[j]].name
    return f"{e.name} ({size:.2g} {test.unit[j]}, {share:.1f} % of the effort of {name})"


def experiment(wanting: Sequence[Estimate], names: Sequence[str]) -> list[str]:
    """Experiments that would show the parameters, joint after joint. names: of the coordinates."""
    found: dict[str, set[int]] = {}
    for e in wanting:
        name = e.standard or e.name
        kind = next((what for heads, what in _SHOWN_BY if name.startswith(heads)), "faster motion")
        found.setdefault(kind, set()).add(e.joint)
    order = [what for _, what in _SHOWN_BY] + ["faster motion"]
    return [
        f"{what}, of {', '.join(names[joint - 1] for joint in sorted(found[what]))}"
        for what in order
        if what in found
    ]
