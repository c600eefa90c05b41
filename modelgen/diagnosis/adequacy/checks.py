"""Checks of every cause, the same for all: what fails one that decides is a suspect, not a cause."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.charts import number
from modelgen.description import Arm
from modelgen.diagnosis.adequacy.dominance import Dominance, dominance
from modelgen.diagnosis.adequacy.explained import explained
from modelgen.diagnosis.adequacy.figures_said import (
    FREE_FUNCTION,
    ahead_of,
    beyond,
    claimed,
    form_said,
    percent,
    possible,
    significance,
)
from modelgen.diagnosis.adequacy.free_form import FreeForm, free_forms, further_terms
from modelgen.diagnosis.adequacy.log_delay import out_of_step
from modelgen.diagnosis.candidates import FittedCandidate, beyond_bounds, with_causes
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.options.thresholds import in_band
from modelgen.diagnosis.selection import (
    SUSPECT,
    Cause,
    Selection,
    deviations,
    left_beside_hidden_weight,
    needed_evidence,
    refit_elastic,
    threshold,
)
from modelgen.diagnosis.validation import Check, Part, Split, agreement, folds
from modelgen.effects.placement import titled


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
    stable = [_stable(k, selection) for k in range(len(selection.causes))]
    every = [
        Examined(
            cause,
            (
                _evidence(cause, selection),
                significant(k, selection, equations, stable[k].widened),
                admissible(cause, equations, solved),
                _gain(cause, equations),
                _undominated(dominance(cause, selection), equations.arm),
                *complete,
                stable[k],
            ),
        )
        for k, (cause, solved, complete) in enumerate(
            zip(selection.causes, selection.solved, _complete(selection, equations), strict=True)
        )
    ]
    return of_those_that_stay(ended_by_suspects(every), selection, equations)


def of_those_that_stay(
    every: Sequence[Examined], selection: Selection, equations: Equations
) -> list[Examined]:
    """The same where causes that stay explain what is there without the suspects.

    What a suspect explained nothing explains, and is no noise: `form` and `explains` are asked again of the
    others alone, until none more becomes a suspect.
    """
    found = list(every)
    while True:
        staying = [k for k, e in enumerate(found) if not e.failed]
        if len(staying) in (0, len(found)):
            return found
        suspects = [e.cause for e in found if e.failed]
        kept = selection.without(suspects, SUSPECT)
        for k, complete in zip(staying, _complete(kept, equations, suspects), strict=True):
            again = {check.name: check for check in complete}
            found[k] = replace(found[k], checks=tuple(again.get(c.name, c) for c in found[k].checks))
        if not any(found[k].failed for k in staying):
            return found


def _complete(
    selection: Selection, equations: Equations, suspects: Sequence[Cause] = ()
) -> list[tuple[Check, Check]]:
    """For every cause, whether those of its joints say all that is to say there: `form` and `explains`."""
    terms = further_terms(selection)
    failed = [c.trial for c in suspects]
    forms = free_forms(selection, equations, terms, failed)
    shares = explained(selection, terms, failed)
    own = (forms.get(c.trial.candidate.joint) for c in selection.causes)
    return [(_form(form), share) for form, share in zip(own, shares, strict=True)]


def ended_by_suspects(every: Sequence[Examined]) -> list[Examined]:
    """The same where a suspect ends the naming at its joint, and a law whose form is a guess at any: what is
    found beside it explains what it leaves. every: in the order in which they were chosen.
    """
    found: list[Examined] = []
    suspects: dict[int | None, Cause] = {}
    guess: Cause | None = None
    for one in every:
        c = one.cause.trial.candidate
        before = guess if c.joint is None or c.joint not in suspects else suspects[c.joint]
        if before is not None and not one.failed:
            checks = tuple(_behind(check, before, one.cause, guess) for check in one.checks)
            found.append(replace(one, checks=checks))
            continue
        found.append(one)
        if one.failed:
            suspects.setdefault(c.joint, one.cause)
        elif c.definition.conditional(c.fixed):
            guess = one.cause
    return found


def _behind(check: Check, before: Cause, cause: Cause, guess: Cause | None) -> Check:
    """The check `undominated` of a cause that was chosen beside a suspect of its joint, or beside a guess."""
    if check.name != "undominated":
        return check
    ahead = before.delta_bic - cause.delta_bic
    what, other = (
        ("whose form is a guess", "guess") if before is guess else ("a suspect at its joint", "suspect")
    )
    text = (
        f"{before.trial.candidate.effect}, {what}, is "
        f"{number(abs(ahead))} {'ahead of' if ahead > 0.0 else 'behind'} it in delta BIC: what is found "
        f"beside a {other} explains what that leaves"
    )
    return replace(check, passed=False, value=ahead, text=text)


def confirmed(gain: float, low: float, there: bool = True) -> Check:
    """Whether a cause lowers the error on the test record.

    gain, low: its share and the lower bound [%]. there: whether the record has it, or is predicted better by
    an arm without it.
    """
    asked = bool(np.isfinite(low))
    text = "the test record cannot tell what it is worth there"
    if np.isfinite(gain):
        end = "which is too short for an interval"
        if asked:
            worst = f"{abs(low):.1f} % {_sense(low)} at the lower end of the 95 % interval"
            end = f"{worst}; more than 0 % less confirms it"
        how = "with it" if there else "where it is not, once the training records are fitted with it"
        text = f"{abs(gain):.1f} % {_sense(gain)} error on the test record {how}, {end}"
    return Check("confirmed", low > 0.0 if asked else None, False, low, 0.0, text)


def _sense(gain: float) -> str:
    return "less" if gain >= 0.0 else "more"


def _evidence(cause: Cause, selection: Selection) -> Check:
    trial, system = cause.trial, selection.system
    least, usual = needed_evidence(trial, system), threshold(system)
    limits = system.equations.thresholds.selection
    unknown = "too little repeats" if system.noise_known else "no period repeats"
    why = "" if system.coloured else f", since {unknown} by which the noise could be measured"
    if least > usual:
        single = least == limits.single_parameter_delta_bic and not trial.candidate.passing
        whose = "a cause with a single parameter" if single else "what fades within a record"
        why = f" of {whose}, {number(usual)} of others"
    share = left_beside_hidden_weight(cause, selection)
    found = share * cause.delta_bic
    beside = "all other causes" if share == 1.0 else "all other causes and weights that an upright arm hides"
    text = f"{number(found)} of delta BIC, the evidence for it beside {beside}; {number(least)} is asked{why}"
    return Check("evidence", found >= least, True, found, least, text)


def significant(k: int, selection: Selection, equations: Equations, widened: float = 1.0) -> Check:
    """Whether what an effect claims is not zero: asked of parameters without which it would not be there.

    k: number of the cause. equations: of the band. widened: times that the records differ more in it than
    noise does.
    """
    trial = selection.causes[k].trial
    if not claimed(trial):
        return significance_of(trial, equations, {}, {})
    settled = refit_elastic(selection, equations)
    values, spread = settled.causes[k].trial.parameters, deviations(settled, equations).causes[k]
    return significance_of(trial, equations, values, {name: widened * s for name, s in spread.items()})


def significance_of(
    trial: FittedCandidate, equations: Equations, values: Mapping[str, float], spread: Mapping[str, float]
) -> Check:
    """The check `significant` of a cause with these values and standard deviations, by name."""
    found, text = significance(trial, equations.arm, values, spread)
    if not claimed(trial):
        return Check("significant", True, True, found, float("nan"), text)
    least = equations.thresholds.adequacy.min_claimed_deviations
    return Check("significant", found >= least, True, found, least, f"{text}; {number(least)} is asked")


def admissible(cause: Cause, equations: Equations, solved: FittedCandidate | None = None) -> Check:
    """Whether its values can be those of an arm, as far as these records tell. equations: of the band.

    solved: the cause with the values that it has beside all others, where these are known.
    """
    c = cause.trial.candidate
    why = "" if solved is None else beyond(beyond_bounds(solved))
    why = why or c.definition.impossible(equations.arm, c.joint, cause.trial.parameters)
    why = why or out_of_step(cause, equations)
    said = why or possible(cause, equations.arm)
    return Check("admissible", not why, True, float("nan"), float("nan"), said)


def _gain(cause: Cause, equations: Equations) -> Check:
    least = in_band(equations.thresholds.validation.min_gain_percent, equations.narrowed)
    found = max(x for x in (cause.cross_gain, cause.expected_gain) if not np.isnan(x))
    hoped = "" if np.isnan(cause.expected_gain) else f", {cause.expected_gain:z.1f} % expected there"
    text = (
        f"{cause.cross_gain:z.1f} % less error on rows that its fit has not seen{hoped}; "
        f"one of them must be {number(least)} % at least"
    )
    return Check("gain", True, True, found, least, text)


def _undominated(by: Dominance, arm: Arm) -> Check:
    text = "nothing else explains as much at its joint"
    if by.place is not None:
        other = f"{titled(arm, *by.place)}, which fails a condition and is no cause itself,"
        text = f"{other} {ahead_of(by.ahead, by.most)}"
    return Check("undominated", by.ahead <= by.most, True, by.ahead, by.most, text)


def _form(by: FreeForm | None) -> Check:
    if by is None:
        text = f"nothing like {FREE_FUNCTION} of the joint's motion is set against it: none acts as it does"
        return Check("form", True, True, float("nan"), float("nan"), text)
    value, asked = (-by.ahead, -by.most) if by.slow else (by.ahead, by.most)
    return Check("form", not by.as_good, True, value, asked, form_said(by))


def _stable(k: int, selection: Selection) -> Check:
    system = selection.system
    least = system.equations.thresholds.adequacy.min_stable_probability
    trial = selection.causes[k].trial
    limits, what = system.equations.thresholds.validation, "records"
    parts: list[Part] = [([row], [i]) for i, row in enumerate(system.rows)]
    if trial.candidate.coming:  # which some records are without
        split, what = Split(limits.max_records_one_by_one, halves=True), "halves of the records"
        parts = [part for _, part in folds(system.rows, split)]
    others = [c.trial for i, c in enumerate(selection.causes) if i != k]
    columns = with_causes(system.equations, [*others, trial])  # the cause's own at the end
    own = columns[0].shape[2] - trial.columns[0].shape[2]
    if len(parts) == 1:
        text = "one record cannot tell whether its size is the same in all"
        return Check("stable", None, False, float("nan"), least, text)
    found, ratio = agreement(parts, system.equations, columns, own)
    text = (
        f"{what} differ in its size as much as these in {percent(found)} of cases where it is the same "
        f"in all; {percent(least)} is asked"
    )
    if found >= least or np.isnan(ratio):
        return Check("stable", found >= least, False, found, least, text)
    text += f"; its deviations are {ratio:z.2g} times those of noise alone, so that they hold what differs"
    return Check("stable", False, False, found, least, text, ratio)
