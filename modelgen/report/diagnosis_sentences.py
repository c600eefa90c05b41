"""Sentences about a diagnosis, as its report and the terminal say them."""

from __future__ import annotations

import numpy as np

from modelgen.charts import at_joints, number
from modelgen.diagnosis.adequacy import LackOfFit
from modelgen.diagnosis.extended import NamedCause
from modelgen.diagnosis.result import Diagnosis
from modelgen.diagnosis.validation import Check
from modelgen.effects import CATALOGUE, Family
from modelgen.effects.placement import joint_meant, titled
from modelgen.identification.impossible import impossible_at
from modelgen.report.words import finding, joint_name, listed, place_of, sentence, there

_SENTENCES = {
    "nothing_missing": "Nothing is missing that these records could show.",
    "cannot_tell": "These records cannot tell.",
}
_TITLES = 2  # suspects that are all in the headline, in words
_PART = 0.5  # of what is not noise: a suspect that explains less is not what is missing
UNMEASURED = (
    "No period repeats in the training records: what of the residuals is noise is not known, and a cause may "
    "be named for it. Record three periods of a motion to be sure."
)
SWINGING = (
    "A swing shows ratios alone: masses, centres of mass and inertia are those of the description. Where "
    "these are wrong, the difference looks like a spring or like friction."
)
_VISIBLE = 0.05  # percent: less is 0.0 in print
_SAME = 0.01  # of a cut-off, that needs no word
_ALIKE = 0.1  # of an error, that nobody who compares wonders about


def cause_title(d: Diagnosis, c: NamedCause) -> str:
    """A cause or suspect, and the joints that it has to do with."""
    return titled(d.arm, c.effect, c.joint, {name: e.value for name, e in c.parameters.items()})


def missing(d: Diagnosis) -> list[str]:
    """What is missing, a sentence for each cause; one that says so where none is named."""
    if d.verdict == "named":
        return [_found(d, c) for c in d.causes]
    if d.verdict == "suspected":
        clauses = [f"{perhaps(d, c)} ({c.effect})" for c in d.suspects]
        shown = clauses if len(clauses) <= _TITLES else [clauses[0], f"{len(clauses) - 1} more"]
        (best, share), fit = _explained(d), d.lack_of_fit
        if best is None or fit is None or not fit.found or share >= _PART:
            return [f"Nothing can be named; perhaps {listed(shown)}."]
        where = f"something deterministic remains, most at {_most(d, fit)}"
        what = "that" if len(clauses) == 1 else f"of these {cause_title(d, best)}"
        part = f"{100 * share:.0f} % of what is not noise at {place_of(d.arm, best.joint)}"
        return [f"Nothing can be named: {where}; perhaps {listed(shown)}, and {what} explains {part}."]
    return [_SENTENCES.get(d.verdict) or sentence(d.reason)]


def perhaps(d: Diagnosis, c: NamedCause) -> str:
    """What a suspect would be, in words without values."""
    others = (joint_meant(d.arm, c.effect, name, e.value) for name, e in c.parameters.items())
    return there(c.effect, place_of(d.arm, c.joint), next((name for name in others if name), ""))


def _found(d: Diagnosis, c: NamedCause) -> str:
    """A cause in a sentence, and what no motion of the arm tells from it."""
    said = sentence(finding(d.arm, c.effect, c.joint, c.parameters, c.records))
    if not c.aliases:
        return said
    same = " or ".join(titled(d.arm, effect, joint) for effect, joint in c.aliases)
    return f"{said} Or it is {same}: no motion of this arm tells them apart."


def reason(d: Diagnosis) -> str:
    """Why no cause is named; empty where `missing` says it."""
    return sentence(d.reason) if d.verdict in _SENTENCES else ""


def headline(d: Diagnosis) -> str:
    """The verdict in one sentence with what it is worth, or with its reason."""
    if d.verdict == "named":
        names = listed(cause_title(d, c) for c in d.causes)
        return " ".join([f"The model lacks {names}: {worth(d)}.", *doubted(d)])
    return " ".join(part for part in (*missing(d), reason(d), *no_arm(d)) if part)


def beside(d: Diagnosis) -> str:
    """What remains beside the causes, the reason without that the checks are passed; empty where nothing."""
    more = d.reason.partition("; ")[2] if d.verdict == "named" else ""
    return sentence(more) if more else ""


def by_worth(d: Diagnosis) -> list[int]:
    """Numbers of the causes, that of most worth on the test record first, those without a figure last."""
    gains = [c.share.gain for c in d.causes]
    return sorted(range(len(gains)), key=lambda k: np.inf if np.isnan(gains[k]) else -gains[k])


def worth(d: Diagnosis) -> str:
    """What the causes are worth on the test record, over all joints, and the worst joint where one lost."""
    e, (low, high) = d.errors, d.errors.interval
    worst = int(np.argmin(np.nan_to_num(e.gain)))
    if np.isnan(e.overall):
        return "the test record cannot tell what that is worth"
    joints = " over all joints" if len(e.gain) > 1 else ""
    between = interval(low, high, " ({} %)")
    if e.overall >= _VISIBLE:
        said = f"{e.overall:z.1f} % less error on the test record{joints}{between}"
    elif e.overall <= -_VISIBLE:
        said = f"the test record has {-e.overall:z.1f} % more error{joints}"
    else:
        said = f"the test record is predicted no better{joints}"
    if joints and e.gain[worst] <= -_VISIBLE:
        beyond = interval(-e.high[worst], -e.low[worst], " ({} %)")
        said += f", {-e.gain[worst]:z.1f} % more at {joint_name(d.arm, worst + 1)}{beyond}"
    return said


_MARKED = 1.0  # %, of harm that no interval says to be more than chance


def interval(low: float, high: float, around: str = "{}") -> str:
    """Of a gain [%], put into `around`; empty where the test record is too short for one, or where both ends
    are the same in print.
    """
    ends = f"{low:z.1f}", f"{high:z.1f}"
    return "" if np.isnan(low) or ends[0] == ends[1] else around.format(" to ".join(ends))


def harms(d: Diagnosis) -> list[str]:
    """Warnings about causes that make the test record worse."""
    short = " (it is too short for an interval)"
    return [
        f"With {cause_title(d, c)} the error on the test record is {-c.share.gain:z.1f} % "
        f"larger{short if np.isnan(c.share.low) else interval(-c.share.high, -c.share.low, ' ({} %)')}: what "
        "was found does not carry "
        f"over to that record.{CATALOGUE[c.effect].caveat}"
        for c in harmful(d)
    ]


def harmful(d: Diagnosis) -> list[NamedCause]:
    """Causes that make the test record worse, by their interval or, where it is too short for one, at all."""
    return [c for c in d.causes if c.share.high < 0.0 or (np.isnan(c.share.high) and c.share.gain < -_MARKED)]


def doubted(d: Diagnosis) -> list[str]:
    """Values that no arm has, and the causes that failed a check that decides nothing, or harm the test
    record, a sentence a kind.
    """
    worse = harmful(d)
    unconfirmed = [c for c in _failing(d, "confirmed") if not any(c is w for w in worse)]
    said = len(d.causes) == 1 and d.errors.overall <= -_VISIBLE  # by what it is worth
    kinds = (
        ("The test record is predicted worse with {}.", [] if said else worse),
        ("The test record does not confirm {}.", unconfirmed),
        ("Not stable, the training records differ in the size of {}.", _failing(d, "stable")),
    )
    marked = [text.format(listed(cause_title(d, c) for c in lost)) for text, lost in kinds if lost]
    unmeasured = d.causes and d.lack_of_fit is None and not d.free
    return [*no_arm(d), *marked, *([UNMEASURED] if unmeasured else [])]


def no_arm(d: Diagnosis) -> list[str]:
    """The sentence about values that no arm has; none where all can be those of one."""
    said = impossible_at(d.doubts, d.arm.coordinate_names)
    return [said] if said else []


def _failing(d: Diagnosis, name: str) -> list[NamedCause]:
    return [c for c in d.causes if any(k.name == name and k.passed is False for k in c.checks)]


def _explained(d: Diagnosis) -> tuple[NamedCause | None, float]:
    """The suspect that explains most of what is not noise at its joints, and that share; None: not known."""
    asked = [(s, c.value) for s in d.suspects for c in s.checks if c.name == "explains"]
    return max((one for one in asked if not np.isnan(one[1])), key=lambda one: one[1], default=(None, np.nan))


def _most(d: Diagnosis, f: LackOfFit) -> str:
    """The joint at which most is left, and when."""
    where, part = joint_name(d.arm, f.worst.joint + 1), d.lack_of_fit_part
    return where if part is None else f"{where}, {part[0]} from {part[1]:z.2f} to {part[2]:z.2f} s"


def remains(d: Diagnosis) -> str:
    """What repeats in the residuals beside the noise, with its size where something deterministic is left."""
    f = d.lack_of_fit
    if f is None:
        unknown = "No period repeats in the training records, so the noise could not be measured."
        return f"{unknown} {_left(d)}".rstrip()
    short = d.lack_of_fit_part is not None
    usual = "the most of many short parts of the period" if short else "1 for a complete model"
    said = (
        f"Lack of fit over {f.periods} repeated periods: {f.statistic:z.2f}, threshold {f.threshold:z.2f} "
        f"({usual}), largest at {_most(d, f)}."
    )
    sizes = repeating_sizes(d) if f.found else {}
    repeats = f"About {listed(sizes.values())} repeats (RMS)." if sizes else ""
    joints = _spoken_of(d)
    left = _left(d) if joints and not joints & sizes.keys() else ""
    return " ".join(part for part in (said, repeats, left) if part)


def _spoken_of(d: Diagnosis) -> set[int]:
    """Joints (from 0) at which the reason says that something is left; empty where it says none or all."""
    if d.likeness is None or d.verdict not in ("named", "outside_catalogue"):
        return set()
    joints = set(d.likeness.shape.columns)
    return joints if len(joints) < len(d.arm.coordinates) else set()


def efforts_of(d: Diagnosis) -> list[float] | None:
    """RMS (n,) of the efforts of the test record while joints move; None of a free motion."""
    if d.free:
        return None
    held = d.test
    effort = held.prepared.effort * held.gain
    moving = [held.moving[:, j] for j in range(effort.shape[1])]
    return [float(np.sqrt(np.mean(effort[m, j] ** 2))) if m.any() else np.nan for j, m in enumerate(moving)]


def _left(d: Diagnosis) -> str:
    """How large the error that is left is of the effort, noise and all.

    Where that is the largest share, of the joints of which the reason speaks if it speaks of some.
    """
    efforts = efforts_of(d)
    if efforts is None:
        return ""
    left = d.errors.after if d.causes else d.errors.before
    shares = np.array([x / e if e > 0.0 else np.nan for x, e in zip(left, efforts, strict=True)])
    if not np.isfinite(shares).any():
        return ""
    most = int(np.nanargmax(shares))
    j = max((k for k in _spoken_of(d) if np.isfinite(shares[k])), key=lambda k: shares[k], default=most)
    sizes = f"{number(left[j], 2)} of {number(efforts[j], 2)} {_unit(d, j)}"
    where = f" at {joint_name(d.arm, j + 1)}" if len(shares) > 1 else ""
    largest = ", the largest share of all joints" if where and j == most else ""
    share = f", {number(100.0 * shares[j], 2)} % of the effort{largest}"
    return f"What is left on the test record, noise and all, is {sizes} (RMS){where}{share}."


def repeating_sizes(d: Diagnosis) -> dict[int, str]:
    """About how large what is deterministic in the residuals of all rows is, of the effort.

    By joint (from 0), first those of which the reason speaks.
    Its mean square adds to the noise's, and k periods that repeat make (F - 1) / k of the noise's of it.
    """
    f, held, efforts = d.lack_of_fit, d.test, efforts_of(d)
    if f is None or efforts is None:
        return {}
    said = {}
    for j, name in enumerate(d.arm.coordinate_names):
        moving = held.moving[:, j]
        share = max(float(f.by_joint[j]) - 1.0, 0.0) / f.periods
        if share and moving.any():
            left = float(np.sqrt(np.mean(d.residuals[1][moving, j] ** 2) * share / (1.0 + share)))
            said[j] = f"{number(left, 2)} of {number(efforts[j], 2)} {_unit(d, j)} at {name}"
    first = _spoken_of(d)
    return {j: said[j] for j in sorted(said, key=lambda j: j not in first)}


def _unit(d: Diagnosis, j: int) -> str:
    units = d.test.prepared.effort_unit
    return units[j] if j < len(units) else d.errors.unit


def assumptions(d: Diagnosis) -> list[str]:
    """Values of the description that no record shows, what is missing there, and doubts."""
    used = [
        f"The drive's inertia at {joint_name(d.arm, k)} is set to {e.value:z.3g} {e.unit}, what was "
        "identified of drive and link together beyond the link's nominal inertials: stiffness and play are "
        "found with it. A value under drive_inertia in the description is used instead."
        for k, e in d.inertias.items()
    ]
    compliant = {c.joint for c in d.causes if CATALOGUE[c.effect].family is Family.ELASTIC}
    unknown = [
        f"The drive's inertia at {joint_name(d.arm, k)} cannot be separated from the link's: the extended "
        "model cannot be simulated, nor its forward dynamics used, until the description gives "
        "drive_inertia a value."
        for drive in d.after.model.grouping.drives
        if drive.nominal is None and (k := d.arm.coordinates.index(drive.joint) + 1) in compliant
    ]
    links = [SWINGING] if d.free else []
    return links + used + unknown + list(d.doubts)


def compared(d: Diagnosis) -> list[str]:
    """How to compare with what `modelgen identify` says of the same model, where that is another error."""
    if d.identified is None:
        return []
    rmse, usual = d.identified.rmse, d.identified.cutoff
    cutoff, before = float(d.settings["cutoff_hz"]), d.errors.before
    rested = bool((np.abs(rmse - before) > _ALIKE * rmse)[np.isfinite(before)].any())
    banded = abs(usual - cutoff) > _SAME * cutoff
    if not rested and not banded:
        return []
    said = [f"The errors on the test record are those below {cutoff:z.4g} Hz, while the joint moves."]
    if banded:
        said.append(
            f"Without an option modelgen identify counts those below {usual:z.4g} Hz, other errors than "
            f"these: to compare, call modelgen identify --cutoff {cutoff:z.6g}."
        )
    if rested:
        numbers = at_joints(d.arm.coordinate_names, [f"{x:z.4g}" for x in rmse])
        said.append(
            f"For the model as described {'it then' if banded else 'modelgen identify'} says {numbers} "
            f"[{d.errors.unit}], since it counts what its filter carries over from rest too, and "
            "weights the rows otherwise, which matters where a model lacks much."
        )
    return [" ".join(said)]


def checked(c: Check) -> tuple[str, str, str]:
    """Name, answer and figures of a check."""
    mark = "not asked" if c.passed is None else "yes" if c.passed else "no"
    if not c.decides and c.passed is False:
        mark = "no, which does not decide"
    return c.name, mark, c.text
