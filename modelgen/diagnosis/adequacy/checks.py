"""Checks of every cause, the same for all: what fails one that decides is a suspect, not a cause."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.diagnosis.adequacy.dominance import Dominance, dominance
from modelgen.diagnosis.adequacy.free_form import FreeForm, free_forms, further_terms
from modelgen.diagnosis.adequacy.lack_of_fit import lack_of_fit, repeating
from modelgen.diagnosis.adequacy.smooth_functions import Worth
from modelgen.diagnosis.candidates import with_causes
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import covariance, mean_squares
from modelgen.diagnosis.options.thresholds import in_band
from modelgen.diagnosis.selection import Cause, Selection, needed_evidence
from modelgen.diagnosis.validation import Check, agreement
from modelgen.numeric import Array
from modelgen.regression.weighted import moving_rows, rmse, weighted_fit


@dataclass(frozen=True)
class Examined:
    """A cause with its checks."""

    cause: Cause
    checks: tuple[Check, ...]

    @property
    def failed(self) -> tuple[Check, ...]:
        """Checks for which it is a suspect."""
        return tuple(c for c in self.checks if c.decides and c.passed is False)


def examined(selection: Selection, equations: Equations) -> list[Examined]:
    """Every cause of the selection with its checks. equations: of the band, all rows that move."""
    terms = further_terms(selection)
    forms, shares = free_forms(selection, equations, terms), explained(selection, terms)
    every = [
        Examined(
            cause,
            (
                _evidence(cause, selection),
                significant(k, selection, equations),
                admissible(cause, equations),
                _gain(cause, equations),
                _undominated(dominance(cause, selection)),
                _form(forms.get(cause.trial.candidate.joint)),
                shares[k],
                _stable(k, selection),
            ),
        )
        for k, cause in enumerate(selection.causes)
    ]
    return ended_by_suspects(every)


def ended_by_suspects(every: Sequence[Examined]) -> list[Examined]:
    """The same where a suspect ends the naming at its joint: what is found beside it explains what it leaves.

    every: in the order in which they were taken.
    """
    found: list[Examined] = []
    suspects: dict[int | None, Cause] = {}
    for one in every:
        joint = one.cause.trial.candidate.joint
        if joint is not None and joint in suspects and not one.failed:
            checks = tuple(_behind(check, suspects[joint], one.cause) for check in one.checks)
            found.append(replace(one, checks=checks))
            continue
        found.append(one)
        if one.failed:
            suspects.setdefault(joint, one.cause)
    return found


def _behind(check: Check, suspect: Cause, cause: Cause) -> Check:
    """The check `undominated` of a cause that was taken beside a suspect of its joint."""
    if check.name != "undominated":
        return check
    text = f"delta BIC by which {suspect.trial.candidate.effect}, a suspect at its joint, is ahead"
    return replace(check, passed=False, value=suspect.delta_bic - cause.delta_bic, text=text)


def confirmed(gain: float, low: float) -> Check:
    """Whether a cause lowers the error on the test record. gain, low: its share and the lower bound [%]."""
    asked = bool(np.isfinite(low))
    return Check(
        "confirmed",
        low > 0.0 if asked else None,
        False,
        low,
        0.0,
        f"it takes {gain:.1f} % off the error on the test record, at least {low:.1f} %"
        if asked
        else "the test record cannot tell what it is worth there",
    )


def _evidence(cause: Cause, selection: Selection) -> Check:
    least = needed_evidence(cause.trial, selection.system)
    text = "evidence (delta BIC) beside all other causes"
    return Check("evidence", cause.delta_bic >= least, True, cause.delta_bic, least, text)


def significant(k: int, selection: Selection, equations: Equations) -> Check:
    """Whether what an effect claims is not zero: asked of parameters without which it would not be there.

    k: number of the cause. equations: of the band.
    """
    cause = selection.causes[k]
    least = selection.system.equations.thresholds.adequacy.min_claimed_deviations
    c = cause.trial.candidate
    claims = [name for name in c.names if name in c.definition.claims]
    if not claims:
        text = "its evidence is that of all its parameters together"
        return Check("significant", True, True, float("nan"), float("nan"), text)
    found = c.definition.above_zero(equations.arm, *_estimated(k, selection))
    text = f"standard deviations that its {' and '.join(claims)} is above zero"
    return Check("significant", found >= least, True, found, least, text)


def _estimated(k: int, selection: Selection) -> tuple[Mapping[str, float], Mapping[str, float]]:
    """Values and standard deviations of what was estimated of the cause number k, by name."""
    system, own = selection.system, selection.columns[k]
    names = selection.causes[k].trial.candidate.names
    spread = np.sqrt(np.maximum(0.0, np.diag(covariance(system))))
    values = zip(names, system.theta[own].tolist(), strict=True)
    return dict(values), dict(zip(names, spread[own].tolist(), strict=True))


def admissible(cause: Cause, equations: Equations) -> Check:
    """Whether its values can be those of an arm, as far as these records tell. equations: of the band."""
    c = cause.trial.candidate
    why = c.definition.impossible(equations.arm, c.joint, cause.trial.parameters)
    why = why or _out_of_step(cause, equations)
    text = why or "nothing in its values speaks against it"
    return Check("admissible", not why, True, float("nan"), float("nan"), text)


def _out_of_step(cause: Cause, equations: Equations) -> str:
    """Why a delay of one joint among others is none of the arm: a log may read its channels in turn."""
    c = cause.trial.candidate
    delay = c.definition.delays(cause.trial.parameters)
    if delay is None or c.joint is None or equations.n == 1:
        return ""
    interval = max(r.prepared.record.step for r in equations.rows)
    if abs(delay) >= interval:
        return ""
    return (
        f"{delay:.2g} s at one joint is less than a sample of {interval:.2g} s, in which a log "
        "may read one channel after the other; log faster to tell"
    )


def _gain(cause: Cause, equations: Equations) -> Check:
    least = in_band(equations.thresholds.validation.min_gain_percent, equations.narrowed)
    found = max(x for x in (cause.cross_gain, cause.expected_gain) if not np.isnan(x))
    text = "percent less error on rows that its fit has not seen"
    return Check("gain", True, True, found, least, text)


def _undominated(by: Dominance) -> Check:
    text = "delta BIC by which a refused candidate of its turn is ahead"
    if by.place is not None:
        effect, joint = by.place
        text = (
            f"delta BIC by which {effect} {'of the arm' if joint is None else f'at joint {joint}'} is ahead"
        )
    return Check("undominated", by.ahead <= by.most, True, by.ahead, by.most, text)


def _form(by: FreeForm | None) -> Check:
    if by is None:
        text = "no function of position and speed does as well"
        return Check("form", True, True, float("nan"), float("nan"), text)
    text = "delta BIC by which a free function of the joint's position and speed is ahead"
    return Check("form", not by.better, True, by.ahead, by.most, text)


def _stable(k: int, selection: Selection) -> Check:
    system = selection.system
    least = system.equations.thresholds.adequacy.min_stable_probability
    parts = [([row], [i]) for i, row in enumerate(system.rows)]
    trial = selection.causes[k].trial
    others = [c.trial for i, c in enumerate(selection.causes) if i != k]
    columns = with_causes(system.equations, [*others, trial])  # the cause's own at the end
    own = columns[0].shape[2] - trial.columns[0].shape[2]
    found = agreement(parts, system.equations, columns, own) if len(parts) > 1 else float("nan")
    text = "probability of records that differ as much in its size where that is the same in all"
    return Check("stable", None if np.isnan(found) else found >= least, False, found, least, text)


def explained(selection: Selection, terms: Mapping[int, Worth]) -> list[Check]:
    """Whether the causes at the joints of each cause explain most of what is not noise there.

    What still repeats from period to period is not noise; what errors of the positions repeat is no lack of
    the model, and what the further terms of a law that is the first ones of a series explain is its own,
    where they are the lesser part. A law that stands in for one that the catalogue lacks leaves more than the
    law itself would. Passed as well where no more repeats than noise leaves by chance. terms: by joint, see
    `further_terms`.
    """
    system, limits = selection.system, selection.system.equations.thresholds.adequacy
    equations, least = system.equations, limits.min_explained_share
    text = "share of what is not noise at its joints that the causes there explain together"
    fit = lack_of_fit(system)
    if fit is None:
        return [Check("explains", None, True, float("nan"), least, text) for _ in selection.causes]
    sizes = mean_squares(system)
    bare = rmse(equations.rows, equations.columns, weighted_fit(equations.rows, equations.columns)) ** 2
    left = np.maximum(0.0, repeating(system) - _repeating_errors(equations))
    left = np.maximum(0.0, left - _of_further_terms(selection, terms))
    gained, rest = (bare - sizes) / sizes, left / sizes
    found = []
    for cause in selection.causes:
        joints = cause.trial.candidate.joints(system.n)
        more, less = float(gained[joints].sum()), float(rest[joints].sum())
        share = more / (more + less) if more + less > 0.0 else 0.0
        passed = share >= least or fit.usual(joints, limits.usual_null_share)
        found.append(Check("explains", passed, True, share, least, text))
    return found


def _of_further_terms(selection: Selection, terms: Mapping[int, Worth]) -> Array:
    """Mean squares (n,) that the further terms of laws explain beside all causes, where they are lesser."""
    system, sizes, found = selection.system, mean_squares(selection.system), np.zeros(selection.system.n)
    most = system.equations.thresholds.adequacy.max_further_terms_share
    for cause in selection.causes:
        c = cause.trial.candidate
        if c.joint is None or not c.definition.series:
            continue
        best = terms[c.joint]
        if 0.0 < best.evidence < most * cause.delta_bic:
            found[c.joint - 1] = sizes[c.joint - 1] * (1.0 - (1.0 - best.percent / 100.0) ** 2)
    return found


def _repeating_errors(equations: Equations) -> Array:
    """Mean squares of what errors of the positions leave alike in every period, by joint (n,)."""
    total, count = np.zeros(equations.n), moving_rows(equations.rows)
    for r in equations.rows:
        if r.repeated is not None:
            total += (r.repeated**2 * r.moving).sum(axis=0)
    return np.asarray(total / np.maximum(count, 1.0))
