"""The verdict and the sentence that gives its reason."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.description import Arm
from modelgen.diagnosis.adequacy.checks import Examined
from modelgen.diagnosis.adequacy.lack_of_fit import LackOfFit, place
from modelgen.diagnosis.adequacy.smooth_functions import Likeness
from modelgen.diagnosis.candidates import Candidate, at_motor
from modelgen.diagnosis.evidence import Endogeneity
from modelgen.diagnosis.selection import Cause, Selection
from modelgen.effects.placement import titled
from modelgen.identification.objects import Doubt
from modelgen.numeric import Array

# Percent of the RMSE that errors of the positions could feign where they are half of its square.
LARGER_PART = 100.0 * (1.0 - np.sqrt(0.5))


@dataclass(frozen=True)
class Remains:
    """Findings that speak for a verdict besides the causes.

    suspects: what has evidence and failed a check; unclear: what coarse positions do not tell from its
    rivals; fit: lack of fit, None where nothing repeats; feigned: percent of the RMSE by joint that errors of
    the positions could feign; correlated: what the test of Durbin, Wu and Hausman says, None where it has no
    say; likeness: what is left is most like; counted: whether the encoders' counts are all the noise there
    is, and what remains is no more than that; asked: whether some effects alone were asked for; drifting:
    questions about joints whose efforts change against the model's as time goes by.
    """

    suspects: Sequence[Examined]
    unclear: Sequence[Cause]
    fit: LackOfFit | None
    feigned: Array
    correlated: Endogeneity | None
    likeness: Likeness | None
    counted: bool = False
    asked: bool = False
    drifting: Sequence[Doubt] = ()


def verdict_of(selection: Selection, remains: Remains) -> tuple[str, str]:
    """Which of the five, and why."""
    fit, likeness, correlated = remains.fit, remains.likeness, remains.correlated
    least = selection.system.equations.thresholds.validation.min_gain_percent
    arm = selection.system.equations.arm
    names = arm.coordinate_names
    like = "" if likeness is None else f", most like {likeness.shape.text}"
    if selection.causes:
        left = like or (fit is not None and fit.found)
        beside = "it" if len(selection.causes) == 1 else "them"
        return "named", "a cause passed every check that decides" + (
            f"; something deterministic remains beside {beside}{like}" if left else ""
        )
    if remains.suspects and not _misread(remains):
        return "suspected", "; ".join(_suspected(arm, e) for e in remains.suspects)
    if remains.unclear:
        rivals = " and ".join(_rivals(arm, c) for c in remains.unclear)
        return "cannot_tell", (
            f"the positions are too coarse to tell {rivals}: each "
            f"explains what is missing nearly as well; {_finer(selection)} can tell"
        )
    if remains.counted and not remains.drifting:
        return "nothing_missing", (
            "what remains is no more than what the counts of the encoders leave; whatever is less than that "
            "takes finer ones to see"
        )
    if remains.feigned.max() > (least if _in_doubt(selection, remains) else LARGER_PART):
        worst = int(np.argmax(remains.feigned))
        what, finer = "the positions are too coarse or too noisy", _finer(selection)
        if _steps_of_effort(selection, worst):
            what = "the efforts are logged in steps that are too coarse"
            finer = "finer steps, or a motion that differs from period to period,"
        return "cannot_tell", (
            f"{what}: their errors alone could feign a gain of {remains.feigned.max():.1f} % at "
            f"{names[worst]}, and nothing explains more; {finer} can tell"
        )
    if fit is None:
        more = ": excite with three or more identical periods (--period says how long where it is not found)"
        return "cannot_tell", (
            "nothing could be named, and no period repeats by which the noise could be measured"
            + ("" if selection.system.equations.free else more)
        )
    if correlated is not None and correlated.found and correlated.cost.max() > least:
        joint = names[int(np.argmax(correlated.cost))]
        return "cannot_tell", (
            "the positions are too noisy: the regressor is correlated with the residuals (test of Durbin, Wu "
            f"and Hausman, {correlated.statistic:.0f} over a threshold of {correlated.threshold:.0f}), which "
            f"costs {correlated.cost.max():.1f} % at {joint}; better encoders can tell"
        )
    pool = "none of the effects asked for" if remains.asked else "no effect of the catalogue"
    if fit.found or likeness is not None:
        return (
            "outside_catalogue",
            f"something deterministic remains{_where(fit, selection)} that {pool} explains{like}",
        )
    if remains.drifting:
        where = ", ".join(name for doubt in remains.drifting for name in doubt.joints)
        return (
            "outside_catalogue",
            f"the efforts of {where} change against the model's as time goes by, which {pool} explains",
        )
    return "nothing_missing", "what remains does not repeat from period to period: it is noise"


def _misread(remains: Remains) -> bool:
    """Whether what is left is an encoder's error, and functions of no law are ahead of all suspects."""
    likeness = remains.likeness
    if likeness is None or likeness.shape.encoder is None:
        return False
    return all("form" in [c.name for c in e.failed] for e in remains.suspects)


def _in_doubt(selection: Selection, remains: Remains) -> bool:
    """Whether anything remains that errors of the positions may have made, or may hide.

    Else what remains is noise, whichever part of it is the positions'.
    """
    deterministic = remains.fit is None or remains.fit.found or remains.likeness is not None
    return deterministic or any(r.refused == "positions" for turn in selection.turns for r in turn)


def _steps_of_effort(selection: Selection, joint: int) -> bool:
    """Whether the rounding of its efforts is the larger part of what errors leave at a joint (from 0)."""
    equations = selection.system.equations
    every, efforts = (np.broadcast_to(x, equations.n)[joint] for x in (equations.blur, equations.stepped))
    return bool(2.0 * efforts > every)


def _finer(selection: Selection) -> str:
    """The encoders that can tell: at the motors, where they are not there."""
    rows, n = selection.system.rows, selection.system.n
    motors = all(at_motor(j, rows) for j in range(1, n + 1))
    return "finer encoders" if motors else "finer encoders, or encoders at the motors,"


def _suspected(arm: Arm, e: Examined) -> str:
    why = " and ".join(f"{c.name} ({c.text})" for c in e.failed)
    return f"{_title(arm, e.cause.trial.candidate)} has evidence and fails a check: {why}"


def _where(fit: LackOfFit, selection: Selection) -> str:
    if not fit.found:
        return ""
    where = place(fit, selection.system.rows)
    part = ""
    if where is not None:
        part = f", most from {where[1]:.2f} to {where[2]:.2f} s of {where[0]} and whenever that repeats,"
    return f" at {selection.system.equations.arm.coordinate_names[fit.worst.joint]}{part}"


def _rivals(arm: Arm, cause: Cause) -> str:
    others = " or ".join(_title(arm, t.candidate) for t, _ in cause.rivals)
    return f"{_title(arm, cause.trial.candidate)} from {others}"


def _title(arm: Arm, c: Candidate) -> str:
    return titled(arm, c.effect, c.joint)
